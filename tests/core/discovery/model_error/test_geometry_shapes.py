"""Ways in which nodes may be elsewhere than drawn."""

import numpy as np
import pytest

from trueup.core.discovery.model_error.geometry_shapes import shapes_of

ANGLE = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
RING = np.column_stack([200.0 * np.cos(ANGLE), 200.0 * np.sin(ANGLE)])
DUCT = np.array([[x, y, z] for z in np.linspace(0.0, 900.0, 10) for x, y in RING])
PLATE = np.array([[x, y, 0.0] for x in np.linspace(0.0, 9.0, 10) for y in np.linspace(0.0, 5.0, 6)])
STEPS = [(0.0, 0.0, 90.0)] * 7 + [(0.0, 85.0, 0.0)] * 5 + [(80.0, 0.0, 0.0)] * 3
BRACKET = np.cumsum(STEPS, axis=0)


def named(xyz, name):
    return [s for s in shapes_of(xyz) if s.name == name]


def test_a_round_section_is_oval_in_any_direction():
    for s, phase in zip(named(DUCT, "out of round"), (0.0, np.pi / 4.0), strict=True):
        outwards = np.sum(s.by[:, :2] * np.tile(RING / 200.0, (10, 1)), axis=1)
        expected = np.cos(2.0 * (np.tile(ANGLE, 10) - phase))
        assert min(np.abs(outwards - k * expected).max() for k in (1.0, -1.0)) < 1e-12


def test_lobes_are_three():
    s = named(DUCT, "out of round by three lobes")[0]
    outwards = np.sum(s.by[:24, :2] * RING / 200.0, axis=1)
    assert np.flatnonzero(np.abs(np.fft.rfft(outwards)) > 1e-9).tolist() == [3]


def test_what_is_not_round_is_not_told_out_of_round_by_lobes():
    square = [[np.sign(c) * min(1, abs(c)), np.sign(s) * min(1, abs(s)), z]
              for c, s in np.sqrt(2.0) * np.array([np.cos(ANGLE), np.sin(ANGLE)]).T
              for z in (0.0, 3.0)]  # fmt: skip
    names = {s.name for s in shapes_of(np.array(square))}
    assert not any("lobes" in name for name in names)
    assert any(name.startswith("out of round in the plane") for name in names)


def test_the_amplitude_of_a_bow_is_its_height_and_that_of_a_length_the_change_of_it():
    out_of_plane = [s.by[:, 2] for s in named(PLATE, "bowed along x") if s.by[:, 2].any()]
    (bow,) = out_of_plane
    assert np.ptp(bow) == pytest.approx(1.0, abs=0.02)  # the middle is between two nodes
    (longer,) = named(PLATE, "longer along x")
    assert np.ptp(longer.by[:, 0]) == pytest.approx(1.0)
    assert longer.reverse == "shorter along x"


@pytest.mark.parametrize("xyz", [DUCT, PLATE, BRACKET])
def test_no_shape_is_told_twice_nor_is_a_motion_as_a_whole(xyz):
    away = xyz - xyz.mean(axis=0)
    rigid = [np.tile(e, (len(xyz), 1)) for e in np.eye(3)] + [np.cross(e, away) for e in np.eye(3)]
    rigid = np.array([u.ravel() for u in rigid])
    moved = np.array([s.by.ravel() for s in shapes_of(xyz)])
    Q = np.linalg.svd(rigid, full_matrices=False)[2][: np.linalg.matrix_rank(rigid)]
    left = moved - moved @ Q.T @ Q
    length = np.linalg.norm(left, axis=1)
    assert np.all(length > 0.05 * np.linalg.norm(moved, axis=1))
    alike = np.abs(np.triu((left / length[:, None]) @ (left / length[:, None]).T, 1))
    assert alike.max() < 0.999


def test_shapes_turn_with_the_structure():
    turn = np.linalg.qr(np.random.default_rng(2).standard_normal((3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    there = shapes_of(BRACKET @ turn.T)
    for here, now in zip(shapes_of(BRACKET), there, strict=True):
        np.testing.assert_allclose(now.by, here.by @ turn.T, atol=1e-9)


def test_an_arc_is_as_round_as_a_whole_circle_and_four_corners_are_not():
    angle = np.linspace(0.4, 1.9, 12)
    arc = [[300.0 * np.cos(a), 300.0 * np.sin(a), z] for a in angle for z in range(0, 500, 50)]
    s = named(np.array(arc), "out of round")[0]
    radial = np.repeat(np.column_stack([np.cos(angle), np.sin(angle)]), 10, axis=0)
    outwards = np.sum(s.by[:, :2] * radial, axis=1)
    waves = np.column_stack([np.cos(2.0 * angle), np.sin(2.0 * angle)]).repeat(10, axis=0)
    assert outwards == pytest.approx(waves @ np.linalg.lstsq(waves, outwards, rcond=None)[0])
    tube = np.array([[x, y, z] for x in (0.0, 80.0) for y in (0.0, 50.0) for z in range(9)])
    assert not named(tube * [1.0, 1.0, 40.0], "out of round")
