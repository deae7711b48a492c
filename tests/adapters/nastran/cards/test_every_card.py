"""What the definitions of cards say of each other is there."""

import pytest

from trueup.adapters.nastran.cards import FAMILIES, definitions
from trueup.adapters.nastran.fields.layouts import canonical_field, movable
from trueup.core.elements import ELEMENTS

MADE = [card for card in definitions().values() if card.elements]


def test_a_card_stands_in_one_family():
    names = [card.name for family in FAMILIES for card in family.cards]
    assert len(names) == len(set(names)) == len(definitions())


@pytest.mark.parametrize("card", MADE, ids=lambda c: c.name)
def test_an_element_is_one_of_the_core_and_finds_its_properties_and_grids(card):
    kinds = [ELEMENTS[name] for name in card.elements.split()]
    assert {kind.shape for kind in kinds} == {kinds[0].shape}
    assert card.number == "eid"
    assert all(name in definitions() for name in card.properties.split())
    assert card.properties or card.moves or card.more or "MID" in card.others
    assert card.grid_fields or "nodes" in card.extra.split()
    if card.element.material:
        assert len(card.grid_fields) >= kinds[-1].nodes


@pytest.mark.parametrize("name", movable())
def test_what_is_said_of_values_names_values(name):
    moves = movable()[name]
    doubted = moves.doubt.fields if moves.doubt else ()
    offered = moves.variable.names if moves.variable else ()
    for value in (*moves.linear, *moves.concentrated, *doubted, *offered, *moves.also.values()):
        assert canonical_field(name, value) == value
    for written, value in moves.also.items():
        assert canonical_field(name, written) == value
