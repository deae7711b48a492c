"""What sensors read of an analysis shape: exact where it can be, accurate where it cannot."""

import time

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.spatial.transform import Rotation

from trueup.core.dofs import Dofs
from trueup.core.errors import InputError
from trueup.core.geometry import Geometry
from trueup.core.observation import observe
from trueup.core.transform import Transform

RNG = np.random.default_rng(7)


def geometry(xyz, **elements):
    xyz = np.asarray(xyz, float)
    return Geometry(np.arange(1, len(xyz) + 1), xyz, "mm", elements)


def six_a_grid(geo):
    n = len(geo.ids)
    return Dofs(np.repeat(geo.ids, 6), np.tile(np.arange(1, 7), n))


def triaxial(geo):
    n = len(geo.ids)
    return Dofs(np.repeat(geo.ids, 3), np.tile([1, 2, 3], n))


def plate(nx=6, ny=4, jitter=0.25, kind="quad", lx=6.0, ly=4.0):
    """A flat mesh with inner grids pushed about in its plane."""
    x, y = np.meshgrid(np.linspace(0, lx, nx + 1), np.linspace(0, ly, ny + 1), indexing="ij")
    inner = (x > 0) & (x < lx) & (y > 0) & (y < ly)
    rng = np.random.default_rng(3)
    x = x + jitter * inner * rng.uniform(-1, 1, x.shape)
    y = y + jitter * inner * rng.uniform(-1, 1, x.shape)
    k = np.arange((nx + 1) * (ny + 1)).reshape(nx + 1, ny + 1)
    quads = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], axis=-1).reshape(-1, 4)
    xyz = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    if kind == "tria":
        return geometry(xyz, tria=np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))
    return geometry(xyz, quad=quads)


def box(n=3):
    k = np.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)
    a, b = k[:-1, :-1, :-1].ravel(), k[:-1, :-1, 1:].ravel()
    base = np.stack([a, a + (n + 1) ** 2, a + (n + 1) ** 2 + n + 1, a + n + 1], axis=1)
    g = np.arange(n + 1.0)
    xyz = np.stack(np.meshgrid(g, g, g, indexing="ij"), axis=-1).reshape(-1, 3)
    return geometry(xyz, hexa=np.concatenate([base, base + (b - a)[:, None]], axis=1))


def beam():
    turn = Rotation.random(random_state=4).as_matrix()
    xyz = np.array([[0, 0, 0], [2, 0, 0], [5, 0, 0], [5, 0, 3]]) @ turn.T
    return geometry(xyz, line=np.array([[0, 1], [1, 2], [2, 3]]))


def sensors_on(geo, rng, n=40, off=0.0):
    """Random points on the elements of a geometry, pushed off by up to `off` in any direction."""
    corners = np.concatenate(list(geo.elements.values()))
    weights = rng.dirichlet(np.ones(corners.shape[1]), n)
    xyz = np.einsum("nc,ncx->nx", weights, geo.xyz[rng.choice(corners, n)])
    return geometry(xyz + off * rng.uniform(-1, 1, xyz.shape))


def read(obs, geo, displacement, rotation=None):
    """C @ shape for fields given as functions of position, as (n_node, 3)."""
    values = np.zeros((len(geo.ids), 6))
    values[:, :3] = displacement(geo.xyz)
    if rotation is not None:
        values[:, 3:] = rotation(geo.xyz)
    return (obs.matrix @ values.ravel()).reshape(-1, 3)


MESHES = {
    "quads": plate(),
    "trias": plate(kind="tria"),
    "solids": box(),
    "beams": beam(),
}


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


