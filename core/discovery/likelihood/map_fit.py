"""Fit known parameters and the magnitudes of suspects together, on the small basis."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from ...arrays import Floats, Ints
from ...numerics.lapack import eigenpairs
from ..effects.candidates import Suspect, changed, magnitudes
from .hypothesis import Fit, Problem
from .likelihood_numbers import LIKELIHOOD
from .mode_likelihood import joint_macs, matched, mode_costs, targets
from .repeated_modes import none_cut, turned_to_test

_FIRST = np.zeros(1, np.int64)
Box = tuple[Floats | float, Floats | float]
_ANYWHERE: Box = (-np.inf, np.inf)


def _matrices(
    problem: Problem, nuisance: Floats, suspects: Sequence[Suspect]
) -> tuple[Floats, Floats]:
    p = np.exp(nuisance[:-1])
    K, M = problem.basis.K(p), problem.basis.M(p) - nuisance[-1] * problem.mesh
    own = []
    for s in suspects:
        rows, law = problem.part(s.kind, np.array([s.row]), nuisance)
        U, theta = rows[0], np.array([s.theta])
        c = law.value(theta, _FIRST)[0]
        if law.on == "A":
            k = np.broadcast_to(1.0 / law.flexibility(theta, _FIRST)[0], len(U))
            K = K + (U.T * k) @ U
            own.append((-(U.T * (k / np.sqrt(c))), k / c))
        elif law.on == "K":
            K = K + (U.T * c) @ U
        else:
            M = M + (U.T * c) @ U
    if own:
        K, M = _bordered(K, M, own)
    return K, M


def _bordered(K: Floats, M: Floats, own: Sequence[tuple[Floats, Floats]]) -> tuple[Floats, Floats]:
    """Return matrices with rows of their own for coordinates of unit mass: side and diagonal."""
    n, more = len(K), sum(len(diagonal) for _, diagonal in own)
    stiffness, mass = np.zeros((2, n + more, n + more))
    stiffness[:n, :n], mass[:n, :n] = K, M
    stiffness[:n, n:] = np.hstack([side for side, _ in own])
    stiffness[n:, :n] = stiffness[:n, n:].T
    rows = np.arange(n, n + more)
    stiffness[rows, rows] = np.concatenate([diagonal for _, diagonal in own])
    mass[rows, rows] = 1.0
    return stiffness, mass


def solve(
    problem: Problem, nuisance: Floats, suspects: Sequence[Suspect], modes: int | None = None
) -> tuple[Floats, Floats]:
    """Return the lowest eigenvalues and vectors on the basis, of repeated ones none or all.

    Attached masses have rows of their own after those of the basis, in the order of the
    suspects, times √m.
    """
    K, M = _matrices(problem, nuisance, suspects)
    values, vectors = eigenpairs(K, M)
    n = none_cut(values, min(modes or problem.modes, len(K)))
    return values[:n], vectors[:, :n]


def misfit(problem: Problem, values: Floats, vectors: Floats) -> tuple[float, Ints]:
    """Return the misfit of a solution and its match."""
    return matched(_costs(problem, values, vectors))


def mode_misfits(problem: Problem, values: Floats, vectors: Floats) -> Floats:
    """Return the misfit of each test mode with its match, (n_test,)."""
    costs = _costs(problem, values, vectors)
    return np.asarray(costs[np.arange(len(costs)), matched(costs)[1]])


def _shapes(problem: Problem, values: Floats, vectors: Floats) -> Floats:
    """Return what the sensors read of the modes that may match, (n_sensor, n)."""
    n = min(problem.columns, len(values))
    return np.asarray(problem.sensors @ vectors[: problem.sensors.shape[1], :n])


def _costs(problem: Problem, values: Floats, vectors: Floats) -> Floats:
    e, shapes = problem.evidence, _shapes(problem, values, vectors)
    return mode_costs(e, values[: shapes.shape[1]], e.shapes.T @ shapes, shapes.T @ shapes)


def surprise(problem: Problem, nuisance: Floats, suspects: Sequence[Suspect]) -> float:
    """Return −2 ln of the prior density of a hypothesis' unknowns, up to a constant."""
    total = float(np.sum((nuisance / problem.prior.spread) ** 2))
    return total + sum(
        float(problem.catalogue[s.kind].surprise(np.array([s.theta]))[0]) for s in suspects
    )


