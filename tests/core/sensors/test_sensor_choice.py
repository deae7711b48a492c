"""Sensors by effective independence and least MAC, against all choices there are."""

from itertools import combinations

import numpy as np
import pytest

from trueup.core.correlation.mac import mac
from trueup.core.errors import InputError
from trueup.core.sensors.sensor_choice import (
    drive_points,
    effective_independence,
    least_off_diagonal,
)


def beam(n=13, modes=3):
    """Bending shapes of a simply supported beam at n places between its ends."""
    x = np.linspace(0.0, 1.0, n + 2)[1:-1]
    return np.sin(np.pi * x[:, None] * np.arange(1, modes + 1))


def information(shapes, rows):
    return np.linalg.det(shapes[rows].T @ shapes[rows])


def off_diagonal(shapes, rows):
    return np.max(mac(shapes[rows], shapes[rows]) - np.eye(shapes.shape[1]))


@pytest.mark.parametrize("count", [3, 4, 6])
def test_effective_independence_is_near_the_best_of_all_choices(count):
    shapes = beam()
    every = [list(c) for c in combinations(range(len(shapes)), count)]
    best = max(information(shapes, c) for c in every)
    found = effective_independence(shapes, count)
    assert len(set(found.tolist())) == count
    assert information(shapes, found) > 0.8 * best
    assert np.mean([information(shapes, c) < information(shapes, found) for c in every]) > 0.97


def test_the_least_mac_is_near_the_best_of_all_choices():
    shapes = beam(11, 4)
    every = [list(c) for c in combinations(range(len(shapes)), 6)]
    found = off_diagonal(shapes, least_off_diagonal(shapes, 6))
    assert np.mean([off_diagonal(shapes, c) < found for c in every]) < 0.05


def test_wanted_sensors_stay_and_many_candidates_take_steps():
    shapes = np.random.default_rng(1).standard_normal((3000, 5))
    for method in (effective_independence, least_off_diagonal):
        found = method(shapes, 10, [7, 2999])
        assert len(found) == 10
        assert {7, 2999} <= set(found.tolist())


def test_exciters_reach_every_mode_and_avoid_nodes():
    shapes = beam(11, 3)
    rows, share = drive_points(shapes, np.array([1.0, 4.0, 9.0]), 2)
    every = shapes**2 / np.max(shapes**2, axis=0)
    assert share.min(axis=1)[0] == pytest.approx(every.min(axis=1).max())
    assert rows[0] != 5  # the middle, a node of the second


def test_what_cannot_be_chosen_is_refused():
    with pytest.raises(InputError, match="2 sensors are fewer than 3 modes"):
        effective_independence(beam(), 2)
    with pytest.raises(InputError, match="do not tell all of the modes apart"):
        effective_independence(np.ones((9, 2)), 4)
