"""Non-structural mass that NSM, NSM1, NSML and NSML1 add to properties and elements."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.elements import Element
from ....core.errors import Place
from ..deck.bulk import Bulk
from ..deck.card_definition import Card, Known, Values
from ..deck.field_values import Fields, numbers
from ..deck.movable_values import Moves
from ..deck.read_deck import Deck
from .grids import Points

Key = tuple[str, int]


def _list(fields: Fields, _: Known) -> tuple[tuple[int | range, ...] | None]:
    """Numbers of a list with THRU and BY; None stands for ALL."""
    every = any(str(f).upper() == "ALL" for f in fields[4:5])
    return (None if every else numbers(fields, 4),)


_VALUE = Moves(also={"VALUE": "VALUE1"})

CARDS = (
    *(
        Card(n, "SID:i! TYPE:w! [ID>ids:i! VALUE>values:r=0.]", "sid", unique=False, moves=_VALUE)
        for n in ("NSM", "NSML")
    ),
    *(
        Card(
            n,
            "SID:i! TYPE:w! VALUE>values:r=0.",
            "sid",
            unique=False,
            more=_list,
            extra="ids",
            moves=Moves(),
        )
        for n in ("NSM1", "NSML1")
    ),
    Card("NSMADD", "SID:i! [S>sets:i]", "sid", unique=False),
)


_ALIKE = (
    ("PSHELL", "PCOMP", "PCOMPG"),
    ("PBAR", "PBARL"),
    ("PBEAM", "PBEAML", "PBCOMP"),
)
"""Properties that Nastran makes one kind of: TYPE names all of them by any (QRG, NSML1)."""


def alike(kind: str) -> tuple[str, ...]:
    """Return the kinds of property that a TYPE of NSM, NSM1, NSML, NSML1 stands for."""
    return next((kinds for kinds in _ALIKE if kind in kinds), (kind,))


class _Share(NamedTuple):
    """One value of a card (`position` None: its only one) and the elements it goes to."""

    key: Key
    position: int | None
    coefficients: dict[int, float]


@dataclass(frozen=True, eq=False)
class Nonstructural:
    """Mass per area or length that NSM cards add, element by element.

    Parameters
    ----------
    shares : tuple
        Values and the elements they go to.
    """

    shares: tuple[_Share, ...] = ()

    def at(self, bulk: Bulk, ids: Ints) -> Floats:
        """Mass per area or length added to the elements `ids`, (n,), at the values of `bulk`."""
        total = np.zeros(len(ids))
        for key, index, coefficients in self.shares:
            values = bulk.table(key[0])[key[1]].values
            value = values if index is None else values[index]
            total += value * np.array([coefficients.get(int(i), 0.0) for i in ids])
        return total

    def sources(self, eid: int) -> frozenset[Key]:
        """Cards that add to an element."""
        return frozenset(s.key for s in self.shares if eid in s.coefficients)


def read_nonstructural(deck: Deck, points: Points) -> Nonstructural:
    """Collect what case control selects by NSM.

    Raises
    ------
    InputError
        A set, a kind of property or a value that does not exist.
    """
    if deck.case.nsm is None:
        return Nonstructural()
    bulk = deck.bulk
    added = (c.sets for c in bulk.table("NSMADD").values() if c.sid == deck.case.nsm)
    wanted = {s for sets in added for s in sets} or {deck.case.nsm}
    measure = _Measures(bulk, points)
    shares: list[_Share] = []
    for name in ("NSM", "NSM1", "NSML", "NSML1"):
        for number, card in bulk.table(name).items():
            if card.sid in wanted:
                shares.extend(_read(name, number, card, measure, bulk.place(name, number)))
    if not shares:
        raise Place(deck.path).error(
            f"case control asks for NSM = {deck.case.nsm}, but the deck has no such "
            "NSM, NSM1, NSML or NSML1"
        )
    return Nonstructural(tuple(shares))


def _read(name: str, number: int, card: Values, measure: _Measures, place: Place) -> list[_Share]:
    """Shares of one card; NSM and NSML hold pairs, NSM1 and NSML1 a value and a list."""
    if card.type not in measure.kinds:
        raise place.error(f"{card.type} is not a kind of property that has mass")
    targets: list[tuple[int | None, list[int] | None]] = [(None, None)]
    if name in ("NSM", "NSML"):
        targets = [(k, [target]) for k, target in enumerate(card.ids)]
    elif card.ids is not None:
        parts = (part if isinstance(part, range) else (part,) for part in card.ids)
        targets = [(None, [n for part in parts for n in part])]
    shares = []
    for index, ids in targets:
        found = measure.elements(card.type, ids)
        if not found:
            raise place.error(f"no element has the {card.type} it names")
        share = 1.0
        if name in ("NSML", "NSML1"):
            if len({by_area for _, by_area in found.values()}) > 1:
                raise place.error("areas and lengths are mixed in one list")
            if bent := [eid for eid in found if measure.is_bent(eid)]:
                raise place.error(
                    f"it lumps mass by the length of element {bent[0]}, which is curved: that is "
                    "not supported, give its mass per length (NSM, NSM1)"
                )
            share = 1.0 / sum(size for size, _ in found.values())
        shares.append(_Share((name, number), index, dict.fromkeys(found, share)))
    return shares


class _Measures:
    """Areas and lengths of elements, found when first asked for."""

    def __init__(self, bulk: Bulk, points: Points) -> None:
        self._bulk = bulk
        self._points = points
        self._known: dict[str, Mapping[int, float]] = {}
        every = ((name, card.element) for name, card in bulk.definitions.items())
        self._elements = {name: e for name, e in every if e and e.dimension in (1, 2)}

    @property
    def kinds(self) -> set[str]:
        """What an NSM card may name: properties, elements without one, or elements by number."""
        return {"ELEMENT", *(kind for name in self._elements for kind in self._kinds(name))}

    def _kinds(self, name: str) -> list[str]:
        return self._bulk.definitions[name].properties.split() or [name]

    def elements(self, kind: str, ids: list[int] | None) -> dict[int, tuple[float, bool]]:
        """Elements of a kind of property (ids None: all), with size and whether it is an area."""
        wanted = None if ids is None else set(ids)
        kinds = alike(kind)
        out = {}
        for name, element in self._elements.items():
            if kind != "ELEMENT" and not set(kinds) & set(self._kinds(name)):
                continue
            sizes = self._sizes(name, element)
            for eid, card in self._bulk.table(name).items():
                number = eid if kind in ("ELEMENT", name) else card.pid
                mine = kind in ("ELEMENT", name) or any(
                    number in self._bulk.table(k) for k in kinds
                )
                if mine and (wanted is None or number in wanted):
                    out[eid] = (sizes[eid], element.dimension == 2)
        return out

    def is_bent(self, eid: int) -> bool:
        """Whether an element is a line on a curve."""
        bent = (name for name, e in self._elements.items() if e.dimension == 1 and e.curved)
        return any(eid in self._bulk.table(name) for name in bent)

    def _sizes(self, name: str, element: Element) -> Mapping[int, float]:
        if name not in self._known:
            cards = self._bulk.table(name)
            ids = np.array(list(cards), dtype=np.int64)
            nodes = [c.nodes[: element.corners] for c in cards.values()]
            xyz = self._points.xyz[self._points.rows(nodes, name, ids)] if nodes else None
            values = [] if xyz is None else _size(xyz)
            self._known[name] = dict(zip(ids.tolist(), values, strict=True))
        return self._known[name]


def _size(xyz: Floats) -> list[float]:
    if xyz.shape[1] == 2:
        sizes = np.linalg.norm(xyz[:, 1] - xyz[:, 0], axis=1)
    else:
        other = xyz[:, 3] - xyz[:, 1] if xyz.shape[1] == 4 else xyz[:, 1] - xyz[:, 0]
        sizes = 0.5 * np.linalg.norm(np.cross(xyz[:, 2] - xyz[:, 0], other), axis=1)
    return [float(s) for s in sizes]