def evaluate(problem: Problem, nuisance: Floats, suspects: Sequence[Suspect]) -> Fit:
    """Return a hypothesis as it stands, nothing fitted."""
    values, vectors = solve(problem, nuisance, suspects)
    bad, match = misfit(problem, values, vectors)
    cross = problem.evidence.shapes.T @ _shapes(problem, values, vectors)
    turned = turned_to_test(vectors, values, cross, match)
    if turned is not vectors:
        vectors, costs = turned, _costs(problem, values, turned)
        bad = float(costs[np.arange(len(match)), match].sum())
    total, none = bad + surprise(problem, nuisance, suspects), np.zeros((0, 0))
    return Fit(total, bad, nuisance, tuple(suspects), match, values, vectors, none, ())


def fit(
    problem: Problem,
    nuisance: Floats,
    suspects: Sequence[Suspect],
    active: Sequence[int],
    iterations: int,
    tolerance: float = LIKELIHOOD.tolerance,
) -> Fit:
    """Minimise misfit plus prior over nuisance parameters and θ: Gauss-Newton, Levenberg's damping.

    `nuisance` (n_parameter + 1,), see `Fit`, of which the `active` entries move, and the
    magnitudes of the suspects are a start; places stay. `tolerance` is the smallest fall of the
    objective that counts, and that is looked for. A step to where a mass is negative is too long.
    """
    now = evaluate(problem, np.array(nuisance), suspects)
    damping = 0.0
    steps = [problem.catalogue[s.kind].steps for s in suspects]
    reach = LIKELIHOOD.reach * np.concatenate([np.ones(len(active)), *steps])
    H = np.zeros((len(reach),) * 2)
    for _ in range(iterations if len(reach) else 0):
        H, g = _normal_equations(problem, now, active)
        better = None
        for _ in range(LIKELIHOOD.dampings):
            step = step_within(H, g, damping=damping)
            if -float(g @ step) < tolerance:
                break
            with suppress(np.linalg.LinAlgError):
                trial = stepped(problem, now, active, np.clip(step, -reach, reach))
                if trial.objective < now.objective:
                    better, damping = trial, LIKELIHOOD.damping_down * damping
                    break
            damping = max(LIKELIHOOD.damping_up * damping, LIKELIHOOD.damping_first)
        if better is None:
            break
        fell = now.objective - better.objective
        now = better
        if fell < tolerance:
            break
    return replace(now, information=H, active=tuple(active))


def promised(
    problem: Problem, nuisance: Floats, suspects: Sequence[Suspect], active: Sequence[int]
) -> float:
    """Return the objective that one Gauss-Newton step would leave if all were linear."""
    now = evaluate(problem, nuisance, suspects)
    H, g = _normal_equations(problem, now, active)
    return now.objective - float(g @ np.linalg.solve(H, g)) if len(g) else now.objective


def step_within(H: Floats, g: Floats, box: Box = _ANYWHERE, damping: float = 0.0) -> Floats:
    """Return Levenberg's step within a box, each unknown in units of its own curvature.

    The others know what the sides of the box hold.
    """
    unit = 1.0 / np.sqrt(np.diag(H))
    A = H * unit * unit[:, None] + damping * np.eye(len(H))
    step, free = np.zeros(len(g)), np.ones(len(g), bool)
    while free.any():
        due = unit * g + A[:, ~free] @ (step / unit)[~free]
        step[free] = -unit[free] * np.linalg.solve(A[np.ix_(free, free)], due[free])
        inside = np.clip(step, *box)
        held = free & (step != inside)
        step, free = inside, free & ~held
        if not held.any():
            break
    return step


def stepped(problem: Problem, now: Fit, active: Sequence[int], step: Floats) -> Fit:
    """Return a fit with its unknowns moved by a step, within their bounds."""
    nuisance = np.array(now.nuisance)
    nuisance[list(active)] += step[: len(active)]
    nuisance = np.clip(nuisance, problem.prior.lower, problem.prior.upper)
    suspects = changed(problem.catalogue, now.suspects, step[len(active) :])
    return evaluate(problem, nuisance, suspects)


