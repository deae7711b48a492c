"""Discover on tests that hold less than they seem to."""

from dataclasses import replace

import numpy as np
import pytest
from tests.cli.test_far_too_stiff import mast

import trueup
from trueup.core.discovery import discover


@pytest.fixture
def deck_and_test(tmp_path):
    deck, test = tmp_path / "mast.bdf", tmp_path / "mast.unv"
    deck.write_text(mast(1.0e-5))
    trueup.convert(trueup.solve(deck, number=8), test)
    return deck, trueup.read_test(test)


def said_of(deck, test, columns, shapes=None):
    modes = test.modes.take(np.array(columns))
    if shapes is not None:
        modes = replace(modes, shapes=shapes(modes.shapes))
    return trueup.discover(deck, replace(test, modes=modes), deck_length_unit="mm")


def test_a_mode_that_is_listed_twice_is_said(deck_and_test):
    told = said_of(*deck_and_test, [0, 1, 2, 2])
    assert any("one mode listed twice" in w for w in told.warnings)


def test_shapes_that_no_mode_has_say_nothing_of_model_or_sensors(deck_and_test):
    rng = np.random.default_rng(2)
    told = said_of(*deck_and_test, range(6), lambda s: rng.standard_normal(s.shape))
    assert told.verdict == "undecided"
    assert any("more modes pair" in w for w in told.would_decide)
    assert not told.findings


def test_what_does_not_solve_judges_no_sensor(tmp_path, monkeypatch):
    """What the search accepts first may leave a deck that does not solve; the next best is told."""
    deck, truth = tmp_path / "mast.bdf", tmp_path / "truth.bdf"
    deck.write_text(mast(0.0))
    truth.write_text(mast(1.0e-5))
    test = tmp_path / "mast.unv"
    trueup.convert(trueup.solve(truth, number=8), test)
    judge, judged, asked = discover._judged, [], []

    def unsound(*_):
        asked.append(True)
        return len(asked) > 1

    def counted(*args):
        judged.append(len(asked))
        return judge(*args)

    monkeypatch.setattr(discover, "solves", unsound)
    monkeypatch.setattr(discover, "_judged", counted)
    told = trueup.discover(deck, test, deck_length_unit="mm")
    assert judged
    assert min(judged) > 1
    assert told.findings
