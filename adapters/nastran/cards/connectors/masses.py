"""Concentrated masses: CONM1, CONM2, CMASS1 ... CMASS4."""

from dataclasses import replace

import numpy as np

from .....core.arrays import Floats, Ints, Matrices
from .....core.elements.connectors.lumped import MASS, rigid_mass
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Values
from ...deck.movable_values import Moves
from ..element_group import Context, Group, numbered
from .springs import ENDS, scalar_groups

_LOWER = "M11 M21 M22 M31 M32 M33 M41 M42 M43 M44 M51 M52 M53 M54 M55 M61 M62 M63 M64 M65 M66"

_M = Moves(linear=("M",), concentrated=("M",))

CARDS = (
    Card(
        "CONM2",
        "EID:i! G:i! CID:i=0 M:r=0. X1,X2,X3>x:r=0. - / I11,I21,I22,I31,I32,I33>i:r=0.",
        "eid",
        grids="g",
        elements="mass",
        moves=replace(_M, also={"MASS": "M", "I12": "I21", "I13": "I31", "I23": "I32"}),
    ),
    Card("CMASS1", f"EID:i! PID:i=EID {ENDS}", "eid", elements="spring", properties="PMASS"),
    Card("CMASS2", f"EID:i! M:r=0. {ENDS}", "eid", elements="spring", moves=_M),
    Card(
        "CMASS3", "EID:i! PID:i=EID S1,S2>scalars:i=0", "eid", elements="spring", properties="PMASS"
    ),
    Card(
        "CMASS4", "EID:i! M:r=0. S1,S2>scalars:i=0", "eid", several=4, elements="spring", moves=_M
    ),
    Card(
        "CONM1",
        f"EID:i! G:i! CID:i=0 {_LOWER.replace(' ', ',')}>m:r=0.",
        "eid",
        grids="g",
        elements="mass",
        moves=Moves(),
    ),
    Card(
        "PMASS", "PID:i! M:r=0.", "pid", several=2, moves=replace(_M, also={"M1": "M", "MASS": "M"})
    ),
)


def masses(context: Context) -> list[Group]:
    """Make the groups of concentrated masses."""
    scalar = (card for card in CARDS if card.elements == "spring")
    groups = [g for card in scalar for g in scalar_groups(context, card, "m", kind=1)]
    groups.extend(_at_grids(context, "CONM2", _conm2))
    groups.extend(_at_grids(context, "CONM1", _conm1))
    return groups


def _at_grids(context: Context, name: str, make: object) -> list[Group]:
    cards = list(context.bulk.table(name).values())
    if not cards:
        return []
    ids = np.array([c.eid for c in cards], dtype=np.int64)
    rows = context.points.rows([c.g for c in cards], name, ids)
    axes = np.stack([_axes(context, name, c, row) for c, row in zip(cards, rows, strict=True)])
    sources, source_of = numbered(frozenset([(name, int(i))]) for i in ids)

    def matrices(bulk: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        if not wanted[1]:
            return None, None
        table = bulk.table(name)
        chosen = [table[int(ids[r])] for r in rows]
        return None, make(context, chosen, axes[rows])  # type: ignore[operator]

    return [Group(name, ids, MASS, rows[:, None], matrices, sources, source_of)]


def _axes(context: Context, name: str, card: Values, row: np.int64) -> Floats:
    """Axes that the card's values refer to, rows in the basic frame."""
    cid = int(card.cid or 0)
    frame = context.points.frames.get(max(cid, 0), context.bulk.place(name, card.eid))
    directions: Floats = frame.directions(context.points.xyz[row : row + 1])[0]
    return directions


def _conm2(context: Context, cards: list[Values], axes: Floats) -> Floats:
    """Mass with an offset and inertias about its own centre, (n, 6, 6), basic frame.

    With CID -1 the offset is the centre's position in the basic frame.
    """
    m = np.array([c.m for c in cards], dtype=np.float64)
    x = np.array([c.x for c in cards], dtype=np.float64)
    arm = np.einsum("nki,nk->ni", axes, x)
    absolute = np.array([int(c.cid or 0) == -1 for c in cards])
    if absolute.any():
        ids = np.array([c.eid for c in cards], dtype=np.int64)
        rows = context.points.rows([c.g for c in cards], "CONM2", ids)
        arm[absolute] = (x - context.points.xyz[rows])[absolute]
    i11, i21, i22, i31, i32, i33 = np.array([c.i for c in cards], dtype=np.float64).T
    inertia = np.stack([i11, -i21, -i31, -i21, i22, -i32, -i31, -i32, i33], axis=1)
    return rigid_mass(m, arm, axes.swapaxes(1, 2) @ inertia.reshape(-1, 3, 3) @ axes)


def _conm1(context: Context, cards: list[Values], axes: Floats) -> Floats:
    """General 6 x 6 mass in the card's axes, (n, 6, 6), basic frame."""
    rows, columns = np.tril_indices(6)
    full = np.zeros((len(cards), 6, 6))
    full[:, rows, columns] = full[:, columns, rows] = [c.m for c in cards]
    T = np.zeros((len(cards), 6, 6))
    T[:, :3, :3] = T[:, 3:, 3:] = axes
    return np.asarray(T.swapaxes(1, 2) @ full @ T)
