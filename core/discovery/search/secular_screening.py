"""Which trial sizes of a mass on a spring are worth an exact look, from its secular equation.

To a structure with eigenvalues λᵢ and modes φᵢ that it pulls at along u, a mass m on a spring of
flexibility c is the flexibility c − 1/(mλ). An eigenvalue λ of both and its shape, scaled by any
mode i that takes part, satisfy

    λ = λᵢ + uᵢ s,   φ = φᵢ − s Σ_{j≠i} uⱼ φⱼ / (λⱼ − λ),
    s = uᵢ / (c − 1/(mλ) + Σ_{j≠i} uⱼ² / (λⱼ − λ)).

At the eigenvalue of a test mode this gives, with no eigensolution, by how much frequency and
shape are missed.
"""

from __future__ import annotations

import numpy as np

from ...arrays import Floats, Ints
from ..effects.effect_laws import AttachedLaw
from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.mode_likelihood import Evidence, targets
from .search_numbers import SEARCH


def promising(problem: Problem, state: Fit, kind: int, rows: Ints, trials: Floats) -> Floats:
    """Return the misfit of every place and size to first order, (n, n_trial).

    See `scan` for the arguments. Kinds of one direction with a coordinate of their own only.
    """
    U, law = problem.part(kind, rows, state.nuisance)
    assert isinstance(law, AttachedLaw)
    modes = state.vectors[: problem.basis.size]
    U, seen = U @ modes, problem.sensors @ modes
    lam, aim = np.maximum(state.eigenvalues, 0.0), targets(problem.evidence)
    inertia = 1.0 / (law.value(trials, rows)[:, :1] * aim)
    own = law.own(trials)[0][:, :1] - inertia
    out = []
    for start in range(0, len(rows), SEARCH.at_once):
        part = np.arange(len(rows))[start : start + SEARCH.at_once]
        flexibility = law.missing[part][:, :1, None] + own
        out.append(_misfit(problem.evidence, seen, lam, U[part, 0], flexibility))
    return np.concatenate(out)


def _misfit(e: Evidence, sensors: Floats, lam: Floats, u: Floats, flexibility: Floats) -> Floats:
    """Misfit for flexibilities (n, n_trial, n_test) at places with mode motion u (n, r)."""
    aim, t = targets(e), e.shapes
    tests, tiny = np.arange(len(aim)), SEARCH.resonance * aim[:, None]
    gap = lam - aim[:, None]
    gap = np.where(np.abs(gap) < tiny, tiny, gap)
    best = np.full(flexibility.shape, np.inf)
    for i in np.argsort(np.abs(gap), axis=1)[:, : SEARCH.nearest].T:
        away = 1.0 / gap
        away[tests, i] = 0.0
        ui, phi = u[:, i], sensors[:, i]
        others = (u**2) @ away.T
        s = ui[:, None] / (flexibility + others[:, None])
        off = 0.5 * np.log(np.maximum((lam[i] + ui[:, None] * s) / aim, SEARCH.secular_least))
        rest = np.einsum("nr,tr,kr->nkt", u, away, sensors, optimize=True)
        across = np.sum(t * phi, axis=0) - s * np.einsum("kt,nkt->nt", t, rest)[:, None]
        square = (
            np.sum(phi**2, axis=0)
            - 2.0 * s * np.einsum("kt,nkt->nt", phi, rest)[:, None]
            + s**2 * np.sum(rest**2, axis=1)[:, None]
        )
        mac = across**2 / np.maximum(square, np.finfo(float).tiny)
        noise = e.noise
        d = (off / noise.frequency) ** 2 + noise.independent * (1.0 - mac) / noise.shape**2
        best = np.minimum(best, d)
    return np.asarray(np.sum(e.noise.robust * np.log1p(best / e.noise.robust), axis=-1))
