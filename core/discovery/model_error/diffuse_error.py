"""How likely a test is by a model that is wrong everywhere a little.

The relative change of the stiffness in modal coordinates that no parameter and no effect makes is
taken as random: K = Λ^½ (I + ε E) Λ^½, with E of the Gaussian orthogonal ensemble (Soize 2000,
Probabilistic Engineering Mechanics 15). To first order ln f has the variance ε²/2, and a mode i
holds of another j an amount of the variance (ε √(λᵢ λⱼ) / (λᵢ − λⱼ))², which saturates at 1: close
modes mix freely, distant ones do not. So a test shape is Gaussian at the sensors, and ε and the
noise of the readings are what makes the test likeliest.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from ...arrays import Floats, Ints
from .model_error_numbers import MODEL_ERROR


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


def diffuse(seen: Seen, near: Diffuse | None = None, least: float = -np.inf) -> Diffuse:
    """Return the likelihood of a test at the diffuse error and the noise that make it largest.

    Those `near` a known one are tried where there is one, else all; none beside the first where
    that is below `least`.
    """
    low, high, n = MODEL_ERROR.errors
    step = float(np.log(high / low)) / (n - 1)
    tried = {k: _at(seen, low * np.exp(k * step)) for k in _first(near, low, step, n)}
    while True:
        best = max(tried, key=lambda k: tried[k].log)
        beside = [k for k in (best - 1, best + 1) if 0 <= k < n and k not in tried]
        if not beside or tried[best].log < least:
            top = float(np.exp((best + _top(tried, best)) * step))
            return replace(tried[best], error=low * top)
        tried |= {k: _at(seen, low * np.exp(k * step)) for k in beside}


def _top(tried: Mapping[int, Diffuse], k: int) -> float:
    """Return how far from one error the largest likelihood is, in steps: a parabola's top."""
    if k - 1 not in tried or k + 1 not in tried:
        return 0.0
    a, b, c = (tried[i].log for i in (k - 1, k, k + 1))
    bend = 2.0 * b - a - c
    return 0.5 * (c - a) / bend if bend > 0.0 else 0.0


def _first(near: Diffuse | None, low: float, step: float, n: int) -> Sequence[int]:
    if near is None:
        return range(0, n, 2)
    return (round(float(np.log(near.error / low) / step)),)


def likelihood_of(seen: Seen, known: Diffuse) -> Floats:
    """Return ln of the likelihood of each test mode at a known error and noise, (n_test,)."""
    return _at(seen, known.error, np.array([known.noise])).each


def _noises(seen: Seen) -> Floats:
    low, high, n = MODEL_ERROR.noises
    return np.asarray(np.unique(np.maximum(np.geomspace(low, high, n), seen.reading)))


def _at(seen: Seen, error: float, noises: Floats | None = None) -> Diffuse:
    """Return the best over the noise at one error."""
    noises = _noises(seen) if noises is None else noises
    frequencies, astray = _frequencies(seen, error), _stray(seen)
    most = 0.5 * _weight(seen) * len(seen.shapes) * np.log(len(seen.shapes) / noises.min() ** 2)
    near = np.flatnonzero(np.any(frequencies + most > astray - MODEL_ERROR.nil, axis=0))
    logs = frequencies[:, near] + _shapes(seen, error, noises, near)
    both = np.full((len(noises), *frequencies.shape), astray)
    both[:, :, near] = np.logaddexp(np.log1p(-MODEL_ERROR.stray) + logs, astray)
    best = None
    for noise, L in zip(noises, both, strict=True):
        rows, match = linear_sum_assignment(-L)
        each = L[rows, match]
        if best is None or each.sum() > best.log:
            chance = np.exp(astray - each)
            log = float(each.sum())
            best = Diffuse(log, float(error), float(noise), each, match, chance, seen.mesh)
    assert best is not None
    return best


def _stray(seen: Seen) -> float:
    """Return ln of the likelihood of a test mode that is none of the model's."""
    n = len(seen.shapes)
    anywhere = np.log(MODEL_ERROR.stray) - np.log(2.0 * MODEL_ERROR.reach)
    return float(anywhere + _weight(seen) * 0.5 * n * (np.log(n) - 1.0))


def _weight(seen: Seen) -> float:
    return min(1.0, MODEL_ERROR.independent / len(seen.shapes))


def _frequencies(seen: Seen, error: float) -> Floats:
    """Return ln of the likelihood of each frequency by each mode, (n_test, columns)."""
    values = np.maximum(seen.eigenvalues[: seen.columns], np.finfo(float).tiny)
    off = np.log(2.0 * np.pi * seen.hz)[:, None] - 0.5 * np.log(values)
    variance = 0.5 * error**2 + seen.scatter[:, None] ** 2
    return np.asarray(-0.5 * (off**2 / variance + np.log(2.0 * np.pi * variance)))


def _roots(seen: Seen, error: float, columns: Ints) -> Floats:
    """Return the standard deviations of what shapes paired with modes hold of all modes.

    Of shapes of unit length: (columns, n).
    """
    values = np.maximum(seen.eigenvalues, np.finfo(float).tiny)
    own = values[columns, None]
    z = error**2 * own * values
    share = z / np.maximum((own - values) ** 2 + z, np.finfo(float).tiny)
    share[np.arange(len(columns)), columns] = 1.0
    length = np.sum(seen.modes[:, columns] ** 2, axis=0)
    return np.asarray(np.sqrt(share / np.maximum(length, np.finfo(float).tiny)[:, None]))


def _shapes(seen: Seen, error: float, noises: Floats, columns: Ints) -> Floats:
    """Return ln of the likelihood of each shape by some modes, (n_noise, n_test, len(columns)).

    But for (2π)^(-n/2). Shapes have the covariance c² A Δ Aᵀ + s² I; c² makes their length that of
    the mode.
    """
    n = len(seen.shapes)
    A, T = seen.modes, seen.shapes
    G, X = A.T @ A, A.T @ T
    root = _roots(seen, error, columns)
    mu, U = np.linalg.eigh(root[:, :, None] * G * root[:, None, :])
    mu = np.maximum(mu, 0.0)
    Y2 = np.matmul(U.transpose(0, 2, 1), root[:, :, None] * X) ** 2
    s2 = noises[:, None] ** 2 / n
    log_det = n * np.log(s2[:, 0]) + np.sum(np.log1p(mu[:, None] / s2), axis=2)
    left = (1.0 - np.matmul(1.0 / (s2 + mu[:, None]), Y2)) / s2
    out = -0.5 * (log_det[:, :, None] + np.maximum(left, 0.0)).transpose(1, 2, 0)
    return np.asarray(_weight(seen) * out)


def covariances(seen: Seen, found: Diffuse) -> Callable[[int, Floats], Floats]:
    """Return what makes vectors (n_sensor, q) white that scatter as the shape of one test mode."""
    root = _roots(seen, found.error, found.match)[:, :, None]
    s = found.noise / np.sqrt(len(seen.shapes))
    mu, U = np.linalg.eigh(root * (seen.modes.T @ seen.modes) * root.transpose(0, 2, 1))
    wide = np.hypot(s, np.sqrt(np.maximum(mu, 0.0)))
    less = -1.0 / (wide * (wide + s))
    along = np.matmul(seen.modes, root * U)

    def white(j: int, X: Floats) -> Floats:
        L = along[j]
        return np.asarray((X + L @ (less[j][:, None] * (L.T @ X))) * (np.sqrt(_weight(seen)) / s))

    return white
