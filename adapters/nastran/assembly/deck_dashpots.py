"""Viscous damping of a deck, which does not enter normal modes: dashpots and direct matrices."""

import scipy.sparse as sp

from ....core.assembly.affine_terms import parametric_terms
from ....core.data.parametric_model import Term
from ..cards import FAMILIES, Context, Group, Settings
from ..deck.bulk import Bulk
from ..deck.read_deck import Deck
from ..properties.dmig_input import direct_damping
from ..properties.grids import Points, read_points
from .deck_elements import element_block
from .moving_grids import following_grids
from .variation import Variation, read_variation


def damping_matrix(deck: Deck) -> sp.csr_matrix | None:
    """Return D of a deck over the g-set, displacement systems; None where it has none.

    Raises
    ------
    InputError
        A dashpot at a grid or with a property that the deck does not have; a matrix likewise.
    """
    terms = dashpot_terms(deck, read_variation(deck, ()))
    if not terms:
        return None
    D = sum((t.matrix for t in terms[1:]), terms[0].matrix).tocsr()
    return D if D.nnz and abs(D).max() > 0.0 else None


def dashpot_terms(deck: Deck, variation: Variation) -> tuple[Term, ...]:
    """Return D over the g-set as terms in the parameters: dashpots and B2GG; none without any."""
    points = read_points(deck.bulk)
    groups = following_grids(deck, variation, points, _made(variation.bulk, points), _made)
    blocks = [element_block(g, points, variation) for g in groups]
    terms = parametric_terms(blocks, points.n_dof, *variation.bounds)[0] if blocks else ()
    direct = direct_damping(deck, points)[0]
    return (*terms, Term(direct)) if direct.nnz else terms


def _made(bulk: Bulk, points: Points) -> tuple[Group, ...]:
    context = Context(bulk, points, Settings())
    return tuple(g for family in FAMILIES if family.dampers for g in family.dampers(context))
