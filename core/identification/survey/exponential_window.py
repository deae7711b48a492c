"""The exponential window of a hammer test, whose damping is no damping of the structure."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from ...errors import InputError
from .survey_numbers import SURVEY


def decay_rate(window: float | str | None, frequencies_hz: Floats) -> float:
    """Return what an exponential window e^(−t/τ) adds to the decay rate of every pole, 1/τ.

    The response times e^(−t/τ) is that to the force times e^(−t/τ) of a structure whose poles are
    moved by −1/τ, so that ζ = ζ_measured − 1/(τ ω).

    Parameters
    ----------
    window : float or str, optional
        Its time constant τ [s], or its value at the end of the record in per cent of that at the
        start ("1%"): the record is taken to last one over the spacing of the lines.
    frequencies_hz : (n_line,) float

    Returns
    -------
    float
        1/s; 0 without a window.

    Raises
    ------
    InputError
        What is no time constant, no end value or, lines not being even, no length of a record.

    References
    ----------
    Fladung, Rost (1997), Application and correction of the exponential window for frequency
    response functions, MSSP 11, 23-36.
    """
    if window is None:
        return 0.0
    text = str(window).strip()
    try:
        value = float(text.removesuffix("%"))
    except ValueError:
        value = np.nan
    if not text.endswith("%"):
        if not 0.0 < value < np.inf:
            raise InputError(_wanted(text))
        return 1.0 / value
    if not 0.0 < value < 100.0:
        raise InputError(_wanted(text))
    spacing = np.diff(frequencies_hz)
    if np.ptp(spacing) > SURVEY.even * spacing.mean():
        raise InputError(
            f"the exponential window is given by its end value, {text}, but the lines are not "
            "evenly spaced and do not tell how long the record was; give its time constant in s"
        )
    return float(-np.log(value / 100.0) * spacing.mean())


def _wanted(text: str) -> str:
    return (
        f"the exponential window is '{text}'; give its time constant in s, above 0, or its value "
        "at the end of the record, above 0% and below 100%"
    )
