"""Frequency responses given beside the modes of a test, on a case made by CalculiX."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trueup.adapters.universal import read_test, write_universal
from trueup.core.data.frfs import Frfs
from trueup.core.identification.survey.modal_synthesis import poles_from

CASE = Path(__file__).resolve().parent / "cases" / "0003_tower_joint_flexibility"


def _driven(path: Path, noise: float = 0.02) -> None:
    """Write the responses that the modes of the test make, two references, 2 % noise."""
    measurement = read_test([CASE / "tower_test.unv"])
    m = measurement.modes
    assert m is not None
    shapes = 1e3 * m.shapes
    loud = np.argsort(-np.sum(shapes**2, axis=1))[:2]
    f = np.linspace(0.8 * m.frequencies_hz[0], 1.1 * m.frequencies_hz[-1], 1500)
    jw = 2j * np.pi * f
    poles = poles_from(m.frequencies_hz, m.damping)
    gain = jw**2 / ((jw - poles[:, None]) * (jw - poles.conj()[:, None]))
    values = np.einsum("rk,sk,kf->rsf", shapes, shapes[loud], gain)
    rng = np.random.default_rng(4)
    values = values * (1.0 + noise * rng.standard_normal(values.shape))
    frfs = Frfs(f, m.dofs, m.dofs.take(loud), values)
    write_universal(path, geometry=measurement.geometry, modes=replace(m), frfs=frfs, units="m")


@pytest.mark.slow
def test_responses_are_met_better_with_what_was_found(tmp_path):
    from trueup.cli.app import app

    _driven(tmp_path / "both.unv")
    app(
        f"discover {CASE}/tower.bdf {tmp_path}/both.unv --deck-length-unit mm "
        f"--out {tmp_path}/run --quiet".split(),
        standalone_mode=False,
    )
    result = json.loads((tmp_path / "run" / "result.json").read_text())
    assert [f["kind"] for f in result["findings"]] == ["joint_flexibility"]
    frf = result["frf"]
    log = frf["log_misfit"]
    assert log["after"] < min(log["before"], log["parameters"])
    assert frf["mean_frac"]["before"] < 0.6
    assert frf["mean_frac"]["after"] > 0.9
    assert 10 < frf["independent_lines"] < frf["lines"] == 1500
    assert "Frequency responses" in (tmp_path / "run" / "report.html").read_text()
