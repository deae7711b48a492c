"""How noisy measured shapes are, judged by what no smooth shape explains."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats, Ints, hold
from ..errors import InputError
from .localisation_numbers import MAPS


@dataclass(frozen=True, eq=False)
class Noise:
    """Standard deviation of the readings of each test shape.

    Parameters
    ----------
    sigma : (n_test,) float
        Of one reading of each test shape, in the shape's own scale.
    relative : float
        Typical sigma over the rms reading of its shape: the lower quartile over the shapes, which
        what the model lacks spoils least.
    outlier : (n_sensor,) bool
        Sensors whose residuals do not belong to the noise of the others, left out of it.
    gain : (n_sensor,) float
        Reading over what the other sensors predict, least squares over the shapes: about 1; -1
        where a polarity is wrong; NaN where nothing is predicted.
    explained : (n_sensor, n_test) float
        What the other sensors predict each reading to be.
    """

    sigma: Floats
    relative: float
    outlier: Bools
    gain: Floats
    explained: Floats

    def __post_init__(self) -> None:
        hold(self, "sigma outlier gain explained")


def given_noise(test_shapes: Floats, relative: float) -> Noise:
    """Noise that is known: a share of the rms reading of each shape.

    Raises
    ------
    InputError
        The share is not positive.
    """
    if not relative > 0:
        raise InputError(f"the noise of the shapes is {relative}; give a share above 0, e.g. 0.02")
    rms = np.sqrt(np.mean(test_shapes**2, axis=0))
    n, m = test_shapes.shape
    nothing = np.full((n, m), np.nan)
    return Noise(relative * rms, relative, np.zeros(n, bool), np.full(n, np.nan), nothing)


def estimate_noise(
    analysis_hz: Floats,
    analysis_shapes: Floats,
    test_hz: Floats,
    test_shapes: Floats,
    rigid_body_modes: int = 0,
    share: float = MAPS.fitted,
) -> Noise:
    """Estimate the noise of test shapes by the part that no nearby analysis shapes explain.

    A model error changes a shape smoothly, mostly into the analysis shapes near in frequency and
    the rigid-body motions; noise scatters over all directions. So each test shape is fitted by
    those shapes, as many as a share of the sensors, and what is left per degree of freedom left
    is the noise: a ceiling, since a local effect may leave more. Sensors that no fit explains
    (wrong gain, swapped) are left out by their residual over all shapes, and the fit repeated.

    Parameters
    ----------
    analysis_hz : (n_analysis,) float
    analysis_shapes : (n_sensor, n_analysis) float
        At the sensors, rigid-body motions first where there are any.
    test_hz : (n_test,) float
    test_shapes : (n_sensor, n_test) float
        Real shapes, any scale.
    rigid_body_modes : int
        How many of the analysis modes are rigid-body motions.
    share : float
        Number of fitted shapes over number of sensors.

    Raises
    ------
    InputError
        Fewer than six sensors, which leave nothing to judge by.
    """
    n, m = test_shapes.shape
    if n < MAPS.few_sensors:
        raise InputError(f"the noise cannot be estimated from {n} sensors; state it")
    bases = [
        _basis(analysis_hz, analysis_shapes, hz, rigid_body_modes, max(2, int(share * n)))
        for hz in test_hz
    ]
    rms = np.sqrt(np.mean(test_shapes**2, axis=0))
    scaled = test_shapes / np.where(rms > 0, rms, 1.0)
    sound = np.ones(n, bool)
    for _ in range(MAPS.rounds):
        predicted, sigma = _fit(bases, scaled, sound)
        error = scaled - predicted
        size = np.sqrt(np.mean((error / np.maximum(sigma, MAPS.floor)) ** 2, axis=1))
        limit = MAPS.outlier * np.median(size[sound])
        kept = size <= max(limit, MAPS.outlier_least)
        if np.array_equal(kept, sound) or np.count_nonzero(kept) < MAPS.sound * n:
            break
        sound = kept
    power = np.sum(predicted**2, axis=1)
    gain = np.divide(
        np.sum(scaled * predicted, axis=1),
        power,
        out=np.full(n, np.nan),
        where=power > MAPS.predicted * m,
    )
    return Noise(
        sigma * rms, float(np.quantile(sigma, MAPS.typical)), ~sound, gain, predicted * rms
    )


def _basis(
    analysis_hz: Floats, shapes: Floats, hz: float, rigid_body_modes: int, count: int
) -> Floats:
    """Orthonormal basis (n_sensor, k) of the rigid-body motions and the nearest shapes."""
    elastic = np.arange(rigid_body_modes, len(analysis_hz))
    highest = float(np.max(analysis_hz, initial=0.0))
    least = max(MAPS.lowest * hz, MAPS.at_rest * highest, float(np.finfo(float).tiny))
    away = np.abs(np.log(np.maximum(analysis_hz[elastic], least) / max(hz, least)))
    nearest = elastic[np.argsort(away, kind="stable")]
    chosen: Ints = np.concatenate([np.arange(rigid_body_modes), nearest])
    picked = shapes[:, chosen[:count]]
    length = np.linalg.norm(picked, axis=0)
    U, s, _ = np.linalg.svd(picked[:, length > 0] / length[length > 0], full_matrices=False)
    return np.asarray(U[:, s > MAPS.dependent * s[0]]) if len(s) else U


def _fit(bases: list[Floats], scaled: Floats, sound: Bools) -> tuple[Floats, Floats]:
    """Predict readings by the other sound sensors (n, m); the noise of each shape (m,)."""
    n, m = scaled.shape
    predicted, sigma = np.empty((n, m)), np.empty(m)
    for j, B in enumerate(bases):
        inside = B[sound]
        inverse = np.linalg.pinv(inside)
        q = inverse @ scaled[sound, j]
        fitted = B @ q
        leverage = np.zeros(n)
        leverage[sound] = np.einsum("ij,ji->i", inside, inverse).clip(0.0, MAPS.leverage)
        residual = (scaled[:, j] - fitted) / (1.0 - leverage)
        predicted[:, j] = scaled[:, j] - residual
        free = max(np.count_nonzero(sound) - B.shape[1], 1)
        sigma[j] = np.sqrt(np.sum((scaled[sound, j] - fitted[sound]) ** 2) / free)
    return predicted, sigma
