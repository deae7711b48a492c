"""Peaks of the functions where no mode was accepted."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from .identification_numbers import IDENTIFICATION
from .poles.band_sweeps import BandFit
from .poles.pole_splitting import tones
from .poles.shared_noise import is_shared_noise
from .survey.mode_indicator import cmif
from .survey.survey_data import Survey


def of_peaks(
    survey: Survey, fits: tuple[BandFit, ...], indicator: Floats, explained: Floats
) -> list[str]:
    """Say where the functions peak well out of the noise and no mode was accepted.

    Parameters
    ----------
    survey : Survey
    fits : tuple of BandFit
        Whose tones and noise that all points share explain a peak, too.
    indicator : (n_line,) float
        First singular value of the functions.
    explained : (n,) float
        Frequencies of modes, and of those that the user does not want [Hz].
    """
    from scipy.signal import find_peaks, peak_widths

    f = survey.frequencies_hz
    decibels = 20.0 * np.log10(np.maximum(indicator, np.finfo(float).tiny))
    lines, _ = find_peaks(decibels, prominence=IDENTIFICATION.peak_db)
    floor = sum(np.sqrt(survey.values.shape[:2]))
    level = cmif(survey.values[:, :, lines])[:, 0] if len(lines) else np.empty(0)
    lines = lines[level > IDENTIFICATION.peak_noise * floor]
    width = peak_widths(indicator**2, lines, rel_height=0.5)[0] / 2.0
    reach = np.maximum(IDENTIFICATION.peak_widths * width, IDENTIFICATION.peak_lines)
    known = np.concatenate([explained, *(_no_resonances(b) for b in fits)])
    apart = np.abs(f[lines, None] - known).min(axis=1, initial=np.inf)
    alone = lines[apart > reach * np.gradient(f)[lines]]
    if not len(alone):
        return []
    named = ", ".join(f"{x:.2f}" for x in f[alone])
    return [
        f"the functions peak at {named} Hz, where no mode was accepted: see what was rejected "
        "there and why; by hand one is taken with take"
    ]


def _no_resonances(b: BandFit) -> Floats:
    """Frequencies of roots that peak without being resonances."""
    fit = b.fit
    told = tones(b.frequencies_hz, fit) | is_shared_noise(b.data, b.frequencies_hz, fit)
    return np.asarray(np.abs(fit.poles[told & b.background]) / (2.0 * np.pi))
