"""Fit a hypothesis once more on a basis made for it alone.

The basis of the search is the same for every place, so it lacks what a heavy mass or a stiff
spring does in its own neighbourhood. Here the modes are those of the model with the effects in
it, and the static response to each effect and each parameter is added.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from ...arrays import Bools, Floats
from ...data.parametric_model import Model
from ...eigen.normal_modes import solve
from ...numerics.factorisation import factorise
from ..effects.candidates import Candidates, Suspect
from ..likelihood.elimination import InDeck, in_deck
from ..likelihood.hypothesis import Fit, Problem, softened
from ..likelihood.map_fit import evaluate, fit, on_whole_test
from ..likelihood.mode_likelihood import targets
from ..model_error.diffuse_fit import Judged, everything, judged, with_drift
from ..model_error.smooth_fields import smooth_fields
from ..reduction.discretisation_error import lumping, with_consistent_bars
from ..reduction.elements_and_supports import Structure
from ..reduction.search_basis import Basis, basis_on, beside, with_answers
from .model_selection import noise_scale
from .search_numbers import SEARCH


def polished(
    structure: Structure, observation: sp.csr_matrix, seen: Bools, problem: Problem, state: Fit
) -> Fit:
    """Return the fit with parameters and magnitudes fitted on a basis of its own.

    `observation` (n_sensor, n_free) is of all sensors, `seen` (n_sensor,) are those of the
    evidence; the laws of the problem's catalogue are not yet fitted to any basis.
    """
    own, basis, start = _own_problem(structure, observation, seen, problem, state)
    new = _refitted(own, state, start)
    return replace(
        on_whole_test(own, new),
        suspects=_back(state, new),
        in_deck=_in_deck(replace(own, basis=basis), new),
    )


def sized(
    structure: Structure,
    observation: sp.csr_matrix,
    seen: Bools,
    problem: Problem,
    state: Fit,
    suspects: Sequence[Suspect],
) -> Fit:
    """Return a polished fit with magnitudes that were found otherwise, those of its `suspects`.

    The known parameters for a deck are fitted beside these. The other arguments are those of
    `polished`.
    """
    moved = replace(state, suspects=tuple(suspects))
    own, basis, start = _own_problem(structure, observation, seen, problem, moved)
    return replace(
        moved, in_deck=_in_deck(replace(own, basis=basis), replace(moved, suspects=start))
    )


def refitted(
    structure: Structure, observation: sp.csr_matrix, seen: Bools, problem: Problem, state: Fit
) -> Fit:
    """Return the fit as `polished` does, but for what a deck would hold of it."""
    own, _, start = _own_problem(structure, observation, seen, problem, state)
    new = _refitted(own, state, start)
    return replace(new, suspects=_back(state, new))


def _refitted(own: Problem, state: Fit, start: Sequence[Suspect]) -> Fit:
    active = tuple(range(len(state.nuisance)))
    return fit(own, state.nuisance, start, active, SEARCH.steps_polished)


def by_model_error(
    structure: Structure,
    observation: sp.csr_matrix,
    seen: Bools,
    problem: Problem,
    state: Fit,
    moving: bool = True,
) -> Judged:
    """Return a fit as the whole test and the diffuse error judge it, on a basis of its own.

    Parameters and smooth fields of stiffness and mass move along; where nothing is `moving`, the
    error of the mesh alone. The other arguments are those of `polished`.
    """
    own, _, start = _own_problem(structure, observation, seen, problem, state)
    whole = own.entire()
    vectors = own.basis.vectors
    here = evaluate(whole, state.nuisance, start)
    if moving:
        found = with_drift(whole, here, lambda: smooth_fields(structure, vectors))
    else:
        found = judged(whole, here, everything(whole)[-1:])
    return replace(found, fit=replace(found.fit, suspects=_back(state, found.fit)))


def _back(state: Fit, own: Fit) -> tuple[Suspect, ...]:
    """Return suspects at their places with the magnitudes that were fitted."""
    both = zip(state.suspects, own.suspects, strict=True)
    return tuple(replace(s, theta=t.theta) for s, t in both)


def _own_problem(
    structure: Structure, observation: sp.csr_matrix, seen: Bools, problem: Problem, state: Fit
) -> tuple[Problem, Basis, tuple[Suspect, ...]]:
    """Return the problem on a basis of its own, that basis as the deck has it, and a start."""
    top = float(targets(problem.whole).max())
    basis, chosen, modes = _own_basis(structure.model, problem.catalogue, state, top)
    everywhere = np.asarray(observation @ basis.vectors)
    own = replace(
        problem,
        basis=with_consistent_bars(structure, basis),
        sensors=everywhere[seen],
        everywhere=everywhere,
        mesh=lumping(structure, basis.vectors),
        catalogue=tuple(c for c, _ in chosen),
        factors=tuple(U for _, U in chosen),
        missing=(),
        modes=min(basis.size, max(modes, problem.columns)),
        turn=None,
        rest=None,
    )
    return own, basis, tuple(Suspect(k, 0, s.theta) for k, s in enumerate(state.suspects))


def _in_deck(own: Problem, found: Fit) -> InDeck:
    """Return the known parameters for a deck, the effects as found.

    A deck has neither the trend for the error of the mesh nor masses better than its elements':
    moduli, thicknesses and inertias have to absorb both.
    """
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


def _own_basis(
    model: Model, catalogue: Sequence[Candidates], state: Fit, top: float
) -> tuple[Basis, list[tuple[Candidates, Floats]], int]:
    p = np.exp(state.log_p)
    K, M = model.K(p), model.M(p)
    loads = []
    for s in state.suspects:
        c = catalogue[s.kind]
        A = c.full(s.row)
        if c.rows_each:
            root = c.root[s.row * c.rows_each : (s.row + 1) * c.rows_each]
            value = c.law.value(np.array([s.theta]), np.array([s.row]))[0]
            change = (root.T @ sp.diags(np.broadcast_to(value, c.rows_each)) @ root).tocsr()
            loads.append(root.T.toarray())
        else:
            change = float(c.law.value(np.array([s.theta]), np.array([s.row]))[0, 0]) * A
            loads.append(A)
        if c.law.on == "K":
            K = (K + change).tocsr()
        elif c.law.on == "M":
            M = (M + change).tocsr()
    modes = int(np.count_nonzero(state.eigenvalues < SEARCH.own_above * top)) + SEARCH.own_more
    solution = solve((K, M), n_modes=modes, count=False)
    phi = solution.vectors
    values = solution.eigenvalues
    elastic = values > SEARCH.rigid * values.max()
    asked = phi[:, elastic & (values < SEARCH.own_reached * top)]
    shift = SEARCH.own_shift * float(values[elastic].min())
    A = factorise((K + shift * M).tocsr(), definite=True)
    local = [x if isinstance(x, np.ndarray) else x @ asked for x in loads]
    V = np.asarray(phi)
    if local:
        X = A.solve(np.ascontiguousarray(np.hstack(local)))
        V = np.hstack([V, beside(X, V, M, SEARCH.own_dependent)])
    V = with_answers(model, p, V, asked, M, A)
    basis = basis_on(model, V, np.zeros((0, V.shape[1])))
    chosen = []
    for s in state.suspects:
        c = catalogue[s.kind]
        if c.rows_each:
            U = np.asarray(c.root[s.row * c.rows_each : (s.row + 1) * c.rows_each] @ V)
        else:
            values, vectors = np.linalg.eigh(V.T @ (c.full(s.row) @ V))
            U = (vectors * np.sqrt(np.maximum(values, 0.0))).T
        one = replace(
            c,
            xyz=c.xyz[[s.row]],
            law=c.law.on_basis(np.array([s.row]), None, state.log_p, 0.0),
            where=(c.where[s.row],),
        )
        chosen.append((one, U[None]))
    return basis, chosen, phi.shape[1]