def test_sensors_read_along_their_own_axes_whatever_the_test_frame():
    geo = plate()
    turn = Rotation.random(random_state=2).as_matrix()
    transform = Transform(turn, np.array([3.0, -2.0, 9.0]), scale=1000.0)
    on_model = sensors_on(geo, np.random.default_rng(5))
    in_test_frame = (on_model.xyz - transform.translation) @ turn / 1000.0
    test = Geometry(np.arange(101, 141), in_test_frame, "m")
    axis = RNG.normal(size=(40, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    sensors = Dofs(test.ids, np.ones(40, int), axis @ turn)
    obs = observe(geo, six_a_grid(geo), test, sensors, transform)
    np.testing.assert_allclose(obs.sensors.axis, axis, atol=1e-12)
    np.testing.assert_allclose(obs.xyz, on_model.xyz, atol=1e-9)
    field = np.zeros((len(geo.ids), 6))
    field[:, :3] = [1.0, 2.0, 3.0]
    np.testing.assert_allclose(obs.matrix @ field.ravel(), axis @ [1, 2, 3], atol=1e-12)


def test_rotational_sensor_reads_the_rotation():
    geo = plate()
    test = sensors_on(geo, np.random.default_rng(5), n=5)
    sensors = Dofs(test.ids, [4, 5, 6, 4, 5])
    obs = observe(geo, six_a_grid(geo), test, sensors)
    turn = np.array([0.7, 0.2, -0.5])
    field = np.concatenate([np.cross(turn, geo.xyz), np.broadcast_to(turn, geo.xyz.shape)], axis=1)
    np.testing.assert_allclose(obs.matrix @ field.ravel(), turn[[0, 1, 2, 0, 1]], atol=1e-12)


def test_dofs_in_other_order_and_with_axes_of_their_own():
    geo = plate()
    test = sensors_on(geo, np.random.default_rng(5))
    plain = observe(geo, six_a_grid(geo), test, triaxial(test))
    turn = Rotation.random(random_state=8).as_matrix()
    dofs = six_a_grid(geo)
    order = np.random.default_rng(1).permutation(len(dofs))
    turned = Dofs(
        np.append(dofs.node[order], 999_999),  # a scalar point among them
        np.append(dofs.component[order], 0 + 1),
        np.vstack([dofs.axis[order] @ turn.T, [1, 0, 0]]),
    )
    obs = observe(geo, turned, test, triaxial(test))
    field = RNG.normal(size=(len(geo.ids), 6))
    in_turned = np.concatenate([field[:, :3] @ turn, field[:, 3:] @ turn], axis=1)
    values = np.append(in_turned.ravel()[order], 5.0)
    np.testing.assert_allclose(obs.matrix @ values, plain.matrix @ field.ravel(), atol=1e-12)


@pytest.mark.parametrize("form", [np.asarray, sp.csr_matrix], ids=["shapes", "expansion"])
def test_rotations_that_never_move_are_not_used(form):
    geo = plate()
    test = sensors_on(geo, np.random.default_rng(6))
    motion = np.zeros((len(geo.ids), 6))
    motion[:, :3] = 1.0
    field = geo.xyz[:, :1] * [0.0, 0.0, 1.0]
    dofs = six_a_grid(geo)
    obs = observe(geo, dofs, test, triaxial(test), motion=form(motion.reshape(-1, 1)))
    assert obs.matrix[:, dofs.component > 3].nnz == 0
    values = np.concatenate([field, 0 * field], axis=1)
    got = (obs.matrix @ values.ravel()).reshape(-1, 3)
    np.testing.assert_allclose(got, test.xyz[:, :1] * [0.0, 0.0, 1.0], atol=1e-12)


def test_clamped_grids_keep_their_zero_rotation():
    geo = geometry([[0, 0, 0], [2, 0, 0]], line=np.array([[0, 1]]))
    test = geometry([[1, 0, 0]])
    motion = np.zeros((12, 1))
    motion[6:] = 1.0
    obs = observe(geo, six_a_grid(geo), test, triaxial(test), motion=motion)
    tip = np.zeros(12)
    tip[[7, 11]] = 4.0, 4.0  # v = x^2
    np.testing.assert_allclose(obs.matrix @ tip, [0, 1, 0], atol=1e-12)


def test_sensor_at_the_end_of_an_undrawn_rigid_element_uses_its_grid():
    geo = Geometry(
        [*range(1, 36), 77],
        np.vstack([plate().xyz, [3.0, 2.0, 1.5]]),
        "mm",
        {"quad": plate().elements["quad"]},
    )
    test = geometry([[3.01, 2.0, 1.5]])
    dofs = six_a_grid(geo)
    obs = observe(geo, dofs, test, triaxial(test), motion=np.ones((len(dofs), 1)), tolerance=2.0)
    assert obs.distance[0] == pytest.approx(0.01)
    assert set(dofs.node[obs.matrix.indices]) == {77}
    assert set(observe(geo, dofs, test, triaxial(test), tolerance=2.0).nearest_grid) != {77}


def test_grids_without_results_are_passed_over():
    geo = plate()
    dofs = six_a_grid(geo)
    without = dofs.take(dofs.node != geo.ids[12])
    test = sensors_on(geo, np.random.default_rng(5))
    obs = observe(geo, without, test, triaxial(test), tolerance=2.0)
    assert geo.ids[12] not in obs.nearest_grid
    shift = (without.axis @ [1.0, 2.0, 3.0]) * (without.component < 4)
    np.testing.assert_allclose(
        (obs.matrix @ shift).reshape(-1, 3), np.tile([1.0, 2.0, 3.0], (40, 1)), atol=1e-12
    )


def test_nearest_grid_and_distance():
    geo = plate(jitter=0.0)
    test = geometry([[2.1, 3.2, 0.05]])
    obs = observe(geo, six_a_grid(geo), test, triaxial(test))
    assert list(obs.nearest_grid) == [geo.ids[2 * 5 + 3]] * 3
    np.testing.assert_allclose(obs.distance, 0.05)


def test_sensor_beyond_the_tolerance_is_listed_and_marked():
    geo = plate()
    xyz = sensors_on(geo, np.random.default_rng(5), n=9).xyz.copy()
    test = geometry(np.vstack([xyz, [3, 2, 0.9]]))
    obs = observe(geo, six_a_grid(geo), test, triaxial(test))
    assert list(np.flatnonzero(~obs.within)) == [27, 28, 29]
    assert len(obs.warnings) == 1
    assert "1 test node(s)" in obs.warnings[0]
    assert "10 (0.9 off, " in obs.warnings[0]
    kept = obs.take(obs.within)
    assert kept.matrix.shape == (27, 6 * 35)
    assert len(kept) == len(kept.sensors) == 27
    assert observe(geo, six_a_grid(geo), test, triaxial(test), tolerance=1.0).within.all()


def test_test_off_the_model_is_refused_with_both_boxes():
    geo = plate()
    test = geometry(sensors_on(geo, np.random.default_rng(5)).xyz * 1000)
    with pytest.raises(InputError, match=r"lie on the model.*check the length units.*frame"):
        observe(geo, six_a_grid(geo), test, triaxial(test))


def test_measured_node_without_position_is_refused():
    geo = plate()
    test = sensors_on(geo, np.random.default_rng(5))
    with pytest.raises(InputError, match="measured node 4711"):
        observe(geo, six_a_grid(geo), test, Dofs([4711], [1]))


def test_permuting_sensors_permutes_rows():
    geo = plate()
    test = sensors_on(geo, np.random.default_rng(5))
    order = np.random.default_rng(2).permutation(120)
    sensors = triaxial(test)
    a = observe(geo, six_a_grid(geo), test, sensors)
    b = observe(geo, six_a_grid(geo), test, sensors.take(order))
    np.testing.assert_array_equal(a.matrix[order].toarray(), b.matrix.toarray())
    assert abs(a.matrix[order] - a.matrix).max() > 0.1


@pytest.mark.slow
def test_a_million_grids_take_seconds():
    n = 1000
    geo = plate(n, n, jitter=0.0, lx=1000.0, ly=1000.0)
    xyz = np.random.default_rng(3).uniform([0, 0, 0], [1000, 1000, 0.2], (500, 3))
    test = geometry(xyz)
    start = time.perf_counter()
    obs = observe(geo, six_a_grid(geo), test, triaxial(test))
    assert time.perf_counter() - start < 20.0
    assert obs.within.all()
