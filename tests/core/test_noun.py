"""Nouns show themselves in one short line."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

import trueup
from trueup.adapters.nastran import build_model, read_deck_text
from trueup.adapters.universal import read_universal
from trueup.core.correlation.comparison import compare, place_test
from trueup.core.eigen import normal_modes
from trueup.core.noun import Noun

FIXTURES = Path(__file__).parents[2] / "fixtures" / "duct"


@dataclass(frozen=True, eq=False)
class Probe(Noun):
    name: str
    f: object
    nothing: object = None


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (np.array([61.2, 33.49]), "<2 from 33.49 to 61.2>"),
        (np.array([np.nan, 2.0, 1.0]), "<3 from 1 to 2>"),
        (np.zeros((240, 8)), "<240 × 8>"),
        (sp.csr_matrix((3, 4)), "<3 × 4 sparse>"),
        (0.123456789, "0.123457"),
        (Path("models/wing.bdf"), "wing.bdf"),
        ((1, "b"), "(1, 'b')"),
        (tuple(range(9)), "<9>"),
        ({"quad": 1, "line": 2}, "<2: quad, line, …>"),
        (Probe("", 1), "<Probe>"),
        ("x" * 60, "'" + "x" * 38 + "…"),
    ],
)
def test_a_value_is_told_in_a_few_words(value: object, told: str) -> None:
    assert repr(Probe("p", value)) == f"Probe(name='p', f={told})"


def test_what_is_empty_is_not_told() -> None:
    assert repr(Probe("", np.zeros((0, 3)))) == "Probe()"


def test_every_noun_is_a_short_line() -> None:
    deck = trueup.read_deck(FIXTURES / "duct.bdf")
    test = trueup.read_test(FIXTURES / "duct_test.unv")
    model = build_model(deck)
    solution = normal_modes.solve(model, n_modes=8)
    modes = normal_modes.modes_of(model, solution)
    placed = place_test(model.geometry, modes, test, "mm", motion=model.expansion)
    comparison = compare(model.geometry, modes, placed)
    assert test.modes is not None
    nouns = [
        deck, deck.bulk, read_deck_text(FIXTURES / "duct.bdf"), model, model.geometry, modes,
        modes.dofs, solution, test, test.geometry, test.modes, test.modes.dofs, placed, comparison,
        comparison.correlation, comparison.observation, comparison.alignment, model.stiffness[0],
        read_universal([FIXTURES / "duct_test.unv"]),
    ]  # fmt: skip
    for noun in nouns:
        shown = repr(noun)
        assert len(shown) < 200, shown
        assert "\n" not in shown
        assert "array(" not in shown
    assert repr(deck).startswith("Deck(")
    assert repr(test.modes).startswith(
        "Modes(frequencies_hz=<24 from 33.91 to 274.7>, shapes=<71 ×"
    )
