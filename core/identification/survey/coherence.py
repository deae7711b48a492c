"""Coherence measured beside the functions: low where a resonance is, or in one function."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Floats, Ints
from ...data.dofs import Dofs
from ...noun import Noun
from .faults import Fault, listed
from .survey_data import Survey, told
from .survey_numbers import SURVEY


@dataclass(frozen=True, eq=False)
class Coherence(Noun):
    """Ordinary or multiple coherence of frequency responses.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    responses, references : Dofs
    values : (n_response, n_reference, n_line) float
        0..1; NaN where it was not measured.
    """

    frequencies_hz: Floats
    responses: Dofs
    references: Dofs
    values: Floats


def coherence_checked(survey: Survey, coherence: Coherence | None) -> Survey:
    """Name functions of low coherence, and resonances at which the others have it.

    Lines count by the square of the function: a function is low at its antiresonances, and that is
    no fault.

    References
    ----------
    Bendat, Piersol (2010), Random Data, 4th edition, section 9.2: the standard error of H₁ of n
    averages is √((1 − γ²)/(2 n γ²)) of it.
    """
    if coherence is None:
        return survey
    squared = _of(survey, coherence)
    power = np.abs(survey.values) ** 2 * np.isfinite(squared)
    shared = power * np.nan_to_num(squared)
    total = power.sum(axis=2)
    own = np.where(total > 0.0, shared.sum(axis=2) / np.maximum(total, 1e-300), 1.0)
    low = own < SURVEY.coherent
    faults = []
    if low.any():
        names = tuple(survey.function(o, i) for o, i in zip(*np.nonzero(low), strict=True))
        sentence = f"{listed(names)}: coherence down to {own.min():.2f} where they are large"
        faults.append(Fault("low_coherence", names, sentence))
    near = np.ones(3)
    every, sound = power[~low].sum(axis=0), shared[~low].sum(axis=0)
    by_line = np.where(every > 0.0, np.convolve(sound, near, "same"), np.nan)
    by_line /= np.maximum(np.convolve(every, near, "same"), 1e-300)
    tops = _resonances(survey)
    poor = tops[by_line[tops] < SURVEY.coherent]
    if len(poor):
        where = listed([f"{survey.frequencies_hz[k]:.2f} Hz ({by_line[k]:.2f})" for k in poor])
        which = "all other" if low.any() else "all"
        sentence = f"low coherence at the resonances near {where}, of {which} functions together"
        faults.append(Fault("low_coherence", (), sentence))
    return told(replace(survey, coherence=by_line), *faults)


def _resonances(survey: Survey) -> Ints:
    """Lines at which the functions together peak."""
    from scipy.signal import find_peaks

    together = 10.0 * np.log10(np.sum(np.abs(survey.values) ** 2, axis=(0, 1)) + 1e-300)
    return np.asarray(find_peaks(together, prominence=SURVEY.signs_prominence_db)[0])


def _of(survey: Survey, coherence: Coherence) -> Floats:
    """Coherence of the functions of a survey at its lines, NaN where unknown."""
    lines = np.searchsorted(coherence.frequencies_hz, survey.frequencies_hz)
    pair = coherence.responses, coherence.references
    outputs, inputs = pair[::-1] if survey.roving_hammer else pair
    values = coherence.values.transpose(1, 0, 2) if survey.roving_hammer else coherence.values
    rows = [outputs.labels.index(label) for label in survey.outputs.labels]
    columns = [inputs.labels.index(label) for label in survey.inputs.labels]
    return np.asarray(values[np.ix_(rows, columns)][:, :, lines])
