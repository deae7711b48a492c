"""How likely a test is by a model that is wrong everywhere a little.

The relative change of the stiffness in modal coordinates that no parameter and no effect makes is
taken as random: K = Λ^½ (I + ε E) Λ^½, with E of the Gaussian orthogonal ensemble (Soize 2000,
Probabilistic Engineering Mechanics 15). To first order ln f has the variance ε²/2, and a mode i
holds of another j an amount of the variance (ε √(λᵢ λⱼ) / (λᵢ − λⱼ))², which saturates at 1: close
modes mix freely, distant ones do not. So a test shape is Gaussian at the sensors, and ε and the
noise of the readings are what makes the test likeliest.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import linear_sum_assignment

from ...arrays import Bools, Floats, Ints
from ..reduction.reduction_numbers import REDUCTION
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
    """

    log: float
    error: float
    noise: float
    each: Floats
    match: Ints
    stray: Floats

    @property
    def astray(self) -> Bools:
        """Which test modes are more likely none of the model's than one that it has, (n_test,)."""
        return self.stray > 0.5

    @property
    def complete(self) -> bool:
        """Whether every mode is explained and no error is left that frequencies could tell."""
        return self.error <= MODEL_ERROR.frequency and not self.astray.any()


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
    """

    hz: Floats
    shapes: Floats
    scatter: Floats
    eigenvalues: Floats
    modes: Floats
    columns: int
    reading: float = 0.0

    @cached_property
    def values(self) -> Floats:
        """The eigenvalues, those of rigid bodies no less than what matters, (n,)."""
        least = REDUCTION.nil * np.abs(self.eigenvalues).max()
        return np.asarray(np.maximum(self.eigenvalues, least))

    @cached_property
    def gram(self) -> Floats:
        """Products of the modes at the sensors, (n, n)."""
        return np.asarray(self.modes.T @ self.modes)

    @cached_property
    def cross(self) -> Floats:
        """Products of the modes and the test's shapes, (n, n_test)."""
        return np.asarray(self.modes.T @ self.shapes)


def at(seen: Seen, error: float, noise: float) -> Diffuse:
    """Return the likelihood at one error and noise."""
    n = len(seen.shapes)
    frequencies, astray = _frequencies(seen, error), _stray(seen)
    most = 0.5 * weight(seen) * n * np.log(n / noise**2)
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
    return Diffuse(log, float(error), float(noise), each, match, chance)


def _tie(seen: Seen) -> Floats:
    """Return what decides between repeated modes alone: how like each is, (n_test, columns)."""
    lengths = np.maximum(np.diag(seen.gram)[: seen.columns], _TINY)
    return np.asarray(MODEL_ERROR.tie * seen.cross[: seen.columns].T ** 2 / lengths)


def _stray(seen: Seen) -> float:
    """Return ln of the likelihood of a test mode that is none of the model's."""
    n = len(seen.shapes)
    anywhere = np.log(MODEL_ERROR.stray) - np.log(2.0 * MODEL_ERROR.reach)
    return float(anywhere + weight(seen) * 0.5 * n * (np.log(n) - 1.0))


def weight(seen: Seen) -> float:
    """Return how much of what its readings say counts of a shape."""
    return min(1.0, MODEL_ERROR.independent / len(seen.shapes))


def _frequencies(seen: Seen, error: float) -> Floats:
    """Return ln of the likelihood of each frequency by each mode, (n_test, columns)."""
    off = np.log(2.0 * np.pi * seen.hz)[:, None] - 0.5 * np.log(seen.values[: seen.columns])
    variance = 0.5 * error**2 + seen.scatter[:, None] ** 2
    return np.asarray(-0.5 * (off**2 / variance + np.log(2.0 * np.pi * variance)))


def shares(seen: Seen, error: float, columns: Ints) -> tuple[Floats, Floats]:
    """Return c² (columns,) and Δ (columns, n) of the shapes paired with some modes.

    c² makes their length that of the modes they hold, tr(AΔAᵀ)² / tr(AΔAᵀ) on the average. What
    sensors hardly see of a mode is rounding, and counts as the least that matters.
    """
    x = seen.values / seen.values[columns, None]
    share = error**2 * x / ((1.0 - x) ** 2 + error**2 * x)
    lengths = np.diag(seen.gram)
    least = max(MODEL_ERROR.unseen * lengths.max(), _TINY)
    squares = np.sum(share * (share @ seen.gram**2), axis=1)
    length = squares / np.maximum(share @ lengths, _TINY)
    return 1.0 / np.maximum(length, least), share


def _shapes(seen: Seen, error: float, noise: float, columns: Ints) -> Floats:
    """Return ln of the likelihood of each shape by some modes, (n_test, len(columns)).

    But for (2π)^(-n/2). Shapes have the covariance c² A Δ Aᵀ + s² I.
    """
    n = len(seen.shapes)
    log_det, taken = _by_modes(seen, error, noise, columns, seen.cross)
    s2 = noise**2 / n
    left = (1.0 - np.einsum("ctn,ctn->ct", taken, taken)) / s2
    out = -0.5 * ((n * np.log(s2) + log_det)[:, None] + np.maximum(left, 0.0))
    return np.asarray(weight(seen) * out.T)


def _by_modes(
    seen: Seen, error: float, noise: float, columns: Ints, Y: Floats
) -> tuple[Floats, Floats]:
    """Return what the modes make of the covariance c² A Δ Aᵀ + s² I of shapes paired with some.

    ln of its determinant over that of s² I, (m,), and of vectors X, of which Y = Aᵀ X (n, q) or
    (m, n, q), what the modes take of their square over s²: rows (m, q, n) whose products are that.
    Both by one Cholesky factor, of I + R Aᵀ A R with R = c Δ^½ / s, bordered by R Y.
    """
    c2, share = shares(seen, error, columns)
    root = np.sqrt(c2[:, None] * share * len(seen.shapes)) / noise
    RY = root[:, None, :] * Y.swapaxes(-1, -2)
    (m, q, n), here = RY.shape, np.arange(sum(RY.shape[1:]))
    whole = np.zeros((m, n + q, n + q))
    np.multiply(root[:, :, None] * seen.gram, root[:, None, :], out=whole[:, :n, :n])
    whole[:, n:, :n] = RY
    whole[:, here, here] += 1.0
    whole[:, here[n:], here[n:]] += np.einsum("mqn,mqn->m", RY, RY)[:, None]
    L = np.linalg.cholesky(whole)
    return 2.0 * np.sum(np.log(L[:, here[:n], here[:n]]), axis=1), L[:, n:, :n]
