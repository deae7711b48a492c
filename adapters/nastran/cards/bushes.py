"""Bushings: CBUSH and CBUSH1D."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.assembly import Matrices
from ....core.elements.bush import bush_stiffness
from ....core.errors import InputError
from ..cards import Bulk, Card, fields_of, to_float
from .common import Context, Group, Key, distinct_properties

Values = Callable[[Context, Bulk, Key], list[float]]
"""The six stiffnesses or dampings of a property."""


@dataclass(frozen=True, eq=False)
class _Bush:
    """Geometry of one bushing.

    Parameters
    ----------
    axes : (3, 3) float
        Rows are the element axes, basic frame.
    arms : list of (3,) float
        From each grid to the spring.
    axial_only : bool
        Whether only K1 and K4 have a meaning: no orientation was given.
    """

    axes: Floats
    arms: list[Floats]
    axial_only: bool


def bushes(context: Context) -> list[Group]:
    """Make the groups of CBUSH and CBUSH1D, between two grids or one and the ground."""
    return _groups(context, {"CBUSH": _stiffnesses, "CBUSH1D": _axial})


def bush_dampers(context: Context) -> list[Group]:
    """Make the same groups with their dampings in place of stiffnesses."""
    return _groups(context, {"CBUSH": _dampings, "CBUSH1D": _axial_damping})


def _groups(context: Context, values_of: dict[str, Values]) -> list[Group]:
    groups = []
    for name, values in values_of.items():
        property_name = f"P{name[1:]}"
        cards = list(context.bulk.table(name).values())
        for grounded in (False, True):
            chosen = [c for c in cards if (not c.nodes[1]) == grounded]
            if chosen:
                groups.append(_group(context, name, property_name, values, chosen, grounded))
    return groups


def _group(
    context: Context,
    name: str,
    property_name: str,
    values: Values,
    cards: list[Card],
    grounded: bool,
) -> Group:
    bulk = context.bulk
    ids = np.array([c.eid for c in cards], dtype=np.int64)
    used = [[c.nodes[0]] if grounded else c.nodes for c in cards]
    ends = context.points.rows(used, name, ids)
    pids = np.array([c.pid for c in cards])
    keys, of = distinct_properties(bulk, [property_name], name, ids, pids)
    bushes = [_geometry(context, name, c, e) for c, e in zip(cards, ends, strict=True)]
    axes = np.stack([b.axes for b in bushes])
    arm_a, arm_b = (np.stack([b.arms[k] for b in bushes]) for k in (0, -1))
    size = 6 * ends.shape[1]
    _check_axial(context, name, ids, bushes, [values(context, bulk, keys[k]) for k in of])
    half = np.array([[0.5, 0.5], [1.0, 0.0]])[int(grounded), : ends.shape[1]]

    def matrices(current: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        numbers, position = np.unique(of[rows], return_inverse=True)
        K = M = None
        if wanted[0]:
            k = np.array([values(context, current, keys[n]) for n in numbers])[position]
            K = bush_stiffness(axes[rows], k, arm_a[rows], arm_b[rows])[:, :size, :size]
        if wanted[1]:
            mass = np.array([_mass(current, keys[n]) for n in numbers])[position]
            if mass.any():
                pattern = np.repeat(half, 6) * np.tile([1.0, 1, 1, 0, 0, 0], len(half))
                M = mass[:, None, None] * np.diag(pattern)
        return K, M

    sources = tuple(frozenset([key]) for key in keys)
    shape = "point" if grounded else "line"
    return Group(name, ids, ends, 6, matrices, sources, of, shape, ends)


def _geometry(context: Context, name: str, card: Card, ends: Ints) -> _Bush:
    xyz = context.points.xyz[ends]
    place = context.bulk.place(name, card.eid)
    line = xyz[1] - xyz[0] if len(ends) == 2 else np.zeros(3)
    apart = bool(np.linalg.norm(line) > 1e-9 * np.ptp(context.points.xyz, axis=0).max(initial=0.0))
    axes, axial_only = _axes(context, name, card, int(ends[0]), line if apart else None, place)
    ocid = int(getattr(card, "ocid", -1))
    if name == "CBUSH" and ocid >= 0:
        frame = context.points.frames.get(ocid, place)
        si = np.array([s or 0.0 for s in card.si], dtype=np.float64)
        at = xyz[0] + si @ frame.directions(xyz[:1])[0]
    else:
        at = xyz[0] + float(getattr(card, "s", 0.5) if name == "CBUSH" else 0.0) * line
    return _Bush(axes, [at - x for x in xyz], axial_only)


def _axes(
    context: Context, name: str, card: Card, row: int, line: Floats | None, place: str
) -> tuple[Floats, bool]:
    """Axes from CID, else from the line of the grids and the orientation vector."""
    if card.cid is not None:
        frame = context.points.frames.get(int(card.cid), place)
        return frame.directions(context.points.xyz[row : row + 1])[0], False
    if line is None:
        raise InputError(f"{place}: its grids coincide or it is grounded, so it needs CID")
    v = _vector(context, name, card, row, place) if name == "CBUSH" else None
    axial_only = v is None
    if v is None:
        v = np.eye(3)[np.argmin(np.abs(line))]
    z = np.cross(line, v)
    if not np.linalg.norm(z) > 1e-9 * np.linalg.norm(line) * np.linalg.norm(v):
        raise InputError(f"{place}: its orientation vector is zero or runs along the element")
    x, z = line / np.linalg.norm(line), z / np.linalg.norm(z)
    return np.stack([x, np.cross(z, x), z]), axial_only


def _vector(context: Context, name: str, card: Card, row: int, place: str) -> Floats | None:
    """Orientation vector, basic frame; None where the card gives none."""
    if card.g0:
        return np.asarray(
            context.points.xyz[context.points.row(int(card.g0), place)] - context.points.xyz[row]
        )
    fields = fields_of(context.bulk.numbered[name][card.eid].lines)
    given = [fields[k] if k < len(fields) else None for k in (5, 6, 7)]
    if all(f is None for f in given):
        return None
    x = np.array([to_float(f) if f else 0.0 for f in given])
    return np.asarray(x @ context.points.directions[row])


def _check_axial(
    context: Context, name: str, ids: Ints, bushes: list[_Bush], stiffness: list[list[float]]
) -> None:
    for number, bush, k in zip(ids, bushes, stiffness, strict=True):
        if bush.axial_only and any(k[i] for i in (1, 2, 4, 5)):
            raise InputError(
                f"{context.bulk.place(name, int(number))} has lateral stiffness but neither an "
                "orientation vector nor CID: give one of them"
            )


def _stiffnesses(context: Context, bulk: Bulk, key: Key) -> list[float]:
    return _six(context, key, "K", bulk.table(key[0])[key[1]].Ki)


def _dampings(context: Context, bulk: Bulk, key: Key) -> list[float]:
    return _six(context, key, "B", bulk.table(key[0])[key[1]].Bi)


def _six(context: Context, key: Key, letter: str, values: object) -> list[float]:
    given = list(values or [])  # type: ignore[call-overload]
    try:
        return [float(given[k] or 0.0) if k < len(given) else 0.0 for k in range(6)]
    except (TypeError, ValueError):
        raise InputError(f"{context.bulk.place(*key)}: every {letter} must be a number") from None


def _axial(context: Context, bulk: Bulk, key: Key) -> list[float]:
    return [float(bulk.table(key[0])[key[1]].k or 0.0), 0.0, 0.0, 0.0, 0.0, 0.0]


def _axial_damping(context: Context, bulk: Bulk, key: Key) -> list[float]:
    return [float(bulk.table(key[0])[key[1]].c or 0.0), 0.0, 0.0, 0.0, 0.0, 0.0]


def _mass(bulk: Bulk, key: Key) -> float:
    card = bulk.table(key[0])[key[1]]
    return float((card.m if key[0] == "PBUSH1D" else card.mass) or 0.0)
