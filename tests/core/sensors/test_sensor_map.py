"""Sensors read along their own axes, wherever they stand on a model."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.spatial.transform import Rotation
from tests.core.sensing import RNG, geometry, plate, sensors_on, six_a_grid, triaxial
from tests.work import calls_of, peak_of

from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.errors import InputError
from trueup.core.sensors.rigid_transform import Transform
from trueup.core.sensors.sensor_map import observe


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


def test_of_grids_in_one_place_the_one_of_the_same_number_is_read():
    geo = geometry(
        [[0, 0, 0], [2, 0, 0], [2, 0, 0], [5, 0, 0]], line=np.array([[0, 1], [2, 3]])
    )  # 2 and 3 are the sides of a joint
    test = geometry(geo.xyz[[0, 1, 2, 2]])
    dofs = six_a_grid(geo)
    obs = observe(geo, dofs, test, triaxial(test))
    assert list(obs.nearest_grid[::3][:3]) == [1, 2, 3]
    reading = obs.matrix @ np.repeat([1.0, 2.0, 3.0, 4.0], 6)
    np.testing.assert_allclose(reading.reshape(4, 3)[:3, 0], [1.0, 2.0, 3.0], atol=1e-12)


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


def test_sensors_on_more_grids_take_no_more_calls_and_memory_in_proportion():
    def work(n):
        geo = plate(n, n, jitter=0.0, lx=1000.0, ly=1000.0)
        xyz = np.random.default_rng(3).uniform([0, 0, 0], [1000, 1000, 0.2], (200, 3))
        test, dofs = geometry(xyz), six_a_grid(geo)
        assert observe(geo, dofs, test, triaxial(test)).within.all()
        return [of(lambda: observe(geo, dofs, test, triaxial(test))) for of in (calls_of, peak_of)]

    (calls, held), (more_calls, more_held) = work(50), work(200)
    assert more_calls < 1.5 * calls
    assert more_held < 18 * held
