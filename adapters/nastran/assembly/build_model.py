"""Make a neutral model of a deck: elements, constraints, parameters put together."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Bools, Floats, Ints, frozen
from ....core.assembly.affine_terms import parametric_terms
from ....core.assembly.guyan import condensed, static_condensation, without_strain
from ....core.assembly.multipoint_constraints import Reduction, reduction, unsupported
from ....core.data.geometry import Geometry
from ....core.data.parameter import Parameter
from ....core.data.parametric_model import Model, Term
from ....core.data.rigid_mass import differs_by_axis
from ....core.errors import CheckError, InputError, Place
from ....core.numerics.shared_pattern_sum import select, weighted_sum
from ....core.reduction.component_modes import component_modes
from ..deck.read_deck import Deck
from ..fields.parameter_references import ParameterSpec
from ..properties.analysis_set import AnalysisSet, read_analysis_set
from ..properties.damping_tables import selected_ratios
from ..properties.deck_constraints import read_constraints
from ..properties.dmig_input import direct_matrices, external_matrices
from ..properties.grids import Points, point_dofs, to_basic
from ..properties.thermal import unused_tables
from ..properties.unit_slips import unit_slips
from .deck_damping import damping_terms, linear, params_moved
from .deck_elements import Structure, read_structure
from .negative_masses import refuse_negative_masses
from .parameter_bounds import admissible
from .variation import GRID, Variation, read_variation

Pair = tuple[tuple[Term, ...], tuple[Term, ...]]
"""Terms of stiffness and of mass."""

_EPZERO = 1e-8
"""PARAM EPZERO: smallest stiffness of a grid's direction, relative to its largest."""


def build_model(
    deck: Deck, parameters: Sequence[ParameterSpec] = (), damped: bool = False
) -> Model:
    """Assemble a deck.

    Parameters
    ----------
    deck : Deck
        As read.
    parameters : sequence of ParameterSpec
        Values of the deck that shall be free to move.
    damped : bool
        Whether its damping is assembled, too; it is where a parameter moves nothing but that.

    Returns
    -------
    Model
        Stiffness and mass on the free degrees of freedom as terms in the parameters.

    Raises
    ------
    InputError
        What the deck or the parameters lack: card, file and line.
    """
    return assemble(deck, parameters, damped).model


@dataclass(frozen=True, eq=False)
class Assembly:
    """A model and what it was assembled of, before constraints.

    Parameters
    ----------
    model : Model
    structure : Structure
    stiffness, mass : tuple of Term
        Over the g-set.
    fixed : (n_dof,) bool
        What single-point constraints fix.
    kept : (n_free,) int or None
        Which degree of freedom of the g-set each free one is; None where some are condensed.
    """

    model: Model
    structure: Structure
    stiffness: tuple[Term, ...]
    mass: tuple[Term, ...]
    fixed: Bools
    kept: Ints | None


def assemble(
    deck: Deck, parameters: Sequence[ParameterSpec] = (), damped: bool = False
) -> Assembly:
    """Assemble a deck and keep its parts; see `build_model`."""
    variation = read_variation(deck, parameters)
    structure = read_structure(deck, variation)
    points = structure.points
    constraints = read_constraints(deck, points)
    variation, narrowed = admissible(variation, parameters, structure.groups, structure.blocks)
    whole = _terms(deck, structure, variation, parameters)
    sets = read_analysis_set(deck, points)
    fixed = constraints.fixed if sets is None else constraints.fixed | sets.modal
    reduced = reduction(points.n_dof, constraints.equations, fixed, points.label)
    terms, reduced, warnings, idle = _remove_singular(deck, points, whole, reduced)
    terms, expansion, kept, more = _condense(deck, points, sets, terms, reduced)
    geometry, rigid_mass = _geometry(deck, structure), _rigid_mass(points, whole[1])
    uneven = differs_by_axis(_at_deck(whole[1], rigid_mass))
    model = Model(
        geometry=geometry,
        dofs=point_dofs(points.ids, points.scalar_ids),
        expansion=(to_basic(points) @ expansion).tocsr(),
        stiffness=terms[0],
        mass=terms[1],
        parameters=variation.parameters,
        free_labels=tuple(points.label(d) for d in kept),
        warnings=(
            *unit_slips(deck, geometry.size),
            *unused_tables(deck),
            *structure.notes,
            *constraints.notes,
            *narrowed,
            *warnings,
            *more,
            *((uneven,) if uneven else ()),
        ),
        idle=idle,
        rigid_mass=() if any(card == GRID for card, _ in variation.moves) else rigid_mass,
        ratios=selected_ratios(deck),
    )
    if damped or _idle(model):
        D, H = damping_terms(deck, model, variation, parameters)
        model = replace(model, damping=D, loss=H)
    _require_influence(model)
    return Assembly(model, structure, *whole, constraints.fixed, kept if sets is None else None)


