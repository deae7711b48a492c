"""Paired shapes, laid over each other at the sensors."""

from __future__ import annotations

import base64
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.adapters.report import make_report, overlay, paired_film
from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.modes import Modes
from trueup.core.results.correlation import Compared
from trueup.core.results.plain import Table
from trueup.verbs.runs.report import answer_of

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
def run(correlation: dict[str, Any]) -> Compared:
    return answer_of(correlation).final


def turned(run: Compared, side: str) -> Compared:
    return replace(run, criteria=replace(run.criteria, rotate=side))


def test_a_perfect_pair_lies_on_itself(run: Compared, cube: Geometry) -> None:
    found = overlay(run, cube, ANALYSIS, measured(turn(0.6)), SEEN, turn(0.6))
    assert found is not None
    np.testing.assert_allclose(found.test, found.model, atol=1e-12)
    moved = (SHAPES @ turn(0.6))[:, [1, 0]].reshape(8, 6, 2)[:, :3].transpose(2, 0, 1)
    largest = np.linalg.norm(moved, axis=2).max(axis=1)
    np.testing.assert_allclose(found.shapes, moved / largest[:, None, None])


def test_where_nothing_is_turned_the_shapes_are_those_of_the_deck(
    run: Compared, cube: Geometry
) -> None:
    found = overlay(turned(run, "none"), cube, ANALYSIS, measured(np.eye(4)), SEEN, turn(0.6))
    assert found is not None
    np.testing.assert_allclose(found.test, found.model, atol=1e-12)


def test_a_turned_test_is_shown_turned(run: Compared, cube: Geometry) -> None:
    test = measured(np.eye(4))
    length = np.linalg.norm(np.real(test.shapes * np.exp(-0.4j)), axis=0)
    swap = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    raw = Modes(test.frequencies_hz, test.shapes @ swap, SENSORS)
    found = overlay(turned(run, "test"), cube, ANALYSIS, raw, SEEN, swap * length[:, None] / length)
    assert found is not None
    np.testing.assert_allclose(np.abs(found.test), np.abs(found.model), atol=1e-12)


def test_sensors_stand_where_the_alignment_puts_them(run: Compared, cube: Geometry) -> None:
    found = overlay(run, cube, ANALYSIS, measured(np.eye(4)), SEEN)
    assert found is not None
    np.testing.assert_array_equal(found.sensors, cube.xyz[[0, 0, 7]])


def test_without_pairs_or_sensor_map_there_is_nothing_to_show(
    run: Compared, cube: Geometry
) -> None:
    test = measured(np.eye(4))
    assert overlay(run, cube, ANALYSIS, test, None) is None
    assert overlay(replace(run, pairs=Table()), cube, ANALYSIS, test, SEEN) is None


def test_the_page_carries_the_shapes_and_a_still(
    correlation: dict[str, Any], cube: Geometry
) -> None:
    run = answer_of(correlation)
    found = paired_film(run.final, cube, ANALYSIS, measured(np.eye(4)), SEEN)
    assert found is not None
    html = make_report(run, None, cube, shapes=found)
    data = dict(re.findall(r'data-(\w+)="([^"]*)"', html.split('class="viewer"')[1]))
    carried = np.frombuffer(base64.b64decode(data["shapes"]), np.int8).reshape(5, 8, 3) / 127
    shapes = [f.shape for f in found.all_frames]
    np.testing.assert_allclose(carried, shapes, atol=0.5 / 127 + 1e-9)
    faces = np.frombuffer(base64.b64decode(data["faces"]), "<u2").reshape(-1, 4)
    np.testing.assert_array_equal(faces, found.mesh.faces)
    assert data["labels"].startswith("test 1 (10.00 Hz) and analysis 2 (9.00 Hz), −10.0 %, MAC 81")
    assert '<div class="stage"><svg class="scene"' in html
    assert "figure.viewer" not in make_report(run, None, cube)
