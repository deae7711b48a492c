"""Samples of the posterior and the evidence for a prior, as a run tells them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.verbs.updating.test_measured_beside import TRUTH, files

import trueup
from trueup.core.errors import InputError

__all__ = ["files"]
ASKED = {"deck_length_unit": "mm", "residuals": "frequencies, prior", "frequency_sigma": 0.01}


def test_samples_and_evidence_are_told_and_come_back(
    files: tuple[Path, Path], tmp_path: Path
) -> None:
    done = trueup.update(
        *files, ["MAT1 1 E [0.3, 3]"], samples=1200, evidence=True, prior_sigma=0.3, **ASKED
    )
    (row,), (parameter,) = done.samples, done.parameters
    assert row.name == parameter.name
    error = row.standard_deviation / np.sqrt(row.effective)
    assert row.mean == pytest.approx(parameter.factor, abs=4.0 * error)
    assert row.standard_deviation == pytest.approx(parameter.standard_error, rel=0.15)
    assert row.low < row.median < row.high
    assert done.draws.values.shape == (1000, 1)
    ratio = TRUTH[0] / TRUTH[1]
    best = max(done.evidence, key=lambda r: r.log_evidence)
    assert 0.3 * abs(ratio - 1.0) < best.prior_sigma < 3.0 * abs(ratio - 1.0)
    again = trueup.open_run(done.save(tmp_path / "run"))
    np.testing.assert_array_equal(again.draws.values, done.draws.values)
    assert list(again.evidence) == list(done.evidence)
    page = (tmp_path / "run" / "report.html").read_text(encoding="utf-8")
    assert "Evidence for the prior" in page
    assert "worth" in page
    assert len((tmp_path / "run" / "tables" / "draws.csv").read_text().splitlines()) == 1001


def test_evidence_asks_for_a_prior(files: tuple[Path, Path]) -> None:
    with pytest.raises(InputError, match="add it to the residuals"):
        trueup.update(*files, "MAT1 1 E", evidence=True, deck_length_unit="mm")


def test_samples_are_not_less_than_none(files: tuple[Path, Path]) -> None:
    with pytest.raises(InputError, match="samples is -1; it must be 0 or more"):
        trueup.update(*files, "MAT1 1 E", samples=-1)