def moved(deck: Deck, kept: Ints, by: Floats) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Return stiffness and mass (n_free, n_free) of a deck, its grids moved `by` (n_grid, 3).

    On the degrees of freedom `kept` of the g-set; see `Assembly`.
    """
    variation = read_variation(deck, ())
    structure = read_structure(deck, variation, by)
    points = structure.points
    constraints = read_constraints(deck, points)
    reduced = reduction(points.n_dof, constraints.equations, constraints.fixed, points.label)
    reduced = reduced.drop(np.flatnonzero(~np.isin(reduced.kept, kept)))
    terms = _each(_terms(deck, structure, variation, ()), reduced.apply)
    return _total(terms[0]), _total(terms[1])


def _terms(
    deck: Deck, structure: Structure, variation: Variation, specs: Sequence[ParameterSpec]
) -> Pair:
    """Stiffness and mass of the g-set: elements, superelements, direct matrices."""
    points, named = structure.points, params_moved(specs)
    try:
        terms = parametric_terms(structure.blocks, points.n_dof, *variation.bounds)
    except CheckError as error:
        raise InputError(str(error)) from None
    added = zip(direct_matrices(deck, points), external_matrices(deck, points), strict=True)
    out = []
    for part, scale, (direct, fixed) in zip(terms, ("CK2", "CM2"), added, strict=True):
        own, (constant, *others) = named.get(scale), part
        if own is None:
            fixed = fixed + direct
        elif direct.nnz:
            others.append(Term(direct, (linear(variation.parameters[own], own),)))
        out.append((Term(constant.matrix + fixed, ()) if fixed.nnz else constant, *others))
    return out[0], out[1]


def _idle(model: Model) -> list[Parameter]:
    """Return the parameters that change nothing of a model."""
    terms = (*model.stiffness, *model.mass, *model.damping, *model.loss)
    moved = {f.parameter for t in terms for f in t.factors}
    return [q for k, q in enumerate(model.parameters) if k not in moved]


def _require_influence(model: Model) -> None:
    for parameter in _idle(model):
        raise InputError(
            f"parameter {parameter.name!r} ({', '.join(parameter.handle)}) changes neither "
            "stiffness nor mass nor damping: no element uses it, or Nastran takes the value from "
            "elsewhere"
        )


def _remove_singular(
    deck: Deck, points: Points, terms: Pair, reduced: Reduction
) -> tuple[Pair, Reduction, tuple[str, ...], tuple[int, ...]]:
    """Reduce all terms; fix what has no stiffness (AUTOSPC), or neither stiffness nor mass.

    The last results are a warning, and the grids of which a translation was fixed.
    """
    terms = _each(terms, reduced.apply)
    K, M = (_total(part) for part in terms)
    if not K.shape[0]:
        raise Place(deck.path).error("the constraints leave no free degree of freedom")
    if not K.nnz:
        raise Place(deck.path).error("the deck has no element that carries stiffness")
    refuse_negative_masses(deck, points, reduced.kept, M.diagonal())
    triple = np.where(reduced.kept < 6 * len(points.ids), reduced.kept // 3, -1)
    automatic = deck.params.get("AUTOSPC", "YES") != "NO"
    smallest = deck.param("EPZERO", _EPZERO)
    loose = unsupported(
        K, triple, reduced.kept % 3, None if automatic else M, smallest, triple % 2 == 1
    )
    if not len(loose):
        return terms, reduced, (), ()
    left = np.setdiff1d(np.arange(K.shape[0]), loose)
    terms = _each(terms, lambda matrices: select(matrices, left))
    fixed = reduced.kept[loose]
    translations = fixed[(fixed < 6 * len(points.ids)) & (fixed % 6 < 3)]
    idle = tuple(int(i) for i in np.unique(points.ids[translations // 6]))
    return terms, reduced.drop(loose), _loose_warning(points, fixed, automatic), idle


def _condense(
    deck: Deck, points: Points, sets: AnalysisSet | None, terms: Pair, reduced: Reduction
) -> tuple[Pair, sp.csr_matrix, Ints, tuple[str, ...]]:
    """Reduce to the analysis set, where the deck asks for it."""
    if sets is None:
        return terms, reduced.expansion, reduced.kept, ()
    kept, modal = np.flatnonzero(sets.kept[reduced.kept]), np.flatnonzero(sets.modal)
    if not len(kept) and not len(modal):
        raise Place(deck.path).error("ASET and OMIT leave no free degree of freedom")
    K, M = (_total(part) for part in terms)
    try:
        rigid = _rigid_motions(points, reduced.kept)[:, : 6 * bool(len(modal))]
        rigid = without_strain(K, rigid)
        T = static_condensation(K, kept, rigid) if len(kept) else np.zeros((K.shape[0], 0))
    except InputError as error:
        raise Place(deck.path).error(f"ASET and OMIT: {error}") from None
    if len(modal):
        held = np.flatnonzero(sets.held[reduced.kept])
        number, fmax = _component_modes_wanted(deck, len(modal))
        T = np.hstack([T, component_modes(K, M, T, kept, held, number, fmax)])
        modal = modal[: T.shape[1] - len(kept)]
    at_rest = np.zeros((T.shape[1] - len(kept), rigid.shape[1]))
    rigid = np.vstack([rigid[kept], at_rest])
    if len(modal):
        terms = _each(terms, lambda matrices: [condensed(A, T, rigid) for A in matrices])
    else:
        terms = _each(terms, lambda matrices: [sp.csr_matrix(T.T @ (A @ T)) for A in matrices])
    warning = (
        f"{len(reduced.kept) - len(kept)} degrees of freedom were condensed statically to the "
        f"{len(kept)} of the analysis set (ASET, OMIT)"
    )
    if len(modal):
        warning = (
            f"the model is reduced to {len(kept)} degrees of freedom of the boundary and "
            f"{len(modal)} component modes (QSET), without residual vectors"
        )
    if any(t.factors for part in terms for t in part):
        warning += "; the condensation stays that of the deck when parameters move"
    expansion = (reduced.expansion @ sp.csr_matrix(T)).tolil()
    expansion[modal, np.arange(len(kept), T.shape[1])] = 1.0
    return terms, expansion.tocsr(), np.concatenate([reduced.kept[kept], modal]), (warning,)


def _rigid_motions(points: Points, dofs: Ints) -> Floats:
    """Displacements of degrees of freedom of the g-set in the six rigid motions, (n, 6)."""
    at = np.flatnonzero(dofs < 6 * len(points.ids))
    out = np.zeros((len(dofs), 6))
    if len(at):
        grid, component = np.divmod(dofs[at], 6)
        out[at] = points.motions(grid, points.xyz[grid].mean(axis=0))[np.arange(len(at)), component]
    return out


def _rigid_mass(points: Points, mass: tuple[Term, ...]) -> tuple[Floats, ...]:
    R = np.zeros((points.n_dof, 6))
    R[: 6 * len(points.ids)] = points.motions(slice(None), np.zeros(3)).reshape(-1, 6)
    return tuple(frozen(R.T @ (t.matrix @ R)) for t in mass)


def _component_modes_wanted(deck: Deck, places: int) -> tuple[int | None, float | None]:
    """How many component modes the deck asks for, and up to which frequency."""
    eigen = deck.eigen
    if eigen is None:
        raise Place(deck.path).error(
            "QSET asks for component modes, but METHOD selects no EIGRL or EIGR that says how many"
        )
    return min(places, eigen.nd or places), eigen.v2


def _each(
    terms: Pair, change: Callable[[Sequence[sp.csr_matrix]], Sequence[sp.csr_matrix]]
) -> Pair:
    stiffness, mass = (
        tuple(
            Term(matrix, t.factors)
            for matrix, t in zip(change([t.matrix for t in part]), part, strict=True)
        )
        for part in terms
    )
    return stiffness, mass


def _total(terms: tuple[Term, ...]) -> sp.csr_matrix:
    """Sum of the terms at the deck's values."""
    pairs = zip(_coefficients(terms), (t.matrix for t in terms), strict=True)
    return weighted_sum(pairs, terms[0].matrix.shape[0])


