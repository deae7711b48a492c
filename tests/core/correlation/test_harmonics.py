"""Harmonics of shapes known in closed form, sensors equally spaced or not."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from trueup.core.correlation.harmonics import find_rings, harmonics

TILT = Rotation.from_rotvec([0.2, -0.3, 0.1]).as_matrix()
STRAIGHT = np.eye(3)
CENTRE = np.array([3.0, -20.0, 7.0])
EVEN = np.arange(12) * np.pi / 6.0
UNEVEN = np.sort(np.random.default_rng(4).uniform(0.0, 2.0 * np.pi, 14))


def duct(angles, ways=("r",), radii=(100.0, 80.0, 110.0), turn=STRAIGHT):
    """Rings about z at three stations; a sensor a way at each place."""
    places, axes, theta, which = [], [], [], []
    for k, radius in enumerate(radii):
        for a in angles:
            e = np.array([np.cos(a), np.sin(a), 0.0])
            for way in ways:
                sense = -1.0 if way == "-r" else 1.0
                by_way = {"t": [-np.sin(a), np.cos(a), 0.0], "z": [0.0, 0.0, 1.0]}
                places.append(radius * e + [0.0, 0.0, 90.0 * k])
                axes.append(np.array(by_way.get(way, sense * e)))
                theta.append(a)
                which.append(way)
    xyz = np.array(places) @ turn.T + CENTRE
    return xyz, np.array(axes) @ turn.T, np.array(theta), np.array(which)


def shape(n, degrees, theta, which, tangential=-0.3, axial=0.2):
    """What sensors read of u_r = cos n(θ − θ0), u_θ = V sin n(θ − θ0), u_z = W cos n(θ − θ0)."""
    x = n * (theta - np.radians(degrees))
    parts = {"r": np.cos(x), "-r": -np.cos(x), "t": tangential * np.sin(x), "z": axial * np.cos(x)}
    return np.select([which == w for w in parts], list(parts.values()))


@pytest.mark.parametrize("angles", [EVEN, UNEVEN], ids=["even", "uneven"])
@pytest.mark.parametrize("ways", [("r",), ("-r",), ("t",), ("r", "t", "z")])
def test_harmonic_and_orientation_are_found(angles, ways):
    xyz, axes, theta, which = duct(angles, ways)
    rings = find_rings(xyz, xyz, axes)
    np.testing.assert_allclose(rings.origin[:2], CENTRE[:2], atol=1e-9)
    np.testing.assert_allclose(np.cos(rings.angle - theta), 1.0, atol=1e-12)
    wanted = [(1, 100.0), (2, 31.0), (3, 17.4), (4, 44.0)]
    shapes = np.column_stack([shape(n, at, theta, which) for n, at in wanted])
    for (n, at), found in zip(wanted, harmonics(rings, -2.0 * shapes), strict=True):
        assert found.number == n
        assert found.orientation_deg == pytest.approx(at % (180.0 / n))
        assert found.share == pytest.approx(1.0)
    assert str(harmonics(rings, shapes)[2]) == "n = 3, 17.4°"


def test_breathing_has_no_orientation():
    xyz, axes, theta, _ = duct(EVEN)
    (found,) = harmonics(find_rings(xyz, xyz, axes), np.ones((len(theta), 1)))
    assert (found.number, found.orientation_deg) == (0, None)
    assert str(found) == "n = 0"


def test_sensors_say_up_to_which_harmonic_they_tell():
    for angles, highest in ((EVEN, 5), (EVEN[::2], 2)):
        xyz, axes, theta, which = duct(angles)
        (found,) = harmonics(find_rings(xyz, xyz, axes), shape(2, 5.0, theta, which)[:, None])
        assert (found.number, found.highest) == (2, highest)


def test_a_tilted_axis_is_found_in_the_cloud_of_the_model():
    xyz, axes, theta, which = duct(EVEN, radii=(100.0,) * 6, turn=TILT)
    rings = find_rings(xyz, xyz, axes)
    np.testing.assert_allclose(np.abs(rings.direction @ TILT[:, 2]), 1.0, atol=1e-9)
    (found,) = harmonics(rings, shape(3, 0.0, theta, which)[:, None])
    assert found.number == 3


def test_noise_moves_the_orientation_by_what_it_must():
    """Of N readings with a scatter s, that of the phase is s √(2/N)."""
    xyz, axes, theta, which = duct(EVEN, radii=(100.0,) * 3)
    rng, scatter = np.random.default_rng(1), 0.1
    readings = shape(3, 17.4, theta, which)[:, None] + scatter * rng.standard_normal(
        (len(theta), 300)
    )
    off = [h.orientation_deg - 17.4 for h in harmonics(find_rings(xyz, xyz, axes), readings)]
    expected = np.degrees(scatter * np.sqrt(2.0 / len(theta))) / 3.0
    assert abs(np.mean(off)) < 3.0 * expected / np.sqrt(300)
    assert np.std(off) == pytest.approx(expected, rel=0.15)


def test_a_mixture_of_many_has_no_name():
    xyz, axes, theta, which = duct(EVEN)
    mixed = sum(shape(n, 10.0, theta, which) for n in (1, 2, 3))
    assert harmonics(find_rings(xyz, xyz, axes), mixed[:, None]) == (None,)


def test_a_plate_and_a_beam_stand_round_no_axis():
    x, y = map(np.ravel, np.meshgrid(np.arange(6.0), np.arange(5.0)))
    plate = np.column_stack([x, y, 0.0 * x])
    assert find_rings(plate, plate, np.tile([0.0, 0.0, 1.0], (30, 1))) is None
    beam = np.column_stack([np.arange(9.0), np.zeros((9, 2))])
    assert find_rings(beam, beam, np.tile([0.0, 0.0, 1.0], (9, 1))) is None


def test_a_disc_has_its_axis_in_the_middle_whatever_the_radii_of_the_sensors():
    rng = np.random.default_rng(2)
    angles = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    cloud = np.concatenate([r * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
                            for r in (50.0, 80.0, 100.0)])  # fmt: skip
    theta = rng.uniform(0.0, 2.0 * np.pi, 24)
    radius = np.repeat([50.0, 80.0, 100.0], 8) + rng.uniform(-1.0, 1.0, 24)
    xyz = np.column_stack([radius * np.cos(theta), radius * np.sin(theta), 0.0 * theta])
    rings = find_rings(cloud + CENTRE, xyz + CENTRE, np.tile([0.0, 0.0, 1.0], (24, 1)))
    np.testing.assert_allclose(rings.origin[:2], CENTRE[:2], atol=1e-9)
    (found,) = harmonics(rings, np.cos(3 * (theta - np.radians(17.4)))[:, None])
    assert str(found) == "n = 3, 17.4°"


def test_a_crest_at_the_origin_is_at_nought_and_many_sensors_take_no_time():
    angles = np.linspace(0.0, 2.0 * np.pi, 150, endpoint=False)
    xyz, axes, theta, which = duct(angles)
    (found,) = harmonics(find_rings(xyz, xyz, axes), shape(7, 0.0, theta, which)[:, None])
    assert str(found) == "n = 7, 0.0°"
    assert found.highest == 30
