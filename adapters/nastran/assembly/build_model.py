"""Make a neutral model of a deck: element matrices, constraints, parameters put together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Bools, Floats, Ints, Matrices
from ....core.assembly.affine_terms import parametric_terms
from ....core.assembly.element_assembly import ElementBlock, Evaluate
from ....core.assembly.guyan import static_condensation
from ....core.assembly.multipoint_constraints import Reduction, reduction, unsupported
from ....core.data.dofs import Dofs
from ....core.data.geometry import Geometry
from ....core.data.parameter import Parameter
from ....core.data.parametric_model import Model, Term
from ....core.errors import CheckError, InputError, Place
from ....core.noun import Noun
from ....core.numerics.shared_pattern_sum import select, weighted_sum
from ..cards import FAMILIES, Context, Group, Settings
from ..deck.read_deck import Deck
from ..fields.parameter_references import ParameterSpec
from ..properties.analysis_set import read_analysis_set
from ..properties.deck_constraints import read_constraints
from ..properties.dmig_input import direct_matrices
from ..properties.grids import Points, read_points
from ..properties.nonstructural import read_nonstructural
from .parameter_bounds import admissible
from .variation import Variation, read_variation

Pair = tuple[tuple[Term, ...], tuple[Term, ...]]
"""Terms of stiffness and of mass."""

_EPZERO = 1e-8
"""PARAM EPZERO: smallest stiffness of a grid's direction, relative to its largest."""


@dataclass(frozen=True, eq=False)
class Structure(Noun):
    """The elements of a deck over the g-set, before constraints.

    Parameters
    ----------
    points : Points
        Grids and the numbering.
    groups : tuple of Group
        Elements.
    blocks : tuple of ElementBlock
        The same for assembly: in displacement systems, scaled by WTMASS.
    notes : tuple of str
        What is left out.
    """

    points: Points
    groups: tuple[Group, ...]
    blocks: tuple[ElementBlock, ...]
    notes: tuple[str, ...] = ()


def read_structure(deck: Deck, variation: Variation) -> Structure:
    """Collect the elements of a deck.

    Raises
    ------
    InputError
        A card that carries stiffness, mass or constraint and is not supported; numbers that refer
        to nothing; elements without shape.
    """
    _refuse(deck)
    points = read_points(deck.bulk)
    settings = Settings(
        k6rot=deck.param("K6ROT", 100.0),
        snorm=deck.param("SNORM", 20.0),
        coupled=deck.param("COUPMASS", -1.0) > 0.0,
    )
    nonstructural = read_nonstructural(deck, points)
    context = Context(variation.bulk, points, settings, nonstructural)
    groups = tuple(g for f in FAMILIES if f.groups for g in f.groups(context))
    wtmass = deck.param("WTMASS", 1.0)
    blocks = tuple(element_block(g, points, variation, wtmass) for g in groups)
    notes = (*context.notes, *_unused_masses(deck), *_shared_numbers(deck, groups))
    return Structure(points, groups, blocks, notes)


def _refuse(deck: Deck) -> None:
    """Raise `InputError` for what carries stiffness, mass or constraint and is not supported."""
    if deck.refused:
        first, more = deck.refused[0], len(deck.refused) - 1
        raise first.reworded(
            f"{first} (and {more} more that are not supported)" if more else f"{first}"
        )


def _shared_numbers(deck: Deck, groups: Sequence[Group]) -> tuple[str, ...]:
    """Say when elements of different cards have one number, which Nastran refuses."""
    owner: dict[int, str] = {}
    shared = []
    for group in groups:
        if group.element.shape:
            new = dict.fromkeys(group.ids.tolist(), group.card)
            shared += [i for i in owner.keys() & new.keys() if owner[i] != new[i]]
            owner |= new
    if not shared:
        return ()
    shown = ", ".join(map(str, sorted(shared)[:5])) + (", ..." if len(shared) > 5 else "")
    return (
        f"{deck.path}: elements of different cards share the number {shown}; Nastran wants every "
        "element number once",
    )


def _unused_masses(deck: Deck) -> tuple[str, ...]:
    """Say when the deck holds non-structural mass that case control does not select."""
    names = [n for n in ("NSM", "NSM1", "NSML", "NSML1") if deck.bulk.table(n)]
    if deck.case.nsm is not None or not names:
        return ()
    return (
        f"{deck.path}: the {', '.join(names)} cards are not used: case control selects none "
        "(NSM = ...)",
    )


