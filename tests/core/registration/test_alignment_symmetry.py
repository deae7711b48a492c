"""Where geometry leaves several positions of a test, its shapes decide, or nothing does."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.core.placing import (
    FLIPS,
    angle_deg,
    cylinder,
    duct_modes,
    error_of,
    geometry,
    is_identity,
    measured,
    panel,
    plate_modes,
    radial,
    read_test,
    sensors_of_panel,
    up,
    wavy,
)

from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.modes import Modes
from trueup.core.registration.alignment import align
from trueup.core.registration.surface_registration import cloud_of, search
from trueup.core.sensors.outer_surface import surface_of

# ------------------------------------------------------------------ symmetric geometry


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
    assert angle_deg(found) == pytest.approx(40.0, abs=2.0)
    assert found.rms < 1.5


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_the_smallest_rotation_does_not_hang_on_rounding(seed):
    geo, test = panel(), measured(sensors_of_panel(), Rotation.from_rotvec([0.7, 0, 0]).as_matrix())
    for k in range(3):
        rounded = 1e-13 * np.random.default_rng([seed, k]).standard_normal(test.xyz.shape)
        found = align(geo, replace(test, xyz=test.xyz + rounded))
        assert angle_deg(found) == pytest.approx(np.degrees(0.7), abs=0.1)


def test_shapes_that_share_the_symmetry_leave_the_panel_undecided():
    geo, xyz = panel(), sensors_of_panel()
    frame = Rotation.from_euler("x", 40, degrees=True).as_matrix()
    test = measured(xyz, frame)
    modes = plate_modes(geo, lopsided=0.0)
    found = align(geo, test, modes, read_test(modes, geo, xyz, test, up, frame))
    assert not found.decided
    assert "4 of the positions" in found.ambiguity
    assert angle_deg(found) == pytest.approx(40.0, abs=2.0)
    assert error_of(found, test, xyz) < 6.0  # where it slides, the shapes still place it


def test_panel_turned_in_its_own_place_is_found_out_by_its_shapes():
    geo, xyz = panel(), sensors_of_panel()
    half = Rotation.from_euler("z", 180, degrees=True).as_matrix()
    test = measured(xyz, half, np.array([0.9, 0.6, 0.0]), noise=0.5)  # lies on the model as it is
    modes = plate_modes(geo, lopsided=0.5)
    found = align(geo, test, modes, read_test(modes, geo, xyz, test, up, half))
    assert error_of(found, test, xyz) < 6.0
    assert "check the coordinate frame" in found.warnings[0]


def tower_of_bars():
    """Five storeys on four columns: turned by half a turn it lies on itself."""
    corners = [(0.0, 0.0), (400.0, 0.0), (400.0, 320.0), (0.0, 320.0)]
    rows = {}
    lines = []

    def straight(a, b, n):
        along = [tuple(p) for p in np.linspace(a, b, n + 1).round(6)]
        rows.update({p: len(rows) + k for k, p in enumerate(q for q in along if q not in rows)})
        lines.extend(pairwise(along))

    for c in corners:
        straight((*c, 0.0), (*c, 2250.0), 20)
    for z in 450.0 * np.arange(1, 6):
        for c, d in zip(corners, corners[1:] + corners[:1], strict=True):
            straight((*c, z), (*d, z), 4)
    ends = np.array([[rows[p] for p in line] for line in lines])
    return Geometry(np.arange(len(rows)) + 1, np.array(list(rows)), None, {"line": ends})


@pytest.mark.parametrize("seed", range(4))
def test_every_position_of_a_symmetric_frame_is_looked_at_however_many_starts_end_in_one(seed):
    geo, rng = tower_of_bars(), np.random.default_rng(seed)
    points = geo.xyz[rng.choice(len(geo.xyz), 41, replace=False)] + rng.normal(0.0, 1.0, (41, 3))
    poses = search(cloud_of(surface_of(geo)), points)
    upright = [R for R, rms in zip(poses.rotation, poses.rms, strict=True) if rms < 2.0]
    turns = np.array([R[0, 0] for R in upright])
    assert np.any(turns > 0.99)
    assert np.any(turns < -0.99)


def test_poor_shapes_do_not_move_a_frame_that_fits():
    geo, xyz = panel(), sensors_of_panel()
    test = measured(xyz, np.eye(3), np.zeros(3))
    modes = plate_modes(geo)
    noise = np.random.default_rng(0).normal(size=(25, 8))
    random = Modes(modes.frequencies_hz, noise, Dofs(test.ids, np.full(25, 3)))
    assert is_identity(align(geo, test, modes, random))


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
    assert angle_deg(found) == pytest.approx(90.0, abs=2.0)
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
