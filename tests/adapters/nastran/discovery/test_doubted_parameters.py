"""Masses and springs of a deck as parameters: each value by itself, what has no value left out."""

import pytest

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.discovery.doubted_parameters import (
    alike,
    concentrated_parameters,
    joined,
)

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
