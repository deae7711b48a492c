"""Fit a hypothesis once more on a basis made for it.

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
from ..effects.effect_numbers import EFFECTS
from ..effects.element_patches import root_of
from ..likelihood.elimination import InDeck, in_deck
from ..likelihood.hypothesis import Fit, Problem, softened
from ..likelihood.map_fit import evaluate, fit, on_whole_test, solve
from ..likelihood.mode_likelihood import targets
from ..model_error.diffuse_fit import Judged, everything, with_drift, with_known
from ..model_error.set_up_fields import mesh_errors, sensor_mass, suspension
from ..model_error.smooth_fields import Fields, smooth_fields
from ..reduction.elements_and_supports import Structure
from ..reduction.reduction_numbers import REDUCTION
from ..reduction.residual_flexibility import Compliance
from ..reduction.search_basis import Basis, beside, independent, structural
from .model_selection import noise_scale
from .search_numbers import SEARCH

Places = tuple[tuple[Candidates, int], ...]
"""Candidates and row of every suspect."""


@dataclass(frozen=True, eq=False)
class Own:
    """A basis for effects at some places: with the deck's masses, with better ones.

    `added` (n_free, s) stands beside the modes of the ground, `seen` (n_sensor, r + s) is what
    sensors read, `mesh` and `bars` see `Ground`, `factors` rows of the effects.
    """

    plain: Basis
    better: Basis
    added: Floats
    seen: Floats
    mesh: ReducedSum
    bars: ReducedSum
    factors: tuple[Floats, ...]


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
        Bases that were made.
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


def polished(ground: Ground, problem: Problem, state: Fit) -> Fit:
    """Return the fit with parameters and magnitudes fitted on a basis of its own.

    The laws of the problem's catalogue are not yet fitted to any basis. A support that gives
    follows the known parameters by its slopes alone, so it is made anew where they came to stand.
    """
    for _ in range(SEARCH.made_anew):
        own, start, *_ = _own_problem(ground, problem, state)
        active = tuple(range(len(state.nuisance)))
        new = fit(own, state.nuisance, start, active, SEARCH.steps_polished)
        moved = float(np.max(np.abs(new.log_p - state.log_p), initial=0.0))
        state = replace(on_whole_test(own, new), suspects=_back(state, new))
        kinds = (problem.catalogue[s.kind].kind for s in state.suspects)
        if moved < SEARCH.followed or support_flexibility.KIND not in kinds:
            break
    return state


def solves(ground: Ground, problem: Problem, state: Fit) -> bool:
    """Whether the model completed by a fit has no negative stiffness."""
    try:
        _own_problem(ground, problem, state)
    except CheckError:
        return False
    return True


def completed_modes(ground: Ground, problem: Problem, state: Fit) -> tuple[Floats, Floats]:
    """Return modes of a completed model on all analysis dofs (n_dof, n), their eigenvalues (n,).

    Beside an effect they move as the basis of the search cannot: a support that gives.
    """
    own, start, free, give = _own_problem(ground, problem, state)
    values, modes = _modes(own, state, start)
    moved = modes[: free.shape[1]]
    out = np.asarray(ground.structure.model.expansion @ (free @ moved))
    supports = ground.structure.supports
    return out if supports is None else out + supports.motion @ (give @ moved), values


def for_deck(ground: Ground, problem: Problem, state: Fit) -> Fit:
    """Return a fit that knows its known parameters for a deck, the effects as found.

    A deck has neither the trend for the error of the mesh nor masses better than its elements':
    moduli, thicknesses and inertias have to absorb both.
    """
    own, start, *_ = _own_problem(ground, problem, state, as_deck=True)
    return replace(state, in_deck=_in_deck(own, replace(state, suspects=start)))


def by_model_error(
    ground: Ground, problem: Problem, state: Fit, moving: bool = True, least: float = -np.inf
) -> Judged:
    """Return a fit as the whole test and the diffuse error judge it, on modes of its own.

    Parameters, what set-up and mesh do and smooth fields of stiffness and mass move along; no
    fields where they could not bring it to the evidence `least`; where nothing is `moving`, the
    error of the mesh alone.
    """
    own, start, *_ = _own_problem(ground, problem, state)
    _, modes = _modes(own, state, start)
    T = structural(*np.split(modes, [len(own.mesh)]))
    small = own.turned(T).entire()
    here = evaluate(small, state.nuisance, start)
    coarse, sensors, smooth = (f.turned(T) for f in (ground.coarse, ground.sensors, ground.fields))
    known = coarse.and_also(sensors)
    if np.count_nonzero(here.eigenvalues < SEARCH.rigid * here.eigenvalues.max()) >= 6:
        M, lowest = small.basis.M(np.exp(state.log_p)), float(targets(small.whole).min())
        known = known.and_also(suspension(M, smooth, lowest))
    if moving:
        found = with_drift(small, here, known, smooth, least)
    else:
        found = with_known(small, here, everything(small)[-1:], coarse)
    return replace(found, fit=replace(found.fit, suspects=_back(state, found.fit)))


def _modes(own: Problem, state: Fit, start: Sequence[Suspect]) -> tuple[Floats, Floats]:
    size = min(SEARCH.own_times * own.modes, len(own.mesh))
    return solve(own, state.nuisance, start, size)


def _back(state: Fit, own: Fit) -> tuple[Suspect, ...]:
    """Return suspects at their places with the magnitudes that were fitted."""
    both = zip(state.suspects, own.suspects, strict=True)
    return tuple(replace(s, theta=t.theta) for s, t in both)


def _own_problem(
    ground: Ground, problem: Problem, state: Fit, as_deck: bool = False
) -> tuple[Problem, tuple[Suspect, ...], Floats, Floats]:
    """Return the problem on a basis of its own, masses better than a deck's or not, and a start.

    Also its vectors, (n_free, r), and what supports that give move by in them, (n_support, r): in
    these they have a mass, and sensors on them read, as the start has it.
    """
    deck = tuple((problem.catalogue[s.kind], s.row) for s in state.suspects)
    places = tuple(_at_state(ground.structure, c, row, state) for c, row in deck)
    make = _known if places == deck else _own
    own = make(ground, places, problem.columns)
    top = SEARCH.own_above * float(targets(problem.whole).max())
    modes = int(np.count_nonzero(state.eigenvalues < top)) + SEARCH.own_more
    catalogue = tuple(_alone(c, row, state) for c, row in places)
    start = tuple(Suspect(k, 0, s.theta) for k, s in enumerate(state.suspects))
    basis, free = own.plain if as_deck else own.better, np.hstack([ground.basis.vectors, own.added])
    give, supports, seen = (
        _given(ground, catalogue, start, own),
        ground.structure.supports,
        own.seen,
    )
    if supports is not None and give.any():
        seen = seen + ground.at_supports @ give
        carried = support_flexibility.carried(supports, free, give)
        basis = replace(basis, mass=basis.mass.plus(carried))
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
    values = evaluate(new, state.nuisance, start).eigenvalues
    if values[0] < -SEARCH.rigid * values[-1]:
        raise CheckError("the completed model has a negative stiffness")
    return new, start, free, give


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
        ground.known[places] = _own(ground, places, columns)
    return ground.known[places]


def _own(ground: Ground, places: Places, columns: int) -> Own:
    """Return the basis with the static responses to effects, the last beside the others."""
    V = ground.basis.vectors
    b = ground.basis
    sums: tuple[ReducedSum, ...] = b.stiffness, b.mass, ground.mesh, ground.bars
    added, seen = V[:, :0], ground.readings
    if places:
        before, (c, row) = _known(ground, places[:-1], columns), places[-1]
        sums = before.plain.stiffness, before.plain.mass, before.mesh, before.bars
        if c.rows_each:
            loads = _root(c, row).T.toarray()
        else:
            loads = independent(c.full(row) @ V[:, :columns])
        released = any(c.law.shared for c, _ in places)
        least = REDUCTION.released if released else REDUCTION.dependent
        known = np.hstack([V, before.added])
        W = beside(ground.compliance.responses(loads), known, ground.mass, least)
        sums = tuple(s.widened([known], W) for s in sums)
        added = np.hstack([before.added, W])
        seen = np.hstack([before.seen, ground.observation @ W])
    stiffness, mass, mesh, bars = sums
    none = np.zeros((0, seen.shape[1]))
    return Own(
        Basis(none, none, stiffness, mass),
        Basis(none, none, stiffness, mass.and_also(bars)),
        added,
        seen,
        mesh,
        bars,
        tuple(_factor(c, row, V, added)[None] for c, row in places),
    )


def _root(c: Candidates, row: int) -> sp.csr_matrix:
    return c.root[row * c.rows_each : (row + 1) * c.rows_each]


def _factor(c: Candidates, row: int, V: Floats, W: Floats) -> Floats:
    """Return rows (q, r + s) whose outer products are the matrix of one place on V and W."""
    if c.rows_each:
        return np.hstack([_root(c, row) @ V, _root(c, row) @ W])
    A = c.full(row)
    own = np.unique(A.indices)
    X = np.hstack([V[own], W[own]])
    return root_of(X.T @ (A[own][:, own] @ X), EFFECTS.patch_rounding)


def _alone(c: Candidates, row: int, state: Fit) -> Candidates:
    law = c.law.on_basis(np.array([row]), None, state.log_p, 0.0)
    return replace(c, xyz=c.xyz[[row]], law=law, where=(c.where[row],))


def _in_deck(own: Problem, found: Fit) -> InDeck:
    """Return the known parameters of a fit for a deck, its effects held as they are."""
    held = tuple(
        replace(c, typical=np.array(s.theta), spread=np.full(len(s.theta), SEARCH.held))
        for c, s in zip(own.catalogue, found.suspects, strict=True)
    )
    own = replace(own, catalogue=held)
    n = len(found.log_p)
    start = np.append(found.log_p, 0.0)
    near = fit(softened(own), start, found.suspects, tuple(range(n)), SEARCH.steps_polished)
    all_of_them = fit(own, near.nuisance, found.suspects, tuple(range(n)), SEARCH.steps_polished)
    scale = noise_scale(own, on_whole_test(own, all_of_them))
    known = in_deck(all_of_them.log_p, all_of_them.information, scale)
    clear = tuple(np.flatnonzero(known.clear).tolist())
    start = np.append(known.alone, 0.0)
    alone = fit(own, start, found.suspects, clear, SEARCH.steps_polished)
    return replace(known, alone=alone.log_p)
