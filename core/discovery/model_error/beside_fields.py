"""A hypothesis beside fields: what the set-up and the mesh do, smooth drifts of stiffness and mass.

Fields are further parameters of known spreads. What they could gain is foretold by the second
derivative and the gradient where a hypothesis is likeliest without them, so that few are fitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import Floats, Ints
from ...data.parametric_model import Factor
from ...reduction.reduced_sum import ReducedSum
from ..likelihood.hypothesis import Fit, Prior, Problem
from ..likelihood.map_fit import spread_of, step_within
from .diffuse_fit import (
    Drift,
    Judged,
    box_of,
    climbed,
    everything,
    judged,
    normal_equations,
    seen,
)
from .model_error_numbers import MODEL_ERROR
from .smooth_fields import Fields


def with_known(problem: Problem, state: Fit, active: Sequence[int], known: Fields) -> Judged:
    """Return a hypothesis as it is likeliest: without fields of known spreads, or with.

    The `active` entries of its nuisance parameters move along, see `judged`.
    """
    plain = judged(problem, state, active)
    best = _beside(plain, known, active)
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
    Smooth ones have one size, of those that could make a part of the error that is left the one
    that promises most. No fields where they could not make up for what the hypothesis lacks of the
    evidence `least`, and none that promise nothing.
    """
    plain = judged(problem, state, everything(problem))
    if not plain.may_reach(least):
        return replace(plain, whole=False)
    best, told = plain, smooth.none()
    if _promised(plain, known)[0] > MODEL_ERROR.seen:
        first = _beside(plain, known, everything(plain.problem))
        if first.evidence > plain.evidence + MODEL_ERROR.seen:
            best, told = first, known
    without = best.evidence
    smallest = min(MODEL_ERROR.drift_part * plain.diffuse.error, max(MODEL_ERROR.drifts))
    sizes = [smooth.of(s) for s in MODEL_ERROR.drifts if s >= smallest]
    hopes = _promised(best, *sizes)
    if max(hopes) > MODEL_ERROR.promised:
        size = sizes[hopes.index(max(hopes))]
        tried = _beside(best, size, everything(best.problem))
        if tried.evidence > best.evidence:
            best, told = tried, told.and_also(size)
    return _told(plain, best, told, without) if told.names else plain


def _with(j: Judged, fields: Fields) -> tuple[Problem, Fit]:
    """Return a problem with fields more, and where a hypothesis is likeliest without them."""
    zeros = np.zeros(len(fields.names))
    nuisance = np.insert(j.state.nuisance, len(j.state.nuisance) - 1, zeros)
    return with_fields(j.problem, fields), replace(j.state, nuisance=nuisance)


def _beside(j: Judged, fields: Fields, active: Sequence[int]) -> Judged:
    """Return a hypothesis moved with fields from where it is likeliest without."""
    problem, start = _with(j, fields)
    n, k = len(j.state.nuisance) - 1, len(fields.names)
    moving = (*(a for a in active if a < n), *range(n, n + k), *(a + k for a in active if a >= n))
    return climbed(problem, start, moving, j.diffuse)


def _promised(j: Judged, *sizes: Fields) -> list[float]:
    """Return what the same fields of several spreads would gain if all were linear and bounded."""
    problem, start = _with(j, sizes[0])
    active = everything(problem)
    H, g, _ = normal_equations(problem, start, seen(problem, start), j.diffuse, active)
    n, k = len(j.state.nuisance) - 1, len(sizes[0].names)
    fields = np.arange(n, n + k)
    low, high = box_of(problem, start, active)
    spread = spread_of(problem, start, active)

    def gain(which: Ints) -> float:
        A = H[np.ix_(which, which)]
        step = step_within(A, g[which], (low[which], high[which]))
        occam = np.linalg.slogdet(spread[which, None] * A * spread[which])[1]
        return -float(g[which] @ step) - 0.5 * float(step @ A @ step) - 0.5 * float(occam)

    without = gain(np.delete(np.arange(len(g)), fields))
    out = []
    for size in sizes:
        H[fields, fields] += 1.0 / size.spread**2 - 1.0 / spread[fields] ** 2
        spread[fields] = size.spread
        out.append(gain(np.arange(len(g))) - without)
    return out


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
    more = Prior(fields.spread, fields.least, np.maximum(MODEL_ERROR.most, -fields.least))
    K, M = problem.basis.stiffness, problem.basis.mass
    return problem.with_more(more, _moved(K, fields.stiffness, n), _moved(M, fields.mass, n))


def _moved(matrices: ReducedSum, changes: Floats, first: int) -> ReducedSum:
    """Return a sum with `changes` times p − 1 of parameters from `first` on."""
    moving = np.flatnonzero(changes.any(axis=(1, 2)))
    factors = [Factor(first + k, (0.0, 1.0), 0.0, 2.0) for k in moving.tolist()]
    return matrices.plus([*changes[moving]], factors) if factors else matrices
