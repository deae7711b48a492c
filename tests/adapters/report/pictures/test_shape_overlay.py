"""Paired shapes, laid over each other at the sensors."""

from __future__ import annotations

import base64
import re
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.adapters.report import make_report, overlay
from trueup.core.dofs import Dofs
from trueup.core.geometry import Geometry
from trueup.core.modes import Modes

RNG = np.random.default_rng(7)
ALL = Dofs(np.repeat(np.arange(1, 9), 6), np.tile(np.arange(1, 7), 8))
SHAPES = RNG.normal(size=(48, 4))
ANALYSIS = Modes(np.array([9.0, 20.5, 30.0, 90.0]), SHAPES, ALL)
SENSORS = Dofs(np.array([101, 101, 108]), np.array([1, 3, 2]))
ROWS = [0, 2, 43]  # grid 1 X and Z, grid 8 Y
SEEN = sp.csr_matrix((np.ones(3), (range(3), ROWS)), shape=(3, 48))


def turn(angle: float) -> np.ndarray[Any, Any]:
    matrix = np.eye(4)
    c, s = np.cos(angle), np.sin(angle)
    matrix[:2, :2] = [[c, -s], [s, c]]
    return matrix


def measured(transformation: np.ndarray[Any, Any]) -> Modes:
    """A test that sees the turned model exactly, in another scale and phase."""
    shapes = (SEEN @ SHAPES @ transformation)[:, [1, 0, 2]]
    return Modes(np.array([10.0, 20.0, 31.0]), -3.0 * shapes * np.exp(0.4j), SENSORS)


@pytest.fixture
def run(correlation: dict[str, Any]) -> dict[str, Any]:
    for pair in correlation["pairs"]:
        pair["mac"] = 1.0
    return correlation


def test_a_perfect_pair_lies_on_itself(run: dict[str, Any], cube: Geometry) -> None:
    found = overlay(run, cube, ANALYSIS, measured(turn(0.6)), SEEN, turn(0.6))
    assert found is not None
    np.testing.assert_allclose(found.test, found.model, atol=1e-12)
    moved = (SHAPES @ turn(0.6))[:, [1, 0]].reshape(8, 6, 2)[:, :3].transpose(2, 0, 1)
    largest = np.linalg.norm(moved, axis=2).max(axis=1)
    np.testing.assert_allclose(found.shapes, moved / largest[:, None, None])


def test_without_the_turn_the_shapes_are_those_of_the_deck(
    run: dict[str, Any], cube: Geometry
) -> None:
    found = overlay(run, cube, ANALYSIS, measured(np.eye(4)), SEEN, turn(0.6))
    assert found is not None
    np.testing.assert_allclose(found.test, found.model, atol=1e-12)


def test_a_turned_test_is_shown_turned(run: dict[str, Any], cube: Geometry) -> None:
    test = measured(np.eye(4))
    length = np.linalg.norm(np.real(test.shapes * np.exp(-0.4j)), axis=0)
    swap = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    raw = Modes(test.frequencies_hz, test.shapes @ swap, SENSORS)
    found = overlay(run, cube, ANALYSIS, raw, SEEN, swap * length[:, None] / length)
    assert found is not None
    np.testing.assert_allclose(np.abs(found.test), np.abs(found.model), atol=1e-12)


def test_sensors_stand_at_their_nearest_grids_unless_told(
    run: dict[str, Any], cube: Geometry
) -> None:
    found = overlay(run, cube, ANALYSIS, measured(np.eye(4)), SEEN)
    assert found is not None
    np.testing.assert_array_equal(found.sensors, cube.xyz[[0, 0, 7]])
    for k, row in enumerate(run["alignment"]["sensors"]):
        row["xyz"] = [float(k), 0.0, 0.5]
    found = overlay(run, cube, ANALYSIS, measured(np.eye(4)), SEEN)
    assert found is not None
    np.testing.assert_array_equal(found.sensors, [[0, 0, 0.5], [1, 0, 0.5], [2, 0, 0.5]])


def test_shapes_that_do_not_belong_to_the_run_are_left_out(
    run: dict[str, Any], cube: Geometry
) -> None:
    test = measured(np.eye(4))
    assert overlay(run, cube, ANALYSIS, test, None) is None
    assert overlay(run, cube, ANALYSIS, test, SEEN[:2]) is None
    assert overlay(run, cube, ANALYSIS.take(np.array([0])), test, SEEN) is None
    assert overlay(run | {"pairs": []}, cube, ANALYSIS, test, SEEN) is None
    del run["alignment"]
    assert overlay(run, cube, ANALYSIS, test, SEEN) is None


def test_the_page_carries_the_shapes_and_a_still(run: dict[str, Any], cube: Geometry) -> None:
    found = overlay(run, cube, ANALYSIS, measured(np.eye(4)), SEEN)
    assert found is not None
    html = make_report(run, None, cube, shapes=found)
    data = dict(re.findall(r'data-(\w+)="([^"]*)"', html.split('class="viewer"')[1]))
    carried = np.frombuffer(base64.b64decode(data["shapes"]), np.int8).reshape(2, 8, 3) / 127
    np.testing.assert_allclose(carried, found.shapes, atol=0.5 / 127 + 1e-9)
    faces = np.frombuffer(base64.b64decode(data["faces"]), "<u2").reshape(-1, 4)
    np.testing.assert_array_equal(faces, found.mesh.faces)
    assert data["labels"].startswith("test 1 (10.00 Hz) and analysis 2 (9.00 Hz), −10.0 %, MAC 100")
    assert '<div class="stage"><svg class="scene"' in html
    assert "figure.viewer" not in make_report(run, None, cube)
