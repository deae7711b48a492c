"""A basis made for a hypothesis, and the model that it completes.

The basis of the search is the same for every place, so it lacks what a heavy mass or a stiff
spring does in its own neighbourhood. Here the static response to each effect stands beside the
modes of the deck and its responses to the known parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ...arrays import Bools, Floats
from ...errors import CheckError
from ...reduction.reduced_sum import ReducedSum
from ..effects import support_flexibility
from ..effects.candidates import Candidates, Suspect
from ..effects.element_patches import root_of
from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.map_fit import solve
from ..likelihood.mode_likelihood import targets
from ..model_error.set_up_fields import mesh_errors, sensor_mass
from ..model_error.smooth_fields import Fields, smooth_fields
from ..reduction.elements_and_supports import Structure
from ..reduction.reduction_numbers import REDUCTION
from ..reduction.residual_flexibility import Compliance
from ..reduction.search_basis import Basis, beside, independent
from .search_numbers import SEARCH

Places = tuple[tuple[Candidates, int], ...]
"""Candidates and row of every suspect."""


@dataclass(frozen=True, eq=False)
class Own:
    """A basis for effects at some places: the deck's matrices, and what is better than its masses.

    `added` (n_free, s) stands beside the modes of the ground, `seen` (n_sensor, r + s) is what
    sensors read, `mesh` and `bars` see `Ground`, `factors` rows of the effects.
    """

    stiffness: ReducedSum
    mass: ReducedSum
    mesh: ReducedSum
    bars: ReducedSum
    added: Floats
    seen: Floats
    factors: tuple[Floats, ...]

    @cached_property
    def better(self) -> Basis:
        """The basis with masses better than the deck's."""
        none = np.zeros((0, self.seen.shape[1]))
        return Basis(none, none, self.stiffness, self.mass.and_also(self.bars))


@dataclass(frozen=True, eq=False)
class Ground:
    """What every hypothesis is fitted on.

    Parameters
    ----------
    structure : Structure
    basis : Basis
        Modes of the deck and its responses to the known parameters, masses as the deck has them.
    mesh, bars : ReducedSum
        What lumping does to shells, and what consistent masses add to bars, on it.
    compliance : Compliance
    observation, at_supports : (n_sensor, n_free), (n_sensor, n_support) sparse
        Of all sensors, weighted: of free degrees of freedom, of supports where these give.
    seen : (n_sensor,) bool
        Those of the evidence.
    loaded : (n_sensor, n_free) sparse
        A root of the mass of all sensors, together as heavy as the structure.
    known : dict
        Bases that were made last.
    """

    structure: Structure
    basis: Basis
    mesh: ReducedSum
    bars: ReducedSum
    compliance: Compliance
    observation: sp.csr_matrix
    at_supports: sp.csr_matrix
    seen: Bools
    loaded: sp.csr_matrix
    known: dict[Places, Own] = field(default_factory=dict)

    @cached_property
    def fields(self) -> Fields:
        """Smooth fields on the basis."""
        return smooth_fields(self.structure, self.basis.vectors)

    @cached_property
    def coarse(self) -> Fields:
        """The error of the mesh along each axis and of bars, on the basis."""
        return mesh_errors(self.structure, self.basis.vectors, self.bars.matrices)

    @cached_property
    def sensors(self) -> Fields:
        """What the sensors weigh, on the basis."""
        return sensor_mass(self.loaded @ self.basis.vectors)

    @cached_property
    def readings(self) -> Floats:
        """What sensors read on the basis, (n_sensor, r)."""
        return np.asarray(self.observation @ self.basis.vectors)

    @cached_property
    def mass(self) -> sp.csr_matrix:
        """The deck's mass matrix, (n_free, n_free)."""
        return self.structure.model.M()


@dataclass(frozen=True, eq=False)
class CompletedModel:
    """A model that effects complete, on a basis of its own.

    Parameters
    ----------
    problem : Problem
    start : tuple of Suspect
        The effects, at the only place of each kind of the problem's catalogue.
    bases : (n_free, r), (n_free, s) float
        The ground's vectors and what stands beside them: together the basis.
    give : (n_support, r + s) float
        What supports that give move by in its vectors.
    bars : (r + s, r + s) float
        What bars have of mass beside what the deck's lumped ones have.
    eigenvalues, modes : (n,), (≥ r + s, n) float
        Lowest first; coordinates that effects have of their own last.
    """

    problem: Problem
    start: tuple[Suspect, ...]
    bases: tuple[Floats, Floats]
    give: Floats
    bars: Floats
    eigenvalues: Floats
    modes: Floats

    @property
    def moved(self) -> Floats:
        """Modes in the vectors of the basis, (r + s, n)."""
        return self.modes[: self.give.shape[1]]

    def parts(self, T: Floats) -> tuple[tuple[Floats, Floats], ...]:
        """Return vectors T (r + s, k) of the basis as bases and what they are on each."""
        each = np.split(T, [self.bases[0].shape[1]])
        return tuple(zip(self.bases, each, strict=True))


