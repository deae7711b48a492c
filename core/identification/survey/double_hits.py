"""Double hits: functions whose phase ripples evenly over frequency."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from .survey_data import Survey
from .survey_numbers import SURVEY


def second_hits(survey: Survey) -> Floats:
    """Return the delay of a second hit in each function, 0 where there is none, s.

    A second hit of a times the force, a time τ after the first and not in the force signal,
    multiplies a function by 1 + a e^(−jωτ). Functions of normal modes have one phase between
    resonances, up to the sign, and go through a resonance together: what is left of the phase of
    one against all, weighted by how well all agree at a line, is the ripple a sin ωτ.

    Returns
    -------
    (n_output, n_input) float
    """
    n_line = len(survey.frequencies_hz)
    step = float(np.median(np.diff(survey.frequencies_hz)))
    fine = 4 * n_line  # of the Fourier transform: a quarter of a cycle in the range
    cycles = np.arange(round(4 * SURVEY.echo_cycles), round(fine * SURVEY.echo_line))
    found = np.zeros(survey.measured.shape)
    for i in range(found.shape[1]):
        rows = np.flatnonzero(survey.measured[:, i])
        if len(rows) < SURVEY.echo_functions:
            continue
        squared = survey.values[rows, i] ** 2
        squared /= np.maximum(np.abs(squared), 1e-300)
        common = squared.mean(axis=0)
        weight = np.abs(common)
        phase = 0.5 * np.angle(squared * common.conj()) * weight
        total = float(np.sum(weight**2))
        spread = np.sum(phase**2, axis=1) / total
        if np.median(spread) > SURVEY.echo_phase**2:
            continue
        ripple = 2.0 * np.abs(np.fft.fft(phase * weight, n=fine, axis=1)[:, cycles]) / total
        best = ripple.argmax(axis=1)
        top = ripple[np.arange(len(rows)), best]
        sure = (top > SURVEY.echo_least) & (0.5 * top**2 > SURVEY.echo_share * spread)
        found[rows[sure], i] = cycles[best[sure]] / (fine * step)
    alone = np.count_nonzero(found, axis=1, keepdims=True) < SURVEY.echo_together
    slow = found < SURVEY.echo_alone / (n_line * step)
    return np.where(alone & slow, 0.0, found)
