"""What the standard errors of identified modes weigh in correlation and updating."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, Numbers, hold
from ..errors import InputError
from ..noun import Noun
from .correlation_numbers import CORRELATION


@dataclass(frozen=True, eq=False)
class ModeErrors(Noun):
    """Standard errors of test modes, relative.

    Parameters
    ----------
    frequency : (n_test,) float
        Of each frequency, over the frequency.
    shape : (n_sensor, n_test) float
        Of each reading, over the rms reading of its shape.
    """

    frequency: Floats
    shape: Floats

    def __post_init__(self) -> None:
        hold(self, "frequency shape", np.float64)

    @property
    def length(self) -> Floats:
        """Length of each shape's error over the shape's, (n_test,): its part of √(1 − MAC)."""
        return np.asarray(np.sqrt(np.mean(self.shape**2, axis=0)))

    @property
    def sensors(self) -> Floats:
        """Weight of each sensor, (n_sensor,): 1/σ² over that of the median sensor."""
        variance = CORRELATION.reading**2 + np.mean(self.shape**2, axis=1)
        return np.asarray(np.median(variance) / variance) if len(variance) else variance


def mode_errors(frequencies_hz: Floats, shapes: Numbers, f_std: Floats, std: Floats) -> ModeErrors:
    """Relative standard errors from absolute ones.

    Of frequencies `f_std` (n_test,), of shapes (n_sensor, n_test) `std` in their scale.
    """
    rms = np.sqrt(np.mean(np.abs(shapes) ** 2, axis=0))
    return ModeErrors(f_std / frequencies_hz, std / np.maximum(rms, np.finfo(float).tiny))


def with_scatter(
    errors: ModeErrors | None, n_sensor: int, n_test: int, frequency: float, shape: float
) -> ModeErrors:
    """Add the scatter of a test that its user states, the same for all modes and sensors.

    Standard deviations: `frequency` of a frequency over itself, `shape` of a reading over the rms
    of its shape; `errors` are those of the identification, if any.

    Raises
    ------
    InputError
        Scatter below zero.
    """
    if frequency < 0.0 or shape < 0.0:
        raise InputError("the scatter of a test is zero or more; correct it in the study")
    if errors is None:
        errors = ModeErrors(np.zeros(n_test), np.zeros((n_sensor, n_test)))
    return ModeErrors(np.hypot(errors.frequency, frequency), np.hypot(errors.shape, shape))


def told(errors: ModeErrors, labels: Sequence[str]) -> str:
    """Say in one sentence what is weighed by what."""
    f, s = 100.0 * errors.frequency, 100.0 * errors.length
    weight = errors.sensors
    little = [labels[k] for k in np.flatnonzero(weight < CORRELATION.little)]
    more = ", ..." if len(little) > CORRELATION.named else ""
    named = ", ".join(little[: CORRELATION.named]) + more
    less = f"; sensor(s) {named} count less than half" if little else ""
    return (
        "the identified modes weigh by their standard errors (frequencies "
        f"{f.min():.2g} to {f.max():.2g} %, shapes {s.min():.2g} to {s.max():.2g} %){less}"
    )
