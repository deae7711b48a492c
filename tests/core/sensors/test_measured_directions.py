"""Directions that were not measured are absent, not zero."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from trueup.core.data.dofs import Dofs
from trueup.core.data.modes import Modes
from trueup.core.sensors.measured_directions import measured_directions


def modes_of(vectors, axis=None, component=None):
    """Modes from vectors (n_node, 3, n_mode), written as a universal file writes them."""
    vectors = np.asarray(vectors)
    n, k, m = vectors.shape
    shapes = np.vectorize(lambda v: float(f"{v:.5e}"))(vectors.real) + (
        1j * np.vectorize(lambda v: float(f"{v:.5e}"))(vectors.imag)
        if np.iscomplexobj(vectors)
        else 0.0
    )
    component = np.tile(np.arange(1, k + 1), n) if component is None else component
    dofs = Dofs(np.repeat(np.arange(1, n + 1), k), component, axis)
    return Modes(np.arange(1.0, m + 1), shapes.reshape(n * k, m), dofs)


def spanned(n, m, basis, seed=0):
    """Random vectors (n, 3, m) in the span of basis rows (n, r, 3)."""
    rng = np.random.default_rng(seed)
    return np.einsum("nrx,nrm->nxm", basis, rng.normal(size=(n, basis.shape[1], m)))


def directions(n, seed=1):
    v = np.random.default_rng(seed).normal(size=(n, 3))
    return v / np.linalg.norm(v, axis=1)[:, None]


def test_zero_components_are_dropped_even_with_one_mode():
    modes = modes_of([[[0.0], [0.0], [2.0]], [[1.0], [0.0], [3.0]]])
    kept, warnings = measured_directions(modes)
    assert kept.dofs.labels == ["1:Z", "2:X", "2:Z"]
    np.testing.assert_array_equal(kept.shapes[:, 0], [2, 1, 3])
    assert warnings == ()


def test_rounding_of_a_rotated_frame_is_not_a_measurement():
    modes = modes_of([[[1e-19] * 5, [0.0] * 5, [1.0, -2.0, 0.5, 3.0, 1.0]]])
    assert measured_directions(modes)[0].dofs.labels == ["1:Z"]


@pytest.mark.parametrize("dtype", [float, complex])
def test_uniaxial_askew_sensor_becomes_one_row_along_its_axis(dtype):
    true = directions(30)
    reading = np.random.default_rng(3).normal(size=(30, 8)).astype(dtype)
    if dtype is complex:
        reading = reading + 0.2j * np.random.default_rng(4).normal(size=(30, 8))
    kept, _ = measured_directions(modes_of(true[:, :, None] * reading[:, None]))
    assert len(kept.dofs) == 30
    sign = np.sign(np.einsum("nx,nx->n", kept.dofs.axis, true))
    np.testing.assert_allclose(kept.dofs.axis, sign[:, None] * true, atol=1e-5)
    np.testing.assert_allclose(kept.shapes, sign[:, None] * reading, atol=1e-4)
    strongest = np.argmax(np.abs(true), axis=1)
    np.testing.assert_array_equal(kept.dofs.component, strongest + 1)
    assert np.all(np.take_along_axis(kept.dofs.axis, strongest[:, None], 1) > 0)


def test_biaxial_sensor_becomes_two_rows_that_span_its_plane():
    normal = directions(30)
    basis = np.linalg.svd(normal[:, None])[2][:, 1:]
    vectors = spanned(30, 9, basis)
    kept, _ = measured_directions(modes_of(vectors))
    assert len(kept.dofs) == 60
    axis = kept.dofs.axis.reshape(30, 2, 3)
    np.testing.assert_allclose(np.einsum("nrx,nsx->nrs", axis, axis)[:, 0, 1], 0, atol=1e-9)
    np.testing.assert_allclose(np.einsum("nrx,nx->nr", axis, normal), 0, atol=1e-4)
    again = np.einsum("nrx,nrm->nxm", axis, kept.shapes.reshape(30, 2, 9))
    np.testing.assert_allclose(again, vectors, atol=1e-3)


def test_triaxial_sensor_keeps_the_axes_of_the_file():
    vectors = np.random.default_rng(5).normal(size=(4, 3, 7))
    modes = modes_of(vectors)
    kept, _ = measured_directions(modes)
    np.testing.assert_array_equal(kept.shapes, modes.shapes)
    np.testing.assert_array_equal(kept.dofs.axis, modes.dofs.axis)


def test_a_weak_direction_that_was_measured_stays():
    vectors = np.random.default_rng(5).normal(size=(4, 3, 7)) * [[1], [1], [1e-3]]
    assert len(measured_directions(modes_of(vectors))[0].dofs) == 12


def test_few_modes_cannot_show_that_a_node_is_confined():
    vectors = np.random.default_rng(5).normal(size=(4, 3, 2))
    assert len(measured_directions(modes_of(vectors))[0].dofs) == 12


def test_one_phase_for_all_shows_no_more_than_real_modes():
    vectors = np.random.default_rng(5).normal(size=(4, 3, 2)) * np.array([1 + 1j, 1 - 0.3j])
    assert len(measured_directions(modes_of(vectors))[0].dofs) == 12


def test_the_same_mode_again_shows_nothing_new():
    vectors = np.tile(np.random.default_rng(5).normal(size=(4, 3, 2)), (1, 1, 3))
    assert len(measured_directions(modes_of(vectors))[0].dofs) == 12


def test_axes_of_local_frames_are_honoured():
    turn = Rotation.random(5, random_state=1).as_matrix()
    along = np.zeros((5, 3, 6))
    along[:, 1] = np.random.default_rng(1).normal(size=(5, 6))
    modes = modes_of(along, axis=np.swapaxes(turn, 1, 2).reshape(15, 3))
    kept, _ = measured_directions(modes)
    np.testing.assert_allclose(kept.dofs.axis, turn[:, :, 1], atol=1e-12)
    np.testing.assert_array_equal(kept.dofs.component, 2)


def test_skewed_sensors_at_one_node_are_left_alone():
    axis = [[1.0, 0, 0], [0.8, 0.6, 0.0]]
    shapes = np.tile([1.0, 0.8], (8, 1)).T * np.arange(1, 9)
    modes = Modes(np.arange(1.0, 9), shapes, Dofs([1, 1], [1, 2], axis))
    np.testing.assert_array_equal(measured_directions(modes)[0].shapes, shapes)


def test_rotations_are_kept_where_they_move():
    vectors = np.zeros((2, 6, 5))
    vectors[:, 2] = 1.0 + np.arange(5)
    vectors[1, 4] = 0.01
    modes = modes_of(vectors)
    assert measured_directions(modes)[0].dofs.labels == ["1:Z", "2:Z", "2:RY"]


def test_a_node_that_never_moves_is_left_out_and_named():
    vectors = np.random.default_rng(5).normal(size=(4, 3, 7))
    vectors[2] = 0.0
    kept, warnings = measured_directions(modes_of(vectors))
    assert set(kept.dofs.node) == {1, 2, 4}
    assert warnings == ("1 test node(s) do not move in any mode and were left out: 3",)


def test_doing_it_twice_changes_nothing():
    once = measured_directions(modes_of(spanned(9, 8, directions(18).reshape(9, 2, 3))))[0]
    twice = measured_directions(once)[0]
    np.testing.assert_allclose(twice.shapes, once.shapes, atol=1e-12)
    np.testing.assert_allclose(twice.dofs.axis, once.dofs.axis, atol=1e-12)
    assert len(once.dofs) == 18
