"""Samples of the posterior and the evidence for a prior, as a run tells them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.verbs.updating.test_measured_beside import TRUTH, E, cantilever, files

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


@pytest.mark.parametrize("product", [1.0, 1.2])
def test_what_is_put_back_has_neither_interval_nor_samples(tmp_path: Path, product: float) -> None:
    """Of E and I bending knows the product; the mass at the tip is known by itself.

    As in the deck a product of 1.2 would leave that mass farther from the test than it came, so
    that it makes up for it, and its error says so.
    """
    deck, truth, test = (tmp_path / n for n in ("bar.bdf", "truth.bdf", "test.unv"))
    for path, e, tip in ((deck, E, 1e-4), (truth, product * E, 1.3e-4)):
        held = "SPC1,1,123456,1"
        path.write_text(cantilever(e).replace(held, f"{held}\nCONM2,91,13,,{tip}"))
    trueup.solve(truth, 5).save(tmp_path / "solved")
    trueup.convert([tmp_path / "solved" / "result.h5"], test)
    done = trueup.update(
        deck, test, ["MAT1 1 E", "I = PBAR 1 I1, PBAR 1 I2", "CONM2 91 M"], samples=400,
        intervals=True, residuals="frequencies", deck_length_unit="mm",
    )  # fmt: skip
    e, i, tip = done.parameters
    assert (e.factor, e.standard_error, e.interval) == (1.0, None, None)
    assert (i.factor, i.standard_error, i.interval) == (1.0, None, None)
    assert [row.name for row in done.samples] == ["CONM2 91 M"]
    assert any("known together" in w for w in done.warnings)
    (row,) = done.samples
    assert tip.interval[0] - 1e-4 <= tip.factor <= tip.interval[1] + 1e-4
    assert row.low - 1e-4 <= tip.factor <= row.high + 1e-4
    off = (done.before, done.after)
    before, after = (c.summary.mean_abs_deviation_percent for c in off)
    assert after < before
    if product == 1.0:
        assert tip.factor == pytest.approx(1.3, rel=0.01)
        assert tip.interval == pytest.approx((1.3, 1.3), rel=0.01)
    else:
        assert any("fitted anew beside it" in w for w in done.warnings)
        assert abs(tip.factor - 1.3) < 1.1 * tip.standard_error
