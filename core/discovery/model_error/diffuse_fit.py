"""A hypothesis fitted by the diffuse error, and how likely the test is by it.

Parameters, smooth fields and magnitudes are moved by Gauss-Newton to where test and prior are
likeliest, with the error and the noise that are best there; the evidence is Laplace's: what the
best values gain less what it costs to have had a choice of values.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Floats
from ..effects.candidates import Suspect, changed, magnitudes
from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.likelihood_numbers import LIKELIHOOD
from ..likelihood.map_fit import evaluate, products, solve, surprise
from ..likelihood.mode_likelihood import targets
from ..likelihood.repeated_modes import some_repeated
from .diffuse_error import Diffuse, Seen, at
from .diffuse_slope import Slope, diffuse, moved, ranges, slope
from .model_error_numbers import MODEL_ERROR

_TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True)
class Drift:
    """A field: its name and its amplitude (of a smooth one the rms over the structure)."""

    name: str
    amplitude: float


@dataclass(frozen=True, eq=False)
class Judged:
    """A hypothesis fitted by the diffuse error.

    Parameters
    ----------
    fit : Fit
    diffuse : Diffuse
    evidence : float
        ln of the probability of the test by the hypothesis, unknowns integrated out.
    information : (n, n) float
        Second derivative of −ln posterior by parameters, fields, mesh and magnitudes.
    plain, bare : float
        The evidence without any smooth field; without what set-up and mesh do, too.
    drifts : tuple of Drift
        Fields that are likelier than none, the largest first.
    problem, state : Problem, Fit
        What was fitted: with the smooth fields, where there are any, as further parameters.
    whole : bool
        Whether smooth fields were tried.
    """

    fit: Fit
    diffuse: Diffuse
    evidence: float
    information: Floats
    plain: float
    bare: float
    problem: Problem
    state: Fit
    drifts: tuple[Drift, ...] = ()
    whole: bool = True

    def may_reach(self, evidence: float) -> bool:
        """Whether smooth fields, if they were not tried, may make it as likely as that."""
        return self.evidence + MODEL_ERROR.drift_gain >= evidence


def everything(problem: Problem) -> tuple[int, ...]:
    """Return the numbers of all entries of the nuisance parameters of a problem."""
    return tuple(range(len(problem.prior.spread)))


def seen(problem: Problem, state: Fit) -> Seen:
    """Return a fit beside the test."""
    p = problem
    modes = state.vectors[: p.basis.size]
    shapes = np.asarray(p.sensors @ modes)
    e = p.evidence
    aim = targets(e)
    band = (state.eigenvalues >= aim.min()) & (state.eigenvalues <= aim.max())
    lumped = 0.5 * np.sum(modes[:, band] * (p.mesh @ modes[:, band]), axis=0)
    scatter = np.hypot(np.broadcast_to(e.scatter, e.frequencies_hz.shape), MODEL_ERROR.frequency)
    columns = min(p.columns, len(state.eigenvalues))
    mesh = float(np.sqrt(np.mean(lumped**2))) if band.any() else 0.0
    hz, values = e.frequencies_hz, state.eigenvalues
    return Seen(hz, e.shapes, scatter, values, shapes, columns, e.reading, mesh)


def judged(
    problem: Problem, state: Fit, active: Sequence[int], near: Diffuse | None = None
) -> Judged:
    """Return a hypothesis fitted by the diffuse error; the problem's evidence is all that counts.

    The entries of ``state.nuisance``, of which the `active` move, are ln p of the parameters, then
    of the fields, then the mesh; the error is looked for from that of `near` on, if there is one. A
    step to where a mass is negative is too long. An error that gets small too soon leaves modes
    out of the model, which then pull no more: where a larger one has more of them in it, the climb
    goes on from there (graduated non-convexity: Blake and Zisserman 1987, chapter 3).
    """
    state = _at(problem, state, state.nuisance, state.suspects)
    here = seen(problem, state)
    best = at(here, near.error, near.noise) if near else diffuse(here)
    found = climbed(problem, state, active, best)
    wide = _with_more_modes(seen(problem, found.state), found.diffuse)
    if wide is None:
        return found
    again = climbed(problem, found.state, active, wide)
    return max(found, again, key=lambda j: j.evidence)


def _with_more_modes(here: Seen, found: Diffuse) -> Diffuse | None:
    """Return the likelihood at the least error at which fewer modes are none of the model's."""
    left = np.count_nonzero(found.astray)
    if not left:
        return None
    errors = np.geomspace(*ranges(here)[0], MODEL_ERROR.starts)
    wider = (at(here, error, found.noise) for error in errors.tolist() if error > found.error)
    return next((d for d in wider if np.count_nonzero(d.astray) < left), None)


def _at(problem: Problem, state: Fit, nuisance: Floats, suspects: Sequence[Suspect]) -> Fit:
    """Return a fit elsewhere, vectors of repeated modes as the test found them."""
    values, vectors = solve(problem, nuisance, suspects)
    if some_repeated(values):
        vectors = evaluate(problem, nuisance, suspects).vectors
    moved = replace(state, nuisance=nuisance, suspects=tuple(suspects))
    return replace(moved, eigenvalues=values, vectors=vectors)


