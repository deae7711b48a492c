"""What every element family hands to the assembly, and helpers they share."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ....core.arrays import Bools, Floats, Ints, Matrices
from ....core.elements import Element
from ....core.errors import InputError
from ..deck.bulk import Bulk
from ..deck.card_definition import Values
from ..properties.grids import Points
from ..properties.nonstructural import Nonstructural

Key = tuple[str, int]
"""A card by name and number."""

_NO_LENGTH = 1e-12
"""Of the size of the model."""

Routine = Callable[[Bulk, Ints, tuple[bool, bool]], Matrices]
"""Stiffness and mass of the elements of some rows, from the values of the cards given."""


Constants = Callable[[Bulk, Key], tuple[Sequence[float], float]]
"""What a property gives to an element: constants of the stiffness, density of the mass."""


@dataclass(frozen=True)
class Settings:
    """PARAM values, and those of the NASTRAN statement, that shape element matrices."""

    k6rot: float = 100.0
    snorm: float = 20.0
    coupled: bool = False
    bars_spin: bool = False


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
    moved : frozenset of Key
        Cards that parameters move.
    """

    bulk: Bulk
    points: Points
    settings: Settings
    nonstructural: Nonstructural = field(default_factory=Nonstructural)
    notes: list[str] = field(default_factory=list)
    moved: frozenset[Key] = frozenset()

    def moved_of(self, name: str, ids: Ints) -> Bools:
        """Return which elements of a card have values of their own that parameters move, (n,)."""
        own = [number for card, number in self.moved if card == name]
        return np.asarray(np.isin(ids, own))

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
    element : Element
        What they are.
    nodes : (n, k) int
        Rows of their grids; of an element of one freedom the numbers of its degrees of freedom.
    matrices : callable
        Their matrices; where the element has 3 or 6 freedoms a node in the basic frame.
    sources : tuple of frozenset of Key
        Sets of cards whose values enter.
    source_of : (n,) int
        Which of `sources` each element takes its values from.
    """

    card: str
    ids: Ints
    element: Element
    nodes: Ints
    matrices: Routine
    sources: tuple[frozenset[Key], ...]
    source_of: Ints

    @property
    def places(self) -> Ints:
        """Where the matrices go: see `core.assembly.element_assembly.ElementBlock`, (n, k)."""
        return 2 * self.nodes if self.element.freedoms == 3 else self.nodes

    @property
    def corners(self) -> Ints:
        """Grid rows of the corners, (n, corners)."""
        return self.nodes[:, : self.element.corners]


def numbered(sources: Iterable[frozenset[Key]]) -> tuple[tuple[frozenset[Key], ...], Ints]:
    """Distinct sets of cards, and which of them each element has."""
    index: dict[frozenset[Key], int] = {}
    of = [index.setdefault(s, len(index)) for s in sources]
    return tuple(index), np.array(of, dtype=np.int64)


def element_sources(
    context: Context, name: str, ids: Ints, of_property: Sequence[frozenset[Key]], of: Ints
) -> tuple[tuple[frozenset[Key], ...], Ints]:
    """Return the sets of cards that elements take values from.

    Their property's, NSM cards, and their own where a parameter moves it.
    """
    own = context.moved_of(name, ids)
    if not context.nonstructural.shares and not own.any():
        return tuple(of_property), of
    return numbered(
        of_property[int(k)]
        | (context.nonstructural.sources(int(eid)) if context.nonstructural.shares else frozenset())
        | (frozenset([(name, int(eid))]) if moved else frozenset())
        for eid, k, moved in zip(ids, of, own, strict=True)
    )


def property_key(bulk: Bulk, card: str, eid: int, number: int | None) -> Key:
    """Return the property card with the number that an element gives as its PID.

    Raises
    ------
    InputError
        There is none of its kinds with that number.
    """
    names = bulk.definitions[card].properties.split()
    found = None if number is None else bulk.find(names, int(number))
    if number is None or found is None:
        raise bulk.place(card, eid).fault(
            f"refers to property {number}, but there is no {' or '.join(names)} {number}"
        )
    return found[0], int(number)


def connected(
    context: Context, name: str, cards: Sequence[Values], grids: Sequence[Sequence[int]] = ()
) -> tuple[Ints, Ints, list[Key], Ints]:
    """Return the numbers of elements of one card, their grid rows, properties, which each has.

    `grids` are those that count where they are not all of the cards'; an element whose card
    knows no properties is its own.
    """
    ids = np.array([c.eid for c in cards], dtype=np.int64)
    nodes = context.points.rows(grids or [c.nodes for c in cards], name, ids)
    if not context.bulk.definitions[name].properties:
        return ids, nodes, [(name, int(i)) for i in ids], np.arange(len(ids))
    pids = np.array([c.pid for c in cards])
    numbers, first, of = np.unique(pids, return_index=True, return_inverse=True)
    asked = zip(ids[first], numbers, strict=True)
    keys = [property_key(context.bulk, name, int(eid), int(pid)) for eid, pid in asked]
    return ids, nodes, keys, of.astype(np.int64)


def property_groups(context: Context, name: str, constants: Constants) -> list[Group]:
    """Make the group of an element that takes its node positions and constants of its property.

    The mass of the element takes one constant, its mass per volume, area or length, to which NSM
    cards add.

    Parameters
    ----------
    context : Context
        The deck.
    name : str
        The element's card; its definition names the element and the properties that it may have
        (itself, where it names none).
    constants : callable
        What the stiffness takes, and the mass, from ``(bulk, (card name, number))``.
    """
    bulk = context.bulk
    cards = list(bulk.table(name).values())
    if not cards:
        return []
    element = bulk.definitions[name].element
    if element is None:
        raise InputError(f"the definition of {name} names no element")
    ids, nodes, keys, of = connected(context, name, cards)
    xyz = context.points.xyz[nodes]
    check_shape(context, name, element, ids, xyz)

    def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        used, position = np.unique(of[rows], return_inverse=True)
        table = [constants(values, keys[k]) for k in used]
        K = M = None
        if wanted[0]:
            K = element.stiffness(xyz[rows], *np.array([t[0] for t in table])[position].T)
        if wanted[1] and element.mass:
            density = np.array([t[1] for t in table])[position]
            density = density + context.extra_mass(values, ids[rows])
            M = element.mass(xyz[rows], density, context.settings.coupled)
        return K, M

    sources, source_of = element_sources(
        context, name, ids, [with_material(bulk, k) for k in keys], of
    )
    return [Group(name, ids, element, nodes, matrices, sources, source_of)]


def with_material(bulk: Bulk, key: Key) -> frozenset[Key]:
    """Return a property and the materials that it names, whose values enter."""
    card = bulk.table(key[0])[key[1]]
    mid, others = (getattr(card, name, None) for name in ("mid", "mids"))
    named = [n for n, c in bulk.definitions.items() if c.space == "material"]
    mids = (*(mid if isinstance(mid, tuple) else (mid,)), *(others or ()))
    found = {m: bulk.find(named, int(m)) for m in mids if m is not None}
    return frozenset([key, *((card[0], int(m)) for m, card in found.items() if card)])


def check_shape(context: Context, name: str, element: Element, ids: Ints, xyz: Floats) -> None:
    """Raise `InputError` for an element without length, flat or turned inside out."""
    if element.dimension == 1:
        what = "has no length: its ends coincide"
        length = np.linalg.norm(xyz[:, 1] - xyz[:, 0], axis=1)
        bad = length <= _NO_LENGTH * np.ptp(context.points.xyz, axis=0).max(initial=0.0)
    else:
        bad = np.zeros(0, bool) if element.sound is None else ~element.sound(xyz)
        more = f" (and {int(bad.sum()) - 1} more elements)" if bad.sum() > 1 else ""
        what = "is flat or turned" if element.dimension == 3 else "has no area or a corner turned"
        what += f" inside out{more}: check the order and the positions of its grids"
    if bad.any():
        raise context.bulk.place(name, int(ids[np.flatnonzero(bad)[0]])).fault(what)
