"""Shear panels: CSHEAR."""

from __future__ import annotations

import numpy as np

from ....core import elements
from ....core.arrays import Floats, Ints
from ....core.assembly import Matrices
from ....core.errors import InputError
from ..cards import Bulk
from ..materials import isotropic
from .common import Context, Group, Key, distinct_properties, element_sources
from .shells import check_shape

_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0))


def panels(context: Context) -> list[Group]:
    """Make the group of CSHEAR."""
    cards = list(context.bulk.table("CSHEAR").values())
    if not cards:
        return []
    ids = np.array([c.eid for c in cards], dtype=np.int64)
    corners = context.points.rows([c.nodes for c in cards], "CSHEAR", ids)
    xyz = context.points.xyz[corners]
    check_shape(context, "CSHEAR", ids, xyz)
    pids = np.array([c.pid for c in cards])
    keys, of = distinct_properties(context.bulk, ["PSHEAR"], "CSHEAR", ids, pids)

    def matrices(bulk: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        table = np.array([_constants(context, bulk, key) for key in keys])
        E, G, t, density, f1, f2 = table[of[rows]].T
        K = M = None
        if wanted[0]:
            K = elements.shear_panel_stiffness(xyz[rows], E, G, t)
            if f1.any() or f2.any():
                K = K + _rods(xyz[rows], E, t, f1, f2)
        if wanted[1]:
            density = density + context.extra_mass(bulk, ids[rows])
            M = elements.shear_panel_mass(xyz[rows], density, context.settings.coupled)
        return K, M

    of_property = [
        frozenset([key, ("MAT1", int(context.bulk.table(key[0])[key[1]].mid))]) for key in keys
    ]
    sources, source_of = element_sources(context, ids, of_property, of)
    return [Group("CSHEAR", ids, corners, 6, matrices, sources, source_of, "quad", corners)]


def _constants(context: Context, bulk: Bulk, key: Key) -> list[float]:
    place = context.bulk.place(*key)
    card = bulk.table(key[0])[key[1]]
    E, G, _, rho = isotropic(bulk, card.mid, place)
    t = float(card.t or 0.0)
    if not t > 0.0 or not G > 0.0:
        raise InputError(f"{place}: a shear panel needs a thickness and a shear modulus")
    return [E, G, t, rho * t + float(card.nsm or 0.0), float(card.f1 or 0.0), float(card.f2 or 0.0)]


def _rods(xyz: Floats, E: Floats, t: Floats, f1: Floats, f2: Floats) -> Floats:
    """Rods along the edges that stand for the panel's direct stiffness (PSHEAR F1, F2).

    Their areas are F t (panel area) / (sum of the two edges' lengths), or F t**2 / 2 where F is
    above 1.01 (Quick Reference Guide, PSHEAR).
    """
    length = np.stack([np.linalg.norm(xyz[:, j] - xyz[:, i], axis=1) for i, j in _EDGES], axis=1)
    area = 0.5 * np.linalg.norm(np.cross(xyz[:, 2] - xyz[:, 0], xyz[:, 3] - xyz[:, 1]), axis=1)
    K = np.zeros((len(xyz), 4, 6, 4, 6))
    for k, (i, j) in enumerate(_EDGES):
        f = f1 if k % 2 == 0 else f2
        wide = f * t * area / (length[:, k] + length[:, (k + 2) % 4])
        A = np.where(f > 1.01, 0.5 * f * t**2, wide)
        rod = elements.rod_stiffness(xyz[:, i], xyz[:, j], E, A, 0.0 * E, 0.0 * E)
        rod = rod.reshape(-1, 2, 6, 2, 6)
        for a, p in enumerate((i, j)):
            for b, q in enumerate((i, j)):
                K[:, p, :, q] += rod[:, a, :, b]
    return K.reshape(-1, 24, 24)
