"""Positions of values on cards, against cards written out by hand and pyNastran's own reading."""

import pytest

from trueup.adapters.nastran.cards import definitions
from trueup.adapters.nastran.deck.movable_values import after
from trueup.adapters.nastran.fields.layouts import canonical_field, field_position, movable
from trueup.core.errors import InputError


def reader(card: str):
    """Read fields of a card given in free field with one line per continuation."""
    fields = {}
    for line, text in enumerate(card.split("\n")):
        for column, word in enumerate(text.split(","), start=1):
            fields[10 * line + column] = word.strip()
    return lambda position: fields.get(position, "")


@pytest.mark.parametrize(
    ("card", "field", "position"),
    [
        ("PSHELL", "T", 4),
        ("PSHELL", "12I/T**3", 6),
        ("PSHELL", "Z2", 13),
        ("PBAR", "I1", 5),
        ("PBAR", "I12", 24),
        ("MAT1", "RHO", 6),
        ("MAT8", "GE", 22),
        ("MAT9", "G66", 27),
        ("MAT9", "RHO", 28),
        ("CONM2", "I33", 17),
        ("CONM1", "M66", 29),
        ("PFAST", "MASS", 14),
    ],
)
def test_positions_of_the_guide(card, field, position):
    assert field_position(card, field, lambda n: "") == position


def test_after_counts_over_line_ends():
    assert [after(9, n) for n in range(3)] == [9, 12, 13]
    assert after(12, 16) == 32


def test_plies_have_four_fields_or_a_line():
    comp = reader("PCOMP,1\n,1,.1,45.,,1,.2\n,1,.3")
    compg = reader("PCOMPG,1\n,1,1,.1\n,2,1,.2")
    assert field_position("PCOMP", "T1", comp) == 13
    assert field_position("PCOMP", "THETA2", comp) == 18
    assert field_position("PCOMP", "T3", comp) == 23
    assert field_position("PCOMP", "T4", comp) is None
    assert field_position("PCOMPG", "T1", compg) == 14
    assert field_position("PCOMPG", "T2", compg) == 24
    assert field_position("PCOMPG", "T3", compg) is None


def test_section_library_nsm_follows_the_dimensions():
    tube = reader("PBARL,1,1,,TUBE\n,5.,4.,0.1")
    dbox = reader("PBARL,1,1,,DBOX\n")
    assert field_position("PBARL", "NSM", tube) == 14
    assert field_position("PBARL", "DIM3", tube) is None
    assert field_position("PBARL", "DIM10", dbox) == 23
    assert field_position("PBARL", "NSM", dbox) == 24


def test_pbeaml_end_b_stands_after_its_ratio():
    beam = reader("PBEAML,1,1,,TUBE\n,5.,4.,.1,YES,0.5,4.5,4.,.1\n,YES,1.0,4.,3.,.2")
    assert field_position("PBEAML", "DIM1(A)", beam) == 12
    assert field_position("PBEAML", "DIM1(0.5)", beam) == 17
    assert field_position("PBEAML", "DIM2(B)", beam) == 25
    assert field_position("PBEAML", "NSM(B)", beam) == 26


PLAIN = "PBEAM,1,1,1.,2.,3.,.4,5.,6.\n,,,,,,,,\n,.8,.9"
TAPERED = (
    "PBEAM,1,1,1.,2.,3.,.4,5.,6.\n,,,,,,,,\n,YES,1.0,1.1,2.1,3.1,.41,5.1\n,,,,,,,,\n"
    ",YESA,0.5,1.2,2.2\n,.8,.9"
)


@pytest.mark.parametrize(
    ("deck", "field", "position"),
    [
        (PLAIN, "K1", 22),
        (PLAIN, "I1(B)", None),
        (TAPERED, "I1(A)", 5),
        (TAPERED, "I1(B)", 25),
        (TAPERED, "C2(B)", 33),
        (TAPERED, "I1(0.5)", 45),
        (TAPERED, "C1(0.5)", None),
        (TAPERED, "K2", 53),
        (TAPERED, "CW(A)", 58),
        (TAPERED, "N1(A)", 66),
    ],
)
def test_pbeam_stations(deck, field, position):
    assert field_position("PBEAM", field, reader(deck)) == position


def test_pbush_lines_may_come_in_any_order():
    bush = reader("PBUSH,1,B,1.,,3.\n,,K,1.,2.,3.\n,,M,0.5")
    assert field_position("PBUSH", "K2", bush) == 15
    assert field_position("PBUSH", "B3", bush) == 6
    assert field_position("PBUSH", "M", bush) == 24
    assert field_position("PBUSH", "GE1", bush) is None


@pytest.mark.parametrize("card", sorted(movable()))
def test_every_name_of_the_table_is_its_own_canonical_form(card):
    for name in definitions()[card].reals:
        assert canonical_field(card, name.lower()) == name


def test_a_number_is_not_a_value():
    with pytest.raises(InputError, match="not a value"):
        canonical_field("PSHELL", "PID")
