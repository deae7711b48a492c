"""A function that was measured with the wrong sign is found, named and turned."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.identification import identify
from trueup.core.identification.survey.survey_data import prepare
from trueup.core.identification.survey.wrong_signs import signs_mended


def flipped(frfs, *places):
    values = np.array(frfs.values)
    for response, reference in places:
        values[response, reference] *= -1.0
    return replace(frfs, values=values)


@pytest.mark.parametrize("place", [(0, 0), (7, 2), (19, 1)])
def test_it_is_named_and_turned(survey, place):
    frfs, _ = survey(12, n_mode=6, n_response=20, n_line=1000, n_reference=3)
    right = prepare(frfs)
    mended = signs_mended(prepare(flipped(frfs, place)))
    said = f"{frfs.responses.labels[place[0]]}/{frfs.references.labels[place[1]]}"
    (warning,) = mended.warnings
    assert warning.startswith(f"{said}: of the wrong sign")
    assert mended.values == pytest.approx(right.values)


def test_a_roving_hammer_names_response_and_reference_as_the_file_does(survey):
    frfs, _ = survey(12, n_mode=6, n_response=20, n_line=1000, n_reference=3)
    wrong = flipped(frfs, (7, 2))
    roving = replace(
        wrong,
        values=wrong.values.transpose(1, 0, 2),
        responses=wrong.references,
        references=wrong.responses,
    )
    said = f"{frfs.references.labels[2]}/{frfs.responses.labels[7]}"
    assert signs_mended(prepare(roving)).warnings[-1].startswith(f"{said}: of the wrong sign")


def test_a_point_that_is_wired_backwards_contradicts_nothing(survey):
    frfs, _ = survey(12, n_mode=6, n_response=20, n_line=1000, n_reference=3)
    whole = prepare(flipped(frfs, (7, 0), (7, 1), (7, 2)))
    assert signs_mended(whole) is whole


def test_it_makes_no_second_mode(survey):
    frfs, truth = survey(12, n_mode=6, n_response=20, n_line=1000, n_reference=3)
    found = identify(flipped(frfs, (7, 2))).modes.frequencies_hz
    assert found == pytest.approx(np.sort(truth.frequencies_hz), rel=1e-3)
