"""Dashpots of a deck, which do not enter normal modes."""

import scipy.sparse as sp

from ....core.assembly.affine_terms import parametric_terms
from ....core.data.parametric_model import Term
from ..cards import FAMILIES, Context, Settings
from ..deck.read_deck import Deck
from ..properties.grids import read_points
from .deck_elements import element_block
from .variation import Variation, read_variation


def damping_matrix(deck: Deck) -> sp.csr_matrix | None:
    """Return D of all dashpots over the g-set, displacement systems; None where there are none.

    Raises
    ------
    InputError
        A dashpot at a grid or with a property that the deck does not have.
    """
    terms = dashpot_terms(deck, read_variation(deck, ()))
    if not terms:
        return None
    D = sum((t.matrix for t in terms[1:]), terms[0].matrix).tocsr()
    return D if D.nnz and abs(D).max() > 0.0 else None


def dashpot_terms(deck: Deck, variation: Variation) -> tuple[Term, ...]:
    """Return D of all dashpots over the g-set as terms in the parameters; none without any."""
    points = read_points(deck.bulk)
    context = Context(variation.bulk, points, Settings())
    groups = [g for family in FAMILIES if family.dampers for g in family.dampers(context)]
    if not groups:
        return ()
    blocks = [element_block(g, points, variation) for g in groups]
    return parametric_terms(blocks, points.n_dof, *variation.bounds)[0]
