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
from ...data.parametric_model import Factor
from ...reduction.reduced_sum import ReducedSum
from ..effects.candidates import magnitudes
from ..likelihood.hypothesis import Fit, Prior, Problem
from ..likelihood.likelihood_numbers import LIKELIHOOD
from ..likelihood.map_fit import products, stepped, surprise
from ..likelihood.mode_likelihood import targets
from .diffuse_error import Diffuse, Seen, diffuse, quadratic
from .model_error_numbers import MODEL_ERROR
from .smooth_fields import Fields

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


def with_known(problem: Problem, state: Fit, active: Sequence[int], known: Fields) -> Judged:
    """Return a hypothesis as it is likeliest: without fields of known spreads, or with.

    The `active` entries of its nuisance parameters move along, see `judged`.
    """
    plain = judged(problem, state, active)
    best = _beside(problem, plain, known, active)
    return _told(plain, best, known, best.evidence) if best.evidence > plain.evidence else plain


def with_drift(
    problem: Problem,
    state: Fit,
    known: Fields,
    smooth: Fields,
    least: float = -np.inf,
) -> Judged:
    """Return a hypothesis as it is likeliest: alone, with known fields, with smooth ones besides.

    Known ones stand where that is clearly likelier: what they could be imitates other unknowns.
    Smooth ones have one size, tried from large to small as long as that is likelier, down to what
    could make a part of the error that is left: small ones are less likely than none where large
    ones are far likelier. No fields where they could not make up for what the hypothesis lacks of
    the evidence `least`.
    """
    active = everything(problem)
    plain = judged(problem, state, active)
    if not plain.may_reach(least):
        return replace(plain, whole=False)
    first = _beside(problem, plain, known, active)
    likelier = first.evidence > plain.evidence + MODEL_ERROR.seen
    best, told = (first, known) if likelier else (plain, None)
    without, larger = best.evidence, -np.inf
    smallest = min(MODEL_ERROR.drift_part * plain.diffuse.error, max(MODEL_ERROR.drifts))
    for size in (s for s in MODEL_ERROR.drifts if s >= smallest):
        both = smooth.of(size).and_also(known) if likelier else smooth.of(size)
        tried = _beside(problem, plain, both, active)
        if tried.evidence < larger:
            break
        larger = tried.evidence
        if larger > best.evidence:
            best, told = tried, both
    return plain if told is None else _told(plain, best, told, without)


def _beside(problem: Problem, plain: Judged, fields: Fields, active: Sequence[int]) -> Judged:
    """Return a hypothesis moved with fields from where it is likeliest without them."""
    n, k = len(problem.prior.spread) - 1, len(fields.names)
    start = replace(plain.fit, nuisance=np.insert(plain.fit.nuisance, n, np.zeros(k)))
    moving = (*(a for a in active if a < n), *range(n, n + k), *(a + k for a in active if a >= n))
    return _climbed(with_fields(problem, fields), start, moving, plain.diffuse)


def _told(plain: Judged, best: Judged, fields: Fields, without: float) -> Judged:
    """Return a hypothesis with fields, its fit without them; `without` smooth ones it is as likely.

    Fields that moved furthest, for what they might have been beforehand, are told first.
    """
    k, n = len(fields.names), len(plain.fit.nuisance) - 1
    amplitudes = best.fit.nuisance[n : n + k]
    order = np.argsort(-np.abs(amplitudes / fields.spread), kind="stable")
    drifts = tuple(Drift(fields.names[i], float(amplitudes[i])) for i in order)
    fit = replace(best.fit, nuisance=np.delete(best.fit.nuisance, np.arange(n, n + k)))
    return replace(best, fit=fit, plain=without, bare=plain.evidence, drifts=drifts)


def with_fields(problem: Problem, fields: Fields) -> Problem:
    """Return a problem whose known parameters are followed by the amplitudes of fields."""
    n = len(problem.prior.spread) - 1
    most = np.maximum(MODEL_ERROR.most, -fields.least)
    added = (problem.prior.spread, fields.spread), (problem.prior.lower, fields.least)
    prior = Prior(*(np.insert(a, n, b) for a, b in (*added, (problem.prior.upper, most))))
    b = problem.basis
    stiffness, mass = (
        _moved(s, A, n) for s, A in ((b.stiffness, fields.stiffness), (b.mass, fields.mass))
    )
    return replace(problem, basis=replace(b, stiffness=stiffness, mass=mass), prior=prior)


