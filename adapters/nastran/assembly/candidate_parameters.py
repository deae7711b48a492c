"""What of a deck may move: its properties with their values, and the parameters these make."""

from collections import Counter, defaultdict
from collections.abc import Iterator

import numpy as np

from ....core.errors import InputError
from ....core.results.parameters import PropertyRow
from ..cards import definitions, holders
from ..deck.bulk import Bulk
from ..deck.movable_values import Moves
from ..deck.read_deck import Deck
from ..fields.layouts import movable, value_names
from ..fields.parameter_references import FieldRef, ParameterSpec
from .deck_elements import read_structure
from .variation import GRID, read_variation, value_of

_BOUNDS = (0.9, 1.1)
"""Nothing moves: so near the deck that any value may be there."""


def properties_of(deck: Deck) -> tuple[PropertyRow, ...]:
    """Return every card with values that may move, and how many elements have it.

    Offsets and thicknesses of single elements and positions, which may move too, are left out.
    """
    held, users = _holding(deck.bulk), referring(deck.bulk)

    def elements(card: str, number: int) -> int:
        if definitions()[card].elements:
            return 1
        if holders(card):
            return held[card, number]
        return sum(held[used] for used in users.get(number, ()))

    return tuple(
        PropertyRow(card, number, elements(card, number), dict(_values(deck, card, number)))
        for card in movable()
        if card != GRID and not definitions()[card].properties
        for number in sorted(deck.bulk.table(card))
    )


def grids_by_property(deck: Deck) -> dict[str, tuple[int, ...]]:
    """Return the grids of the elements of each property, by card, number and how many they are."""
    found: dict[tuple[str, int], list[int]] = defaultdict(list)
    for name, known in definitions().items():
        for values in deck.bulk.table(name).values() if known.properties else ():
            for card in known.properties.split():
                if values.pid in deck.bulk.table(card):
                    found[card, values.pid] += [g for g in getattr(values, "nodes", ()) if g]
    held = _holding(deck.bulk)
    return {
        f"{card} {pid}, {held[card, pid]} elements": tuple(sorted(set(grids)))
        for (card, pid), grids in sorted(found.items())
        if grids
    }


def candidates(deck: Deck, most: int) -> tuple[tuple[ParameterSpec, ...], int]:
    """Return parameters worth a look, one a value, and how many more there would be.

    Moduli, densities, thicknesses, areas and moments of inertia, springs and masses on which an
    element depends; of more than `most` the first.
    """
    refs = [
        FieldRef(row.card, row.id, name)
        for row in properties_of(deck)
        for name in _looked_at(movable()[row.card])
        if row.values.get(name)
    ]
    specs = [ParameterSpec(str(ref), (ref,), *_BOUNDS) for ref in refs]
    parts = read_structure(deck, read_variation(deck, specs))
    used = {k for b in parts.blocks for i in np.unique(b.depends_of) for k in b.depends[int(i)]}
    kept = [s for k, s in enumerate(specs) if k in used]
    return tuple(kept[:most]), max(len(kept) - most, 0)


def _looked_at(moves: Moves) -> tuple[str, ...]:
    doubted = moves.doubt.fields if moves.doubt else ()
    return tuple(dict.fromkeys((*doubted, *moves.linear, *moves.concentrated)))


def _values(deck: Deck, card: str, number: int) -> Iterator[tuple[str, float]]:
    for name in value_names(definitions()[card]):
        try:
            yield name, value_of(deck, FieldRef(card, number, name))
        except InputError:
            continue


def referring(bulk: Bulk) -> dict[int, list[tuple[str, int]]]:
    """Return the properties that refer to each material, by its number."""
    found: dict[int, list[tuple[str, int]]] = defaultdict(list)
    for name, known in definitions().items():
        single = [f.lower() for f in known.others if f.startswith("MID")]
        repeated = [f.attribute for f in known.repeated if f.name.startswith("MID")]
        if holders(name) and (single or repeated):
            for number, values in sorted(bulk.table(name).items()):
                mids = {getattr(values, m, None) for m in single}
                mids |= {m for attribute in repeated for m in getattr(values, attribute)}
                for mid in mids:
                    if mid:
                        found[mid].append((name, number))
    return found


def _holding(bulk: Bulk) -> Counter[tuple[str, int]]:
    """Count the elements of each property."""
    return Counter(
        (card, values.pid)
        for name, known in definitions().items()
        for card in known.properties.split()
        for values in bulk.table(name).values()
        if values.pid in bulk.table(card)
    )
