import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from trueup.core.discovery.sensor_faults.misalignment import (
    about,
    anyhow,
    maps_of,
    rotation,
    tilted,
)

MOTION = np.random.default_rng(0).normal(size=(12, 3))
SIGMA = 0.02


def skew(v):
    return np.cross(v, np.eye(3)).T


def likelihood(axes, turned):
    """Log likelihood of maps where sensors along `axes` were turned by a rotation vector."""
    read = MOTION @ rotation(np.asarray(turned)) @ axes.T

    def of(maps):
        k = len(axes)
        off = read - np.einsum("gkx,mx->gmk", maps[:, :, k:], MOTION)
        return -0.5 * np.sum(off**2, axis=(1, 2)) / SIGMA**2

    return of


@pytest.mark.parametrize("vector", [[0.3, -1.0, 0.4], [0.0, 0.0, 0.0], [0.0, 3.0, 0.0]])
def test_a_rotation_is_the_exponential_of_its_vector(vector):
    Q = rotation(np.array(vector))
    np.testing.assert_allclose(Q, expm(skew(vector)), atol=1e-12)
    np.testing.assert_allclose(Rotation.from_matrix(Q).as_rotvec(), vector, atol=1e-9)


def test_what_turned_sensors_read_is_the_motion_along_turned_axes():
    Q = rotation(np.array([0.2, 0.5, -0.3]))
    axes = np.eye(3)[[0, 2]]
    (seen,) = maps_of(axes, Q[None])
    np.testing.assert_allclose(seen[:, :2], 0.0)
    np.testing.assert_allclose(seen[:, 2:], (Q @ axes.T).T)


@pytest.mark.parametrize("degrees", [-150.0, 33.0, 178.0])
def test_the_angle_about_an_axis_is_found(degrees):
    turned = np.radians(degrees) * np.eye(3)[2]
    _, vector, spread = about(np.eye(3), np.eye(3)[2], likelihood(np.eye(3), turned))
    np.testing.assert_allclose(rotation(vector), rotation(turned), atol=4.0 * spread)
    assert np.degrees(spread) < 1.0


def test_any_rotation_is_found_from_nearby_and_its_evidence_is_the_integral():
    """Laplace against the closed form for small errors: (2π)^1.5 / √det H / 8π²."""
    turned = np.array([0.4, -0.2, 0.7])
    start = rotation(turned + 0.05)
    found = anyhow(np.eye(3), start, likelihood(np.eye(3), turned))
    assert found is not None
    log, vector, spread = found
    np.testing.assert_allclose(vector, turned, atol=1e-3)
    H = sum(skew(u).T @ skew(u) for u in MOTION) / SIGMA**2
    exact = 1.5 * np.log(2.0 * np.pi) - 0.5 * np.linalg.slogdet(H)[1] - np.log(8.0 * np.pi**2)
    assert log == pytest.approx(exact, abs=0.05)
    assert 0.0 < spread < 0.02


def test_readings_that_leave_a_rotation_open_give_none():
    assert anyhow(np.eye(3), np.eye(3), lambda maps: np.zeros(len(maps))) is None


def test_a_lone_sensor_turned_away_is_found():
    axis = np.eye(3)[2]
    turned = np.radians(40.0) * np.eye(3)[0]
    _, vector, spread = tilted(axis, likelihood(axis[None], turned))
    seen, true = rotation(vector) @ axis, rotation(turned) @ axis
    assert np.degrees(np.arccos(seen @ true)) < 5.0
    assert abs(np.linalg.norm(vector) - np.radians(40.0)) < 3.0 * spread
