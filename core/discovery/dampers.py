"""Is there a dashpot, and where: damping ratios and complex shapes against every place.

A dashpot leaves undamped frequencies and shapes nearly alone, so it is weighed on evidence of its
own, given the model that the search completed. Every place and direction is tried over a range of
sizes to first order, the best of them by the exact quadratic eigenproblem; places, sizes and what
the structure has of damping by itself are integrated out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from ..arrays import Bools, Floats, Ints
from .damping import Oriented, added, imaginary, predicted
from .ratios import Levels, expected_level, levels_for, log_likelihood, marginal

Gain = Callable[[Ints, Floats], Floats]
"""How much likelier (ln) dashpots at some places (n,), of sizes (n, t), make the shapes, (n, t)."""

_FEWEST = 5
_RARE = 3.0
"""ln of how many times rarer a dashpot is beforehand than none."""
_SHAPE_ERROR = 0.08
"""Error of a shape anywhere, over its rms."""
_STILL = 1e-3
"""A place where no mode gets this part of the most damping that a place can give is still."""
_SCREENED, _EXACT = 240, 24
_WORTH = 0.01
_CHUNK = 48
_SPREAD = 0.45
_COMPLEXITY, _OWN_SHARE, _FREEDOM = 0.03, 0.2, 3.0
"""Imaginary part of a shape without a dashpot over its rms, the part of a predicted one that is
wrong, and how firmly both are known (degrees of freedom)."""


@dataclass(frozen=True, eq=False)
class DampingEvidence:
    """What a test says of damping.

    Parameters
    ----------
    measured : (n_test,) float
        Damping ratios, NaN or 0 where unknown.
    imaginary : (n_sensor, n_test) float or None
        Imaginary parts of the shapes beside real parts of unit modal mass; None for real shapes.
    independent : float
        Number of sensors that count as independent.
    """

    measured: Floats
    imaginary: Floats | None
    independent: float

    @property
    def known(self) -> Bools:
        """Modes whose ratio is known."""
        return np.isfinite(self.measured) & (self.measured > 0.0) & (self.measured < 1.0)


@dataclass(frozen=True, eq=False)
class DamperFound:
    """What the damping says.

    Parameters
    ----------
    exists : float
        Posterior of a dashpot anywhere.
    evidence : float
        Twice the ln of how much more likely the data are with one than without, its rarity
        beforehand counted.
    rows : (n,) int
        Places that explain the data, most likely first.
    weights : (n,) float
        Posterior of each, given that there is one.
    log_size, log_deviation : (n,) float
        Mean and standard deviation of ln c at each.
    level_without, level_with : (n_test,) float
        What the structure has of damping by itself, without a dashpot and with the best one.
    """

    exists: float
    evidence: float
    rows: Ints
    weights: Floats
    log_size: Floats
    log_deviation: Floats
    level_without: Floats
    level_with: Floats


def find_damper(
    e: DampingEvidence, modes: Oriented, u: Floats, sensors: Floats, known: Floats, trials: Floats
) -> DamperFound | None:
    """Weigh a dashpot at every place against none.

    Parameters
    ----------
    e : DampingEvidence
    modes : Oriented
    u : (n_place, n) float
        Motion of every place in the coordinates of `modes`, along the direction tried there.
    sensors : (n_sensor, n) float
        Likewise of the sensors.
    known : (n, n) float
        Dashpots that the deck has, on unit modal masses.
    trials : (n_trial,) float
        ln of the ratio that the mode which feels a dashpot most gets from it.

    Returns
    -------
    DamperFound or None
        None where fewer than five ratios are known.
    """
    chosen = np.flatnonzero(e.known)
    if len(chosen) < _FEWEST or not len(u):
        return None
    z, omega = e.measured[chosen], modes.omega[chosen]
    own = np.diag(known)[chosen] / (2.0 * omega)
    grid = levels_for(np.maximum(z - own, 0.2 * z), omega)
    nothing = np.zeros(len(z))
    null = float(marginal(z, grid, own, nothing))
    g = added(u[:, chosen], omega)
    peak = g.max(axis=1)
    live = np.flatnonzero(peak > _STILL * peak.max())
    if not len(live):
        return None
    delta = _SHAPE_ERROR * np.sqrt(np.mean(u[:, chosen] ** 2, axis=0))
    wrong = (2.0 * np.abs(u[:, chosen]) * delta + delta**2) / (2.0 * omega)
    sizes = np.exp(trials) / np.maximum(peak, np.finfo(float).tiny)[:, None]
    shape = _of_shapes(e, modes, u, sensors)

    def tried(rows: Ints, grid: Levels) -> Floats:
        out = np.empty((len(rows), len(trials)))
        for start in range(0, len(rows), _CHUNK):
            some = rows[start : start + _CHUNK]
            c = sizes[some][:, :, None]
            out[start : start + _CHUNK] = marginal(
                z, grid, own + c * g[some][:, None, :], c * wrong[some][:, None, :]
            )
        return out - null + shape(rows, sizes[rows])

    best = np.argsort(-tried(live, _coarse(z, grid, own)).max(axis=1), kind="stable")
    rows = live[best[:_SCREENED]]
    score = tried(rows, grid)
    place = logsumexp(score, axis=1)
    for i in np.argsort(-place, kind="stable")[:_EXACT]:
        r = rows[i]
        for k in np.flatnonzero(score[i] > score[i].max() + np.log(_WORTH)):
            c = sizes[r, k]
            first = own + c * g[r]
            level = expected_level(z, grid, first, c * wrong[r])
            exact = _exact(modes, known, u[r], c, level, chosen)
            either = [float(marginal(z, grid, a, c * wrong[r])) for a in (first, exact)]
            score[i, k] += np.logaddexp(*either) - np.log(2.0) - either[0]
    place = logsumexp(score, axis=1) - np.log(len(trials))
    order = np.argsort(-place, kind="stable")
    rows, score, place = rows[order], score[order], place[order]
    odds = float(logsumexp(place)) - np.log(len(live)) - _RARE
    within = np.exp(score - logsumexp(score, axis=1)[:, None])
    log_c = np.log(sizes[rows])
    mean = np.sum(within * log_c, axis=1)
    step = float(np.ptp(trials)) / max(len(trials) - 1, 1)
    deviation = np.sqrt(np.sum(within * (log_c - mean[:, None]) ** 2, axis=1) + step**2 / 12.0)
    c = float(np.exp(mean[0]))
    full = expected_level(z, grid, own + c * g[rows[0]], c * wrong[rows[0]])
    return DamperFound(
        1.0 / (1.0 + np.exp(-np.clip(odds, -60.0, 60.0))),
        2.0 * odds,
        rows,
        np.exp(place - logsumexp(place)),
        mean,
        deviation,
        _everywhere(expected_level(z, grid, own, nothing), modes, chosen),
        _everywhere(full, modes, chosen),
    )


def _coarse(z: Floats, grid: Levels, own: Floats) -> Levels:
    """Few levels for a first look: of middling spread, the course that suits no dashpot best."""
    away = np.abs(grid.spreads - _SPREAD)
    some = grid.take(np.flatnonzero(away == away.min()))
    alone = log_likelihood(z, some, own, np.zeros(len(z))).sum(axis=-1)
    best = some.course[int(np.argmax(alone + some.log_prior))]
    return some.take(np.flatnonzero(some.course == best)[::2])


def _everywhere(level: Floats, modes: Oriented, chosen: Ints) -> Floats:
    """Levels of all measured modes from those whose ratio is known."""
    ln = np.interp(
        np.log(modes.omega[: modes.count]),
        np.sort(np.log(modes.omega[chosen])),
        np.log(level)[np.argsort(modes.omega[chosen], kind="stable")],
    )
    return np.asarray(np.exp(ln))


def _exact(
    modes: Oriented, known: Floats, u: Floats, c: float, level: Floats, chosen: Ints
) -> Floats:
    """Return what all dashpots add to the ratios of the measured modes, exactly."""
    base = np.full(len(modes.omega), float(np.exp(np.mean(np.log(level)))))
    base[chosen] = level
    all_of_them = predicted(modes.omega, known + c * np.outer(u, u), base)[chosen]
    return np.where(np.isfinite(all_of_them), np.maximum(all_of_them - level, 0.0), 1.0)


def _of_shapes(e: DampingEvidence, modes: Oriented, u: Floats, sensors: Floats) -> Gain:
    """Return the function that says how much likelier imaginary parts become by dashpots.

    Of each mode the variance of what is left is unknown (inverse gamma prior), so one mode that
    is complex for other reasons does not decide.
    """
    Y = e.imaginary

    def none(rows: Ints, sizes: Floats) -> Floats:
        return np.zeros(sizes.shape)

    if Y is None or not np.abs(Y).max() > 1e-3 * np.abs(sensors).max():
        return none
    n, count = len(Y), modes.count
    rms = np.mean(sensors[:, :count] ** 2, axis=0)
    total = np.mean(Y**2, axis=0)
    ground = _FREEDOM * _COMPLEXITY**2 * rms
    each = min(float(n), e.independent)
    cross = Y.T @ sensors

    def gain(rows: Ints, sizes: Floats) -> Floats:
        turned, gram = imaginary(u[rows], modes, sensors)
        a = np.einsum("pjk,jk->pj", turned, cross)[:, None, :] / n
        b = np.einsum("pjk,pjk->pj", turned @ gram, turned)[:, None, :] / n
        c = sizes[:, :, None]
        left = np.maximum(total - 2.0 * c * a + c**2 * b, 0.0)
        floor = ground + _FREEDOM * (_OWN_SHARE * c) ** 2 * b
        ratio = (floor + each * left) / (ground + each * total)
        ln = -0.5 * (_FREEDOM + each) * np.log(ratio) + 0.5 * _FREEDOM * np.log(floor / ground)
        return np.asarray(ln.sum(axis=-1))

    return gain
