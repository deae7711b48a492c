"""References that are exchanged or reversed, driving points that are none."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.identification import identify
from trueup.core.identification.survey.check_survey import checked
from trueup.core.identification.survey.driving_points import positive_share
from trueup.core.identification.survey.survey_data import prepare


@pytest.mark.parametrize("pair", [(0, 1), (1, 2), (0, 2)])
def test_exchanged_references_are_named_and_exchanged_back(survey, pair):
    frfs, _ = survey(7, n_mode=6, n_reference=3)
    values = np.array(frfs.values)
    values[:, pair] = frfs.values[:, pair[::-1]]
    mended = checked(prepare(replace(frfs, values=values)))
    (fault,) = mended.faults
    assert (fault.kind, fault.done) == ("swapped_references", "exchanged")
    for k in pair:
        assert frfs.references.labels[k] in fault.sentence
    assert mended.physical == pytest.approx(prepare(frfs).physical)


def test_one_driving_point_is_enough_to_see_an_exchange(survey):
    """The second reference stands where nothing was measured."""
    frfs, _ = survey(7, n_mode=6)
    frfs = frfs.at(np.arange(39))
    values = np.array(frfs.values[:, ::-1])
    mended = checked(prepare(replace(frfs, values=values)))
    assert [f.kind for f in mended.faults] == ["swapped_references"]
    assert mended.physical == pytest.approx(prepare(frfs).physical)


def test_a_driving_point_that_gives_power_back_is_said_and_not_turned(survey):
    """Whether the reference is reversed or the point cannot be known here."""
    frfs, _ = survey(7, n_mode=6)
    values = np.array(frfs.values)
    values[:, 1] *= -1.0
    given = prepare(replace(frfs, values=values))
    mended = checked(given)
    (fault,) = mended.faults
    assert (fault.kind, fault.functions, fault.done) == ("wrong_sign", ("40:Z/40:Z",), "")
    assert np.array_equal(mended.values, given.values)


def test_a_driving_point_alone_is_reversed_where_its_point_is_reciprocal_with_another(survey):
    """Only the functions of driving points are there: no resonance compares the points."""
    frfs = survey(7, n_mode=6)[0].at(np.array([0, 39]))
    values = np.array(frfs.values)
    values[0, 0] *= -1.0
    mended = checked(prepare(replace(frfs, values=values)))
    (fault,) = mended.faults
    assert (fault.kind, fault.functions, fault.done) == ("wrong_sign", ("1:Z/1:Z",), "turned")
    assert mended.values == pytest.approx(prepare(frfs).values)


def test_a_driving_point_that_is_none_is_named(survey):
    frfs, _ = survey(7, n_mode=6, n_reference=1)
    values = np.array(frfs.values)
    share = [positive_share(h[0]) for h in values]
    other = int(np.argmin(np.abs(share)))
    values[[0, other]] = values[[other, 0]]
    (fault,) = checked(prepare(replace(frfs, values=values))).faults
    assert (fault.kind, fault.functions) == ("driving_point", ("1:Z/1:Z",))


def test_driving_points_and_reciprocity_are_reported(survey):
    found = identify(survey(7, n_mode=6)[0])
    assert [d.function for d in found.driving_points] == ["1:Z/1:Z", "40:Z/40:Z"]
    assert [d.positive_share for d in found.driving_points] == pytest.approx([1.0, 1.0], abs=1e-2)
    assert [d.phase_deg for d in found.driving_points] == pytest.approx([0.0, 0.0], abs=1.0)
    (pair,) = found.reciprocity
    assert (pair.function, pair.reciprocal) == ("1:Z/40:Z", "40:Z/1:Z")
    assert pair.correlation > 0.99
    assert pair.difference < 0.02


def test_a_reference_that_lacks_the_function_of_another_point_is_no_fault(survey):
    frfs, _ = survey(7, n_mode=6)
    values = np.array(frfs.values)
    values[0, 1] = np.nan
    assert checked(prepare(replace(frfs, values=values))).faults == ()
