"""Fit a hypothesis once more on a basis made for it.

The basis of the search is the same for every place, so it lacks what a heavy mass or a stiff
spring does in its own neighbourhood. Here the static response to each effect stands beside the
modes of the deck and its responses to the known parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ...arrays import Bools, Floats
from ...errors import CheckError
from ..effects.candidates import Candidates, Suspect
from ..likelihood.elimination import InDeck, in_deck
from ..likelihood.hypothesis import Fit, Problem, softened
from ..likelihood.map_fit import evaluate, fit, on_whole_test, solve
from ..likelihood.mode_likelihood import targets
from ..model_error.diffuse_fit import Judged, everything, judged, with_drift
from ..model_error.smooth_fields import Fields, smooth_fields, suspended
from ..reduction.discretisation_error import lumping, with_consistent_bars
from ..reduction.elements_and_supports import Structure
from ..reduction.reduction_numbers import REDUCTION
from ..reduction.residual_flexibility import Compliance
from ..reduction.search_basis import Basis, beside, structural
from .model_selection import noise_scale
from .search_numbers import SEARCH


@dataclass(frozen=True, eq=False)
class Ground:
    """What every hypothesis is fitted on.

    Parameters
    ----------
    structure : Structure
    basis : Basis
        Modes of the deck and its responses to the known parameters, masses as the deck has them.
    compliance : Compliance
    observation : (n_sensor, n_free) sparse
        Of all sensors, weighted.
    seen : (n_sensor,) bool
        Those of the evidence.
    """

    structure: Structure
    basis: Basis
    compliance: Compliance
    observation: sp.csr_matrix
    seen: Bools

    @cached_property
    def fields(self) -> Fields:
        """Smooth fields on the basis."""
        return smooth_fields(self.structure, self.basis.vectors)

    @cached_property
    def mass(self) -> sp.csr_matrix:
        """The deck's mass matrix, (n_free, n_free)."""
        return self.structure.model.M()


def polished(ground: Ground, problem: Problem, state: Fit) -> Fit:
    """Return the fit with parameters and magnitudes fitted on a basis of its own.

    The laws of the problem's catalogue are not yet fitted to any basis.
    """
    own, start = _own_problem(ground, problem, state)
    active = tuple(range(len(state.nuisance)))
    new = fit(own, state.nuisance, start, active, SEARCH.steps_polished)
    return replace(on_whole_test(own, new), suspects=_back(state, new))


def for_deck(ground: Ground, problem: Problem, state: Fit) -> Fit:
    """Return a fit that knows its known parameters for a deck, the effects as found.

    A deck has neither the trend for the error of the mesh nor masses better than its elements':
    moduli, thicknesses and inertias have to absorb both.
    """
    own, start = _own_problem(ground, problem, state, as_deck=True)
    return replace(state, in_deck=_in_deck(own, replace(state, suspects=start)))


def by_model_error(ground: Ground, problem: Problem, state: Fit, moving: bool = True) -> Judged:
    """Return a fit as the whole test and the diffuse error judge it, on modes of its own.

    Parameters and smooth fields of stiffness and mass move along, of a free structure its
    suspension too; where nothing is `moving`, the error of the mesh alone.
    """
    own, start = _own_problem(ground, problem, state)
    size = min(SEARCH.own_times * own.modes, own.basis.size)
    _, modes = solve(own, state.nuisance, start, size)
    T = structural(*np.split(modes, [own.basis.size]))
    small = replace(own, basis=own.basis.bare()).turned(T).entire()
    here = evaluate(small, state.nuisance, start)

    def fields() -> Fields:
        known = ground.fields.turned(T)
        rigid = np.count_nonzero(here.eigenvalues < SEARCH.rigid * here.eigenvalues.max())
        if rigid < 6:
            return known
        return suspended(
            known, small.basis.M(np.exp(state.log_p)), float(targets(small.whole).min())
        )

    if moving:
        found = with_drift(small, here, fields)
    else:
        found = judged(small, here, everything(small)[-1:])
    return replace(found, fit=replace(found.fit, suspects=_back(state, found.fit)))


def _back(state: Fit, own: Fit) -> tuple[Suspect, ...]:
    """Return suspects at their places with the magnitudes that were fitted."""
    both = zip(state.suspects, own.suspects, strict=True)
    return tuple(replace(s, theta=t.theta) for s, t in both)


def _own_problem(
    ground: Ground, problem: Problem, state: Fit, as_deck: bool = False
) -> tuple[Problem, tuple[Suspect, ...]]:
    """Return the problem on a basis of its own, masses better than a deck's or not, and a start."""
    wide = [(problem.catalogue[s.kind], s.row) for s in state.suspects]
    basis = _widened(ground, wide, problem.columns)
    everywhere = np.asarray(ground.observation @ basis.vectors)
    top = SEARCH.own_above * float(targets(problem.whole).max())
    modes = int(np.count_nonzero(state.eigenvalues < top)) + SEARCH.own_more
    own = replace(
        problem,
        basis=basis if as_deck else with_consistent_bars(ground.structure, basis),
        sensors=everywhere[ground.seen],
        everywhere=everywhere,
        mesh=lumping(ground.structure, basis.vectors),
        catalogue=tuple(_alone(c, row, state) for c, row in wide),
        factors=tuple(_factor(c, row, basis.vectors)[None] for c, row in wide),
        missing=(),
        modes=min(basis.size, max(modes, problem.columns)),
        turn=None,
        rest=None,
    )
    start = tuple(Suspect(k, 0, s.theta) for k, s in enumerate(state.suspects))
    values = evaluate(own, state.nuisance, start).eigenvalues
    if values[0] < -SEARCH.rigid * values[-1]:
        raise CheckError("the completed model has a negative stiffness")
    return own, start


def _widened(ground: Ground, places: Sequence[tuple[Candidates, int]], columns: int) -> Basis:
    """Return the basis with the static responses to effects."""
    basis, V = ground.basis, ground.basis.vectors
    loads = [
        _root(c, row).T.toarray() if c.rows_each else c.full(row) @ V[:, :columns]
        for c, row in places
    ]
    if not loads:
        return replace(basis, motion=np.zeros((0, basis.size)))
    X = ground.compliance.responses(np.hstack(loads))
    W = beside(X, V, ground.mass, REDUCTION.dependent)
    both = np.hstack([V, W])
    stiffness, mass = (s.widened(V, W) for s in (basis.stiffness, basis.mass))
    return Basis(both, np.zeros((0, both.shape[1])), stiffness, mass)


def _root(c: Candidates, row: int) -> sp.csr_matrix:
    return c.root[row * c.rows_each : (row + 1) * c.rows_each]


def _factor(c: Candidates, row: int, V: Floats) -> Floats:
    """Return rows (q, r) whose outer products are the matrix of one place on a basis."""
    if c.rows_each:
        return np.asarray(_root(c, row) @ V)
    values, vectors = np.linalg.eigh(V.T @ (c.full(row) @ V))
    return np.asarray((vectors * np.sqrt(np.maximum(values, 0.0))).T)


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
