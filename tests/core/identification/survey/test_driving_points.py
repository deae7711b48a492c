"""Modal mass from driving points of any direction, and references under the wrong name."""

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.identification.survey.driving_points import (
    driving_points,
    positive_share,
    reciprocity_of_modes,
    scale,
)
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from
from trueup.core.identification.survey.real_shapes import (
    known_components,
    real_shapes,
    turned_to_principal_phase,
)

POLES = poles_from(np.array([10.0, 17.0, 31.0]), np.array([0.01, 0.02, 0.005]))
MASS = np.array([2.0, 0.5, 7.0])


def structure(n_node=4):
    """Shapes at three basic directions of each node, and what a unit force there excites."""
    shapes = np.random.default_rng(0).standard_normal((3 * n_node, 3))
    dofs = Dofs(np.repeat(np.arange(1, n_node + 1), 3), np.tile([1, 2, 3], n_node))
    return dofs, shapes, shapes / (2j * POLES.imag * MASS)


def test_modal_mass_of_plain_driving_points():
    dofs, shapes, part = structure()
    drive = np.array([2, 7])
    points = driving_points(dofs, dofs.take(drive))
    found = scale(POLES, shapes, part[drive], points, dofs.take(drive))
    assert found.modal_mass == pytest.approx(MASS)
    assert found.warnings == ()


def test_the_mode_whose_shape_contradicts_its_participation_is_told():
    dofs, shapes, part = structure()
    drive = np.array([2, 7, 9])
    points = driving_points(dofs, dofs.take(drive))
    wrong = shapes.copy()
    wrong[drive, 1] = np.roll(shapes[drive, 1], 1)
    told = reciprocity_of_modes(wrong, part[drive], points)
    assert told[[0, 2]] == pytest.approx(1.0)
    a, b = shapes[drive, 1], wrong[drive, 1]
    assert told[1] == pytest.approx((a @ b) ** 2 / (a @ a) / (b @ b))
    assert np.isnan(reciprocity_of_modes(shapes, part[drive[:1]], points[:1])).all()


def test_a_force_askew_is_met_by_three_responses():
    dofs, shapes, part = structure()
    axis = np.array([0.6, 0.0, 0.8])
    inputs = Dofs([2], [3], [axis])
    points = driving_points(dofs, inputs)
    found = scale(POLES, shapes, (axis @ part[3:6])[None], points, inputs)
    assert found.modal_mass == pytest.approx(MASS)


def test_a_force_that_the_responses_do_not_span_has_no_driving_point():
    dofs, _, _ = structure()
    in_plane = dofs.take(np.flatnonzero(dofs.component < 3))
    assert np.isnan(driving_points(in_plane, Dofs([2], [3]))).all()
    assert np.isnan(driving_points(dofs, Dofs([2], [5]))).all()


def test_a_response_mounted_backwards_counts_with_its_sign():
    dofs, shapes, part = structure()
    backwards = Dofs(dofs.node, dofs.component, -dofs.axis)
    inputs = dofs.take(np.array([4]))
    points = driving_points(backwards, inputs)
    assert scale(POLES, -shapes, part[[4]], points, inputs).modal_mass == pytest.approx(MASS)


def test_nodes_at_one_position_are_one_point():
    dofs, shapes, part = structure()
    xyz = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [1, 0, 0]], float)
    geometry = Geometry([1, 2, 3, 4, 99], xyz)
    inputs = Dofs([99], [1])
    points = driving_points(dofs, inputs, geometry)
    found = scale(POLES, shapes, part[[3]], points, inputs)
    assert found.modal_mass == pytest.approx(MASS)
    assert np.isnan(driving_points(dofs, inputs)).all()


def test_no_driving_point_is_said():
    dofs, shapes, part = structure()
    inputs = Dofs([99], [1])
    found = scale(POLES, shapes, part[[0]], driving_points(dofs, inputs), inputs)
    assert np.isnan(found.modal_mass).all()
    assert "no driving point" in found.warnings[0]


def test_residues_that_are_not_reciprocal_give_no_modal_mass():
    dofs, shapes, part = structure()
    inputs = dofs.take(np.array([2, 7, 9]))
    points = driving_points(dofs, inputs)
    found = scale(POLES, shapes, part[[7, 2, 9]], points, inputs)
    assert np.isnan(found.modal_mass).all()
    assert "from their reciprocal" in found.warnings[0]


def test_of_residues_that_are_not_reciprocal_the_worst_pairs_are_named():
    dofs, shapes, part = structure()
    inputs = dofs.take(drive := np.array([2, 7, 9]))
    turned = part[drive]
    turned[2] *= -1.0
    found = scale(POLES, shapes, turned, driving_points(dofs, inputs), inputs)
    pairs = found.warnings[0].split("most between ")[1].split(": modal")[0].split(", ")
    assert all("4:X" in pair for pair in pairs)


def test_a_driving_point_takes_power_and_a_reversed_one_gives_it_back():
    _, shapes, part = structure()
    values = modal_response(np.linspace(5.0, 40.0, 500), POLES, shapes, part[[2]])[:, 0]
    assert positive_share(values[2]) == pytest.approx(1.0, abs=1e-6)
    assert positive_share(-values[2]) == pytest.approx(-1.0, abs=1e-6)
    assert abs(positive_share(values[7])) < 0.9


def test_a_reversed_force_is_named():
    dofs, shapes, part = structure()
    inputs = dofs.take(np.array([2]))
    found = scale(POLES, shapes, -part[[2]], driving_points(dofs, inputs), inputs)
    assert np.isnan(found.modal_mass).all()
    assert "wrong sign" in found.warnings[0]


def test_real_shapes_of_a_lone_mode_is_its_real_part():
    shape = np.random.default_rng(0).standard_normal((8, 1)) * np.exp(2.1j)
    turned = turned_to_principal_phase(shape, np.ones(shape.shape, bool))
    assert np.abs(turned.imag).max() < 1e-12
    largest = turned[np.argmax(np.abs(turned))]
    assert largest.real > 0.0
    assert real_shapes(
        np.array([5.0]), turned, np.ones(8), np.ones(turned.shape, bool)
    ) == pytest.approx(turned.real)


def test_real_shapes_of_a_mixed_pair_span_the_real_pair():
    """Any complex mixture of two real shapes; here one with nearly parallel real parts."""
    pair = np.linalg.qr(np.random.default_rng(0).standard_normal((12, 2)))[0]
    mixture = pair @ np.array([[1.0, 1.0], [0.6j, -0.6j]])
    turned = turned_to_principal_phase(mixture, np.ones(mixture.shape, bool))
    assert np.linalg.svd(turned.real)[1][1] < 1e-9
    real = real_shapes(np.array([50.0, 50.01]), turned, np.ones(12), np.ones(turned.shape, bool))
    assert np.linalg.svd(pair.T @ np.linalg.qr(real)[0])[1] == pytest.approx([1.0, 1.0])
    assert np.linalg.svd(real)[1][1] > 0.5


def test_large_components_with_large_errors_are_known_and_lost_ones_are_not():
    """Noise that follows the response makes large components uncertain, but not unknown."""
    shapes = np.array([[1.0], [1.0], [1.0], [50.0], [1.0]]) + 0j
    std = np.array([0.01, 0.01, 0.01, 0.5, 0.5])
    covariance = (std**2)[:, None, None, None] * np.eye(2)
    assert known_components(shapes, covariance)[:, 0].tolist() == [True, True, True, True, False]
