"""What may be wrong in the test: each sensor against what all the others say.

A measured shape is, whatever the model lacks, nearly a combination of analysis shapes of
neighbouring frequency. Each sensor is predicted from all the others as the mean of a Gaussian
process whose covariance is spanned by those shapes (Rasmussen and Williams 2006, equations 5.10
to 5.12, leave-one-out). A sensor that reads the opposite, a multiple, or another sensor's values
stands out against its prediction in every mode, no matter which effect the model misses.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats

_WIDTH = 0.3
_SUSPICIOUS = 6.0
_LEFT = 0.45
_SMALLEST_GAIN = 0.15


@dataclass(frozen=True, eq=False)
class Prediction:
    """What the others say of each sensor, (n_sensor, n_mode), and how surely."""

    mean: Floats
    deviation: Floats


@dataclass(frozen=True)
class Fault:
    """A sensor that does not read what it should.

    `kind` is ``sensor_polarity``, ``sensor_gain``, ``sensor_swap`` or ``doubled``; `sensors` are
    rows; `factor` what the sensor reads over what it should; `deviation` its standard deviation;
    `gain_in_fit` how many times the misfit of the sensors falls.
    """

    kind: str
    sensors: tuple[int, ...]
    factor: float
    deviation: float
    gain_in_fit: float


def predict(
    shapes: Floats, test_hz: Floats, analysis: Floats, analysis_hz: Floats, noise: Floats
) -> Prediction:
    """Predict every reading from the other sensors.

    Parameters
    ----------
    shapes : (n_sensor, n_mode) float
        Of unit rms.
    test_hz : (n_mode,) float
    analysis : (n_sensor, n_analysis) float
        Analysis shapes at the sensors, of unit rms.
    analysis_hz : (n_analysis,) float
    noise : (n_sensor,) float
        Standard deviation of each sensor; infinite leaves it out of the others' predictions.
    """
    mean, deviation = np.zeros_like(shapes), np.zeros_like(shapes)
    finite = np.where(np.isfinite(noise), noise, 1e3)
    for j, f in enumerate(test_hz):
        near = np.maximum(analysis_hz, 0.2 * f)
        h = 1.0 / (1.0 + (np.log(near / f) / _WIDTH) ** 2) ** 2
        C = (analysis * (h / h.sum())) @ analysis.T
        inverse = np.linalg.inv(C + np.diag(finite**2))
        diagonal = np.diag(inverse)
        mean[:, j] = shapes[:, j] - (inverse @ shapes[:, j]) / diagonal
        deviation[:, j] = 1.0 / np.sqrt(diagonal)
    masked = ~np.isfinite(noise)
    if masked.any():
        rest = float(np.median(deviation[~masked])) if (~masked).any() else 1.0
        deviation[masked] = rest
    return Prediction(mean, deviation)


def find_faults(
    shapes: Floats, test_hz: Floats, analysis: Floats, analysis_hz: Floats
) -> tuple[tuple[Fault, ...], float]:
    """Find sensors that contradict all the others.

    Parameters
    ----------
    shapes : (n_sensor, n_mode) float
    test_hz : (n_mode,) float
    analysis : (n_sensor, n_analysis) float
    analysis_hz : (n_analysis,) float

    Returns
    -------
    faults : tuple of Fault
    noise : float
        Standard deviation of a sound sensor relative to the rms of its shape.
    """
    n = len(shapes)
    if n < 8 or shapes.shape[1] < 3:
        return (), 0.03
    y = shapes / np.maximum(np.sqrt(np.mean(shapes**2, axis=0)), np.finfo(float).tiny)
    length = np.sqrt(np.mean(analysis**2, axis=0))
    keep = length > 1e-9 * length.max()
    a, hz = analysis[:, keep] / length[keep], analysis_hz[keep]
    noise = np.full(n, 0.03)
    masked = np.zeros(n, bool)
    for _ in range(max(2, n // 4)):
        said = predict(y, test_hz, a, hz, np.where(masked, np.inf, noise))
        z2 = np.mean(((y - said.mean) / said.deviation) ** 2, axis=1)
        z2 = z2 / max(1.0, float(np.median(z2[~masked])))
        z2[masked] = 0.0
        worst = int(np.argmax(z2))
        if z2[worst] < _SUSPICIOUS:
            break
        masked[worst] = True
    said = predict(y, test_hz, a, hz, np.where(masked, np.inf, noise))
    rest = ((y - said.mean) / said.deviation)[~masked]
    level = 0.03 * float(np.clip(1.4826 * np.median(np.abs(rest)), 0.2, 5.0))
    return _explained(y, said, masked), level


def _explained(y: Floats, said: Prediction, masked: Bools) -> tuple[Fault, ...]:
    rows = [int(i) for i in np.flatnonzero(masked)]
    swaps: list[Fault] = []
    used: set[int] = set()
    for i in rows:
        for j in rows:
            if i < j and not {i, j} & used:
                own = _chi(y[i], said, i) + _chi(y[j], said, j)
                crossed = _best(y[j], said, i)[2] + _best(y[i], said, j)[2]
                alone = _best(y[i], said, i)[2] + _best(y[j], said, j)[2]
                if crossed < 0.3 * alone and crossed < 0.2 * own:
                    swaps.append(Fault("sensor_swap", (i, j), 1.0, 0.0, own / max(crossed, 1e-9)))
                    used |= {i, j}
    single = []
    for i in rows:
        if i in used:
            continue
        factor, deviation, left = _best(y[i], said, i)
        own = _chi(y[i], said, i)
        if left > _LEFT * own or abs(factor - 1.0) < max(_SMALLEST_GAIN, 4.0 * deviation):
            continue
        if abs(factor + 1.0) < 0.25:
            kind = "sensor_polarity"
        elif abs(factor - 2.0) < max(0.12, 3.0 * deviation):
            kind, factor = "doubled", 2.0
        else:
            kind = "sensor_gain"
        single.append(Fault(kind, (i,), factor, deviation, own / max(left, 1e-9)))
    return (*swaps, *single)


def _chi(reading: Floats, said: Prediction, i: int) -> float:
    return float(np.sum(((reading - said.mean[i]) / said.deviation[i]) ** 2))


def _best(reading: Floats, said: Prediction, i: int) -> tuple[float, float, float]:
    """Factor on the prediction that explains a reading best, its deviation, the misfit left."""
    w = 1.0 / said.deviation[i] ** 2
    square = float(np.sum(w * said.mean[i] ** 2))
    factor = float(np.sum(w * said.mean[i] * reading)) / max(square, float(np.finfo(float).tiny))
    left = float(np.sum(w * (reading - factor * said.mean[i]) ** 2))
    return factor, float(np.sqrt(max(left / max(len(reading) - 1, 1), 1.0) / square)), left