def build_model(deck: Deck, parameters: Sequence[ParameterSpec] = ()) -> Model:
    """Assemble a deck.

    Parameters
    ----------
    deck : Deck
        As read.
    parameters : sequence of ParameterSpec
        Values of the deck that shall be free to move.

    Returns
    -------
    Model
        Stiffness and mass on the free degrees of freedom as terms in the parameters.

    Raises
    ------
    InputError
        What the deck or the parameters lack: card, file and line.
    """
    return assemble(deck, parameters).model


@dataclass(frozen=True, eq=False)
class Assembly:
    """A model and what it was assembled of, before constraints.

    Parameters
    ----------
    model : Model
    structure : Structure
    stiffness : tuple of Term
        Over the g-set.
    fixed : (n_dof,) bool
        What single-point constraints fix.
    """

    model: Model
    structure: Structure
    stiffness: tuple[Term, ...]
    fixed: Bools


def assemble(deck: Deck, parameters: Sequence[ParameterSpec] = ()) -> Assembly:
    """Assemble a deck and keep its parts; see `build_model`."""
    variation = read_variation(deck, parameters)
    structure = read_structure(deck, variation)
    points = structure.points
    constraints = read_constraints(deck, points)
    variation, narrowed = admissible(variation, parameters, structure.groups, structure.blocks)
    whole = _terms(deck, structure, variation)
    reduced = reduction(points.n_dof, constraints.equations, constraints.fixed, points.label)
    terms, reduced, warnings, idle = _remove_singular(deck, points, whole, reduced)
    terms, expansion, kept, more = _condense(deck, points, terms, reduced)
    model = Model(
        geometry=_geometry(deck, structure),
        dofs=_dofs(points),
        expansion=(to_basic(points) @ expansion).tocsr(),
        stiffness=terms[0],
        mass=terms[1],
        parameters=variation.parameters,
        free_labels=tuple(points.label(d) for d in kept),
        warnings=(*structure.notes, *constraints.notes, *narrowed, *warnings, *more),
        idle=idle,
    )
    return Assembly(model, structure, whole[0], constraints.fixed)


def _terms(deck: Deck, structure: Structure, variation: Variation) -> Pair:
    """Stiffness and mass of the g-set: elements, then direct matrices in the constant term."""
    n = structure.points.n_dof
    lower = np.array([p.lower for p in variation.parameters])
    upper = np.array([p.upper for p in variation.parameters])
    try:
        terms = parametric_terms(structure.blocks, n, lower, upper)
    except CheckError as error:
        raise InputError(str(error)) from None
    _check_influence(variation.parameters, (*terms[0], *terms[1]))
    added = direct_matrices(deck, structure.points)
    return tuple(
        tuple(Term(t.matrix + extra, ()) if not t.factors and extra.nnz else t for t in part)
        for part, extra in zip(terms, added, strict=True)
    )  # type: ignore[return-value]


def element_block(
    group: Group, points: Points, variation: Variation, wtmass: float = 1.0
) -> ElementBlock:
    """Return a group for assembly: in displacement systems, masses times WTMASS."""
    sets = [
        tuple(sorted({p for key in source for p in variation.acting_on(key)}))
        for source in group.sources
    ]
    distinct = tuple(dict.fromkeys(sets))
    of_source = np.array([distinct.index(s) for s in sets], dtype=np.int64)
    return ElementBlock(
        places=group.places,
        width=group.element.freedoms,
        evaluate=_evaluation(group, points, variation, wtmass),
        depends=distinct,
        depends_of=of_source[group.source_of],
        name=group.card,
    )


def _evaluation(group: Group, points: Points, variation: Variation, wtmass: float) -> Evaluate:
    at_grids = group.element.freedoms > 1
    rotated = points.rotated[group.nodes].any(axis=1) if at_grids else None

    def evaluate(rows: Ints, p: Floats, wanted: tuple[bool, bool]) -> Matrices:
        try:
            K, M = group.matrices(variation.at(p), rows, wanted)
        except InputError as error:
            moved = variation.describe(p)
            advice = "; give narrower bounds, such as '[0.9, 1.1]'" if moved else ""
            raise error.reworded(f"{moved}{error}{advice}") from None
        for X in (K, M):
            if X is not None and not np.isfinite(X).all():
                bad = int(group.ids[rows[np.flatnonzero(~np.isfinite(X).all(axis=(1, 2)))[0]]])
                raise variation.bulk.place(group.card, bad).error(
                    "its matrix is not finite; check its shape, its property and its material"
                )
        M = M * wtmass if M is not None and wtmass != 1.0 else M
        if rotated is not None and rotated[rows].any():
            turned = np.flatnonzero(rotated[rows])
            R = points.directions[group.nodes[rows[turned]]]
            K, M = (None if X is None else _turn(X, turned, R) for X in (K, M))
        return K, M

    return evaluate


