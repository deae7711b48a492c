"""Straight bars and rods of constant section: CBAR, CROD, CONROD, CTUBE."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.assembly import Matrices
from ....core.elements.bar import (
    bar_mass,
    bar_stiffness,
    offset_transform,
    rod_mass,
    rod_stiffness,
)
from ....core.errors import InputError
from ..cards import Bulk, Card
from ..materials import isotropic
from ..sections import section
from .common import Context, Group, Key, distinct_properties, element_sources
from .lines import line_axes

_RIGID_SHEAR = 1e8
"""pyNastran's number for a blank K1 or K2."""

BAR_PROPERTIES = ("PBAR", "PBARL")

_MASS = 9  # column of a bar's constants, after E, G, A, I1, I2, I12, J, K1, K2


def bars(context: Context) -> list[Group]:
    """Make the groups of CBAR."""
    cards = list(context.bulk.table("CBAR").values())
    if not cards:
        return []
    ids = np.array([c.eid for c in cards], dtype=np.int64)
    ends = context.points.rows([[c.ga, c.gb] for c in cards], "CBAR", ids)
    keys, of = distinct_properties(
        context.bulk, BAR_PROPERTIES, "CBAR", ids, np.array([c.pid for c in cards])
    )
    lines = line_axes(context, "CBAR", cards, ids, ends)
    of_property = [_sources(context.bulk, key) for key in keys]

    def matrices(bulk: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        table = np.array([_bar_constants(context, bulk, key) for key in keys])
        c = table[of[rows]].T
        xa, xb, v = lines.xa[rows], lines.xb[rows], lines.v[rows]
        K = M = None
        if wanted[0]:
            E, G, A, I1, I2, I12, J, k1, k2 = c[:_MASS]
            pins = lines.pins[rows]
            K = bar_stiffness(xa, xb, v, E, G, A, I1, I2, I12, J, k1, k2, pins[:, :6], pins[:, 6:])
        if wanted[1]:
            mass = c[_MASS] + context.extra_mass(bulk, ids[rows])
            M = bar_mass(xa, xb, v, mass, context.settings.coupled)
        if lines.offset:
            T = offset_transform(lines.wa[rows], lines.wb[rows])
            K, M = (None if X is None else T.swapaxes(1, 2) @ X @ T for X in (K, M))
        return K, M

    sources, source_of = element_sources(context, ids, of_property, of)
    return [Group("CBAR", ids, ends, 6, matrices, sources, source_of, "line", ends)]


def _sources(bulk: Bulk, key: Key) -> frozenset[Key]:
    mid = bulk.table(key[0])[key[1]].mid
    return frozenset([key, ("MAT1", int(mid))])


def _bar_constants(context: Context, bulk: Bulk, key: Key) -> list[float]:
    place = context.bulk.place(*key)
    card = bulk.table(key[0])[key[1]]
    E, G, _, rho = isotropic(bulk, card.mid, place)
    nsm = float(card.nsm or 0.0)
    if key[0] == "PBARL":
        s = section(str(card.Type).upper(), list(card.dim), place)
        sheared = s.I12 == 0.0
        k1, k2 = (s.K1, s.K2) if sheared else (0.0, 0.0)
        return [E, G, s.A, s.I1, s.I2, s.I12, s.J, k1, k2, rho * s.A + nsm]
    values = [float(x or 0.0) for x in (card.A, card.i1, card.i2, card.i12, card.j)]
    A, I1, I2, I12, _ = values  # K1 and K2 do not count beside an I12 (Quick Reference, PBAR)
    if min(A, I1, I2) < 0.0 or I12**2 > I1 * I2 * (1.0 + 1e-9):
        raise InputError(f"{place}: its area and inertias are not those of a real section")
    k1, k2 = (float(k or 0.0) for k in (card.k1, card.k2))
    k1, k2 = (0.0 if k >= _RIGID_SHEAR or I12 != 0.0 else k for k in (k1, k2))
    return [E, G, *values, k1, k2, rho * A + nsm]


def rods(context: Context) -> list[Group]:
    """Make the groups of CROD, CONROD and CTUBE."""
    kinds = (
        ("CROD", ("PROD",), _rod_constants),
        ("CTUBE", ("PTUBE",), _tube_constants),
        ("CONROD", None, _rod_constants),
    )
    groups = []
    for name, properties, constants in kinds:
        cards = list(context.bulk.table(name).values())
        if cards:
            groups.append(_rods(context, name, cards, properties, constants))
    return groups


Constants = Callable[[Context, Bulk, Key], list[float]]


def _rods(
    context: Context,
    name: str,
    cards: list[Card],
    properties: tuple[str, ...] | None,
    constants: Constants,
) -> Group:
    bulk = context.bulk
    ids = np.array([c.eid for c in cards], dtype=np.int64)
    ends = context.points.rows([c.nodes for c in cards], name, ids)
    xa, xb = context.points.xyz[ends[:, 0]], context.points.xyz[ends[:, 1]]
    check_length(context, name, ids, xa, xb)
    if properties is None:
        keys = [(name, int(i)) for i in ids]
        of = np.arange(len(ids))
    else:
        pids = np.array([c.pid for c in cards])
        keys, of = distinct_properties(bulk, properties, name, ids, pids)
    of_property = [_sources(bulk, key) for key in keys]
    sources, source_of = element_sources(context, ids, of_property, of)

    def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        used, position = np.unique(of[rows], return_inverse=True)
        table = np.array([constants(context, values, keys[k]) for k in used])
        E, G, A, J, mass = table[position].T
        K = rod_stiffness(xa[rows], xb[rows], E, A, G, J) if wanted[0] else None
        coupled = context.settings.coupled
        mass = mass + context.extra_mass(values, ids[rows])
        M = rod_mass(xa[rows], xb[rows], mass, coupled) if wanted[1] else None
        return K, M

    return Group(name, ids, ends, 6, matrices, sources, source_of, "line", ends)


def _rod_constants(context: Context, bulk: Bulk, key: Key) -> list[float]:
    card = bulk.table(key[0])[key[1]]
    E, G, _, rho = isotropic(bulk, card.mid, context.bulk.place(*key))
    A, J = float(card.A or 0.0), float(card.j or 0.0)
    nsm = float(card.nsm or 0.0)
    return [E, G, A, J, rho * A + nsm]


def _tube_constants(context: Context, bulk: Bulk, key: Key) -> list[float]:
    """Outer diameter OD1 at end A, OD2 at end B (their mean area, as Nastran takes it)."""
    card = bulk.table(key[0])[key[1]]
    place = context.bulk.place(*key)
    E, G, _, rho = isotropic(bulk, card.mid, place)
    t = float(card.t or 0.0)
    A = J = 0.0
    outer = [float(card.OD1), float(card.OD2 or card.OD1)]
    for od in outer:
        inner = max(od - 2.0 * t, 0.0) if t else 0.0
        if 2.0 * t > od:
            raise InputError(f"{place}: twice the wall thickness exceeds the diameter")
        A += 0.5 * math.pi / 4.0 * (od**2 - inner**2)
        J += 0.5 * math.pi / 32.0 * (od**4 - inner**4)
    nsm = float(card.nsm or 0.0)
    return [E, G, A, J, rho * A + nsm]


def check_length(context: Context, name: str, ids: Ints, xa: Floats, xb: Floats) -> None:
    """Raise `InputError` for an element whose ends coincide."""
    length = np.linalg.norm(xb - xa, axis=1)
    size = np.ptp(context.points.xyz, axis=0).max(initial=0.0)
    if (length <= 1e-12 * size).any():
        bad = int(ids[np.flatnonzero(length <= 1e-12 * size)[0]])
        raise InputError(f"{context.bulk.place(name, bad)} has no length: its ends coincide")
