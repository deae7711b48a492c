"""Dashpots of a deck, which do not enter normal modes."""

import numpy as np
import scipy.sparse as sp

from ....core.assembly.affine_terms import parametric_terms
from ..cards import FAMILIES, Context, Settings
from ..deck.read_deck import Deck
from ..properties.grids import read_points
from .deck_elements import element_block
from .variation import read_variation


def damping_matrix(deck: Deck) -> sp.csr_matrix | None:
    """Return D of all dashpots over the g-set, displacement systems; None where there are none.

    Raises
    ------
    InputError
        A dashpot at a grid or with a property that the deck does not have.
    """
    points = read_points(deck.bulk)
    context = Context(deck.bulk, points, Settings())
    groups = [g for family in FAMILIES if family.dampers for g in family.dampers(context)]
    if not groups:
        return None
    nothing = read_variation(deck, ())
    blocks = [element_block(g, points, nothing) for g in groups]
    terms, _ = parametric_terms(blocks, points.n_dof, np.zeros(0), np.zeros(0))
    D = sum((t.matrix for t in terms[1:]), terms[0].matrix).tocsr()
    return D if D.nnz and abs(D).max() > 0.0 else None
