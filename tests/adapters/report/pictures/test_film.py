"""What the viewer moves: pairs, what they were before turning, modes without a partner."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.adapters.report import paired_film
from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.modes import Modes
from trueup.core.results.correlation import Compared
from trueup.verbs.runs.report import answer_of

SHAPES = np.random.default_rng(5).normal(size=(24, 4))
ALL = Dofs(np.repeat(np.arange(1, 9), 3), np.tile(np.arange(1, 4), 8))
ANALYSIS = Modes(np.array([9.0, 20.5, 30.0, 90.0]), SHAPES, ALL)
SENSORS = Dofs(np.array([101, 101, 108]), np.array([1, 3, 2]))
SEEN = sp.csr_matrix((np.ones(3), (range(3), [0, 2, 22])), shape=(3, 24))  # grid 1 X, Z; grid 8 Y
TURN = np.eye(4)
TURN[:2, :2] = [[0.8, -0.6], [0.6, 0.8]]
LINES = Geometry(np.array([101, 105, 108]), np.eye(3), "m", {"line": np.array([[0, 2], [0, 1]])})


@pytest.fixture
def run(correlation: dict[str, Any]) -> Compared:
    return answer_of(correlation).final


def measured(transformation: np.ndarray[Any, Any]) -> Modes:
    """A test that sees the turned model exactly, in another scale."""
    shapes = (SEEN @ SHAPES @ transformation)[:, [1, 0, 2]]
    return Modes(np.array([10.0, 20.0, 31.0]), -2.0 * shapes, SENSORS)


def test_a_sensor_follows_the_model_where_it_does_not_measure(
    run: Compared, cube: Geometry
) -> None:
    found = paired_film(run, cube, ANALYSIS, measured(TURN), SEEN, TURN, LINES)
    assert found is not None
    for frame, mode in zip(found.frames, (1, 0), strict=False):
        moved = (SHAPES @ TURN)[:, mode].reshape(8, 3)
        moved = moved / np.linalg.norm(moved, axis=1).max()
        np.testing.assert_allclose(frame.model, moved[[0, 7]], atol=1e-12)
        np.testing.assert_allclose(frame.test, moved[[0, 7]], atol=1e-12)


def test_what_a_sensor_reads_is_what_it_moves(run: Compared, cube: Geometry) -> None:
    other = measured(TURN)
    wrong = Modes(other.frequencies_hz, other.shapes * [[1.0], [-1.0], [1.0]], SENSORS)
    found = paired_film(run, cube, ANALYSIS, wrong, SEEN, TURN, LINES)
    assert found is not None
    first = found.frames[0]
    ratio = first.test[0] / first.model[0]
    assert ratio[1] == pytest.approx(1.0), "along Y nothing is measured: as the model"
    assert ratio[2] == pytest.approx(-ratio[0]), "along Z the sensor is reversed"


def test_turned_pairs_can_be_seen_as_they_were(run: Compared, cube: Geometry) -> None:
    found = paired_film(run, cube, ANALYSIS, measured(TURN), SEEN, TURN, LINES)
    assert found is not None
    first, second = found.frames[:2]
    assert first.before is not None
    assert second.before is None
    plain = SHAPES[:, 1].reshape(8, 3)
    np.testing.assert_allclose(first.before.shape, plain / np.linalg.norm(plain, axis=1).max())
    assert first.before.pair is not None
    assert first.before.pair.mac == 0.40


def test_modes_without_a_partner_are_shown_alone(run: Compared, cube: Geometry) -> None:
    found = paired_film(run, cube, ANALYSIS, measured(TURN), SEEN, TURN, LINES)
    assert found is not None
    assert [(f.side, f.mode) for f in found.frames[2:]] == [("test", 3), ("analysis", 3)]
    test, analysis = found.frames[2:]
    assert not test.shape.any()
    np.testing.assert_allclose(np.linalg.norm(test.test, axis=1).max(), 1.0)
    assert test.test[1, 0] == test.test[1, 2] == 0.0, "grid 8 is measured along Y alone"
    np.testing.assert_allclose(np.linalg.norm(analysis.shape, axis=1).max(), 1.0)


def test_the_lines_of_the_test_join_its_sensors(run: Compared, cube: Geometry) -> None:
    with_lines = paired_film(run, cube, ANALYSIS, measured(TURN), SEEN, TURN, LINES)
    without = paired_film(run, cube, ANALYSIS, measured(TURN), SEEN, TURN)
    assert with_lines is not None
    assert without is not None
    assert with_lines.lines.tolist() == without.lines.tolist() == [[0, 1]]
    assert with_lines.drawn
    assert not without.drawn
