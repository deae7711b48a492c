"""References that are exchanged or reversed, driving points that are none."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.identification.identify import identify
from trueup.core.identification.survey.check_survey import checked
from trueup.core.identification.survey.driving_points import positive_share
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from
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


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_what_symmetry_makes_nil_contradicts_nothing(seed):
    """Two references, in two directions, of which each moves its own in modes of its own."""
    rng = np.random.default_rng(seed)
    f, lines, points = np.linspace(55.0, 285.0, 11), np.linspace(40.0, 300.0, 1041), 30
    way, moves = np.arange(points) % 2, np.arange(11) % 2
    shapes = rng.standard_normal((points, 11)) * (way[:, None] == moves)
    poles = poles_from(f, rng.uniform(0.001, 0.005, 11))
    part = shapes[[0, points - 1]] / (2j * poles.imag)
    values = modal_response(lines, poles, shapes, part, "acceleration")
    e = rng.standard_normal((*values.shape, 2)) @ [1.0, 1.0j]
    values += 0.005 * (e + np.roll(e, 1, axis=2) + np.roll(e, 2, axis=2))
    values += 0.2 * rng.standard_normal((points, 2, 1))  # of modes outside the range
    dofs = Dofs(np.arange(1, points + 1), np.full(points, 3))
    frfs = Frfs(lines, dofs, dofs.take(np.array([0, points - 1])), values, "acceleration")
    found = identify(frfs)
    assert not any("wrong" in fault.kind for fault in found.faults)
    assert found.reciprocity == ()
    assert not any("reciprocal" in w for w in found.warnings)
    assert found.modes.frequencies_hz == pytest.approx(f, rel=1e-3)
