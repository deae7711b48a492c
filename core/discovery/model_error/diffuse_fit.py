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
from ..effects.candidates import magnitudes
from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.likelihood_numbers import LIKELIHOOD
from ..likelihood.map_fit import (
    evaluate,
    products,
    spread_of,
    step_within,
    stepped,
    surprise,
    with_prior,
)
from ..likelihood.mode_likelihood import targets
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

    @property
    def lumped(self) -> float:
        """What lumping does to ln f of the modes in the measured band, rms."""
        p, values, aim = self.problem, self.state.eigenvalues, targets(self.problem.evidence)
        band = (values >= aim.min()) & (values <= aim.max())
        modes = self.state.vectors[: p.basis.size, band]
        each = 0.5 * np.sum(modes * (p.mesh @ modes), axis=0)
        return float(np.sqrt(np.mean(each**2))) if band.any() else 0.0


def everything(problem: Problem) -> tuple[int, ...]:
    """Return the numbers of all entries of the nuisance parameters of a problem."""
    return tuple(range(len(problem.prior.spread)))


def seen(problem: Problem, state: Fit) -> Seen:
    """Return a fit beside the test."""
    e = problem.evidence
    shapes = np.asarray(problem.sensors @ state.vectors[: problem.basis.size])
    scatter = np.hypot(np.broadcast_to(e.scatter, e.frequencies_hz.shape), MODEL_ERROR.frequency)
    values, columns = state.eigenvalues, min(problem.columns, len(state.eigenvalues))
    return Seen(e.frequencies_hz, e.shapes, scatter, values, shapes, columns, e.reading)


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
    state = evaluate(problem, state.nuisance, state.suspects)
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
                trial = stepped(problem, now, active, step)
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


def box_of(problem: Problem, now: Fit, active: Sequence[int]) -> tuple[Floats, Floats]:
    """Return how far the unknowns may move down and up."""
    free = np.full(len(magnitudes(now.suspects)), np.inf)
    x, p, moving = now.nuisance, problem.prior, list(active)
    low, high = ((end - x)[moving] for end in (p.lower, p.upper))
    return np.concatenate([low, -free]), np.concatenate([high, free])


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
    return *with_prior(problem, now, active, H, g), by