def _at_deck(terms: tuple[Term, ...], parts: Sequence[Floats]) -> Floats:
    return np.asarray(sum(c * A for c, A in zip(_coefficients(terms), parts, strict=True)))


def _coefficients(terms: tuple[Term, ...]) -> list[float]:
    ones = np.ones(1 + max((f.parameter for t in terms for f in t.factors), default=-1))
    return [t.coefficient(ones) for t in terms]


def _loose_warning(points: Points, dofs: Ints, automatic: bool) -> tuple[str, ...]:
    """Say which degrees of freedom were removed, by component."""
    n_grid = 6 * len(points.ids)
    parts = []
    for component in range(6):
        grids = points.ids[dofs[(dofs < n_grid) & (dofs % 6 == component)] // 6]
        if len(grids):
            shown = ", ".join(map(str, grids[:5])) + (", ..." if len(grids) > 5 else "")
            parts.append(f"component {component + 1} of {len(grids)} grids ({shown})")
    scalar = points.scalar_ids[dofs[dofs >= n_grid] - n_grid]
    if len(scalar):
        parts.append(f"{len(scalar)} scalar points ({', '.join(map(str, scalar[:5]))})")
    what = "stiffness were fixed (AUTOSPC)" if automatic else "stiffness and mass were fixed"
    return (f"{len(dofs)} degrees of freedom without {what}: {'; '.join(parts)}",)


def _geometry(deck: Deck, structure: Structure) -> Geometry:
    corners: dict[str, list[Ints]] = {}
    ids: dict[str, list[Ints]] = {}
    for group in structure.groups:
        if shape := group.element.shape:
            corners.setdefault(shape.name, []).append(group.corners)
            ids.setdefault(shape.name, []).append(group.ids)
    return Geometry(
        structure.points.ids,
        structure.points.xyz,
        deck.length_unit,
        {k: np.concatenate(v) for k, v in corners.items()},
        {k: np.concatenate(v) for k, v in ids.items()},
    )
