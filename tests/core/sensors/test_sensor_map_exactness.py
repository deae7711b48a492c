"""What sensors between grids must read exactly: rigid motion, patches, bending."""

import numpy as np
import pytest
from tests.core.sensing import MESHES, geometry, plate, read, sensors_on, six_a_grid, triaxial

from trueup.core.sensors.sensor_map import observe


@pytest.mark.parametrize("name", MESHES)
def test_rigid_body_motion_is_exact_for_sensors_that_stand_off(name):
    geo = MESHES[name]
    test = sensors_on(geo, np.random.default_rng(5), off=0.1)
    obs = observe(geo, six_a_grid(geo), test, triaxial(test), tolerance=1.0)
    shift, turn = np.array([0.3, -1.0, 2.0]), np.array([0.7, 0.2, -0.5])

    def displacement(x):
        return shift + np.cross(turn, x)

    got = read(obs, geo, displacement, lambda x: np.broadcast_to(turn, x.shape))
    np.testing.assert_allclose(got, displacement(test.xyz), atol=1e-12)


@pytest.mark.parametrize("name", ["quads", "trias"])
def test_rigid_body_motion_is_exact_on_faces_without_rotations(name):
    geo = MESHES[name]
    test = sensors_on(geo, np.random.default_rng(5), off=0.1)
    dofs = triaxial(geo)
    obs = observe(geo, dofs, test, triaxial(test), tolerance=1.0)
    turn = np.array([0.7, 0.2, -0.5])
    got = (obs.matrix @ np.cross(turn, geo.xyz).ravel()).reshape(-1, 3)
    np.testing.assert_allclose(got, np.cross(turn, test.xyz), atol=1e-12)


@pytest.mark.parametrize("name", ["quads", "trias", "solids"])
def test_patch_linear_displacements_are_exact(name):
    geo = MESHES[name]
    test = sensors_on(geo, np.random.default_rng(6))
    if name == "solids":  # sensors sit on the outside
        test = geometry(np.where(np.arange(3) == 2, 3.0, test.xyz))
    obs = observe(geo, six_a_grid(geo), test, triaxial(test))
    gradient = np.array([[0.4, 0.7, 0.0], [-0.2, 0.5, 0.0], [0.0, 0.0, 0.0]])
    got = read(obs, geo, lambda x: x @ gradient.T)
    np.testing.assert_allclose(got, test.xyz @ gradient.T, atol=1e-12)


@pytest.mark.parametrize("name", ["quads", "trias"])
def test_patch_linear_displacements_in_any_direction_are_exact_without_rotations(name):
    geo = MESHES[name]
    test = sensors_on(geo, np.random.default_rng(6))
    gradient = np.random.default_rng(0).normal(size=(3, 3))
    obs = observe(geo, triaxial(geo), test, triaxial(test))
    got = (obs.matrix @ (geo.xyz @ gradient.T).ravel()).reshape(-1, 3)
    np.testing.assert_allclose(got, test.xyz @ gradient.T, atol=1e-12)


@pytest.mark.parametrize("name", ["rectangles", "trias"])
def test_constant_curvature_of_a_plate_is_exact_between_grids(name):
    geo = MESHES["trias"] if name == "trias" else plate(jitter=0.0)
    test = sensors_on(geo, np.random.default_rng(8))
    obs = observe(geo, six_a_grid(geo), test, triaxial(test))
    a, b, c = 0.3, -0.5, 0.2

    def bending(x):
        w = a * x[:, 0] ** 2 + b * x[:, 1] ** 2 + c * x[:, 0] * x[:, 1]
        return np.stack([0 * w, 0 * w, w], axis=1)

    def turning(x):  # theta = (dw/dy, -dw/dx)
        wx = 2 * a * x[:, 0] + c * x[:, 1]
        wy = 2 * b * x[:, 1] + c * x[:, 0]
        return np.stack([wy, -wx, 0 * wx], axis=1)

    got = read(obs, geo, bending, turning)
    np.testing.assert_allclose(got, bending(test.xyz), atol=1e-12)


