"""How likely a test is by a model that is wrong everywhere a little.

The relative change of the stiffness in modal coordinates that no parameter and no effect makes is
taken as random: K = Λ^½ (I + ε E) Λ^½, with E of the Gaussian orthogonal ensemble (Soize 2000,
Probabilistic Engineering Mechanics 15). To first order ln f has the variance ε²/2, and a mode i
holds of another j an amount of the variance (ε √(λᵢ λⱼ) / (λᵢ − λⱼ))², which saturates at 1: close
modes mix freely, distant ones do not. So a test shape is Gaussian at the sensors, and ε and the
noise of the readings are what makes the test likeliest.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np
from scipy.optimize import linear_sum_assignment

from ...arrays import Floats, Ints
from .model_error_numbers import MODEL_ERROR

_TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True, eq=False)
class Diffuse:
    """How likely a test is by a model and its diffuse error.

    Parameters
    ----------
    log : float
        ln of the likelihood.
    error : float
        ε, relative.
    noise : float
        Standard deviation of a reading over the rms of its shape.
    each : (n_test,) float
        What each test mode adds to `log`.
    match : (n_test,) int
        Its analysis mode.
    stray : (n_test,) float
        Chance that it is none of the model's.
    mesh : float
        See `Seen`.
    """

    log: float
    error: float
    noise: float
    each: Floats
    match: Ints
    stray: Floats
    mesh: float = 0.0

    @property
    def complete(self) -> bool:
        """Whether every mode is explained and no error is left that frequencies could tell."""
        return self.error <= MODEL_ERROR.frequency and not np.any(self.stray > 0.5)


@dataclass(frozen=True, eq=False)
class Seen:
    """A test beside a model: eigenvalues and shapes at the sensors.

    Parameters
    ----------
    hz : (n_test,) float
    shapes : (n_sensor, n_test) float
        Of unit length.
    scatter : (n_test,) float
        Standard deviation of ln f.
    eigenvalues : (n,) float
    modes : (n_sensor, n) float
        Mass-normalised.
    columns : int
        How many of the modes may match.
    reading : float
        Noise of a reading over the rms of its shape, at least.
    mesh : float
        What lumping does to ln f of the modes in the measured band, rms.
    """

    hz: Floats
    shapes: Floats
    scatter: Floats
    eigenvalues: Floats
    modes: Floats
    columns: int
    reading: float = 0.0
    mesh: float = 0.0

    @cached_property
    def gram(self) -> Floats:
        """Products of the modes at the sensors, (n, n)."""
        return np.asarray(self.modes.T @ self.modes)

    @cached_property
    def cross(self) -> Floats:
        """Products of the modes and the test's shapes, (n, n_test)."""
        return np.asarray(self.modes.T @ self.shapes)


def diffuse(seen: Seen, near: Diffuse | None = None, least: float = -np.inf) -> Diffuse:
    """Return the likelihood of a test at the diffuse error and the noise that make it largest.

    Looked for uphill over a grid of both, aslant too where the one makes up for the other, from a
    known one `near`, or from the best of a few from small to large in wide steps first; not beyond
    the first where that is below `least`.
    """
    errors, noises = _grid(*MODEL_ERROR.errors), _noises(seen.reading)
    tried: dict[tuple[int, int], Diffuse] = {}

    def best_of(places: Iterable[tuple[int, int]]) -> tuple[int, int]:
        for k, j in places:
            if (k, j) not in tried and 0 <= k < len(errors) and 0 <= j < len(noises):
                tried[k, j] = _at(seen, errors[k], noises[j])
        return max(tried, key=lambda place: tried[place].log)

    if near is None:
        wide = MODEL_ERROR.wide
        best = best_of(zip(range(0, len(errors), wide), range(0, len(noises), wide), strict=False))
    else:
        wide = 1
        best = best_of([(_nearest(errors, near.error), _nearest(noises, near.noise))])
    while tried[best].log >= least:
        k, j = best
        best = best_of([(k - wide, j), (k + wide, j), (k, j - wide), (k, j + wide)])
        if best != (k, j):
            continue
        if wide > 1:
            wide //= 2
            continue
        best = best_of([(k - 1, j + 1), (k + 1, j - 1)])
        if best == (k, j):
            break
    return replace(tried[best], error=float(errors[best[0]] * _top(tried, best, errors)))


def _nearest(grid: Floats, value: float) -> int:
    return int(np.argmin(np.abs(np.log(grid / value))))


def _top(tried: Mapping[tuple[int, int], Diffuse], best: tuple[int, int], errors: Floats) -> float:
    """Return times one error the largest likelihood is at: a parabola's top."""
    k, j = best
    if (k - 1, j) not in tried or (k + 1, j) not in tried:
        return 1.0
    a, b, c = (tried[i, j].log for i in (k - 1, k, k + 1))
    bend = 2.0 * b - a - c
    return float((errors[1] / errors[0]) ** (0.5 * (c - a) / bend)) if bend > 0.0 else 1.0


def likelihood_of(seen: Seen, known: Diffuse) -> Floats:
    """Return ln of the likelihood of each test mode at a known error and noise, (n_test,)."""
    return _at(seen, known.error, known.noise).each


@cache
def _grid(low: float, high: float, n: int) -> Floats:
    return np.geomspace(low, high, n)


@cache
def _noises(least: float) -> Floats:
    return np.asarray(np.unique(np.maximum(_grid(*MODEL_ERROR.noises), least)))


