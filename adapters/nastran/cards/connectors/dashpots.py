"""Dashpots: CDAMP1 ... CDAMP4, CVISC. They do not enter normal modes."""

import numpy as np

from .....core.arrays import Ints, Matrices
from .....core.elements.connectors.lumped import BUSH, bush_stiffness
from ...deck.bulk import Bulk
from ...deck.card_definition import Card
from ...deck.movable_values import Moves
from ..element_group import Context, Group, connected
from .springs import ENDS, scalar_groups

CARDS = (
    Card("CDAMP1", f"EID:i! PID:i=EID {ENDS}", "eid", properties="PDAMP"),
    Card("CDAMP2", f"EID:i! B:r! {ENDS}", "eid", moves=Moves()),
    Card("CDAMP3", "EID:i! PID:i=EID S1,S2>scalars:i=0", "eid", properties="PDAMP"),
    Card("CDAMP4", "EID:i! B:r! S1,S2>scalars:i=0", "eid", several=4, moves=Moves()),
    Card("CVISC", "EID:i! PID:i=EID G1,G2>nodes:i!", "eid", properties="PVISC"),
    Card("PDAMP", "PID:i! B:r!", "pid", several=2, companions="PDAMPT", moves=Moves()),
    Card("PVISC", "PID:i! CE:r! CR:r=0. -", "pid", several=4, moves=Moves()),
)


def dashpots(context: Context) -> list[Group]:
    """Make the groups of dashpots, dampings in place of stiffnesses."""
    scalar = (card for card in CARDS if card.name.startswith("CDAMP"))
    groups = [g for card in scalar for g in scalar_groups(context, card, "b", kind=0)]
    return [*groups, *_viscous(context)]


def _viscous(context: Context) -> list[Group]:
    """CVISC: a dashpot along the line of two grids, and one about it."""
    cards = list(context.bulk.table("CVISC").values())
    if not cards:
        return []
    ids, ends, keys, of = connected(context, "CVISC", cards)
    along = np.diff(context.points.xyz[ends], axis=1)[:, 0]
    length = np.linalg.norm(along, axis=1)
    axes = np.zeros((len(cards), 3, 3))
    axes[:, 0] = along / np.where(length > 0.0, length, 1.0)[:, None]

    def matrices(current: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        if not wanted[0]:
            return None, None
        c = np.zeros((len(rows), 6))
        for i, k in enumerate(of[rows]):
            card = current.table(keys[k][0])[keys[k][1]]
            c[i, [0, 3]] = card.ce, card.cr
        none = np.zeros((len(rows), 3))
        return bush_stiffness(axes[rows], c, none, none), None

    sources = tuple(frozenset([key]) for key in keys)
    return [Group("CVISC", ids, BUSH, ends, matrices, sources, of)]
