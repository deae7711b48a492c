"""How usual the error is that a model leaves, and the modes that it does not explain."""

import numpy as np
from scipy.special import bdtrc, ndtr

from .model_error_numbers import MODEL_ERROR


def adequacy(error: float, noise: float = 0.0) -> float:
    """Return the probability that a model which lacks nothing leaves a diffuse error as large.

    Errors that right models left are normal in their logs. A structure whose readings scatter,
    relative `noise`, is as far from any linear model in a part of that.
    """
    usual = np.hypot(MODEL_ERROR.usual, MODEL_ERROR.usual_noise * noise)
    off = np.log(error / usual) / MODEL_ERROR.usual_spread
    return float(ndtr(-off))


def as_many_astray(number: int, modes: int) -> float:
    """Return the probability that of so many test modes a right model explains no more.

    Each is none of its modes by the same chance: binomial. `number` are not explained.
    """
    return float(bdtrc(number - 1, modes, MODEL_ERROR.stray)) if number else 1.0
