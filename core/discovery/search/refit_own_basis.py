"""Fit a hypothesis once more on a basis made for it alone.

The basis of the search is the same for every place, so it lacks what a heavy mass or a stiff
spring does in its own neighbourhood. Here the modes are those of the model with the effects in
it, and the static response to each effect and each parameter is added.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from ..arrays import Bools, Floats
from ..eigen import solve
from ..factor import factorise
from ..model import Model
from .basis import Basis, beside, reduced_sum
from .candidates import Candidates, Suspect, magnitudes
from .evidence import targets
from .fitting import fit, on_whole_test
from .mesh_error import lumping, with_consistent_bars
from .problem import Fit, Problem, softened
from .structure import Structure

_DEPENDENT = 1e-5
_ABOVE, _MORE = 1.6, 8
"""Eigenvalues beside the test's highest up to which modes are computed, and so many more."""
_REACHED = 1.2
"""Eigenvalues beside the test's highest that a fit may still give to a test mode."""
_RIGID = 1e-6
"""Eigenvalue beside the largest below which a mode has no strain."""
_CHANGED = 0.03
_HELD = 1e-3
"""Standard deviation of a magnitude that is to stay."""


def polished(
    structure: Structure,
    catalogue: Sequence[Candidates],
    observation: sp.csr_matrix,
    seen: Bools,
    problem: Problem,
    state: Fit,
    rounds: int = 1,
) -> Fit:
    """Return the fit with parameters and magnitudes fitted on a basis of its own.

    Parameters
    ----------
    structure : Structure
    catalogue : sequence of Candidates
        As made, their laws not yet fitted to any basis.
    observation : (n_sensor, n_free) sparse
        All sensors.
    seen : (n_sensor,) bool
        Those of the evidence.
    problem : Problem
        Evidence and priors.
    state : Fit
        From the search.
    rounds : int
        At most; ends when no magnitude moves by more than a few per cent.
    """
    top = float(targets(problem.whole).max())
    for _ in range(rounds):
        basis, chosen, modes = _own_basis(structure.model, catalogue, state, top)
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
        suspects = [Suspect(k, 0, s.theta) for k, s in enumerate(state.suspects)]
        new = fit(own, state.log_p, suspects, tuple(range(len(state.log_p))), 20)
        moved = np.abs(magnitudes(new.suspects) - magnitudes(state.suspects))
        state = replace(
            on_whole_test(own, new),
            suspects=tuple(
                replace(s, theta=t.theta) for s, t in zip(state.suspects, new.suspects, strict=True)
            ),
            in_deck=_in_deck(replace(own, basis=basis), new),
        )
        if np.all(moved < _CHANGED):
            break
    return state


def _in_deck(own: Problem, found: Fit) -> Floats:
    """Return ln p of the known parameters for a deck, the effects as found, (n_parameter,).

    A deck has neither the trend for the error of the mesh nor masses better than its elements':
    moduli, thicknesses and inertias have to absorb both.
    """
    held = tuple(
        replace(c, typical=np.array(s.theta), spread=np.full(len(s.theta), _HELD))
        for c, s in zip(own.catalogue, found.suspects, strict=True)
    )
    own = replace(own, catalogue=held)
    n = len(found.log_p) - 1
    start = np.append(found.log_p[:n], 0.0)
    near = fit(softened(own), start, found.suspects, tuple(range(n)), 20)
    return fit(own, near.log_p, found.suspects, tuple(range(n)), 20).log_p[:n]


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
    modes = int(np.count_nonzero(state.eigenvalues < _ABOVE * top)) + _MORE
    solution = solve((K, M), n_modes=modes, count=False)
    phi = solution.vectors
    asked = phi[:, _asked(solution.eigenvalues, top)]
    A = factorise((K + _shift(solution.eigenvalues) * M).tocsr(), definite=True)
    local = [x if isinstance(x, np.ndarray) else x @ asked for x in loads]
    V = np.asarray(phi)
    if local:
        V = np.hstack([V, beside(A.solve(np.ascontiguousarray(np.hstack(local))), V, M, 1e-13)])
    sides = [model.dK(k, p) @ asked for k in range(len(model.parameters))]
    if sides:
        X = A.solve(np.ascontiguousarray(np.hstack(sides)))
        V = np.hstack([V, beside(X, V, M, _DEPENDENT)])
    basis = Basis(
        V,
        np.zeros((0, V.shape[1])),
        reduced_sum(model.stiffness, V),
        reduced_sum(model.mass, V),
    )
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


def _asked(eigenvalues: Floats, top: float) -> Bools:
    """Modes whose change with the parameters counts: elastic ones that the test may hold."""
    elastic = eigenvalues > _RIGID * eigenvalues.max()
    return np.asarray(elastic & (eigenvalues < _REACHED * top))


def _shift(eigenvalues: Floats) -> float:
    positive = eigenvalues[eigenvalues > _RIGID * eigenvalues.max()]
    return 0.25 * float(positive.min())
