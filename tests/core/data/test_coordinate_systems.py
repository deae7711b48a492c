"""Coordinate systems: positions, and directions as derivatives of positions."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from trueup.core.data.coordinate_systems import BASIC, frame_of_points
from trueup.core.errors import InputError

A, B, C = np.array([1.0, 2.0, 3.0]), np.array([0.0, 1.0, 5.0]), np.array([4.0, 2.0, 2.0])


@given(
    st.floats(0.5, 10.0),
    st.floats(10.0, 170.0),
    st.floats(-170.0, 170.0),
    st.sampled_from(["rectangular", "cylindrical", "spherical"]),
)
def test_directions_are_those_in_which_positions_move(a, b, c, kind):
    frame = frame_of_points(kind, A, B, C)
    at = np.array([[a, b, c]])
    x = frame.positions(at)
    R = frame.directions(x)[0]
    h = 1e-3
    for k in range(3):
        step = frame.positions(at + h * np.eye(3)[k]) - frame.positions(at - h * np.eye(3)[k])
        step = step[0] / np.linalg.norm(step)
        np.testing.assert_allclose(R[k], step, atol=1e-7)
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(R), 1.0)


@pytest.mark.parametrize("kind", ["cylindrical", "spherical"])
def test_on_the_axis_the_angle_counts_as_zero(kind):
    frame = frame_of_points(kind, A, B, C)
    R = frame.directions(A + 2.0 * (B - A))[0]
    np.testing.assert_allclose(np.abs(R @ frame.axes.T).max(axis=1), 1.0)
    np.testing.assert_allclose(np.abs(R @ R.T), np.eye(3), atol=1e-12)


def test_the_z_axis_points_to_b_and_c_lies_in_the_xz_plane():
    frame = frame_of_points("rectangular", A, B, C)
    local = (np.vstack([A, B, C]) - frame.origin) @ frame.axes.T
    np.testing.assert_allclose(local[1, :2], 0.0, atol=1e-12)
    assert local[1, 2] > 0.0
    assert local[2, 0] > 0.0
    assert local[2, 1] == pytest.approx(0.0, abs=1e-12)


def test_points_in_a_line_define_nothing():
    with pytest.raises(InputError, match="in a line"):
        frame_of_points("rectangular", A, B, 2.0 * B - A)


def test_basic_is_basic():
    assert BASIC.is_basic
    np.testing.assert_array_equal(BASIC.positions(np.array([[1.0, 2.0, 3.0]])), [[1.0, 2.0, 3.0]])
