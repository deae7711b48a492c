"""What every element family hands to the assembly, and helpers they share."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.assembly import Matrices
from ....core.errors import InputError
from ..cards import Bulk, Card
from ..grids import Points
from ..nonstructural import Nonstructural

Key = tuple[str, int]
"""A card by name and number."""

Routine = Callable[[Bulk, Ints, tuple[bool, bool]], Matrices]
"""Stiffness and mass of the elements of some rows, from the values of the cards given."""


@dataclass(frozen=True)
class Settings:
    """PARAM values that shape element matrices."""

    k6rot: float = 100.0
    snorm: float = 20.0
    coupled: bool = False


@dataclass(frozen=True, eq=False)
class Context:
    """What a family needs of the deck: its cards, its points, its settings.

    Parameters
    ----------
    bulk : Bulk
        Cards at the deck's own values; connectivity is taken from here.
    points : Points
        Grids and scalar points.
    settings : Settings
        PARAM values.
    nonstructural : Nonstructural
        Mass per area or length that NSM cards add to elements.
    notes : list of str
        What families leave out, to be said as warnings.
    """

    bulk: Bulk
    points: Points
    settings: Settings
    nonstructural: Nonstructural = field(default_factory=Nonstructural)
    notes: list[str] = field(default_factory=list)

    def extra_mass(self, bulk: Bulk, ids: Ints) -> Floats | float:
        """Mass per area or length that NSM cards add to the elements `ids`."""
        return self.nonstructural.at(bulk, ids) if self.nonstructural.shares else 0.0


@dataclass(frozen=True, eq=False)
class Group:
    """Elements of one kind.

    Parameters
    ----------
    card : str
        Name of their card.
    ids : (n,) int
        Element numbers.
    places : (n, w) int
        See `core.assembly.ElementBlock`.
    width : {1, 3, 6}
        Degrees of freedom a place.
    matrices : callable
        Their matrices; where `width` is 3 or 6 in the basic frame.
    sources : tuple of frozenset of Key
        Sets of cards whose values enter.
    source_of : (n,) int
        Which of `sources` each element takes its values from.
    shape : str
        Name of the shape for drawing, "" where the element is not drawn.
    corners : (n, k) int
        Grid rows of the corners for drawing.
    """

    card: str
    ids: Ints
    places: Ints
    width: int
    matrices: Routine
    sources: tuple[frozenset[Key], ...]
    source_of: Ints
    shape: str = ""
    corners: Ints = field(default_factory=lambda: np.zeros((0, 0), np.int64))


def columns(cards: Sequence[Card], *names: str) -> tuple[Any, ...]:
    """Attributes of cards as arrays, one a name."""
    return tuple(np.array([getattr(c, name) for c in cards]) for name in names)


def numbered(sources: Iterable[frozenset[Key]]) -> tuple[tuple[frozenset[Key], ...], Ints]:
    """Distinct sets of cards, and which of them each element has."""
    index: dict[frozenset[Key], int] = {}
    of = [index.setdefault(s, len(index)) for s in sources]
    return tuple(index), np.array(of, dtype=np.int64)


def element_sources(
    context: Context, ids: Ints, of_property: Sequence[frozenset[Key]], of: Ints
) -> tuple[tuple[frozenset[Key], ...], Ints]:
    """Return the sets of cards that elements take values from: their property's, and NSM cards."""
    if not context.nonstructural.shares:
        return tuple(of_property), of
    return numbered(
        of_property[int(k)] | context.nonstructural.sources(int(eid))
        for eid, k in zip(ids, of, strict=True)
    )


def property_of(
    bulk: Bulk, names: Sequence[str], number: int | None, asked_by: Callable[[], str]
) -> tuple[str, Card]:
    """Return a property card and its name.

    Raises
    ------
    InputError
        There is none of these kinds with that number.
    """
    found = None if number is None else bulk.find(names, int(number))
    if found is None:
        raise InputError(
            f"{asked_by()} refers to property {number}, but there is no {' or '.join(names)} "
            f"{number}"
        )
    return found


def distinct_properties(
    bulk: Bulk, names: Sequence[str], card: str, ids: Ints, pids: Ints
) -> tuple[list[Key], Ints]:
    """Properties used by elements as (card, number), and which each element uses."""
    numbers, first, of = np.unique(pids, return_index=True, return_inverse=True)
    keys = []
    for number, k in zip(numbers, first, strict=True):
        name, _ = property_of(bulk, names, int(number), lambda k=k: bulk.place(card, int(ids[k])))  # type: ignore[misc]
        keys.append((name, int(number)))
    return keys, of.astype(np.int64)


def finite(matrix: Floats | None, what: Callable[[int], str]) -> Floats | None:
    """Return the matrices, or raise `InputError` naming the first element that is not finite."""
    if matrix is not None and not np.isfinite(matrix).all():
        bad = int(np.flatnonzero(~np.isfinite(matrix).all(axis=(1, 2)))[0])
        raise InputError(f"{what(bad)}: its matrix is not finite; check its shape and its property")
    return matrix
