import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.properties.mass_unit import mass_unit
from trueup.core.data.mass_unit import MassUnit
from trueup.core.discovery.effects import KINDS
from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.effects.sentence_parts import mode_ranges, odds
from trueup.core.discovery.likelihood.map_fit import fit
from trueup.core.discovery.narrative.sentences import effects_said
from trueup.core.discovery.search.model_selection import explained

MASS = KINDS["point_mass"]


@pytest.mark.parametrize(
    ("modes", "said"),
    [
        ([4], "test mode 4"),
        ([3, 4], "test modes 3 and 4"),
        ([12, 7, 8, 9, 10, 11], "test modes 7 to 12"),
        ([1, 3, 7, 8, 9], "test modes 1, 3 and 7 to 9"),
        ([1, 3, 5, 7, 9, 10], "6 test modes"),
    ],
)
def test_modes_in_ranges(modes, said):
    assert mode_ranges(modes) == said


@pytest.mark.parametrize(
    ("ratio", "said"),
    [
        (7.3, "7.3 times less likely"),
        (1.3, "1.3 times less likely"),
        (1.02, "about as likely"),
        (0.95, "about as likely"),
        (0.4, "2.5 times more likely"),
        (123456.0, "more than 10 times less likely"),
        (1e26, "more than 10 times less likely"),
        (0.0, "more than 10 times more likely"),
    ],
)
def test_a_likelihood_ratio_is_said_the_way_it_points(ratio, said):
    assert odds(ratio) == said


@pytest.mark.parametrize(
    ("ratio", "most", "said"),
    [
        (1e26, 9.0, "more than 9 times less likely"),
        (4.0, 9.0, "4 times less likely"),
        (1e26, 1.5, "more than 1.5 times less likely"),
        (1e26, 0.67, "less likely"),
        (0.2, 0.67, "more likely"),
        (1.05, 0.67, "about as likely"),
        (1e26, 50.0, "more than 10 times less likely"),
    ],
)
def test_no_more_is_said_than_the_confidence_in_the_best_supports(ratio, most, said):
    assert odds(ratio, most=most) == said


def test_odds_beside_something_named():
    assert odds(9.8, "none") == "9.8 times less likely than none"
    assert odds(1.0, "none") == "about as likely as none"


@pytest.mark.parametrize(
    ("rho", "wtmass", "unit", "kilograms"),
    [
        ("7.85-9", 1.0, "mm", 1e3),
        ("7.85-6", 1.0, "mm", 1.0),
        ("2700.", 1.0, "m", 1.0),
        (".098", 0.00259, "in", 175.12683699),
        ("2.5-4", 1.0, "in", 175.12683699),
        (".098", 1.0, "in", 0.45359237),
        ("490.", 0.0310810, "ft", 14.59390294),
        ("7.85-9", 1.0, None, None),
        ("1.", 1.0, "mm", None),
    ],
)
def test_the_densities_of_solids_tell_the_unit_of_mass(tmp_path, rho, wtmass, unit, kilograms):
    deck = tmp_path / "a.bdf"
    deck.write_text(
        f"SOL 103\nCEND\nBEGIN BULK\nPARAM,WTMASS,{wtmass}\nMAT1,1,7.+10,,.3,{rho}\n"
        "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCROD,1,1,1,2\nPROD,1,1,1.\nENDDATA\n"
    )
    found = mass_unit(read_deck(deck), unit)
    assert found.card == pytest.approx(1.0 / wtmass)
    assert found.kilograms == (pytest.approx(kilograms) if kilograms else None)


def test_a_mass_is_said_in_kilograms_where_they_are_known():
    assert MassUnit(1.0, 1e3).said(0.62e-3) == "0.62 kg"
    pounds = MassUnit(1.0 / 0.00259, 175.12683699)
    assert pounds.said(10.0) == "4.54 kg"
    assert MassUnit().said(0.62e-3) == "0.00062 (deck units)"
    known = MassUnit(1.0, 1e3, "N/mm")
    assert known.per_length([1, 3]) == "N/mm"
    assert known.per_length([3, 5]) == MassUnit().per_length([1]) == "(deck units)"


@pytest.mark.parametrize(
    ("kinds", "regions", "said"),
    [
        (("point_mass",), ("near grid 7 (x = 1)",), "an attached mass near grid 7 (x = 1)"),
        (
            ("distributed_mass", "point_mass", "point_mass"),
            ("near grid 7 (x = 1)", "near grid 8 (x = 2)", "near grid 9 (x = 3)"),
            "a distributed mass near grid 7, and two attached masses, near grid 8 and near grid 9",
        ),
        (
            ("point_mass",) * 2,
            ("near grid 36", "near grid 36"),
            "two attached masses, near grid 36",
        ),
        (("ground_spring",) * 3, ("a", "b", "c"), "three springs to ground, a, b and c"),
        (("flux_leak",), ("near grid 7",), "1 flux leak near grid 7"),
    ],
)
def test_effects_are_told_as_a_person_would(kinds, regions, said):
    assert effects_said(kinds, regions) == said


def test_a_mass_explains_the_modes_that_move_where_it_sits():
    """A bead at the middle of a string moves in every other mode: 1, 3, 5, ..."""
    s = searcher(hidden(masses=[(15, 0.5), (16, 0.5)]), scatter=(0.0, 0.0))
    null = s.null()
    best = fit(s.problem, 0.0 * null.nuisance, (Suspect(0, 15, (0.0,)),), (0,), 20)
    modes = np.array(explained(s, best, 0)) + 1
    assert len(modes) >= 4
    assert set(modes % 2) == {1}