def _turn(X: Floats, which: Ints, R: Floats) -> Floats:
    """Turn the matrices of some elements to the displacement systems of their grids.

    `R` is (len(which), w, 3, 3), one rotation a place; a place holds one or two triples.
    """
    n, w = R.shape[:2]
    triples = X.shape[1] // (3 * w)
    T = np.repeat(R, triples, axis=1)
    blocks = X[which].reshape(n, w * triples, 3, w * triples, 3)
    blocks = np.einsum("naij,najbk->naibk", T, blocks, optimize=True)
    blocks = np.einsum("naibk,nblk->naibl", blocks, T, optimize=True)
    out = X.copy()
    out[which] = blocks.reshape(n, X.shape[1], X.shape[1])
    return out


def _check_influence(parameters: tuple[Parameter, ...], terms: Sequence[Term]) -> None:
    moved = {f.parameter for t in terms for f in t.factors}
    for number, parameter in enumerate(parameters):
        if number not in moved:
            raise InputError(
                f"parameter {parameter.name!r} ({', '.join(parameter.handle)}) changes neither "
                "stiffness nor mass: no element uses it, or Nastran takes the value from elsewhere"
            )


def _remove_singular(
    deck: Deck, points: Points, terms: Pair, reduced: Reduction
) -> tuple[Pair, Reduction, tuple[str, ...], tuple[int, ...]]:
    """Reduce all terms; fix what has no stiffness (AUTOSPC), or neither stiffness nor mass.

    The last results are a warning, and the grids of which a translation was fixed.
    """
    terms = _each(terms, reduced.apply)
    K, M = (_total(part) for part in terms)
    if not K.nnz:
        raise Place(deck.path).error("the deck has no element that carries stiffness")
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
    deck: Deck, points: Points, terms: Pair, reduced: Reduction
) -> tuple[Pair, sp.csr_matrix, Ints, tuple[str, ...]]:
    """Apply static condensation to the analysis set, where the deck asks for it."""
    chosen = read_analysis_set(deck, points)
    if chosen is None:
        return terms, reduced.expansion, reduced.kept, ()
    kept = np.flatnonzero(chosen[reduced.kept])
    if not len(kept):
        raise Place(deck.path).error("ASET and OMIT leave no free degree of freedom")
    try:
        T = static_condensation(_total(terms[0]), kept)
    except InputError as error:
        raise Place(deck.path).error(f"ASET and OMIT: {error}") from None
    terms = _each(terms, lambda matrices: [sp.csr_matrix(T.T @ (A @ T)) for A in matrices])
    warning = (
        f"{len(reduced.kept) - len(kept)} degrees of freedom were condensed statically to the "
        f"{len(kept)} of the analysis set (ASET, OMIT)"
    )
    if any(t.factors for part in terms for t in part):
        warning += "; the condensation stays that of the deck when parameters move"
    expansion = (reduced.expansion @ sp.csr_matrix(T)).tocsr()
    return terms, expansion, reduced.kept[kept], (warning,)


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
    ones = np.ones(1 + max((f.parameter for t in terms for f in t.factors), default=-1))
    pairs = ((t.coefficient(ones), t.matrix) for t in terms)
    return weighted_sum(pairs, terms[0].matrix.shape[0])


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
    why = "without stiffness were fixed (AUTOSPC)" if automatic else "without stiffness and mass"
    what = why if automatic else f"{why} were fixed"
    return (f"{len(dofs)} degrees of freedom {what}: {'; '.join(parts)}",)


def to_basic(points: Points) -> sp.csr_matrix:
    """Return basic displacements from those in the displacement systems."""
    n = points.n_dof
    turned = np.flatnonzero(points.rotated)
    diagonal = np.ones(n)
    start = (6 * turned[:, None] + np.array([0, 3])).reshape(-1)
    triples = start[:, None] + np.arange(3)
    diagonal[triples] = 0.0
    R = np.repeat(points.directions[turned], 2, axis=0)
    rows = np.repeat(triples, 3, axis=1).reshape(-1)
    columns = np.tile(triples, (1, 3)).reshape(-1)
    values = R.swapaxes(1, 2).reshape(-1)
    return (sp.diags(diagonal) + sp.coo_matrix((values, (rows, columns)), shape=(n, n))).tocsr()


def _dofs(points: Points) -> Dofs:
    node = np.concatenate([np.repeat(points.ids, 6), points.scalar_ids])
    component = np.concatenate(
        [np.tile(np.arange(1, 7), len(points.ids)), np.ones(len(points.scalar_ids), np.int64)]
    )
    return Dofs(node, component)


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
