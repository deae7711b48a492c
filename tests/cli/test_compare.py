"""Runs, decks and modes side by side, and modes of any file as a test."""

from __future__ import annotations

from pathlib import Path

import pytest

import trueup
from trueup.core.errors import InputError

DATA = Path(__file__).parents[3] / "shared" / "data" / "nastran"


@pytest.fixture(scope="module")
def runs(duct, call, tmp_path_factory):
    """The folders of a correlation and of an update of the same files."""
    folder = tmp_path_factory.mktemp("runs")
    files = (duct / "duct.bdf", duct / "duct_test.unv", "--deck-length-unit", "mm", "-q")
    moved = ("--residuals", "frequencies", "-p", "PBAR 11 I1, PBAR 11 I2")
    assert call("correlate", *files, "--out", folder / "as_is").status == 0
    assert call("update", *files, *moved, "--out", folder / "moved").status == 0
    return folder


def test_runs_stand_side_by_side(runs, call, tmp_path):
    said = call("compare", runs / "as_is", runs / "moved", "--out", tmp_path / "both")
    assert said.status == 0
    assert "as_is (correlate)" in said.out
    found = trueup.compare([runs / "as_is", runs / "moved"])
    one, two = (trueup.open_run(runs / name) for name in ("as_is", "moved"))
    for row, run in zip(found.sources, (one, two), strict=True):
        assert row.pairs == run.final.summary.pairs
    assert {v.source for v in found.values} == {"moved"}
    assert found.values[0].value == pytest.approx(two.parameters[0].updated[0])
    assert (tmp_path / "both" / "tables" / "modes.csv").is_file()


def test_decks_stand_side_by_side(runs, duct):
    found = trueup.compare([duct / "duct.bdf", runs / "moved" / "deck" / "duct.bdf"], 14)
    assert {v.name for v in found.values} == {"PBAR 11 I1", "PBAR 11 I2"}
    assert {m.mode for m in found.modes} == set(range(7, 15))
    assert found.sources[0].mass == pytest.approx(found.sources[1].mass)
    assert found.sources[0].kilograms == pytest.approx(1000.0 * found.sources[0].mass)
    assert found.sources[1].pairs == sum(m.partner is not None for m in found.modes) > 4


def test_a_deck_agrees_with_its_own_modes(duct, call, tmp_path):
    modes = trueup.solve(duct / "duct.bdf", 14).write(tmp_path / "modes.h5")
    found = trueup.compare([duct / "duct.bdf", modes], 14)
    assert [m.partner for m in found.modes] == list(range(7, 15))
    assert all(m.mac == pytest.approx(1.0) and abs(m.deviation_percent) < 1e-6
               for m in found.modes)  # fmt: skip
    paired = trueup.correlate(duct / "duct.bdf", modes)
    assert [(p.test, p.analysis) for p in paired.pairs] == [(k, k) for k in range(7, 15)]


@pytest.mark.skipif(not DATA.is_dir(), reason="the shared data are not there")
def test_results_of_nastran_are_a_test_with_the_deck_of_their_grids():
    results = DATA / "svanberg_beam" / "modes.f06"
    deck = results.with_suffix(".dat")
    found = trueup.correlate(deck, [results, deck])
    assert len(found.pairs) > 3
    assert min(p.mac for p in found.pairs) > 0.99
    with pytest.raises(InputError, match="give the deck, too"):
        trueup.correlate(deck, results)


def test_what_cannot_be_compared_is_said(runs, duct):
    with pytest.raises(InputError, match="two paths or more"):
        trueup.compare([runs / "as_is"])
    with pytest.raises(InputError, match="compares with run folders"):
        trueup.compare([runs / "as_is", duct / "duct.bdf"])
    with pytest.raises(InputError, match="given twice"):
        trueup.compare([duct / "duct.bdf", duct / "duct.bdf"])


def test_of_a_large_model_some_grids_stand_for_the_test(duct, tmp_path):
    modes = trueup.solve(duct / "duct.bdf", 10).write(tmp_path / "modes.h5")
    test = trueup.read_test(modes)
    assert len(set(test.modes.dofs.node.tolist())) == 1000
    assert set(test.modes.dofs.component.tolist()) == {1, 2, 3}
    assert "of the 1933 grids that the modes hold 1000 stand" in test.warnings[0]