def test_bending_wave_on_a_coarse_plate_is_read_to_third_order():
    def error(n):
        geo = plate(n, n, jitter=0.0, lx=1.0, ly=1.0)
        test = sensors_on(geo, np.random.default_rng(9), n=400)
        k = 2 * np.pi
        obs = observe(geo, six_a_grid(geo), test, triaxial(test))
        bare = observe(geo, triaxial(geo), test, triaxial(test))

        def w(x):
            wave = np.sin(k * x[:, 0]) * np.cos(k * x[:, 1])
            return np.stack([0 * wave, 0 * wave, wave], axis=1)

        def theta(x):
            wx = k * np.cos(k * x[:, 0]) * np.cos(k * x[:, 1])
            wy = -k * np.sin(k * x[:, 0]) * np.sin(k * x[:, 1])
            return np.stack([wy, -wx, 0 * wx], axis=1)

        linked = np.abs(read(obs, geo, w, theta) - w(test.xyz)).max()
        linear = np.abs((bare.matrix @ w(geo.xyz).ravel()).reshape(-1, 3) - w(test.xyz)).max()
        return linked, linear

    coarse, fine = error(8), error(16)
    assert coarse[0] < 0.012  # eight elements a wave
    assert coarse[1] > 0.1  # bilinear interpolation would lose ten per cent
    assert coarse[0] / fine[0] > 6.0


def test_transverse_shear_does_not_spoil_the_reading_of_a_plate():
    geo = plate(jitter=0.0)
    test = sensors_on(geo, np.random.default_rng(8))
    obs = observe(geo, six_a_grid(geo), test, triaxial(test))

    def shear(x):  # w = 0.3 x - 0.1 y, sections do not turn
        w = 0.3 * x[:, 0] - 0.1 * x[:, 1]
        return np.stack([0 * w, 0 * w, w], axis=1)

    np.testing.assert_allclose(read(obs, geo, shear), shear(test.xyz), atol=1e-12)


def test_cubic_bending_of_a_beam_is_exact_between_grids():
    geo = geometry([[0, 0, 0], [1, 0, 0], [3, 0, 0]], line=np.array([[0, 1], [1, 2]]))
    test = geometry([[x, 0, 0] for x in np.linspace(0, 3, 31)])
    obs = observe(geo, six_a_grid(geo), test, triaxial(test))

    def v(x):
        s = x[:, 0]
        return np.stack([0.2 * s, s**3 - 2 * s**2, 0.5 * s**3 + s], axis=1)

    def theta(x):  # theta_z = dv/dx, theta_y = -dw/dx
        s = x[:, 0]
        return np.stack([0 * s, -(1.5 * s**2 + 1), 3 * s**2 - 4 * s], axis=1)

    np.testing.assert_allclose(read(obs, geo, v, theta), v(test.xyz), atol=1e-12)


def cylinder(around=40, along=12, radius=1.0, height=2.0):
    phi = 2 * np.pi * np.arange(around) / around
    z = np.linspace(0, height, along + 1)
    xyz = [[radius * np.cos(a), radius * np.sin(a), h] for h in z for a in phi]
    i, k = np.meshgrid(np.arange(around), np.arange(along))
    j = (i + 1) % around
    quads = np.stack([k * around + i, k * around + j, (k + 1) * around + j, (k + 1) * around + i])
    return geometry(xyz, quad=quads.reshape(4, -1).T)


def test_ovalling_of_a_cylinder_is_read_on_the_true_radius_though_facets_lie_inside():
    n = 4  # ten elements a wave; inextensional: v = -(1/n) w', theta = (v - w') / R

    def fields(x):
        phi = np.arctan2(x[:, 1], x[:, 0])
        radial = np.stack([np.cos(phi), np.sin(phi), 0 * phi], axis=1)
        hoop = np.stack([-np.sin(phi), np.cos(phi), 0 * phi], axis=1)
        w, v = np.cos(n * phi), -np.sin(n * phi) / n
        theta = v + n * np.sin(n * phi)
        return w[:, None] * radial + v[:, None] * hoop, theta[:, None] * [0, 0, 1]

    geo = cylinder()
    rng = np.random.default_rng(11)
    phi, z = rng.uniform(0, 2 * np.pi, 100), rng.uniform(0, 2, 100)
    test = geometry(np.stack([np.cos(phi), np.sin(phi), z], axis=1))
    obs = observe(geo, six_a_grid(geo), test, triaxial(test))
    got = read(obs, geo, lambda x: fields(x)[0], lambda x: fields(x)[1])
    error = np.linalg.norm(got - fields(test.xyz)[0], axis=1).max()
    assert error < 0.006
    bare = observe(geo, triaxial(geo), test, triaxial(test))
    linear = (bare.matrix @ fields(geo.xyz)[0].ravel()).reshape(-1, 3)
    assert error < 0.15 * np.linalg.norm(linear - fields(test.xyz)[0], axis=1).max()
    assert obs.distance.max() == pytest.approx(1 - np.cos(np.pi / 40), rel=0.02)
