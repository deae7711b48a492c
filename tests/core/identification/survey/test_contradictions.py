"""Functions of the wrong sign or under each other's name are found, named and mended."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.identification.identify import identify
from trueup.core.identification.survey.check_survey import checked
from trueup.core.identification.survey.survey_data import prepare


def flipped(frfs, *places):
    values = np.array(frfs.values)
    for response, reference in places:
        values[response, reference] *= -1.0
    return replace(frfs, values=values)


@pytest.mark.parametrize("place", [(0, 0), (7, 2), (19, 1)])
def test_it_is_named_and_turned(survey, place):
    frfs, _ = survey(12, n_mode=6, n_response=20, n_line=1000, n_reference=3)
    right = prepare(frfs)
    mended = checked(prepare(flipped(frfs, place)))
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
    assert checked(prepare(roving)).warnings[-1].startswith(f"{said}: of the wrong sign")


def test_a_point_that_is_wired_backwards_contradicts_nothing(survey):
    frfs, _ = survey(12, n_mode=6, n_response=20, n_line=1000, n_reference=3)
    whole = prepare(flipped(frfs, (7, 0), (7, 1), (7, 2)))
    assert checked(whole).faults == ()
    assert np.array_equal(checked(whole).values, whole.values)


def test_it_makes_no_second_mode(survey):
    frfs, truth = survey(12, n_mode=6, n_response=20, n_line=1000, n_reference=3)
    found = identify(flipped(frfs, (7, 2))).modes.frequencies_hz
    assert found == pytest.approx(np.sort(truth.frequencies_hz), rel=1e-3)


@pytest.mark.parametrize("place", [(0, 0), (39, 1)])
def test_of_two_references_the_driving_point_tells_which_function_is_wrong(survey, place):
    """References stand at the first and the last of the 40 points."""
    frfs, _ = survey(3, n_mode=6)
    mended = checked(prepare(flipped(frfs, place)))
    (fault,) = mended.faults
    label = frfs.responses.labels[place[0]]
    assert fault.functions == (f"{label}/{label}",)
    assert (fault.kind, fault.done) == ("wrong_sign", "turned")
    assert mended.values == pytest.approx(prepare(frfs).values)


def test_of_two_references_alone_nothing_tells_and_both_are_left_out(survey):
    frfs, _ = survey(3, n_mode=6)
    mended = checked(prepare(flipped(frfs, (7, 0))))
    (fault,) = mended.faults
    assert fault.functions == ("8:Z/1:Z", "8:Z/40:Z")
    assert (fault.kind, fault.done) == ("wrong_sign", "left out")
    assert 8 not in mended.outputs.node
    assert mended.values.shape[:2] == (39, 2)


@pytest.mark.parametrize("n_reference", [2, 3])
def test_two_functions_of_a_point_under_each_others_name_are_exchanged(survey, n_reference):
    frfs, _ = survey(5, n_mode=6, n_reference=n_reference)
    values = np.array(frfs.values)
    values[[4, 11], 0], values[[4, 11], 1] = frfs.values[[4, 11], 1], frfs.values[[4, 11], 0]
    mended = checked(prepare(replace(frfs, values=values)))
    (fault,) = mended.faults
    assert (fault.kind, fault.done) == ("swapped_references", "exchanged")
    assert len(fault.functions) == 4
    assert "at 5:Z, 12:Z stand under each other's name" in fault.sentence
    right = prepare(frfs)
    assert mended.physical == pytest.approx(right.physical)


def test_a_function_of_the_wrong_size_is_left_out(survey):
    frfs, _ = survey(12, n_mode=6, n_response=20, n_line=1000, n_reference=3)
    values = np.array(frfs.values)
    values[3, 2] *= 5.0
    mended = checked(prepare(replace(frfs, values=values)))
    (fault,) = mended.faults
    assert (fault.kind, fault.functions, fault.done) == ("wrong_gain", ("4:Z/20:Z",), "left out")
    assert np.argwhere(~mended.measured).tolist() == [[3, 2]]


def test_of_two_references_alone_nothing_tells_whose_size_is_wrong(survey):
    frfs, _ = survey(3, n_mode=6)
    values = np.array(frfs.values)
    values[7, 0] *= 5.0
    (fault,) = checked(prepare(replace(frfs, values=values))).faults
    assert (fault.kind, fault.done) == ("wrong_gain", "left out")
    assert fault.functions == ("8:Z/1:Z", "8:Z/40:Z")


@pytest.mark.parametrize(("times", "said"), [(3.0, "3"), (0.5, "0.5")])
@pytest.mark.parametrize("reference", [0, 1, 2])
def test_points_after_a_change_of_gain_are_brought_to_the_size_of_the_others(
    survey, reference, times, said
):
    frfs, _ = survey(12, n_mode=6, n_reference=3)
    values = np.array(frfs.values)
    values[27:, reference] *= times
    mended = checked(prepare(replace(frfs, values=values)))
    (fault,) = mended.faults
    label = frfs.references.labels[reference]
    assert (fault.kind, fault.done) == ("wrong_gain", "scaled")
    assert fault.functions == tuple(f"{n}:Z/{label}" for n in range(28, 41))
    assert f"about {said}" in fault.sentence
    assert mended.physical == pytest.approx(prepare(frfs).physical, rel=0.05)


@pytest.mark.parametrize("seed", range(4))
def test_a_survey_in_order_has_no_step_of_gain(survey, seed):
    frfs, _ = survey(seed, n_mode=6, n_reference=3, noise=0.05)
    assert checked(prepare(frfs)).faults == ()


def test_references_exchanged_at_some_points_are_no_step_of_gain(survey):
    frfs, _ = survey(12, n_mode=6, n_reference=3)
    values = np.array(frfs.values)
    values[27:36, [0, 1]] = values[27:36, [1, 0]]
    assert not any("gain" in f.kind for f in checked(prepare(replace(frfs, values=values))).faults)
