"""Every family of cards: one file each, with the layouts of its cards and what is made of them.

A family is a file with its cards and, where it makes element matrices, a routine from `Context`
to groups, and one line of `FAMILIES`; `register_family` adds one from outside.
"""

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import NamedTuple

from ....core.elements import ELEMENTS
from ....core.errors import InputError, require_kind
from ..deck import control_cards
from ..deck.card_definition import Card
from ..deck.movable_values import Moves
from ..properties import (
    analysis_set,
    damping_tables,
    deck_constraints,
    deck_coordinate_systems,
    dmig_input,
    grids,
    materials,
    nonstructural,
    rigid_elements,
    superelements,
    thermal,
)
from . import not_read
from .connectors import bushes, dashpots, fasteners, general_elements, masses, springs
from .element_group import Context, Group, Key, Settings, property_groups
from .lines import bars, beams, bends, rods, three_node_beams
from .surfaces import axisymmetric, panels, shells
from .volumes import solids


class Family(NamedTuple):
    """Cards that belong together.

    Parameters
    ----------
    name : str
        For messages.
    cards : tuple of Card
        Their definitions.
    groups : callable, optional
        Makes the element matrices of a deck.
    dampers : callable, optional
        Makes its damping matrices, in place of stiffness.
    """

    name: str
    cards: tuple[Card, ...] = ()
    groups: Callable[[Context], list[Group]] | None = None
    dampers: Callable[[Context], list[Group]] | None = None


FAMILIES: list[Family] = [
    Family("shells", shells.CARDS, shells.shells),
    Family("panels", panels.CARDS, panels.panels),
    Family("solids", solids.CARDS, solids.solids),
    Family("bodies of revolution", axisymmetric.CARDS, axisymmetric.axisymmetric),
    Family("bars", bars.CARDS, bars.bars),
    Family("beams", beams.CARDS, beams.beams),
    Family("three-node beams", three_node_beams.CARDS, three_node_beams.three_node_beams),
    Family("bends", bends.CARDS, bends.bends),
    Family("rods", rods.CARDS, rods.rods),
    Family("bushes", bushes.CARDS, bushes.bushes, bushes.bush_dampers),
    Family("springs", springs.CARDS, springs.springs),
    Family("fasteners", fasteners.CARDS, fasteners.fasteners),
    Family("general elements", general_elements.CARDS, general_elements.general_elements),
    Family("dashpots", dashpots.CARDS, dampers=dashpots.dashpots),
    Family("masses", masses.CARDS, masses.masses),
    Family("control", control_cards.CARDS),
    Family("points", grids.CARDS),
    Family("coordinate systems", deck_coordinate_systems.CARDS),
    Family("materials", materials.CARDS),
    Family("temperature", thermal.CARDS),
    Family("damping tables", damping_tables.CARDS),
    Family("non-structural mass", nonstructural.CARDS),
    Family("constraints", deck_constraints.CARDS),
    Family("rigid elements", rigid_elements.CARDS),
    Family("analysis set", analysis_set.CARDS),
    Family("direct matrices", dmig_input.CARDS),
    Family("superelements", superelements.CARDS),
    Family("cards that are not read", not_read.CARDS),
]
"""Everything that is read and assembled, in this order."""


def register_family(family: Family) -> None:
    """Read and assemble the cards of a family more; ``FAMILIES.remove(family)`` undoes it.

    Raises
    ------
    InputError
        The name of one of its cards is taken, or the card is not sound: what it lacks.
    """
    require_kind(family, Family, "what is registered")
    for card in family.cards:
        require_kind(card, Card, "a card of a family")
        if lost := set(card.elements.split()) - ELEMENTS.keys():
            raise InputError(f"{card.name}: there is no element {min(lost)!r}, register it before")
        if card.number not in ("", *card.type._fields):
            raise InputError(f"{card.name}: no field of its layout is {card.number!r}, its number")
    taken = definitions().keys() & {card.name for card in family.cards}
    if taken:
        raise InputError(f"there is a card {min(taken)} already")
    FAMILIES.append(family)


def definitions() -> Mapping[str, Card]:
    """Return the definition of every card by name."""
    return _by_name(tuple(FAMILIES))


@lru_cache(maxsize=4)
def _by_name(families: tuple[Family, ...]) -> dict[str, Card]:
    return {card.name: card for family in families for card in family.cards}


def holders(card: str) -> tuple[str, ...]:
    """Return the elements whose PID may refer to a property card."""
    return tuple(n for n, c in definitions().items() if card in c.properties.split())


__all__ = [
    "FAMILIES",
    "Card",
    "Context",
    "Family",
    "Group",
    "Key",
    "Moves",
    "Settings",
    "definitions",
    "holders",
    "property_groups",
    "register_family",
]
