"""Warnings of a correlation: sensors the wrong way round, modes twice, crowded clusters."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trueup

DUCT = Path(__file__).parents[3] / "fixtures" / "duct"
CASES = Path(__file__).parents[4] / "shared" / "data" / "cases"


@pytest.fixture(scope="module")
def sides():
    return trueup.read_deck(DUCT / "duct.bdf"), trueup.read_test(DUCT / "duct_test.unv")


def told(sides, test, **options):
    return trueup.correlate(sides[0], test, deck_length_unit="mm", **options)


def with_shapes(test, change):
    shapes = np.array(test.modes.shapes)
    change(shapes)
    return replace(test, modes=replace(test.modes, shapes=shapes))


def test_a_sensor_the_wrong_way_round_is_named(sides):
    rows = [11, 25]

    def turn(shapes):
        shapes[rows] *= -1.0

    plain, found = told(sides, sides[1]), told(sides, with_shapes(sides[1], turn))
    labels = [sides[1].modes.dofs.labels[r] for r in rows]
    assert not any("against the model" in w for w in plain.warnings)
    (said,) = (w for w in found.warnings if "against the model" in w)
    assert all(label in said for label in labels)
    assert {r.sensor for r in found.agreement if r.suspect} == set(labels)
    assert {r.sensor for r in sorted(found.agreement, key=lambda r: -r.misfit)[:6]} >= set(labels)


def test_a_mode_listed_twice_is_named(sides):
    def copy(shapes):
        shapes[:, 3] = -2.0 * shapes[:, 2]

    (said,) = (w for w in told(sides, with_shapes(sides[1], copy)).warnings if "same shape" in w)
    assert said.startswith("test modes 3 and 4")
    assert "nothing tells them apart" in said


def test_a_cluster_that_holds_nearly_any_shape_is_doubted(sides):
    assert any("nearly any shape" in w for w in told(sides, sides[1], cluster_width=0.3).warnings)


def test_the_auto_mac_is_of_one_side_alone(sides):
    found = told(sides, sides[1])
    for table, count in ((found.auto_mac_test, 24), (found.auto_mac_analysis, None)):
        assert len(table) == (count or len(found.analysis_hz))
        np.testing.assert_allclose(np.diag(table.values), 1.0)
        np.testing.assert_allclose(table.values, table.values.T, atol=1e-12)


@pytest.mark.skipif(not CASES.is_dir(), reason="the shared cases are not there")
def test_a_tower_that_sways_is_not_free_and_one_that_was_hung_is():
    folder = CASES / "tower_frame"
    test = trueup.read_test(folder / "tower_test.unv")
    found = trueup.correlate(folder / "tower.bdf", test, deck_length_unit="mm")
    assert not any("as a whole" in w for w in found.warnings)
    seen = test.modes.dofs
    xyz = test.geometry.xyz[test.geometry.index_of(seen.node)]
    turns = np.cross(np.array([[0.0, 1.0, 0.0]]), xyz)
    moves = [seen.axis[:, 0], seen.axis[:, 2], np.sum(turns * seen.axis, axis=1)]
    hung = with_shapes(
        test, lambda shapes: shapes.__setitem__((slice(None), slice(3)), np.transpose(moves))
    )
    found = trueup.correlate(folder / "tower.bdf", hung, deck_length_unit="mm")
    assert any("as a whole" in w and "SPC" in w for w in found.warnings)
