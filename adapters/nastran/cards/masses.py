"""Concentrated masses: CONM1, CONM2, CMASS1 ... CMASS4."""

from __future__ import annotations

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.assembly import Matrices
from ....core.elements.batch import skew
from ..cards import Bulk, Card
from .common import Context, Group, numbered
from .springs import scalar_groups

_PROPERTY: dict[str, tuple[str, str] | None] = {
    "CMASS1": ("PMASS", "mass"),
    "CMASS2": None,
    "CMASS3": ("PMASS", "mass"),
    "CMASS4": None,
}


def masses(context: Context) -> list[Group]:
    """Make the groups of concentrated masses."""
    groups = []
    for name in _PROPERTY:
        groups.extend(scalar_groups(context, name, _PROPERTY[name], "mass", kind=1))
    groups.extend(_at_grids(context, "CONM2", _conm2))
    groups.extend(_at_grids(context, "CONM1", _conm1))
    return groups


def _at_grids(context: Context, name: str, make: object) -> list[Group]:
    cards = list(context.bulk.table(name).values())
    if not cards:
        return []
    ids = np.array([c.eid for c in cards], dtype=np.int64)
    rows = context.points.rows([c.nid for c in cards], name, ids)
    axes = np.stack(
        [_axes(context, name, card, int(row)) for card, row in zip(cards, rows, strict=True)]
    )
    sources, source_of = numbered(frozenset([(name, int(i))]) for i in ids)

    def matrices(bulk: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        if not wanted[1]:
            return None, None
        table = bulk.table(name)
        chosen = [table[int(ids[r])] for r in rows]
        return None, make(context, chosen, axes[rows])  # type: ignore[operator]

    return [
        Group(
            card=name,
            ids=ids,
            places=rows[:, None],
            width=6,
            matrices=matrices,
            sources=sources,
            source_of=source_of,
            shape="point",
            corners=rows[:, None],
        )
    ]


def _axes(context: Context, name: str, card: Card, row: int) -> Floats:
    """Axes that the card's values refer to, rows in the basic frame."""
    cid = int(card.cid or 0)
    frame = context.points.frames.get(max(cid, 0), context.bulk.place(name, card.eid))
    directions: Floats = frame.directions(context.points.xyz[row : row + 1])[0]
    return directions


def _conm2(context: Context, cards: list[Card], axes: Floats) -> Floats:
    """Mass with an offset and inertias about its own centre, (n, 6, 6), basic frame.

    With CID -1 the offset is the centre's position in the basic frame.
    """
    m = np.array([c.mass or 0.0 for c in cards], dtype=np.float64)
    x = np.array([c.X for c in cards], dtype=np.float64)
    arm = np.einsum("nki,nk->ni", axes, x)
    absolute = np.array([int(c.cid or 0) == -1 for c in cards])
    if absolute.any():
        ids = np.array([c.eid for c in cards], dtype=np.int64)
        rows = context.points.rows([c.nid for c in cards], "CONM2", ids)
        arm[absolute] = (x - context.points.xyz[rows])[absolute]
    i11, i21, i22, i31, i32, i33 = np.array([c.I for c in cards], dtype=np.float64).T
    inertia = np.stack([i11, -i21, -i31, -i21, i22, -i32, -i31, -i32, i33], axis=1)
    inertia = axes.swapaxes(1, 2) @ inertia.reshape(-1, 3, 3) @ axes
    S = skew(arm)
    M = np.zeros((len(cards), 6, 6))
    M[:, :3, :3] = m[:, None, None] * np.eye(3)
    M[:, :3, 3:] = -m[:, None, None] * S
    M[:, 3:, :3] = m[:, None, None] * S
    M[:, 3:, 3:] = inertia - m[:, None, None] * (S @ S)
    return M


def _conm1(context: Context, cards: list[Card], axes: Floats) -> Floats:
    """General 6 x 6 mass in the card's axes, (n, 6, 6), basic frame."""
    lower = np.array([c.mass_matrix for c in cards], dtype=np.float64)
    full = np.tril(lower) + np.tril(lower, -1).swapaxes(1, 2)
    T = np.zeros((len(cards), 6, 6))
    T[:, :3, :3] = T[:, 3:, 3:] = axes
    return np.asarray(T.swapaxes(1, 2) @ full @ T)
