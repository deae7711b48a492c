"""The elements of a deck one by one, for discovery."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from ...core.arrays import Floats, Ints
from ...core.assembly_parameters import parametric_terms
from ...core.discovery.structure import Members, Structure, Supports
from ...core.model import Model, Term
from .build import build_model, read_structure, to_basic
from .constraints import read_constraints
from .damping import damping_matrix
from .grids import Points, read_points
from .parameters import FieldRef, ParameterSpec
from .read import Deck
from .variation import read_variation

_DOUBTED: dict[str, tuple[tuple[str, ...], float, tuple[float, float]]] = {
    "PSHELL": (("T",), 0.06, (0.7, 1.4)),
    "PBAR": (("I1", "I2"), 0.4, (0.25, 4.0)),
    "MAT1": (("E",), 0.1, (0.7, 1.4)),
}
_SPRINGS = ("CBUSH", "CBUSH1D")
"""Elements drawn as lines that are no bars: their properties move, no part of them is lost."""
_ATTRIBUTE = {"T": "t", "I1": "i1", "I2": "i2", "E": "e"}


def build_structure(deck: Deck, parameters: Sequence[ParameterSpec] = ()) -> Structure:
    """Assemble a deck and keep its elements and supports apart.

    Raises
    ------
    InputError
        As `build_model`.
    """
    model = build_model(deck, parameters)
    variation = read_variation(deck, parameters)
    parts = read_structure(deck, variation)
    displacement = (to_basic(parts.points).T @ model.expansion).tocsr()
    members = tuple(
        Members(g.card, "point" if g.card in _SPRINGS else g.shape, g.ids, g.corners, b)
        for g, b in zip(parts.groups, parts.blocks, strict=True)
        if g.shape
    )
    fixed = read_constraints(deck, parts.points).fixed
    lower = np.array([q.lower for q in model.parameters])
    upper = np.array([q.upper for q in model.parameters])
    stiffness, _ = parametric_terms(parts.blocks, parts.points.n_dof, lower, upper)
    return Structure(
        model,
        members,
        displacement,
        _supports(parts.points, stiffness, displacement, fixed, model),
        free_damping(deck, model),
    )


def free_damping(deck: Deck, model: Model) -> sp.csr_matrix | None:
    """Return D of the deck's dashpots on the free degrees of freedom; None where it has none."""
    D = damping_matrix(deck)
    if D is None:
        return None
    motion = to_basic(read_points(deck.bulk)).T @ model.expansion
    return (motion.T @ D @ motion).tocsr()


def _supports(
    points: Points,
    stiffness: Sequence[Term],
    displacement: sp.csr_matrix,
    fixed: object,
    model: Model,
) -> Supports | None:
    held = np.asarray(fixed)
    held = np.flatnonzero(held) if held.dtype == bool else held
    held = held[held < 6 * len(points.ids)]
    if not len(held):
        return None
    p = model.deck_point
    K = sum(
        (t.coefficient(p) * t.matrix[held] for t in stiffness[1:]),
        stiffness[0].coefficient(p) * stiffness[0].matrix[held],
    )
    coupling = K[:, held].tocsr()
    root = (K @ displacement).tocsr()
    live = np.flatnonzero((np.diff(root.indptr) > 0) & (coupling.diagonal() > 0.0))
    if not len(live):
        return None
    own = held[live]
    among = [t.matrix[own][:, own] for t in stiffness]
    slopes = tuple(
        sum(
            (t.coefficient_derivative(p, k) * A for t, A in zip(stiffness, among, strict=True)),
            sp.csr_matrix((len(own), len(own))),
        ).tocsr()
        for k in range(len(p))
    )
    return Supports(
        points.ids[own // 6],
        own % 6 + 1,
        points.xyz[own // 6],
        _axes(points, own),
        root[live],
        coupling[live][:, live],
        slopes,
    )


def _axes(points: Points, dofs: Ints) -> Floats:
    """Directions of degrees of freedom in basic axes, (n, 3)."""
    turned = to_basic(points).tocsc()[:, dofs].tocoo()
    out = np.zeros((len(dofs), 3))
    out[turned.col, turned.row % 3] = turned.data
    return out


def known_parameters(deck: Deck) -> tuple[tuple[ParameterSpec, ...], tuple[float, ...]]:
    """Return what an analyst would doubt first, and how far each may be off (spread of ln p).

    Moduli of materials, thicknesses of shells and bending inertias of bars (both axes together).
    """
    specs, spreads = [], []
    for name, (fields, spread, bounds) in _DOUBTED.items():
        for number, card in sorted(deck.bulk.table(name).items()):
            held = tuple(f for f in fields if getattr(card, _ATTRIBUTE[f], None))
            if held:
                refs = tuple(FieldRef(name, number, f) for f in held)
                specs.append(ParameterSpec(f"{name} {number} {'+'.join(held)}", refs, *bounds))
                spreads.append(spread)
    used = used_parameters(deck, specs)
    return tuple(specs[k] for k in used), tuple(spreads[k] for k in used)


def used_parameters(deck: Deck, specs: Sequence[ParameterSpec]) -> list[int]:
    """Numbers of the parameters on which at least one element depends."""
    parts = read_structure(deck, read_variation(deck, specs))
    return sorted(
        {k for b in parts.blocks for i in np.unique(b.depends_of) for k in b.depends[int(i)]}
    )