def _moved(matrices: ReducedSum, changes: Floats, first: int) -> ReducedSum:
    """Return a sum with `changes` times p − 1 of parameters from `first` on."""
    for k, A in enumerate(changes):
        if A.any():
            matrices = matrices.plus(A, Factor(first + k, (0.0, 1.0), 0.0, 2.0))
    return matrices


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
    step to where a mass is negative is too long.
    """
    return _climbed(problem, state, active, diffuse(seen(problem, state), near))


def _climbed(problem: Problem, state: Fit, active: Sequence[int], best: Diffuse) -> Judged:
    """Return a hypothesis moved from a state, at which `best` is the diffuse error."""
    now, height = state, best.log - 0.5 * surprise(problem, state.nuisance, state.suspects)
    damping = 0.0
    H, g = _normal_equations(problem, now, best, active)
    for _ in range(MODEL_ERROR.steps):
        better = None
        for _ in range(MODEL_ERROR.dampings):
            with suppress(np.linalg.LinAlgError):
                step = _step(H, g, damping)
                if -float(g @ step) < MODEL_ERROR.tolerance:
                    break
                trial = stepped(problem, now, active, step)
                lost = 0.5 * surprise(problem, trial.nuisance, trial.suspects)
                d = diffuse(seen(problem, trial), best, height + lost - MODEL_ERROR.hopeless)
                new = d.log - lost
                if new > height:
                    better = trial, d, new
                    damping *= LIKELIHOOD.damping_down
                    break
            damping = max(LIKELIHOOD.damping_up * damping, LIKELIHOOD.damping_first)
        if better is None:
            break
        gained = better[2] - height
        now, best, height = better
        H, g = _normal_equations(problem, now, best, active)
        if gained < MODEL_ERROR.tolerance:
            break
    spread = _spread(problem, now, active)
    occam = 0.5 * float(np.linalg.slogdet(spread[:, None] * H * spread)[1])
    evidence = height - occam
    return Judged(now, best, evidence, H, evidence, evidence, problem, now)


def _step(H: Floats, g: Floats, damping: float) -> Floats:
    unit = 1.0 / np.sqrt(np.diag(H))
    scaled = H * unit * unit[:, None] + damping * np.eye(len(H))
    return np.asarray(np.clip(-unit * np.linalg.solve(scaled, unit * g), -0.5, 0.5))


def _spread(problem: Problem, now: Fit, active: Sequence[int]) -> Floats:
    kinds = [problem.catalogue[s.kind] for s in now.suspects]
    return np.concatenate([problem.prior.spread[list(active)], *(c.spread for c in kinds)])


def _normal_equations(
    problem: Problem, now: Fit, d: Diffuse, active: Sequence[int]
) -> tuple[Floats, Floats]:
    """Second derivative and gradient of −ln posterior, error and noise held."""
    here = seen(problem, now)
    k = d.match
    count = np.arange(len(k))
    lam, lk = np.maximum(now.eigenvalues, _TINY), now.eigenvalues[k]
    a, b = products(problem, replace(now, match=k), active)
    F = a - b * lk
    gap = lk[None, :] - lam[:, None]
    z = d.error**2 * lk[None, :] * lam[:, None]
    C = F * gap / np.maximum(gap**2 + z, _TINY)
    C[:, k, count] = -0.5 * b[:, k, count]
    t, own = here.shapes, here.modes[:, k]
    c = np.sum(t * own, axis=0) / np.maximum(np.sum(own**2, axis=0), _TINY)
    J = np.matmul(here.modes, C) * c
    rest = t - own * c
    sure = 1.0 - d.stray
    variance = 0.5 * d.error**2 + here.scatter**2
    aim = targets(problem.evidence)
    floor = np.maximum(lk, LIKELIHOOD.least_eigenvalue * aim)
    off = 0.5 * np.log(floor / aim)
    dlam = 0.5 * F[:, k, count] / floor
    H = (dlam * (sure / variance)) @ dlam.T
    g = dlam @ (off * sure / variance)
    X = np.concatenate([J, -rest[None]]).transpose(2, 1, 0)
    both = np.tensordot(sure, quadratic(here, d, X), 1)
    H, g = H + both[:-1, :-1], g + both[:-1, -1]
    kinds = [problem.catalogue[s.kind] for s in now.suspects]
    spread = _spread(problem, now, active)
    mean = np.concatenate([np.zeros(len(active)), *(c.typical for c in kinds)])
    x = np.concatenate([now.nuisance[list(active)], magnitudes(now.suspects)])
    return H + np.diag(1.0 / spread**2), g + (x - mean) / spread**2
