"""Twins are hidden where both show."""

from types import SimpleNamespace as Some

import numpy as np
import pytest
from benchmarks.discovery.calculix import CalculixError
from benchmarks.discovery.hide import Scene, twins


def scene(xyz, moves, seed=0):
    mesh = Some(xyz=np.array(xyz, float), clamped=np.array([0]))
    shapes = np.array(moves)[:, None, None] * np.ones((1, 3, 2))
    return Scene(Some(size=10.0), mesh, Some(shapes=shapes), np.random.default_rng(seed))


@pytest.mark.parametrize("seed", range(6))
def test_the_image_of_a_lively_place_at_a_clamp_is_no_twin(seed, monkeypatch):
    """A frame across its height: the mass at its foot moved in no mode."""
    monkeypatch.setattr(Scene, "mass", 1.0)
    ends = [(0, 0, 0), (8, 0, 0), (0, 0, 10), (8, 0, 10)]
    pair = twins(scene(ends, [0.0, 0.0, 1.0, 1.0], seed))
    assert sorted(e["xyz"] for _, e in pair) == [[0.0, 0.0, 10.0], [8.0, 0.0, 10.0]]


def test_a_structure_without_such_places_hides_none(monkeypatch):
    monkeypatch.setattr(Scene, "mass", 1.0)
    with pytest.raises(CalculixError, match="mirror"):
        twins(scene([(0, 0, 0), (8, 0, 0), (0, 0, 10)], [0.0, 0.0, 1.0]))