def complete_model(ground: Ground, problem: Problem, state: Fit) -> CompletedModel:
    """Return the model that a fit completes, with masses better than a deck's.

    Supports that give have a mass, and sensors on them read, as the fit has it. The laws of the
    problem's catalogue are not yet fitted to any basis.

    Raises
    ------
    CheckError
        The completed model has a negative stiffness or mass.
    """
    deck = tuple((problem.catalogue[s.kind], s.row) for s in state.suspects)
    places = tuple(_at_state(ground.structure, c, row, state) for c, row in deck)
    make = _known if places == deck else _own
    own = make(ground, places, problem.columns)
    top = SEARCH.own_above * float(targets(problem.whole).max())
    modes = int(np.count_nonzero(state.eigenvalues < top)) + SEARCH.own_more
    catalogue = tuple(_alone(c, row, state) for c, row in places)
    start = tuple(Suspect(k, 0, s.theta) for k, s in enumerate(state.suspects))
    basis, seen = own.better, own.seen
    give, supports = _given(ground, catalogue, start, own), ground.structure.supports
    if supports is not None and give.any():
        seen = seen + ground.at_supports @ give
        free = np.hstack([ground.basis.vectors, own.added])
        basis = replace(
            basis, mass=basis.mass.plus([support_flexibility.carried(supports, free, give)])
        )
    new = replace(
        problem,
        basis=basis,
        sensors=seen[ground.seen],
        everywhere=seen,
        mesh=own.mesh.whole[0],
        catalogue=catalogue,
        factors=own.factors,
        missing=(),
        modes=min(own.seen.shape[1], max(modes, problem.columns)),
        turn=None,
        rest=None,
    )
    size = min(SEARCH.own_times * new.modes, len(new.mesh))
    try:
        values, vectors = solve(new, state.nuisance, start, size)
    except np.linalg.LinAlgError:
        raise CheckError("the completed model has a negative mass") from None
    if values[0] < -SEARCH.rigid * values[new.modes - 1]:
        raise CheckError("the completed model has a negative stiffness")
    bases, bars = (ground.basis.vectors, own.added), np.sum(own.bars.matrices, axis=0)
    return CompletedModel(new, start, bases, give, bars, values, vectors)


def _given(
    ground: Ground, catalogue: Sequence[Candidates], start: Sequence[Suspect], own: Own
) -> Floats:
    """Return what supports move by in the vectors of a basis, (n_support, r)."""
    out = np.zeros((ground.at_supports.shape[1], own.seen.shape[1]))
    for c, s, rows in zip(catalogue, start, own.factors, strict=True):
        if c.kind is support_flexibility.KIND:
            out += support_flexibility.given(c, s.theta, rows[0])
    return out


def _at_state(structure: Structure, c: Candidates, row: int, state: Fit) -> tuple[Candidates, int]:
    """Return candidates and row of a place as the known parameters of a fit make it."""
    if c.kind is not support_flexibility.KIND:
        return c, row
    return support_flexibility.at_parameters(structure, c, row, state.log_p), 0


def _known(ground: Ground, places: Places, columns: int) -> Own:
    if places not in ground.known:
        made = _own(ground, places, columns)
        while len(ground.known) >= SEARCH.bases_kept:
            del ground.known[next(iter(ground.known))]
        ground.known[places] = made
    return ground.known[places]


def _own(ground: Ground, places: Places, columns: int) -> Own:
    """Return the basis with the static responses to effects, the last beside the others."""
    V = ground.basis.vectors
    b = ground.basis
    sums: tuple[ReducedSum, ...] = b.stiffness, b.mass, ground.mesh, ground.bars
    added, seen = V[:, :0], ground.readings
    acting = [c.acting(row) for c, row in places]
    if places:
        before, (c, row) = _known(ground, places[:-1], columns), places[-1]
        sums = before.stiffness, before.mass, before.mesh, before.bars
        if c.rows_each:
            loads = acting[-1].T.toarray()
            if c.rows_each > 6 * c.many(row):
                loads = independent(loads)
        else:
            loads = independent(acting[-1] @ V[:, :columns])
        released = any(c.law.shared for c, _ in places)
        least = REDUCTION.nil if released else REDUCTION.dependent
        known = [basis for basis in (V, before.added) if basis.shape[1]]
        W = beside(ground.compliance.responses(loads), known, ground.mass, least)
        sums = tuple(s.widened(known, W) for s in sums)
        added = np.hstack([before.added, W])
        seen = np.hstack([before.seen, ground.observation @ W])
    stiffness, mass, mesh, bars = sums
    both = zip(places, acting, strict=True)
    factors = tuple(_factor(c, A, V, added)[None] for (c, _), A in both)
    return Own(stiffness, mass, mesh, bars, added, seen, factors)


def _factor(c: Candidates, A: sp.csr_matrix, V: Floats, W: Floats) -> Floats:
    """Return rows (q, r + s) whose outer products are the matrix of one place on V and W.

    A is that matrix or, of candidates that have one, a root of it.
    """
    if c.rows_each:
        return np.hstack([A @ V, A @ W])
    own = np.unique(A.indices)
    X = np.hstack([V[own], W[own]])
    return root_of(X.T @ (A[own][:, own] @ X), REDUCTION.nil)


def _alone(c: Candidates, row: int, state: Fit) -> Candidates:
    law = c.law.on_basis(np.array([row]), None, state.log_p, 0.0)
    return replace(c, xyz=c.xyz[[row]], law=law, where=(c.where[row],))
