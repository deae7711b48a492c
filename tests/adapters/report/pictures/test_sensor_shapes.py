"""Shapes of a test alone: what its sensors tell, and no more."""

from __future__ import annotations

import numpy as np
import pytest

from trueup.adapters.report.pictures.sensor_shapes import sensor_shapes
from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.modes import Modes

XYZ = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 5, 0]])
LINES = {"line": np.array([[0, 1], [1, 2]])}


def shapes_at(node: list[int], axis: list[list[float]], read: list[float]) -> Modes:
    axes = np.array(axis) / np.linalg.norm(axis, axis=1, keepdims=True)
    dofs = Dofs(np.array(node), np.ones(len(node), int), axes)
    return Modes(np.array([10.0]), np.array(read)[:, None], dofs)


def test_a_sensor_of_one_axis_moves_along_it_and_no_other_way() -> None:
    modes = shapes_at([1, 2], [[0, 0, 1], [0, 1, 1]], [1.0, -2.0])
    seen = sensor_shapes(Geometry(np.arange(1, 5), XYZ, "m", LINES), modes)
    assert seen is not None
    assert seen.shapes[0, 0] == pytest.approx([0.0, 0.0, 0.5])
    assert seen.shapes[0, 1] == pytest.approx([0.0, -np.sqrt(0.5), -np.sqrt(0.5)])
    assert not seen.shapes[0, 2:].any()  # no sensor, no motion
    assert seen.mesh.lines.tolist() == LINES["line"].tolist()


def test_a_node_of_skew_sensors_moves_so_that_each_reads_what_it_read() -> None:
    axis = [[1.0, 0, 0], [1, 1, 0], [1, 0, 2]]
    modes = shapes_at([2, 2, 2], axis, [0.3, -0.4, 0.9])
    seen = sensor_shapes(Geometry(np.arange(1, 5), XYZ, "m", LINES), modes)
    assert seen is not None
    read = modes.dofs.axis @ seen.shapes[0, 1]
    assert read / read[0] == pytest.approx(np.array([0.3, -0.4, 0.9]) / 0.3)
    assert seen.test[0] == pytest.approx(read)


def test_places_without_lines_are_joined_to_their_neighbours() -> None:
    modes = shapes_at([3, 1, 2], [[0, 0, 1]] * 3, [1.0, 1.0, 1.0])
    seen = sensor_shapes(Geometry(np.arange(1, 5), XYZ, "m"), modes)
    assert seen is not None
    assert sorted(sorted(line) for line in seen.mesh.lines.tolist()) == [[0, 1], [1, 2]]


def test_nothing_is_drawn_without_positions_or_modes() -> None:
    modes = shapes_at([1], [[0, 0, 1]], [1.0])
    assert sensor_shapes(None, modes) is None
    assert sensor_shapes(Geometry(np.array([9]), XYZ[:1], "m"), modes) is None
    assert sensor_shapes(Geometry(np.arange(1, 5), XYZ), modes.take(np.zeros(1, bool))) is None
