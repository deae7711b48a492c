"""Names that stand for many cards, for some elements, and bounds in the card's own unit."""

from __future__ import annotations

import re

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck
from trueup.adapters.nastran.assembly.wide_parameters import parameters_of
from trueup.core.errors import InputError

DECK = """\
SOL 103
CEND
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,1.,1.,0.
GRID,4,,0.,1.,0.
GRID,5,,2.,0.,0.
GRID,6,,2.,1.,0.
GRID,7,,3.,0.,0.
GRID,8,,3.,1.,0.
CQUAD4,101,1,1,2,3,4
CQUAD4,102,1,2,5,6,3
CQUAD4,103,2,5,7,8,6
CBAR,201,11,1,2,0.,0.,1.
CBAR,202,12,2,5,0.,0.,1.
PSHELL,1,1,0.8,1,,1
PSHELL,2,1,1.2,1,,1
PBAR,11,1,10.,3.,4.,5.
PBAR,12,1,10.,6.,4.
PBAR,13,1,10.
MAT1,1,7.+10,,0.3,2700.
ENDDATA
"""


@pytest.fixture
def deck(tmp_path):
    path = tmp_path / "plate.bdf"
    path.write_text(DECK)
    return read_deck(path)


def fields(deck, text):
    _, (spec,) = parameters_of(deck, [text])
    return [str(f) for f in spec.fields]


def test_a_star_is_every_card_with_the_value(deck):
    assert fields(deck, "PSHELL * T") == ["PSHELL 1 T", "PSHELL 2 T"]
    assert fields(deck, "PBAR * J") == ["PBAR 11 J"]


def test_a_range_of_cards(deck):
    assert fields(deck, "PBAR 11:12 I1") == ["PBAR 11 I1", "PBAR 12 I1"]
    assert fields(deck, "all = PBAR 11:99 I1, PSHELL 2 T") == [
        "PBAR 11 I1",
        "PBAR 12 I1",
        "PSHELL 2 T",
    ]


def test_bounds_in_the_unit_of_the_card(deck):
    _, (spec,) = parameters_of(deck, ["PSHELL 1 T [=0.4, =2.4]"])
    assert (spec.lower, spec.upper) == pytest.approx((0.5, 3.0))
    _, (both,) = parameters_of(deck, ["PSHELL * T [=0.6, =2.4]"])
    assert (both.lower, both.upper) == pytest.approx((0.75, 2.0))


@pytest.mark.parametrize(
    "where", ["@elements 101", "@elements 1:101,9", "@box -1,-1,-1,1.2,2,1", "@box 1,2,1,-1,-1,-1"]
)
def test_some_elements_get_a_property_of_their_own(deck, where):
    split, (spec,) = parameters_of(deck, [f"PSHELL 1 T {where}"])
    shells = split.bulk.table("PSHELL")
    (ref,) = spec.fields
    assert ref.id not in (1, 2)
    assert shells[ref.id].t == 0.8
    pid = {e: c.pid for e, c in split.bulk.table("CQUAD4").items()}
    assert pid == {101: ref.id, 102: 1, 103: 2}


def test_a_material_of_some_elements(deck):
    split, (spec,) = parameters_of(deck, ["MAT1 1 E @elements 102:201"])
    quads, bars = split.bulk.table("CQUAD4"), split.bulk.table("CBAR")
    assert quads[101].pid == 1
    assert bars[202].pid == 12
    used = {split.bulk.table("PSHELL")[quads[e].pid].mid1 for e in (102, 103)}
    used |= {split.bulk.table("PBAR")[bars[201].pid].mid}
    assert used == {f.id for f in spec.fields}
    assert 1 not in used


def test_all_elements_of_a_property_need_no_copy(deck):
    split, (spec,) = parameters_of(deck, ["PSHELL 2 T @elements 103"])
    assert split is deck
    assert [str(f) for f in spec.fields] == ["PSHELL 2 T"]


def test_a_split_model_is_the_same_until_its_parameter_moves(deck):
    split, specs = parameters_of(deck, ["PSHELL 1 T @elements 101", "MAT1 1 RHO @elements 103"])
    again, before = build_model(split), build_model(deck)
    np.testing.assert_allclose(again.K().toarray(), before.K().toarray(), rtol=1e-14)
    np.testing.assert_allclose(again.M().toarray(), before.M().toarray(), rtol=1e-14)
    moved = build_model(split, specs).K(np.array([2.0, 1.0])).toarray()
    assert not np.allclose(moved, before.K().toarray())


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("PSHELL 5:9 T", "no PSHELL of these numbers is in the deck"),
        ("PBAR * K1", "none of its PBAR has a value K1"),
        ("PBAR 13:11 I1", "ends before it begins"),
        ("PSHELL ** T", "is not the number of a card"),
        ("PSHELL * TT", "has no value 'TT'"),
        ("PSHEL * T", "did you mean PSHELL"),
        ("PSHELL 1 T @elements 103", "none of these elements has PSHELL 1"),
        ("PSHELL 1 T @elements x", "is not a number of elements"),
        ("PSHELL 1 T @box 0,0,0,1,1", "a box is six numbers"),
        ("PSHELL 1 T @boxes 0,0,0,1,1,1", "write @elements or @box"),
        ("PSHELL 1 T [=0.4, 2]", "is not two numbers"),
        ("PSHELL 1 T [=0.9, =2]", "PSHELL 1 T is 0.8, outside the bounds"),
        ("CONM2 * M", "no CONM2 of these numbers is in the deck"),
        ("PBAR 11 I1 @elements 202", "none of these elements has PBAR 11"),
    ],
)
def test_what_stands_for_nothing_is_said(deck, text, said):
    with pytest.raises(InputError, match=re.escape(said)):
        parameters_of(deck, [text])
