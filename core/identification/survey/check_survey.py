"""All checks of a survey, in the order in which they build on each other."""

from __future__ import annotations

import numpy as np

from ...data.geometry import Geometry
from .coherence import Coherence, coherence_checked
from .contradictions import contradictions_mended, gain_steps_mended
from .driving_points import driving_points
from .function_faults import noise_ratio, second_hits
from .neighbours import neighbours_of, points_mended, points_of_wrong_gain_left_out
from .references import references_mended
from .survey_data import Survey, named_and_left_out, noise_levels, weighed
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
    given = survey
    survey = gain_steps_mended(_second_hits_left_out(_noisy_left_out(survey)))
    points = driving_points(survey.outputs, survey.inputs, geometry)
    survey = contradictions_mended(survey, points, neighbours_of(survey, geometry))
    survey = points_of_wrong_gain_left_out(survey, geometry)
    points = driving_points(survey.outputs, survey.inputs, geometry)
    survey = points_mended(survey, neighbours_of(survey, geometry))
    survey = references_mended(survey, points, neighbours_of(survey, geometry))
    if any(f.done for f in survey.faults[len(given.faults) :]):
        survey = weighed(survey)
    return coherence_checked(survey, coherence)


def _noisy_left_out(survey: Survey) -> Survey:
    """Name noisy functions; leave out those of an output that has better ones.

    An output of which all are noisy has a small weight, and no other functions to tell its shape.
    """
    ratio = noise_ratio(survey.physical, survey.measured, noise_levels)
    noisy = survey.measured & (ratio > SURVEY.noisy)
    all_of_it = (noisy == survey.measured).all(axis=1, keepdims=True)
    why = "an overload, a double hit or a loose sensor makes such"
    for bad, done in ((noisy & ~all_of_it, "left out"), (noisy & all_of_it, "")):
        what = (
            f"noise floor up to {ratio[bad].max(initial=0.0):.0f} times that of the survey ({why})"
        )
        survey = named_and_left_out(survey, "noise_floor", bad, what, done)
    return survey


def _second_hits_left_out(survey: Survey) -> Survey:
    delay = second_hits(survey.frequencies_hz, survey.values, survey.measured)
    if not delay.any():
        return survey
    after = 1e3 * float(np.median(delay[delay > 0.0]))
    hit = delay > 0.0
    together = np.count_nonzero(hit, axis=1, keepdims=True) >= SURVEY.echo_together
    what = (
        f"phase ripples every {1e3 / after:.3g} Hz, as after a second hit {after:.3g} ms behind "
        "the first"
    )
    return named_and_left_out(survey, "double_hit", survey.measured & (hit | together), what)
