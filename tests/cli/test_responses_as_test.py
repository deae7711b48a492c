"""Frequency responses of whole tests in place of modes: GARTEUR, measured, and the duct."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

DATA = Path(__file__).parents[3] / "shared" / "data"
GARTEUR = DATA / "uff" / "garteur_frf_1995.uff"

Call = Callable[..., Any]


@pytest.mark.skipif(not GARTEUR.exists(), reason=f"real data absent: {GARTEUR.name}")
def test_garteur_frfs_correlate_in_one_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: Call
) -> None:
    """Rigid-body and suspension modes of the model pair with none of the nine elastic ones."""
    monkeypatch.chdir(tmp_path)
    deck = DATA / "nastran" / "garteur" / "garteur_fem.bdf"
    answer = call(
        "correlate", deck, GARTEUR, DATA / "uff" / "garteur_geometry.unv", "--json", "-", "--quiet"
    )
    assert answer.status == 0
    result = json.loads(answer.out)
    hz = [p["test_hz"] for p in result["pairs"]]
    known = [6.5, 16.4, 33.5, 34.0, 36.1, 49.4, 50.2, 55.6, 64.2]
    assert hz == pytest.approx(known, rel=5e-3)
    assert min(p["analysis"] for p in result["pairs"]) > 6
    assert min(p["mac"] for p in result["pairs"]) > 0.8
    assert any("one reference cannot tell" in w for w in result["warnings"])
    assert any("weigh by their standard errors" in w for w in result["warnings"])
    assert any("seem computed" in w for w in result["warnings"])


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="real data absent")
def test_an_update_says_what_the_identified_modes_weigh(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: Call
) -> None:
    monkeypatch.chdir(tmp_path)
    case = DATA / "cases" / "duct"
    flanges = ["-p", "PBAR 11 I1, PBAR 11 I2", "-p", "PBAR 12 I1, PBAR 12 I2"]
    weights = []
    for test in ("duct_frf.unv", "duct_test.unv"):
        answer = call(
            "update", case / "duct.bdf", case / test, *flanges, "--residuals", "frequencies",
            "--json", "-", "--quiet",
        )  # fmt: skip
        assert answer.status == 0
        weights.append(json.loads(answer.out)["weights"])
    assert weights[1] is None
    assert len(weights[0]["frequency_std_percent"]) == 24
    assert 0.0 < max(weights[0]["frequency_std_percent"]) < 0.01
    assert 0.1 < max(weights[0]["shape_std_percent"]) < 1.0
    assert len(weights[0]["sensor_weights"]) == 71


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="real data absent")
def test_duct_frfs_pair_as_its_modes_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: Call
) -> None:
    """Every mode of the modal test (0.1 % noise) that pairs is paired when identified here, too."""
    monkeypatch.chdir(tmp_path)
    case = DATA / "cases" / "duct"
    paired = []
    for test in ("duct_frf.unv", "duct_test.unv"):
        answer = call("correlate", case / "duct.bdf", case / test, "--json", "-", "--quiet")
        assert answer.status == 0
        paired.append(np.array([p["test_hz"] for p in json.loads(answer.out)["pairs"]]))
    assert len(paired[1]) >= 10
    for hz in paired[1]:
        assert np.abs(paired[0] / hz - 1.0).min() < 5e-3
