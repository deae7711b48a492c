"""Dashpots of a deck: CDAMP1 ... CDAMP4, CVISC, and the damping of CBUSH and CBUSH1D.

They do not enter normal modes. Structural damping (GE, PARAM G) sits at no place in particular
and is left to what a test says.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from ...core.arrays import Ints
from ...core.assembly import Matrices
from ...core.assembly_parameters import parametric_terms
from ...core.elements.bush import bush_stiffness
from .build import element_block
from .cards import Bulk
from .families import Context, Group, Settings
from .families.bushes import bush_dampers
from .families.common import distinct_properties
from .families.springs import scalar_groups
from .grids import read_points
from .read import Deck
from .variation import read_variation

_SCALAR: dict[str, tuple[str, str] | None] = {
    "CDAMP1": ("PDAMP", "b"),
    "CDAMP2": None,
    "CDAMP3": ("PDAMP", "b"),
    "CDAMP4": None,
}


def damping_matrix(deck: Deck) -> sp.csr_matrix | None:
    """Return D of all dashpots over the g-set, displacement systems; None where there are none.

    Raises
    ------
    InputError
        A dashpot at a grid or with a property that the deck does not have.
    """
    points = read_points(deck.bulk)
    context = Context(deck.bulk, points, Settings())
    groups = [g for name, via in _SCALAR.items() for g in scalar_groups(context, name, via, "b", 0)]
    groups += [*bush_dampers(context), *_viscous(context)]
    if not groups:
        return None
    nothing = read_variation(deck, ())
    blocks = [element_block(g, points, nothing) for g in groups]
    terms, _ = parametric_terms(blocks, points.n_dof, np.zeros(0), np.zeros(0))
    D = sum((t.matrix for t in terms[1:]), terms[0].matrix).tocsr()
    return D if D.nnz and abs(D).max() > 0.0 else None


def _viscous(context: Context) -> list[Group]:
    """CVISC: a dashpot along the line of two grids, and one about it."""
    bulk = context.bulk
    cards = list(bulk.table("CVISC").values())
    if not cards:
        return []
    ids = np.array([c.eid for c in cards], dtype=np.int64)
    ends = context.points.rows([c.nodes for c in cards], "CVISC", ids)
    keys, of = distinct_properties(bulk, ["PVISC"], "CVISC", ids, np.array([c.pid for c in cards]))
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
            c[i, [0, 3]] = card.ce or 0.0, card.cr or 0.0
        none = np.zeros((len(rows), 3))
        return bush_stiffness(axes[rows], c, none, none), None

    sources = tuple(frozenset([key]) for key in keys)
    return [Group("CVISC", ids, ends, 6, matrices, sources, of, "line", ends)]
