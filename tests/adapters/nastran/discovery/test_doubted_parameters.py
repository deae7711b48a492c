"""Known properties of a deck that may be off: each value by itself, those that modes notice."""

from pathlib import Path

import numpy as np
import pytest

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.assembly.wide_parameters import parameters_of
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.adapters.nastran.discovery.doubted_parameters import (
    alike,
    concentrated_parameters,
    doubted,
    joined,
    settled,
)
from trueup.core.discovery.screening.mode_selection import reference_modes

DUCT = Path(__file__).parents[4] / "fixtures" / "duct"

DECK = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.
CONM2,1,1,,0.5
CONM2,2,2,,0.5
CONM2,3,3,,0.7
CONM2,4,3
CELAS2,11,100.,1,1,2,1
CELAS1,12,5,2,1,3,1
PELAS,5,300.
CBUSH,13,6,1,,,,,0
PBUSH,6,K,10.,,30.
ENDDATA
"""


@pytest.fixture
def deck(tmp_path):
    path = tmp_path / "deck.bdf"
    path.write_text(DECK)
    return read_deck(path)


def test_every_value_that_is_there_is_one_parameter(deck):
    names = {s.name for s in concentrated_parameters(deck)}
    assert names == {
        "CONM2 1 M",
        "CONM2 2 M",
        "CONM2 3 M",
        "CELAS2 11 K",
        "PELAS 5 K",
        "PBUSH 6 K1",
        "PBUSH 6 K3",
    }


def test_equal_values_of_one_field_are_alike(deck):
    specs = concentrated_parameters(deck)
    found = [{specs[k].name for k in g} for g in alike(deck, specs) if len(g) > 1]
    assert found == [{"CONM2 1 M", "CONM2 2 M"}]


def test_joined_values_keep_every_card(deck):
    specs = [s for s in concentrated_parameters(deck) if s.name in {"CONM2 1 M", "CONM2 2 M"}]
    both = joined(specs)
    assert [str(f) for f in both.fields] == ["CONM2 1 M", "CONM2 2 M"]
    assert both.name == "CONM2 1 M and 1 alike"
    assert joined(specs[:1]) == specs[0]


def column(deep, port):
    """A clamped column of four bars, a bar of a property of its own on top; it bends in a plane
    or, if `deep` is None, in both."""
    free = "" if deep is None else deep
    cards = [f"GRID,{k},,0.,0.,{100.0 * k},,{free if k else ''}" for k in range(1, 7)]
    cards += [f"CBAR,{k},{1 + (k > 4)},{k},{k + 1},1.,0.,0." for k in range(1, 6)]
    cards += ["PBAR,1,1,440.,17700.,17700.,24000.", f"PBAR,2,2,44.,{port},{port},240."]
    cards += [f"MAT1,{k},210000.,,.3,7.85-9" for k in (1, 2)]
    return "\n".join(["CEND", "SPC=1", "BEGIN BULK", *cards, "SPC1,1,123456,1", "ENDDATA"])


@pytest.mark.parametrize(
    ("deep", "names"),
    [
        (None, ["PBAR 1 I1", "PBAR 1 I2", "MAT1 1 E"]),
        ("246", ["PBAR 1 I1+I2", "MAT1 1 E"]),
    ],
)
def test_inertias_move_apart_where_modes_tell_them_and_small_properties_stay(deep, names, tmp_path):
    path = tmp_path / "column.bdf"
    path.write_text(column(deep, 17700.0))
    deck = read_deck(path)
    every = doubted(deck, ())
    structure = build_structure(deck, every.specs)
    solution = reference_modes(structure.model, 600.0)
    own, left = settled(deck, structure, solution, solution.frequencies_hz[:2], every)
    assert [s.name for s in left.specs] == names
    assert [p.name for p in own.model.parameters] == names
    assert left.spreads == tuple(0.4 if "PBAR" in n else 0.1 for n in names)


def test_a_value_that_the_user_names_has_no_other(tmp_path):
    path = tmp_path / "column.bdf"
    path.write_text(column(None, 17700.0))
    deck = read_deck(path)
    deck, (named,) = parameters_of(deck, ("PBAR 1 I1",))
    every = doubted(deck, (named,))
    assert [s.name for s in every.specs].count("PBAR 1 I1") == 1
    assert every.specs[0] == named
    assert "PBAR 1 I2" in {s.name for s in every.specs}


def test_a_product_of_inertia_binds_both_inertias(tmp_path):
    path = tmp_path / "column.bdf"
    alone, whole = "PBAR,1,1,440.,17700.,17700.,24000.", ",,,+\n+,,,,,,,,,+\n+,,,12000."
    path.write_text(column(None, 17700.0).replace(alone, alone + whole))
    deck = read_deck(path)
    every = doubted(deck, ())
    assert "PBAR 1 I1+I2+I12" in {s.name for s in every.specs}
    assert len(build_structure(deck, every.specs).model.parameters) == len(every.specs)


def test_a_modulus_is_the_same_whether_that_of_shear_is_written_or_follows(tmp_path):
    """Written, it had stayed where it was, and a soft patch of a panel was taken for a modulus."""

    def stiffness(shear, name):
        path = tmp_path / "column.bdf"
        text = column(None, 17700.0)
        path.write_text(text.replace("MAT1,1,210000.,,", f"MAT1,1,210000.,{shear},"))
        deck = read_deck(path)
        every = doubted(deck, ())
        p = np.ones(len(every.specs))
        p[[s.name for s in every.specs].index(name)] = 1.2
        return build_structure(deck, every.specs).model.K(p).toarray()

    written = stiffness("80769.230769230769", "MAT1 1 E+G")
    np.testing.assert_allclose(
        written, stiffness("", "MAT1 1 E"), atol=1e-9 * np.abs(written).max()
    )


def test_ports_that_no_measured_mode_notices_stay_as_they_are():
    """They made up for what the model errs by: one came out at 0.54 of its stiffness."""
    deck = read_deck(DUCT / "duct.bdf")
    hz = np.array([34.0, 275.0])
    every = doubted(deck, ())
    structure = build_structure(deck, every.specs)
    solution = reference_modes(structure.model, float(hz.max()))
    _, left = settled(deck, structure, solution, hz, every)
    rings = [f"PBAR {k} I1+I2" for k in (11, 12, 13)]
    assert [s.name for s in left.specs] == ["PSHELL 1 T", *rings, "MAT1 1 E"]
