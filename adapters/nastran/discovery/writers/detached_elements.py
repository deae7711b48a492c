"""Elements taken off their grid and hung on it by a bushing."""

from collections.abc import Sequence
from typing import Any

from .....core.errors import InputError
from ...deck.card_definition import Card as Definition
from ...deck.number_spaces import space_of
from ...deck.read_deck import Deck
from ...editing.find_cards import Card, find_card, free_id
from ...editing.set_values import edit_cards
from ...text.deck_text import DeckText
from .site import Site


def attached(deck: Deck, grid: int) -> list[int]:
    """Return the elements of a grid.

    Raises
    ------
    InputError
        The grid carries what cannot be moved to a new one.
    """
    found = []
    for name, definition in deck.bulk.definitions.items():
        connects = space_of(name, deck.bulk.definitions) == "element"
        for number, card in deck.bulk.table(name).items() if connects else ():
            if grid in definition.grids_of(card):
                if not _is_material(definition):
                    raise InputError(
                        f"grid {grid} also carries {name} {number}, which stays where it is: put "
                        "the spring between the two by hand"
                    )
                found.append(int(number))
    return found


def _is_material(definition: Definition) -> bool:
    return definition.element is not None and definition.element.material


def detached(
    text: DeckText, site: Site, elements: Sequence[int], grid: int, free: Sequence[int] = ()
) -> DeckText:
    """Attach some elements of a grid to a new one, sprung or free in some components only.

    The bushing between the two lies in the displacement system of the grid.
    """
    new, number, pid = (free_id(text, what) for what in ("grid", "element", "property"))
    cd, components = site.system(grid), site.components
    stiff = "".join(str(c) for c in range(1, 7) if c not in (*components, *free))
    k = site.each("stiffness")
    along = [k if c in components else None for c in range(1, max(components) + 1)]
    rows: list[list[Any]] = [
        ["GRID", new, 0, *site.middle([grid]), cd],
        *([["RBE2", number, grid, stiff, new]] if stiff else []),
        ["PBUSH", pid, "K", *along],
        ["CBUSH", number + 1, pid, grid, new, None, None, None, cd],
    ]
    edits = []
    for name, definition in site.deck.bulk.definitions.items():
        table = site.deck.bulk.table(name) if _is_material(definition) else {}
        for e in elements:
            if e in table:
                member = find_card(text, name, e)
                held = next((k for k in definition.grid_fields if _is(member, k, grid)), None)
                if held is None:
                    raise InputError(
                        f"{name} {e} is detached from grid {grid} already, by another effect: put "
                        "the second spring there by hand"
                    )
                edits.append((member, {held: new}))
    return site.added(edit_cards(text, edits), rows, grid)


def _is(card: Card, field: int, number: int) -> bool:
    """Whether a field of a card holds a number; an earlier effect may have changed it."""
    text = card.text(field)
    return text.isdigit() and int(text) == number
