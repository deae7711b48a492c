"""The elements of a deck one by one, for discovery."""

from collections.abc import Sequence
from functools import partial

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Floats, Ints
from ....core.data.parametric_model import Term
from ....core.discovery.reduction.elements_and_supports import Members, Structure, Supports
from ..assembly.build_model import Assembly, assemble, moved
from ..assembly.deck_damping import free_damping
from ..deck.read_deck import Deck
from ..fields.parameter_references import ParameterSpec
from ..properties.grids import Points, to_basic


def build_structure(deck: Deck, parameters: Sequence[ParameterSpec] = ()) -> Structure:
    """Assemble a deck and keep its elements and supports apart.

    Raises
    ------
    InputError
        As `build_model`.
    """
    whole = assemble(deck, parameters)
    model, parts = whole.model, whole.structure
    displacement = (to_basic(parts.points).T @ model.expansion).tocsr()
    members = tuple(
        Members(g.element, g.ids, g.corners, b)
        for g, b in zip(parts.groups, parts.blocks, strict=True)
        if g.element.shape
    )
    kept = whole.kept
    return Structure(
        model,
        members,
        displacement,
        _supports(whole, displacement),
        free_damping(deck, model),
        None if kept is None else partial(moved, deck, kept),
    )


def _supports(whole: Assembly, displacement: sp.csr_matrix) -> Supports | None:
    points, stiffness, p = whole.structure.points, whole.stiffness, whole.model.deck_point
    held = np.flatnonzero(whole.fixed)
    held = held[held < 6 * len(points.ids)]
    if not len(held):
        return None
    K, M = (_rows(terms, held, p) for terms in (stiffness, whole.mass))
    coupling = K[:, held].tocsr()
    root = (K @ displacement).tocsr()
    live = np.flatnonzero((np.diff(root.indptr) > 0) & (coupling.diagonal() > 0.0))
    if not len(live):
        return None
    own = held[live]
    among, none = [(t, t.matrix[own][:, own]) for t in stiffness], sp.csr_matrix((len(own),) * 2)
    slopes = tuple(
        sum((t.coefficient_derivative(p, k) * A for t, A in among), none).tocsr()
        for k in range(len(p))
    )
    grid, component = own // 6, own % 6 + 1
    held_by = root[live], coupling[live][:, live], slopes
    with_them = (M @ displacement)[live].tocsr(), M[live][:, own].tocsr(), to_basic(points)[:, own]
    at = points.ids[grid], component, points.xyz[grid], _axes(points, own)
    return Supports(*at, *held_by, *with_them)


def _rows(terms: Sequence[Term], rows: Ints, p: Floats) -> sp.csr_matrix:
    """Return some rows of a sum at the parameter values `p`."""
    none = sp.csr_matrix((len(rows), terms[0].matrix.shape[1]))
    return sum((t.coefficient(p) * t.matrix[rows] for t in terms), none).tocsr()


def _axes(points: Points, dofs: Ints) -> Floats:
    """Directions of degrees of freedom in basic axes, (n, 3)."""
    turned = to_basic(points).tocsc()[:, dofs].tocoo()
    out = np.zeros((len(dofs), 3))
    out[turned.col, turned.row % 3] = turned.data
    return out
