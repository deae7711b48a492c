"""Non-structural mass that NSM, NSM1, NSML and NSML1 add to properties and elements."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...core.arrays import Floats, Ints
from ...core.errors import InputError
from .cards import Bulk, Fields, to_float
from .grids import Points
from .read import Deck

Key = tuple[str, int]

_PER_AREA = ("CQUAD4", "CTRIA3", "CQUAD8", "CTRIA6", "CQUADR", "CTRIAR", "CSHEAR")
_PER_LENGTH = ("CBAR", "CBEAM", "CROD", "CTUBE", "CONROD")
_OWNERS = {
    "PSHELL": _PER_AREA, "PCOMP": _PER_AREA, "PCOMPG": _PER_AREA, "PSHEAR": ("CSHEAR",),
    "PBAR": ("CBAR",), "PBARL": ("CBAR",), "PBEAM": ("CBEAM",), "PBEAML": ("CBEAM",),
    "PBCOMP": ("CBEAM",), "PROD": ("CROD",), "PTUBE": ("CTUBE",), "CONROD": ("CONROD",),
    "ELEMENT": (*_PER_AREA, *_PER_LENGTH),
}  # fmt: skip


class _Share(NamedTuple):
    """One value of a card and the elements it goes to."""

    key: Key
    field: int
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
        for key, field, coefficients in self.shares:
            value = to_float(str(bulk.table(key[0])[key[1]][field]))
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
    numbers = {deck.case.nsm}
    for fields in bulk.table("NSMADD").values():
        if int(str(fields[1])) == deck.case.nsm:
            numbers.update(int(f) for f in fields[2:] if f is not None)
    measure = _Measures(bulk, points)
    shares: list[_Share] = []
    for name in ("NSM", "NSM1", "NSML", "NSML1"):
        for number, fields in bulk.table(name).items():
            if int(str(fields[1])) in numbers:
                place = bulk.place(name, number)
                try:
                    shares.extend(_read(name, number, fields, measure, place))
                except (ValueError, IndexError):
                    raise InputError(f"{place}: a number or value is missing or wrong") from None
    if not shares:
        raise InputError(
            f"{deck.path}: case control asks for NSM = {deck.case.nsm}, but the deck has no such "
            "NSM, NSM1, NSML or NSML1"
        )
    return Nonstructural(tuple(shares))


def _read(
    name: str, number: int, fields: Fields, measure: _Measures, place: str
) -> Iterable[_Share]:
    """Shares of one card; NSM and NSML hold pairs, NSM1 and NSML1 a value and a list."""
    kind = str(fields[2] or "").upper()
    if kind not in _OWNERS:
        raise InputError(f"{place}: {kind or 'blank'} is not a kind of property that has mass")
    if name in ("NSM", "NSML"):
        for k in range(3, len(fields), 2):
            if fields[k] is not None:
                ids = [int(str(fields[k]))]
                yield _share(name, number, k + 1, kind, ids, measure, place)
        return
    every = any(str(f).upper() == "ALL" for f in fields[4:5])
    ids = None if every else _list(fields[4:])  # type: ignore[assignment]
    yield _share(name, number, 3, kind, ids, measure, place)


def _share(
    name: str,
    number: int,
    index: int,
    kind: str,
    ids: list[int] | None,
    measure: _Measures,
    place: str,
) -> _Share:
    found = measure.elements(kind, ids)
    if not found:
        raise InputError(f"{place}: no element has the {kind} it names")
    if name in ("NSML", "NSML1"):
        kinds = {by_area for _, by_area in found.values()}
        if len(kinds) > 1:
            raise InputError(f"{place}: areas and lengths are mixed in one list")
        total = sum(size for size, _ in found.values())
        return _Share((name, number), index, dict.fromkeys(found, 1.0 / total))
    return _Share((name, number), index, dict.fromkeys(found, 1.0))


def _list(fields: Fields) -> list[int]:
    """Numbers of a list with THRU and BY."""
    words = [str(f).upper() for f in fields if f is not None]
    out: list[int] = []
    k = 0
    while k < len(words):
        if words[k] == "THRU":
            step = int(words[k + 3]) if words[k + 2 : k + 3] == ["BY"] else 1
            out.extend(range(out[-1] + step, int(words[k + 1]) + 1, step))
            k += 4 if step != 1 or words[k + 2 : k + 3] == ["BY"] else 2
        else:
            out.append(int(words[k]))
            k += 1
    return out


class _Measures:
    """Areas and lengths of elements, found when first asked for."""

    def __init__(self, bulk: Bulk, points: Points) -> None:
        self._bulk = bulk
        self._points = points
        self._known: dict[str, Mapping[int, float]] = {}

    def elements(self, kind: str, ids: list[int] | None) -> dict[int, tuple[float, bool]]:
        """Elements of a kind of property (ids None: all), with size and whether it is an area."""
        wanted = None if ids is None else set(ids)
        out = {}
        for name in _OWNERS[kind]:
            sizes = self._sizes(name)
            for eid, card in self._bulk.table(name).items():
                number = eid if kind in ("ELEMENT", "CONROD") else int(card.pid)
                mine = kind in ("ELEMENT", "CONROD") or number in self._bulk.table(kind)
                if mine and (wanted is None or number in wanted):
                    out[eid] = (sizes[eid], name in _PER_AREA)
        return out

    def _sizes(self, name: str) -> Mapping[int, float]:
        if name not in self._known:
            cards = self._bulk.table(name)
            ids = np.array(list(cards), dtype=np.int64)
            corners = 2 if name in _PER_LENGTH else (3 if "TRIA" in name else 4)
            nodes = [_nodes(c)[:corners] for c in cards.values()]
            xyz = self._points.xyz[self._points.rows(nodes, name, ids)] if nodes else None
            values = [] if xyz is None else _size(xyz)
            self._known[name] = dict(zip(ids.tolist(), values, strict=True))
        return self._known[name]


def _nodes(card: object) -> list[int]:
    ends = getattr(card, "nodes", None)
    return list(ends) if ends is not None else [card.ga, card.gb]  # type: ignore[attr-defined]


def _size(xyz: Floats) -> list[float]:
    if xyz.shape[1] == 2:
        sizes = np.linalg.norm(xyz[:, 1] - xyz[:, 0], axis=1)
    elif xyz.shape[1] == 3:
        sizes = 0.5 * np.linalg.norm(np.cross(xyz[:, 1] - xyz[:, 0], xyz[:, 2] - xyz[:, 0]), axis=1)
    else:
        sizes = 0.5 * np.linalg.norm(np.cross(xyz[:, 2] - xyz[:, 0], xyz[:, 3] - xyz[:, 1]), axis=1)
    return [float(s) for s in sizes]
