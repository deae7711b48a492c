"""The test frame is kept where it agrees and found where it does not."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from trueup.core.alignment import align
from trueup.core.dofs import Dofs
from trueup.core.errors import InputError
from trueup.core.geometry import Geometry
from trueup.core.modes import Modes
from trueup.core.observation import observe
from trueup.core.transform import Transform

FRAME = Rotation.from_euler("xyz", [25.0, -40.0, 110.0], degrees=True).as_matrix()
FLIPS = [[90, 0, 0], [0, 0, 180], [180, 5, 90]]
SHIFT = np.array([0.3, -2.0, 0.7])


def geometry(xyz, unit="mm", **elements):
    xyz = np.asarray(xyz, float)
    return Geometry(np.arange(1, len(xyz) + 1), xyz, unit, elements)


def grid_of_quads(k):
    return np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], axis=-1).reshape(-1, 4)


def panel(nx=18, ny=12, lx=900.0, ly=600.0):
    x, y = np.meshgrid(np.linspace(0, lx, nx + 1), np.linspace(0, ly, ny + 1), indexing="ij")
    k = np.arange(x.size).reshape(x.shape)
    return geometry(np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), quad=grid_of_quads(k))


def cylinder(around=48, along=12, radius=300.0, height=700.0):
    phi = 2 * np.pi * np.arange(around) / around
    xyz = [
        [radius * np.cos(a), radius * np.sin(a), h]
        for h in np.linspace(0, height, along + 1)
        for a in phi
    ]
    k = np.arange(around * (along + 1)).reshape(along + 1, around)
    return geometry(xyz, quad=grid_of_quads(np.concatenate([k, k[:, :1]], axis=1)))


def bracket():
    """A lopsided frame of beams with a plate on it: fits in one position only."""
    joints = np.array([[0, 0, 0], [400, 0, 0], [400, 250, 0], [400, 250, 600], [90, 0, 330.0]])
    members = [(0, 1), (1, 2), (2, 3), (0, 4), (4, 3)]
    xyz, lines = [*joints], []
    for a, b in members:
        inner = [joints[a] + (joints[b] - joints[a]) * s for s in np.linspace(0, 1, 7)[1:-1]]
        rows = [a, *range(len(xyz), len(xyz) + 5), b]
        xyz += inner
        lines += list(pairwise(rows))
    n = len(xyz)
    x, y = np.meshgrid(np.linspace(0, 400, 6), np.linspace(0, 250, 5), indexing="ij")
    k = n + np.arange(30).reshape(6, 5)
    xyz = np.vstack([xyz, np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)])
    return geometry(xyz, line=np.array(lines), quad=grid_of_quads(k))


def points_on(geo, n, seed=0):
    """Random points on the elements, (n, 3), evenly by element."""
    rng = np.random.default_rng(seed)
    out = []
    for corners in geo.elements.values():
        share = max(8, n * len(corners) // sum(len(c) for c in geo.elements.values()))
        w = rng.dirichlet(np.ones(corners.shape[1]), share)
        out.append(np.einsum("nc,ncx->nx", w, geo.xyz[rng.choice(corners, share)]))
    return np.concatenate(out)[:n]


def measured(xyz, frame=FRAME, shift=SHIFT, noise=1.0, seed=1):
    """Test nodes in metres, in a frame of their own, with position noise in mm."""
    noisy = xyz + np.random.default_rng(seed).normal(0, noise, xyz.shape)
    return Geometry(np.arange(len(xyz)) + 101, noisy / 1000 @ frame.T + shift, "m")


def wavy(xyz, hz, waves, normals):
    """Modes of bending waves a(x) normal with rotations left out, on three dofs a grid."""
    shapes = np.stack([(w(xyz)[:, None] * normals(xyz)).ravel() for w in waves], axis=1)
    n = len(xyz)
    return Modes(hz, shapes, Dofs(np.repeat(np.arange(1, n + 1), 3), np.tile([1, 2, 3], n)))


def read_test(modes, geo, xyz, test, normals, frame=FRAME, noise=0.02, seed=2):
    """Read modes at positions `xyz` along the normals, with noise, as a test in its own frame."""
    axis = normals(xyz)
    clean = geometry(xyz)
    sensors = Dofs(clean.ids, np.full(len(xyz), 3), axis)
    values = observe(geo, modes.dofs, clean, sensors).matrix @ modes.shapes
    values = values + noise * values.std(axis=0) * np.random.default_rng(seed).normal(
        size=values.shape
    )
    return Modes(
        modes.frequencies_hz * 1.01, values, Dofs(test.ids, sensors.component, axis @ frame.T)
    )


def up(xyz):
    return np.tile([0.0, 0.0, 1.0], (len(xyz), 1))


def radial(xyz):
    flat = xyz * [1, 1, 0]
    return flat / np.linalg.norm(flat, axis=1)[:, None]


def plate_modes(geo, lopsided=0.15):
    """Waves on a panel with a heavier corner: no two of its four positions are alike."""

    def wave(i, j):
        def w(x):
            s, t = x[:, 0] / 900, x[:, 1] / 600
            warp = lopsided * s * t
            return np.cos(i * np.pi * (s + warp)) * np.cos(j * np.pi * (t - warp))

        return w

    pairs = [(1, 1), (2, 0), (0, 2), (2, 1), (1, 2), (3, 1), (2, 2), (3, 0)]
    return wavy(geo.xyz, [20, 32, 41, 55, 66, 83, 95, 110.0], [wave(*p) for p in pairs], up)


def duct_modes(geo, bump=0.0):
    """Pairs of circumferential waves; a bump at 50 degrees takes the symmetry away."""
    waves, hz = [], []
    for n in (2, 3, 4, 5):
        for phase in (0, np.pi / 2):

            def w(x, n=n, phase=phase):
                phi = np.arctan2(x[:, 1], x[:, 0])
                local = np.exp(-((((phi - 0.87 + np.pi) % (2 * np.pi) - np.pi) / 0.5) ** 2))
                return (1 + bump * local) * np.cos(n * phi + phase) * (1 + 0.3 * x[:, 2] / 700)

            waves.append(w)
            hz.append(30.0 * n**1.5)
    return wavy(geo.xyz, hz, waves, radial)


def error_of(found, test, xyz):
    """Root mean square distance of the moved test nodes from where they truly are."""
    return np.sqrt(((found.apply(test.xyz) - xyz) ** 2).sum(axis=1).mean())


# ------------------------------------------------------------------ frames that agree


@pytest.mark.parametrize("make", [panel, cylinder, bracket])
def test_frame_that_agrees_is_kept_exactly(make):
    geo = make()
    test = measured(points_on(geo, 40), np.eye(3), np.zeros(3))
    found = align(geo, test)
    assert found.method == "as it is"
    assert found.is_identity
    assert found.scale == pytest.approx(1000.0)
    assert found.ambiguity == ""
    assert found.decided
    assert found.warnings == ()
    assert 0.2 < found.rms < 1.5


def test_frame_that_agrees_is_kept_although_a_few_nodes_hang_in_the_air():
    geo = panel()
    xyz = points_on(geo, 40)
    xyz[:3, 2] += 200.0
    assert align(geo, measured(xyz, np.eye(3), np.zeros(3))).is_identity


def test_a_small_shift_is_left_but_said():
    geo, shift = bracket(), np.array([9.0, 4.0, 0.0])
    test = measured(points_on(geo, 60) + shift, np.eye(3), np.zeros(3), noise=0.2)
    found = align(geo, test)
    assert found.is_identity
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
    from trueup.core.surface import surface_of

    xyz = surface_of(geo).samples(70)[0]
    found = align(geo, measured(xyz, noise=0.3))
    assert error_of(found, measured(xyz, noise=0.3), xyz) < 1.5


def test_mirror_image_is_not_a_fit():
    geo = bracket()
    xyz = points_on(geo, 60)
    found = align(geo, measured(xyz * [1, 1, -1]))
    assert np.linalg.det(found.rotation) == pytest.approx(1.0)
    assert found.rms > 5.0
    assert any("not mirrored" in w for w in found.warnings)


def test_different_structure_is_refused():
    with pytest.raises(InputError, match="does not fit on the model in any position"):
        align(panel(), measured(2.0 * points_on(cylinder(), 60)))


def test_same_seed_same_answer():
    geo = bracket()
    test = measured(points_on(geo, 60))
    first, second = align(geo, test, seed=3), align(geo, test, seed=3)
    np.testing.assert_array_equal(first.rotation, second.rotation)
    np.testing.assert_array_equal(first.translation, second.translation)


# ------------------------------------------------------------------ symmetric geometry


def sensors_of_panel():
    x, y = np.meshgrid([60, 250, 430, 640, 830.0], [50, 180, 330, 440, 560.0], indexing="ij")
    jitter = np.random.default_rng(4).uniform(-30, 30, (25, 2))
    return np.column_stack([np.stack([x.ravel(), y.ravel()], axis=1) + jitter, np.zeros(25)])


@pytest.mark.parametrize(
    "euler",
    [[25, -40, 110], *(pytest.param(e, marks=pytest.mark.slow) for e in FLIPS)],
)
def test_panel_is_put_in_the_one_of_four_positions_that_correlates(euler):
    geo, xyz = panel(), sensors_of_panel()
    frame = Rotation.from_euler("xyz", euler, degrees=True).as_matrix()
    test = measured(xyz, frame)
    modes = plate_modes(geo)
    found = align(geo, test, modes, read_test(modes, geo, xyz, test, up, frame))
    assert found.decided
    assert "correlation decided" in found.ambiguity
    assert error_of(found, test, xyz) < 6.0
    assert len(found.candidates) >= 4
    scores = [c.score for c in found.candidates]
    assert scores[0] > 0.97
    assert scores[0] == max(scores)


def test_panel_without_shapes_stays_undecided_and_takes_the_smallest_rotation():
    geo, xyz = panel(), sensors_of_panel()
    frame = Rotation.from_euler("x", 40, degrees=True).as_matrix()
    found = align(geo, measured(xyz, frame))
    assert not found.decided
    assert "without shapes" in found.ambiguity
    assert found.warnings == (found.ambiguity,)
    assert found.angle_deg == pytest.approx(40.0, abs=2.0)
    assert found.rms < 1.5


def test_shapes_that_share_the_symmetry_leave_the_panel_undecided():
    geo, xyz = panel(), sensors_of_panel()
    frame = Rotation.from_euler("x", 40, degrees=True).as_matrix()
    test = measured(xyz, frame)
    modes = plate_modes(geo, lopsided=0.0)
    found = align(geo, test, modes, read_test(modes, geo, xyz, test, up, frame))
    assert not found.decided
    assert "4 of the positions" in found.ambiguity
    assert found.angle_deg == pytest.approx(40.0, abs=2.0)
    assert error_of(found, test, xyz) < 6.0  # where it slides, the shapes still place it


def test_panel_turned_in_its_own_place_is_found_out_by_its_shapes():
    geo, xyz = panel(), sensors_of_panel()
    half = Rotation.from_euler("z", 180, degrees=True).as_matrix()
    test = measured(xyz, half, np.array([0.9, 0.6, 0.0]), noise=0.5)  # lies on the model as it is
    modes = plate_modes(geo, lopsided=0.5)
    found = align(geo, test, modes, read_test(modes, geo, xyz, test, up, half))
    assert error_of(found, test, xyz) < 6.0
    assert "check the coordinate frame" in found.warnings[0]


def test_poor_shapes_do_not_move_a_frame_that_fits():
    geo, xyz = panel(), sensors_of_panel()
    test = measured(xyz, np.eye(3), np.zeros(3))
    modes = plate_modes(geo)
    noise = np.random.default_rng(0).normal(size=(25, 8))
    random = Modes(modes.frequencies_hz, noise, Dofs(test.ids, np.full(25, 3)))
    assert align(geo, test, modes, random).is_identity


def sensors_of_duct():
    rng = np.random.default_rng(8)
    phi, z = rng.uniform(0, 2 * np.pi, 60), rng.choice([0, 175, 350, 525, 700.0], 60)
    return np.stack([300 * np.cos(phi), 300 * np.sin(phi), z], axis=1)


def test_duct_is_turned_to_where_its_shapes_correlate():
    geo, xyz = cylinder(), sensors_of_duct()
    test = measured(xyz)
    modes = duct_modes(geo, bump=1.5)
    found = align(geo, test, modes, read_test(modes, geo, xyz, test, radial))
    assert "a turn about (0.00, 0.00, 1.00)" in found.ambiguity
    assert "correlation decided" in found.ambiguity
    assert error_of(found, test, xyz) < 10.0  # within two degrees


def test_duct_of_perfect_symmetry_is_turned_as_little_as_can_be_and_said():
    geo, xyz = cylinder(), sensors_of_duct()
    frame = Rotation.from_euler("x", 90, degrees=True).as_matrix()
    test = measured(xyz, frame)
    modes = duct_modes(geo)
    found = align(geo, test, modes, read_test(modes, geo, xyz, test, radial, frame))
    assert not found.decided
    assert "does not decide a turn about" in found.ambiguity
    assert found.angle_deg == pytest.approx(90.0, abs=2.0)
    assert found.rms < 2.5
    assert found.score > 0.95


def test_beam_with_sensors_on_one_line_is_placed_along_it_by_its_shapes():
    x = np.linspace(0, 1000.0, 41)
    geo = geometry(
        np.stack([x, 0 * x, 0 * x], axis=1), line=np.stack([np.arange(40), np.arange(1, 41)], 1)
    )
    xyz = np.array([[s, 0, 0] for s in (80, 210, 330, 470, 560, 690, 770.0)])
    test = measured(xyz, noise=0.5)
    waves = [lambda p, k=k: np.sin(k * p[:, 0] / 1000 + 0.2 * k) for k in (3, 5, 7.5)]
    modes = wavy(geo.xyz, [10, 30, 60.0], waves, up)
    found = align(geo, test, modes, read_test(modes, geo, xyz, test, up))
    moved = found.apply(test.xyz)
    assert np.abs(moved[:, 0] - xyz[:, 0]).max() < 15.0
    assert np.abs(moved[:, 1:]).max() < 3.0


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
    assert align(geo, test, None, modes).is_identity
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
    assert move.angle_deg == pytest.approx(90.0)
    np.testing.assert_allclose(move.axis, [0, 0, 1], atol=1e-12)