def climbed(problem: Problem, state: Fit, active: Sequence[int], best: Diffuse) -> Judged:
    """Return a hypothesis moved from a state, at which `best` is the diffuse error."""
    now, height = state, best.log - 0.5 * surprise(problem, state.nuisance, state.suspects)
    here = seen(problem, now)
    H, g, by = normal_equations(problem, now, here, best, active)
    damping = 0.0
    for _ in range(MODEL_ERROR.steps):
        box = box_of(problem, now, active)
        scale, more = by.towards(here, best)
        for _ in range(MODEL_ERROR.dampings):
            step = np.clip(step_within(H, g, box, damping), -MODEL_ERROR.step, MODEL_ERROR.step)
            promised = more - float(g @ step)
            if promised < MODEL_ERROR.tolerance:
                break
            new = -np.inf
            with suppress(np.linalg.LinAlgError):
                trial = _stepped(problem, now, active, step)
                there = seen(problem, trial)
                d = at(there, *moved(there, best, scale))
                new = d.log - 0.5 * surprise(problem, trial.nuisance, trial.suspects)
            if new > height:
                break
            damping = max(LIKELIHOOD.damping_up * damping, LIKELIHOOD.damping_first)
        else:
            break
        if promised < MODEL_ERROR.tolerance:
            break
        now, here, best, height = trial, there, d, new
        damping *= LIKELIHOOD.damping_down
        H, g, by = normal_equations(problem, now, here, best, active)
    spread = spread_of(problem, now, active)
    occam = 0.5 * float(np.linalg.slogdet(spread[:, None] * H * spread)[1])
    evidence = height - occam
    return Judged(now, best, evidence, H, evidence, evidence, problem, now)


def _stepped(problem: Problem, now: Fit, active: Sequence[int], step: Floats) -> Fit:
    """Return a fit with its unknowns moved by a step."""
    nuisance = np.array(now.nuisance)
    nuisance[list(active)] += step[: len(active)]
    suspects = changed(problem.catalogue, now.suspects, step[len(active) :])
    return _at(problem, now, nuisance, suspects)


def box_of(problem: Problem, now: Fit, active: Sequence[int]) -> tuple[Floats, Floats]:
    """Return how far the unknowns may move down and up."""
    free = np.full(len(magnitudes(now.suspects)), np.inf)
    x, p, moving = now.nuisance, problem.prior, list(active)
    low, high = ((end - x)[moving] for end in (p.lower, p.upper))
    return np.concatenate([low, -free]), np.concatenate([high, free])


def step_within(H: Floats, g: Floats, box: tuple[Floats, Floats], damping: float = 0.0) -> Floats:
    """Return Levenberg's step within a box, the others knowing what its sides hold."""
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


def spread_of(problem: Problem, now: Fit, active: Sequence[int]) -> Floats:
    """Return the standard deviation beforehand of each unknown."""
    kinds = [problem.catalogue[s.kind] for s in now.suspects]
    return np.concatenate([problem.prior.spread[list(active)], *(c.spread for c in kinds)])


def normal_equations(
    problem: Problem, now: Fit, here: Seen, d: Diffuse, active: Sequence[int]
) -> tuple[Floats, Floats, Slope]:
    """Second derivative and gradient of −ln posterior; what it is by the diffuse error."""
    k, lam = d.match, here.values
    lk, count = lam[k], np.arange(len(k))
    by = slope(here, d)
    a, b = products(problem, replace(now, match=np.arange(len(lam))), active)
    g = np.tensordot(a, by.stiffness, 2) + np.tensordot(b, by.mass, 2)
    a, b = a[:, :, k], b[:, :, k]
    F = a - b * lk
    gap = lk[None, :] - lam[:, None]
    z = d.error**2 * lk[None, :] * lam[:, None]
    C = F * gap / (gap**2 + z)
    C[:, k, count] = -0.5 * b[:, k, count]
    t, own = here.shapes, here.modes[:, k]
    least = max(MODEL_ERROR.unseen * float(np.diag(here.gram).max()), _TINY)
    c = np.sum(t * own, axis=0) / np.maximum(np.sum(own**2, axis=0), least)
    C = (C * c).transpose(2, 0, 1)
    sure = 1.0 - d.stray
    variance = 0.5 * d.error**2 + here.scatter**2
    aim = targets(problem.evidence)
    floor = np.maximum(lk, LIKELIHOOD.least_eigenvalue * aim)
    dlam = 0.5 * F[:, k, count] / floor
    H = (dlam * (sure / variance)) @ dlam.T
    H = H + np.sum(np.matmul(C, np.matmul(by.shapes, C.transpose(0, 2, 1))), axis=0)
    kinds = [problem.catalogue[s.kind] for s in now.suspects]
    spread = spread_of(problem, now, active)
    mean = np.concatenate([np.zeros(len(active)), *(c.typical for c in kinds)])
    x = np.concatenate([now.nuisance[list(active)], magnitudes(now.suspects)])
    return H + np.diag(1.0 / spread**2), g + (x - mean) / spread**2, by