def _normal_equations(problem: Problem, now: Fit, active: Sequence[int]) -> tuple[Floats, Floats]:
    """Hessian and gradient of half the objective, robust weights included."""
    e, noise = problem.evidence, problem.evidence.noise
    V, lam, k = now.vectors, now.eigenvalues, now.match
    lk = lam[k]
    here = np.arange(len(k))
    shapes = problem.sensors @ V[: problem.basis.size]
    a, b = products(problem, now, active)
    gap = lk[None, :] - lam[:, None]
    close = np.abs(gap) < LIKELIHOOD.degenerate * np.abs(lk)[None, :]
    F = a - b * lk
    dlam = F[:, k, here]
    C = np.where(close, 0.0, F / np.where(close, 1.0, gap))
    C[:, k, here] = -0.5 * b[:, k, here]
    dshape = np.matmul(shapes, C)
    aim = targets(e)
    floor = np.maximum(lk, LIKELIHOOD.least_eigenvalue * aim)
    off = 0.5 * np.log(floor / aim) / noise.frequency
    doff = 0.5 * dlam / floor / noise.frequency
    a, lengths = shapes[:, k], np.linalg.norm(shapes, axis=0)
    length = np.maximum(lengths[k], np.finfo(float).tiny)
    seen = length > np.sqrt(LIKELIHOOD.unseen) * lengths.max()
    a = a / length
    t = e.shapes
    m = min(problem.columns, shapes.shape[1])
    near = shapes[:, :m]
    strained = np.where(lam[:m] > LIKELIHOOD.least_eigenvalue * aim.min(), lam[:m], 0.0)
    joint = joint_macs(strained, t.T @ near, near.T @ near, noise.mixing)[here, k]
    own = np.sum(t * a, axis=0) ** 2
    counts = np.sqrt((1.0 - joint) / np.maximum(1.0 - own, LIKELIHOOD.apart_least))
    scale = np.sqrt(noise.independent) / noise.shape * np.minimum(counts, 1.0)
    rest = (a - t * np.sum(t * a, axis=0)) * scale
    d = np.where(seen, dshape, 0.0) / length
    d = d - a * np.einsum("sj,psj->pj", a, d)[:, None]
    d = (d - t * np.einsum("sj,psj->pj", t, d)[:, None]) * scale
    w = np.sqrt(1.0 / (1.0 + (off**2 + np.sum(rest**2, axis=0)) / noise.robust))
    J = np.concatenate([doff * w, (d * w).reshape(len(d), -1)], axis=1)
    r = np.concatenate([off * w, (rest * w).ravel()])
    H, g = J @ J.T, J @ r
    return with_prior(problem, now, active, H, g)


def with_prior(
    problem: Problem, now: Fit, active: Sequence[int], H: Floats, g: Floats
) -> tuple[Floats, Floats]:
    """Return second derivative and gradient of −ln posterior from those of −ln likelihood."""
    kinds = [problem.catalogue[s.kind] for s in now.suspects]
    spread = spread_of(problem, now, active)
    mean = np.concatenate([np.zeros(len(active)), *(c.typical for c in kinds)])
    x = np.concatenate([now.nuisance[list(active)], magnitudes(now.suspects)])
    return H + np.diag(1.0 / spread**2), g + (x - mean) / spread**2


def spread_of(problem: Problem, now: Fit, active: Sequence[int]) -> Floats:
    """Return the standard deviation beforehand of each unknown."""
    kinds = [problem.catalogue[s.kind] for s in now.suspects]
    return np.concatenate([problem.prior.spread[list(active)], *(c.spread for c in kinds)])


def products(problem: Problem, now: Fit, active: Sequence[int]) -> tuple[Floats, Floats]:
    """Return Vᵀ ∂K V and Vᵀ ∂M V by each unknown, on the right only the modes that match."""
    V, k = now.vectors, now.match
    S, own, p = V[: problem.basis.size], problem.basis.size, np.exp(now.log_p)
    first = len(active)
    a = np.zeros((first + sum(len(s.theta) for s in now.suspects), V.shape[1], len(k)))
    b, i = np.zeros_like(a), first
    for out, matrices in ((a, problem.basis.stiffness), (b, problem.basis.mass)):
        moving = np.flatnonzero([q in matrices.moved_by for q in active])
        which = np.array(active, np.int64)[moving]
        moved = np.matmul(matrices.slopes(p, which.tolist()), S[:, k])
        out[moving] = p[which, None, None] * np.matmul(S.T, moved)
    if len(p) in active:
        b[active.index(len(p))] = -S.T @ (problem.mesh @ S[:, k])
    for s in now.suspects:
        rows, law = problem.part(s.kind, np.array([s.row]), now.nuisance)
        U, theta = rows[0], np.array([s.theta])
        u, slopes = U @ S, law.slope(theta, _FIRST)[0]
        if law.on == "A":
            x = V[own : own + len(U)] / np.sqrt(law.value(theta, _FIRST)[0])[:, None]
            own += len(U)
            stretch, soft = u - x, law.flexibility(theta, _FIRST)[0]
            for df, dm in zip(law.flexibility_slope(theta)[0], slopes, strict=True):
                a[i], b[i] = (stretch.T * (-df / soft**2)) @ stretch[:, k], (x.T * dm) @ x[:, k]
                i += 1
            continue
        for c in slopes:
            (a if law.on == "K" else b)[i] = (u.T * c) @ u[:, k]
            i += 1
        for j, q in enumerate(active):
            change = law.by_parameter(theta, _FIRST, q) if q < len(p) else None
            if change is not None:
                a[j] += (u.T * change[0]) @ u[:, k]
    return a, b
