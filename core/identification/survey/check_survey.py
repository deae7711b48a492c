"""All checks of a survey, in the order in which they build on each other."""

from __future__ import annotations

import numpy as np

from ...data.geometry import Geometry
from .coherence import Coherence, coherence_checked
from .contradictions import contradictions_mended
from .double_hits import second_hits
from .driving_points import driving_points
from .faults import Fault, listed
from .function_faults import noise_ratio
from .neighbours import neighbours_of, points_mended
from .references import references_mended
from .survey_data import Survey, noise_levels, told
from .survey_numbers import SURVEY


def checked(
    survey: Survey, geometry: Geometry | None = None, coherence: Coherence | None = None
) -> Survey:
    """Name what is wrong with the functions, and mend what can be known.

    Parameters
    ----------
    survey : Survey
    geometry : Geometry, optional
        For neighbours, and driving points under two numbers.
    coherence : Coherence, optional
        Of the functions that the survey was made of.
    """
    points = driving_points(survey.outputs, survey.inputs, geometry)
    survey = contradictions_mended(survey, points, neighbours_of(survey, geometry))
    points = driving_points(survey.outputs, survey.inputs, geometry)
    survey = points_mended(survey, neighbours_of(survey, geometry))
    survey = references_mended(survey, points, neighbours_of(survey, geometry))
    return coherence_checked(_second_hits_named(_noise_named(survey)), coherence)


def _noise_named(survey: Survey) -> Survey:
    ratio = noise_ratio(survey.physical, survey.measured, noise_levels)
    rows, columns = np.nonzero(ratio > SURVEY.noisy)
    if not len(rows):
        return survey
    names = tuple(survey.function(o, i) for o, i in zip(rows, columns, strict=True))
    worst = ratio[rows, columns].max()
    sentence = (
        f"{listed(names)}: noise floor up to {worst:.0f} times that of the survey (an overload, a "
        "double hit or a loose sensor makes such)"
    )
    return told(survey, Fault("noise_floor", names, sentence))


def _second_hits_named(survey: Survey) -> Survey:
    delay = second_hits(survey)
    rows, columns = np.nonzero(delay)
    if not len(rows):
        return survey
    names = tuple(survey.function(o, i) for o, i in zip(rows, columns, strict=True))
    after = 1e3 * float(np.median(delay[rows, columns]))
    sentence = (
        f"{listed(names)}: phase ripples every {1e3 / after:.3g} Hz, as after a second hit "
        f"{after:.3g} ms behind the first"
    )
    return told(survey, Fault("double_hit", names, sentence))
