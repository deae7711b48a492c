"""Points against their neighbours: a plate of smooth shapes, one reference."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry
from trueup.core.identification.survey.check_survey import checked
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from
from trueup.core.identification.survey.survey_data import prepare


@pytest.fixture(scope="module")
def plate():
    """A survey of 8 × 6 points, hit at one that is measured, and their positions."""
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, 8), np.linspace(0, 0.7, 6)))
    orders = [(1, 0), (0, 1), (1, 1), (2, 0), (2, 1)]
    shapes = np.stack([np.cos(np.pi * m * x) * np.cos(np.pi * n * y / 0.7) for m, n in orders], 1)
    poles = poles_from(np.array([20.0, 31.0, 44.0, 62.0, 75.0]), np.full(5, 0.005))
    f = np.arange(10.0, 90.0, 0.125)
    values = modal_response(f, poles, shapes, shapes[[1]] / (2j * poles.imag))
    rng = np.random.default_rng(0)
    noise = rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    values = values + 0.003 * np.abs(values).std() * noise
    dofs = Dofs(np.arange(1, 49), np.full(48, 3))
    geometry = Geometry(np.arange(1, 49), np.column_stack([x, y, 0 * x]))
    return Frfs(f, dofs, dofs.take(np.array([1])), values, "acceleration", "plate"), geometry


def found(plate, change):
    frfs, geometry = plate
    values = np.array(frfs.values)
    change(values)
    return checked(prepare(replace(frfs, values=values)), geometry)


def test_smooth_shapes_have_no_fault(plate):
    assert found(plate, lambda v: None).faults == ()


@pytest.mark.parametrize("point", [1, 10, 27, 47])
def test_a_point_that_is_the_reverse_of_its_neighbours_is_turned(plate, point):
    mended = found(plate, lambda v: np.negative(v[point], out=v[point]))
    (fault,) = mended.faults
    assert (fault.kind, fault.functions, fault.done) == (
        "wrong_sign", (f"{point + 1}:Z/2:Z",), "turned")  # fmt: skip
    assert mended.values == pytest.approx(prepare(plate[0]).values)


@pytest.mark.parametrize("pair", [[0, 47], [9, 38], [1, 30]])
def test_two_points_that_fit_crosswise_are_exchanged(plate, pair):
    def exchange(values):
        values[pair] = values[pair[::-1]]

    mended = found(plate, exchange)
    (fault,) = mended.faults
    assert (fault.kind, fault.done) == ("swapped_points", "exchanged")
    assert set(fault.functions) == {f"{k + 1}:Z/2:Z" for k in pair}
    assert mended.physical == pytest.approx(prepare(plate[0]).physical)


def test_without_positions_nothing_is_known(plate):
    values = np.array(plate[0].values)
    values[10] *= -1.0
    assert checked(prepare(replace(plate[0], values=values))).faults == ()


def test_a_reversed_reference_is_turned_where_the_neighbours_stand_by_the_point(plate):
    mended = found(plate, lambda v: np.negative(v, out=v))
    (fault,) = mended.faults
    assert (fault.kind, fault.done) == ("wrong_sign", "turned")
    assert len(fault.functions) == 48
    assert mended.values == pytest.approx(prepare(plate[0]).values)
