"""The test frame is kept where it agrees and found where it does not."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.core.placing import (
    angle_deg,
    bracket,
    cylinder,
    error_of,
    geometry,
    is_identity,
    measured,
    panel,
    points_on,
    sensors_of_panel,
)

from trueup.core.data.dofs import Dofs
from trueup.core.data.modes import Modes
from trueup.core.errors import InputError
from trueup.core.registration.alignment import align
from trueup.core.sensors.rigid_transform import Transform
from trueup.core.sensors.sensor_map import observe

# ------------------------------------------------------------------ frames that agree


@pytest.mark.parametrize("make", [panel, cylinder, bracket])
def test_frame_that_agrees_is_kept_exactly(make):
    geo = make()
    test = measured(points_on(geo, 40), np.eye(3), np.zeros(3))
    found = align(geo, test)
    assert found.method == "as it is"
    assert is_identity(found)
    assert found.scale == pytest.approx(1000.0)
    assert found.ambiguity == ""
    assert found.decided
    assert found.warnings == ()
    assert 0.2 < found.rms < 1.5


def test_frame_that_agrees_is_kept_although_a_few_nodes_hang_in_the_air():
    geo = panel()
    xyz = points_on(geo, 40)
    xyz[:3, 2] += 200.0
    assert is_identity(align(geo, measured(xyz, np.eye(3), np.zeros(3))))


@pytest.mark.parametrize("moved", [0.0, 1e4])
def test_a_single_sensor_is_laid_on_the_model_in_any_frame(moved):
    geo = bracket()
    point = points_on(geo, 40)[:1]
    found = align(geo, measured(point + moved, np.eye(3), np.zeros(3)))
    assert found.rms < 1.5


def test_a_small_shift_is_left_but_said():
    geo, shift = bracket(), np.array([9.0, 4.0, 0.0])
    test = measured(points_on(geo, 60) + shift, np.eye(3), np.zeros(3), noise=0.2)
    found = align(geo, test)
    assert is_identity(found)
    assert "the frame was left as it is" in found.warnings[0]


# ------------------------------------------------------------------ frames that differ


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in range(1, 8))]
)
def test_unlike_frame_is_recovered_from_geometry_alone(seed):
    geo = bracket()
    xyz = points_on(geo, 60)
    frame = Rotation.random(random_state=seed).as_matrix()
    found = align(geo, measured(xyz, frame), seed=seed)
    assert found.method == "fitted"
    assert found.decided
    assert found.ambiguity == ""
    assert error_of(found, measured(xyz, frame), xyz) < 2.5
    np.testing.assert_allclose(found.rotation, frame.T, atol=0.01)
    assert np.linalg.det(found.rotation) == pytest.approx(1.0)
    assert 0.3 < found.rms < 1.5


def test_exact_positions_are_recovered_to_rounding():
    geo = bracket()
    xyz = points_on(geo, 60)
    test = measured(xyz, noise=0.0)
    assert error_of(align(geo, test), test, xyz) < 1e-3


@pytest.mark.parametrize("seed", range(3))
def test_a_plane_is_slid_where_few_points_on_a_fin_say(seed):
    """All but two points of the test lie on the wing, exactly; only those two fix it spanwise."""
    x, y = np.meshgrid(np.linspace(0, 400, 9), np.linspace(-700, 900, 13), indexing="ij")
    wing = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)
    fin = np.array([[0, 0, 0], [300, 0, 0], [300, 0, 350], [120, 0, 350.0]])
    rows = (np.arange(8)[:, None] * 13 + np.arange(12)).ravel()
    quads = np.vstack([rows[:, None] + [0, 13, 14, 1], [117, 118, 119, 120]])
    geo = geometry(np.vstack([wing, fin]), quad=quads)
    rng = np.random.default_rng(seed)
    inner = np.column_stack([rng.uniform(20, 380, 40), rng.uniform(-650, 850, 40), np.zeros(40)])
    xyz = np.vstack([inner, [[200, 0, 300.0], [250, 0, 180.0]], wing[[0, 12, 104, 116]]])
    test = measured(xyz, Rotation.random(random_state=seed).as_matrix(), noise=0.0)
    assert error_of(align(geo, test), test, xyz) < 1e-3


def test_nodes_that_hang_in_the_air_do_not_pull_the_fit():
    geo = bracket()
    xyz = points_on(geo, 60)
    xyz[::10] += [120.0, -90.0, 60.0]
    assert error_of(align(geo, measured(xyz)), measured(xyz), xyz) < 4.0


def test_points_of_solids_are_laid_on_their_faces():
    k = np.arange(5 * 4 * 3).reshape(5, 4, 3)
    a, b = k[:-1, :-1, :-1].ravel(), k[:-1, :-1, 1:].ravel()
    base = np.stack([a, a + 12, a + 15, a + 3], axis=1)
    hexa = np.concatenate([base, base + (b - a)[:, None]], axis=1)
    x = np.stack(
        np.meshgrid([0, 100, 220, 310, 400.0], [0, 80, 150, 230.0], [0, 50, 120.0], indexing="ij"),
        axis=-1,
    ).reshape(-1, 3)
    keep = ~((a % 12 > 5) & (a > 23))  # a notch: one position only
    geo = geometry(x, hexa=hexa[keep])
    from trueup.core.sensors.outer_surface import surface_of

    xyz = surface_of(geo).samples(70)[0]
    found = align(geo, measured(xyz, noise=0.3))
    assert error_of(found, measured(xyz, noise=0.3), xyz) < 1.5


def test_mirror_image_is_not_a_fit():
    geo = bracket()
    xyz = points_on(geo, 60)
    found = align(geo, measured(xyz * [1, 1, -1]))
    assert np.linalg.det(found.rotation) == pytest.approx(1.0)
    assert found.rms > 5.0
    assert any("mirrored, 100% of the nodes would lie on it" in w for w in found.warnings)


def test_different_structure_is_refused():
    with pytest.raises(InputError, match="does not fit on the model in any position"):
        align(panel(), measured(2.0 * points_on(cylinder(), 60)))


def test_same_seed_same_answer():
    geo = bracket()
    test = measured(points_on(geo, 60))
    first, second = align(geo, test, seed=3), align(geo, test, seed=3)
    np.testing.assert_array_equal(first.rotation, second.rotation)
    np.testing.assert_array_equal(first.translation, second.translation)


# ------------------------------------------------------------------ what the answer is


def test_alignment_is_a_transform_for_observe():
    geo = bracket()
    xyz = points_on(geo, 60)
    test = measured(xyz)
    found = align(geo, test)
    dofs = Dofs(np.repeat(geo.ids, 3), np.tile([1, 2, 3], len(geo.ids)))
    sensors = Dofs(np.repeat(test.ids, 3), np.tile([1, 2, 3], 60))
    obs = observe(geo, dofs, test, sensors, found)
    assert obs.within.mean() > 0.95
    np.testing.assert_allclose(obs.xyz[::3], found.apply(test.xyz))
    rigid = np.tile([1.0, 2.0, 3.0], len(geo.ids))
    got = obs.matrix @ rigid
    want = (sensors.axis @ found.rotation.T) @ [1.0, 2.0, 3.0]
    np.testing.assert_allclose(got, want, atol=1e-9)


def test_test_already_in_deck_units_needs_no_scale():
    geo = bracket()
    test = measured(points_on(geo, 60))
    in_mm = replace(test, xyz=1000 * test.xyz, length_unit="mm")
    a, b = align(geo, test), align(geo, in_mm)
    assert (a.scale, b.scale) == (1000.0, 1.0)
    np.testing.assert_allclose(a.apply(test.xyz), b.apply(in_mm.xyz), atol=1e-6)


def test_only_measured_nodes_are_laid_on_the_model():
    geo = panel()
    xyz = np.vstack([sensors_of_panel(), [[4000.0, 3000, 2000]] * 30])
    test = measured(xyz, np.eye(3), np.zeros(3))
    shapes = np.ones((25, 1))
    modes = Modes([5.0], shapes, Dofs(test.ids[:25], np.full(25, 3)))
    assert is_identity(align(geo, test, None, modes))
    with pytest.raises(InputError, match="does not fit"):
        align(geo, test)


def test_measured_node_without_position_is_refused():
    geo = panel()
    test = measured(sensors_of_panel())
    modes = Modes([5.0], np.ones((1, 1)), Dofs([4711], [3]))
    with pytest.raises(InputError, match="measured node 4711"):
        align(geo, test, None, modes)


@pytest.mark.parametrize("bad", [np.diag([1.0, 1.0, -1.0]), 2 * np.eye(3), np.zeros((3, 3))])
def test_transform_takes_proper_rotations_only(bad):
    with pytest.raises(InputError, match="mirror images are not allowed"):
        Transform(bad, np.zeros(3))


def test_transform_applies_scale_then_rotation_then_translation():
    turn = Rotation.from_euler("z", 90, degrees=True).as_matrix()
    move = Transform(turn, np.array([10.0, 0, 0]), 1000.0)
    np.testing.assert_allclose(move.apply(np.array([[1.0, 0, 0]])), [[10, 1000, 0]], atol=1e-9)
    np.testing.assert_allclose(move.turn(np.array([[1.0, 0, 0]])), [[0, 1, 0]], atol=1e-12)
    assert angle_deg(move) == pytest.approx(90.0)
