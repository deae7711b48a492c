"""What `trueup discover` writes of known parameters is what is off in the structure, and no more.

Tests made by an independent solver on a finer mesh: the deck's is 1 to 2 % off in frequency, which
is no thickness and no modulus. What else was changed is known.
"""

import json
from pathlib import Path

import pytest

import trueup

ROOT = Path(__file__).resolve().parents[2]
CASES = ROOT.parent / "shared" / "data" / "cases"
CARDS = {
    "duct": {"front": ("PBAR 11",), "rear": ("PBAR 12",)},
    "panel": {"t1": ("PSHELL 1",), "t2": ("PSHELL 2",), "long": ("PBAR 11",)},
    "tower": {"col": ("PBAR 1",)},
    "wheel": {"t1": ("PSHELL 1",), "rim": ("PBAR 11",)},
}
"""Names of what was changed, and the cards that have it, by deck."""
HIDDEN = (
    "duct",
    "panel_parameters",
    "panel_spring",
    "panel_stiffness",
    "tower_frame",
    "tower_joint",
    "wheel_faults",
    "wheel_mass",
)
OFF = 0.02
"""Of a property: what a mesh may look like at most."""


@pytest.mark.slow
@pytest.mark.parametrize("name", HIDDEN)
def test_only_what_is_off_is_written_and_as_far_as_it_is(name):
    case = CASES / name
    if not case.is_dir():
        pytest.skip("the data folder is not beside the checkout")
    (test,) = case.glob("*_test.unv")
    deck = test.name.removesuffix("_test.unv")
    scatter = json.loads((case / "truth.json").read_text())["scatter"]
    truth = {
        card: scatter[group] for group, cards in CARDS[deck].items() if group in scatter
        for card in cards
    }  # fmt: skip
    found = trueup.discover(case / f"{deck}.bdf", test, deck_length_unit="mm")
    written = [p for p in found.parameters if p.updated != p.initial]
    cards = {" ".join(p.name.split()[:2]): p for p in written}
    large = {card for card, factor in truth.items() if abs(factor - 1.0) > OFF}
    assert cards.keys() == large, sorted(p.name for p in written)
    for card, p in cards.items():
        assert p.factor == pytest.approx(truth[card], abs=3.0 * p.standard_error), card
        assert p.standard_error < OFF