def _at(seen: Seen, error: float, noise: float) -> Diffuse:
    """Return the likelihood at one error and noise."""
    n = len(seen.shapes)
    frequencies, astray = _frequencies(seen, error), _stray(seen)
    most = 0.5 * _weight(seen) * n * np.log(n / noise**2)
    near = np.flatnonzero(np.any(frequencies + most > astray - MODEL_ERROR.nil, axis=0))
    logs = frequencies[:, near] + _shapes(seen, error, noise, near)
    L = np.full(frequencies.shape, astray)
    L[:, near] = np.logaddexp(np.log1p(-MODEL_ERROR.stray) + logs, astray)
    likelier = L + _tie(seen)
    match = likelier.argmax(axis=1)
    if len(set(match.tolist())) < len(match):
        match = linear_sum_assignment(-likelier)[1]
    each = L[np.arange(len(L)), match]
    chance, log = np.exp(astray - each), float(each.sum())
    return Diffuse(log, float(error), float(noise), each, match, chance, seen.mesh)


def _tie(seen: Seen) -> Floats:
    """Return what decides between repeated modes alone: how like each is, (n_test, columns)."""
    lengths = np.maximum(np.diag(seen.gram)[: seen.columns], _TINY)
    return np.asarray(MODEL_ERROR.tie * seen.cross[: seen.columns].T ** 2 / lengths)


def _stray(seen: Seen) -> float:
    """Return ln of the likelihood of a test mode that is none of the model's."""
    n = len(seen.shapes)
    anywhere = np.log(MODEL_ERROR.stray) - np.log(2.0 * MODEL_ERROR.reach)
    return float(anywhere + _weight(seen) * 0.5 * n * (np.log(n) - 1.0))


def _weight(seen: Seen) -> float:
    return min(1.0, MODEL_ERROR.independent / len(seen.shapes))


def _frequencies(seen: Seen, error: float) -> Floats:
    """Return ln of the likelihood of each frequency by each mode, (n_test, columns)."""
    values = np.maximum(seen.eigenvalues[: seen.columns], _TINY)
    off = np.log(2.0 * np.pi * seen.hz)[:, None] - 0.5 * np.log(values)
    variance = 0.5 * error**2 + seen.scatter[:, None] ** 2
    return np.asarray(-0.5 * (off**2 / variance + np.log(2.0 * np.pi * variance)))


def _roots(seen: Seen, error: float, columns: Ints) -> Floats:
    """Return the standard deviations of what shapes paired with modes hold of all modes.

    Of shapes of unit length: (columns, n). A mode that the sensors hardly see has that length of
    rounding, and holds others as the least that counts.
    """
    values = np.maximum(seen.eigenvalues, _TINY)
    own = values[columns, None]
    z = error**2 * own * values
    share = z / np.maximum((own - values) ** 2 + z, _TINY)
    share[np.arange(len(columns)), columns] = 1.0
    lengths = np.diag(seen.gram)
    least = max(MODEL_ERROR.unseen * lengths.max(), _TINY)
    return np.asarray(np.sqrt(share / np.maximum(lengths[columns], least)[:, None]))


def _shapes(seen: Seen, error: float, noise: float, columns: Ints) -> Floats:
    """Return ln of the likelihood of each shape by some modes, (n_test, len(columns)).

    But for (2π)^(-n/2). Shapes have the covariance c² A Δ Aᵀ + s² I; c² makes their length that of
    the mode.
    """
    n = len(seen.shapes)
    log_det, taken = _by_modes(seen, error, noise, columns, seen.cross)
    s2 = noise**2 / n
    left = (1.0 - np.einsum("ctn,ctn->ct", taken, taken)) / s2
    out = -0.5 * ((n * np.log(s2) + log_det)[:, None] + np.maximum(left, 0.0))
    return np.asarray(_weight(seen) * out.T)


def _by_modes(
    seen: Seen, error: float, noise: float, columns: Ints, Y: Floats
) -> tuple[Floats, Floats]:
    """Return what the modes make of the covariance c² A Δ Aᵀ + s² I of shapes paired with some.

    ln of its determinant over that of s² I, (m,), and of vectors X, of which Y = Aᵀ X (n, q) or
    (m, n, q), what the modes take of their square over s²: rows (m, q, n) whose products are that.
    Both by one Cholesky factor, of I + R Aᵀ A R with R = c Δ^½ / s, bordered by R Y.
    """
    root = _roots(seen, error, columns) * (np.sqrt(len(seen.shapes)) / noise)
    RY = root[:, None, :] * Y.swapaxes(-1, -2)
    (m, q, n), here = RY.shape, np.arange(sum(RY.shape[1:]))
    whole = np.zeros((m, n + q, n + q))
    np.multiply(root[:, :, None] * seen.gram, root[:, None, :], out=whole[:, :n, :n])
    whole[:, n:, :n] = RY
    whole[:, here, here] += 1.0
    whole[:, here[n:], here[n:]] += np.einsum("mqn,mqn->m", RY, RY)[:, None]
    L = np.linalg.cholesky(whole)
    return 2.0 * np.sum(np.log(L[:, here[:n], here[:n]]), axis=1), L[:, n:, :n]


def quadratic(seen: Seen, found: Diffuse, X: Floats) -> Floats:
    """Return Xᵀ C⁻¹ X of vectors (n_test, n_sensor, q), C the covariance of each test shape."""
    Y = np.matmul(seen.modes.T, X)
    _, taken = _by_modes(seen, found.error, found.noise, found.match, Y)
    by_s2 = _weight(seen) * len(seen.shapes) / found.noise**2
    own = np.matmul(X.transpose(0, 2, 1), X)
    return np.asarray(by_s2 * (own - np.matmul(taken, taken.transpose(0, 2, 1))))
