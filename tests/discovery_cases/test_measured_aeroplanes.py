"""`trueup discover` on two aeroplanes that were measured, with decks that lack what is known.

Steel plates with engines, by a roving hammer; and GARTEUR SM-AG19, whose deck has a mass at each
wing end and two on the fin, from its frequency responses.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import trueup

DATA = Path(__file__).parents[3] / "shared" / "data"
PLATES = DATA / "measured" / "aeroplane"
GARTEUR = DATA / "nastran" / "garteur" / "garteur_fem.bdf"
SURVEY = [DATA / "uff" / name for name in ("garteur_frf_1995.uff", "garteur_geometry.unv")]

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not PLATES.is_dir(), reason="data of measured aeroplanes are absent"),
]


def masses(told):
    return [f for f in told.findings if f.kind == "point_mass"]


@pytest.mark.parametrize("test", ["operating_shapes.unv", "survey.uff"])
def test_missing_engines_are_named_on_both_wings(test):
    """2.15 kg each, 12 % of the whole."""
    told = trueup.discover(PLATES / "aeroplane_no_engines.bdf", PLATES / test)
    found = masses(told)
    assert len(found) == len(told.findings) == 2
    for side, f in zip((1.0, -1.0), sorted(found, key=lambda f: -f.where.xyz[1]), strict=True):
        assert np.linalg.norm(np.array(f.where.xyz) - [0.8, 0.25 * side, -0.055]) < 0.1
        assert 1.0 / 1.4 < f.magnitude["kilograms"] / 2.15 < 1.4
        assert f.interval[0] < 2.15 < f.interval[1]
    assert len(told.after.pairs) > len(told.before.pairs)


def test_nothing_is_claimed_where_the_engines_are_in_the_deck():
    told = trueup.discover(PLATES / "aeroplane_block_engines.bdf", PLATES / "operating_shapes.unv")
    assert told.verdict == "undecided"
    assert not [f for f in told.findings if f.confidence > 0.5]


def without(deck: Path, *cards: str) -> str:
    lines = GARTEUR.read_text().splitlines(keepends=True)
    deck.write_text("".join(line for line in lines if not line.startswith(cards)))
    return str(deck)


def test_a_missing_mass_of_one_wing_end_is_named_there(tmp_path):
    told = trueup.discover(without(tmp_path / "a.bdf", "CONM2,9503"), SURVEY)
    (found,) = told.findings
    assert found.kind == "point_mass"
    assert np.linalg.norm(np.array(found.where.xyz) - [0.42, 0.93, 0.176]) < 0.1


def test_missing_masses_of_both_wing_ends_are_named_there(tmp_path):
    told = trueup.discover(without(tmp_path / "a.bdf", "CONM2,9503", "CONM2,9504"), SURVEY)
    found = sorted(masses(told), key=lambda f: -f.where.xyz[1])
    assert len(found) == len(told.findings) == 2
    for side, f in zip((1.0, -1.0), found, strict=True):
        assert np.linalg.norm(np.array(f.where.xyz) - [0.42, 0.93 * side, 0.176]) < 0.1


def test_a_resonance_that_its_identification_doubts_is_no_evidence(tmp_path):
    """The root near 9 Hz, no resonance of all responses, once got an absorber on the fuselage."""
    deck = tmp_path / "heavy.bdf"
    card, heavy = "CONM2,9503,146,,0.5", "CONM2,9503,146,,1.5"
    deck.write_text(GARTEUR.read_text().replace(card, heavy))
    told = trueup.discover(deck, SURVEY)
    assert any("left out" in w and "8.98 Hz" in w for w in told.warnings)
    assert told.verdict == "undecided"
    assert not [f for f in told.findings if f.kind == "tuned_absorber" or f.confidence > 0.5]
    (too_heavy,) = (p for p in told.parameters if p.name == "CONM2 9503 M")
    assert 1.5 * too_heavy.factor < 0.9
