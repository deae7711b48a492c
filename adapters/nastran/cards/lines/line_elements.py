"""Ends, orientation, offsets and pins of CBAR and CBEAM."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .....core.arrays import Bools, Floats, Ints, Matrices
from .....core.elements.lines.bar import BAR, offset_transform
from ...deck.bulk import Bulk
from ...deck.card_definition import Values
from ..element_group import (
    Context,
    Group,
    Key,
    check_shape,
    connected,
    element_sources,
    with_material,
)


@dataclass(frozen=True, eq=False)
class Lines:
    """Geometry of bars or beams in the basic frame.

    Parameters
    ----------
    xa, xb : (n, 3) float
        Ends, offsets included.
    v : (n, 3) float
        Orientation vectors.
    wa, wb : (n, 3) float
        Offsets from the grids to the ends.
    pins : (n, 12) bool
        Released motions of end A, then of end B, element axes.
    offset : bool
        Whether any element has an offset.
    """

    xa: Floats
    xb: Floats
    v: Floats
    wa: Floats
    wb: Floats
    pins: Any
    offset: bool

    def take(self, rows: Ints) -> Lines:
        """Return the geometry of some of them."""
        xa, xb, v, wa, wb, pins = (
            part[rows] for part in (self.xa, self.xb, self.v, self.wa, self.wb, self.pins)
        )
        return Lines(xa, xb, v, wa, wb, pins, self.offset)


Make = Callable[[Bulk, list[Key], Ints, Lines, Floats | float, tuple[bool, bool]], Matrices]
"""Stiffness and mass between the ends, from the properties used, which of them each element has,
its geometry, and the mass per length that NSM cards add."""


def line_groups(context: Context, name: str, make: Make) -> list[Group]:
    """Make the group of an element between two ends that may stand off their grids."""
    cards = list(context.bulk.table(name).values())
    element = context.bulk.definitions[name].element
    if not cards or element is None:
        return []
    ids, ends, keys, of = connected(context, name, cards)
    lines, own = line_axes(context, name, cards, ids, ends), context.moved_of(name, ids)

    def matrices(bulk: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        used, position = np.unique(of[rows], return_inverse=True)
        extra = context.extra_mass(bulk, ids[rows])
        at = lines.take(rows)
        if own[rows].any():
            now = [bulk.table(name)[int(i)] for i in ids[rows]]
            at = line_axes(context, name, now, ids[rows], ends[rows])
        K, M = make(bulk, [keys[k] for k in used], position, at, extra, wanted)
        if lines.offset:
            T = offset_transform(at.wa, at.wb)
            K, M = (None if X is None else T.swapaxes(1, 2) @ X @ T for X in (K, M))
        return K, M

    of_property = [with_material(context.bulk, key) for key in keys]
    sources, source_of = element_sources(context, name, ids, of_property, of)
    return [Group(name, ids, element, ends, matrices, sources, source_of)]


_OLD_FLAGS = {"0": "GGG", "1": "GGG", "2": "GGG"}
"""What stood in the place of OFFT before it: X1, X2, X3 are a vector (1) or G0 is a grid (2)."""


def line_axes(context: Context, name: str, cards: Sequence[Values], ids: Ints, ends: Ints) -> Lines:
    """Read the geometry of CBAR or CBEAM cards.

    Raises
    ------
    InputError
        An end on the other, an orientation along the bar, an OFFT that is not known.
    """
    points = context.points
    xa, xb = points.xyz[ends[:, 0]], points.xyz[ends[:, 1]]
    offt = np.array([_offt(context, name, c) for c in cards])
    v = orientation(context, name, cards, ids, ends, offt[:, 0] == "G")
    wa, wb = (np.array([getattr(c, w) for c in cards], dtype=np.float64) for w in ("wa", "wb"))
    offset = bool(wa.any() or wb.any())
    if offset:
        along = _element_axes(xa, xb, v)
        wa = _offset(points.directions[ends[:, 0]], along, wa, offt[:, 1])
        wb = _offset(points.directions[ends[:, 1]], along, wb, offt[:, 2])
    lines = Lines(xa + wa, xb + wb, v, wa, wb, _pins(context, name, cards), offset)
    _check(context, name, ids, lines)
    return lines


def _offt(context: Context, name: str, card: Values) -> tuple[str, str, str]:
    offt = _OLD_FLAGS.get(str(card.offt), str(card.offt))
    if len(offt) != 3 or offt[0] not in "GB" or any(c not in "GOEB" for c in offt[1:]):
        raise context.bulk.place(name, card.eid).error(
            f"OFFT {offt!r} is not one of GGG, BGG, GGO, ..."
        )
    return offt[0], offt[1], offt[2]


def orientation(
    context: Context,
    name: str,
    cards: Sequence[Values],
    ids: Ints,
    ends: Ints,
    displaced: Bools | bool = True,
) -> Floats:
    """Vectors towards G0, or X1, X2, X3 in the displacement system of end A where `displaced`."""
    points = context.points
    by_grid = np.flatnonzero([type(c.x[0]) is int for c in cards])
    v = np.array([[x or 0.0 for x in c.x] for c in cards])
    turned = np.flatnonzero(displaced & points.rotated[ends[:, 0]])
    v[turned] = np.einsum("nki,nk->ni", points.directions[ends[turned, 0]], v[turned])
    if len(by_grid):
        g0 = points.rows([cards[k].x[0] for k in by_grid], name, ids[by_grid])
        v[by_grid] = points.xyz[g0] - points.xyz[ends[by_grid, 0]]
    return v


def _element_axes(xa: Floats, xb: Floats, v: Floats) -> Floats:
    """Axes of the line between the grids, for offsets given along the element (OFFT O)."""
    x = xb - xa
    z = np.cross(x, v)
    with np.errstate(invalid="ignore", divide="ignore"):
        x, z = (a / np.linalg.norm(a, axis=1, keepdims=True) for a in (x, z))
    return np.stack([x, np.cross(z, x), z], axis=1)


def _offset(directions: Floats, along: Floats, w: Floats, kind: Any) -> Floats:
    out = np.einsum("nki,nk->ni", directions, w)
    element = np.isin(kind, ("O", "E"))
    out[element] = np.einsum("nki,nk->ni", along[element], w[element])
    out[kind == "B"] = w[kind == "B"]
    return np.asarray(out)


def _pins(context: Context, name: str, cards: Sequence[Values]) -> Any:
    pins = np.zeros((len(cards), 12), dtype=bool)
    for k, card in enumerate(cards):
        for first, text in ((0, card.pa), (6, card.pb)):
            for digit in str(text or ""):
                if digit not in "123456":
                    raise context.bulk.place(name, card.eid).error(
                        f"the pin flags {text} are not numbers from 1 to 6"
                    )
                pins[k, first + int(digit) - 1] = True
    return pins


def _check(context: Context, name: str, ids: Ints, lines: Lines) -> None:
    check_shape(context, name, BAR, ids, np.stack([lines.xa, lines.xb], axis=1))
    check_orientation(context, name, ids, lines.xb - lines.xa, lines.v)


def check_orientation(context: Context, name: str, ids: Ints, x: Floats, v: Floats) -> None:
    """Raise `InputError` where orientation vectors v (n, 3) run along the elements x (n, 3)."""
    length = np.linalg.norm(x, axis=1) * np.linalg.norm(v, axis=1)
    along = np.linalg.norm(np.cross(x, v), axis=1) <= 1e-9 * length
    if along.any():
        bad = int(ids[np.flatnonzero(along)[0]])
        raise context.bulk.place(name, bad).error(
            "its orientation vector is zero or runs along the "
            "element: give another X1, X2, X3 or G0"
        )
