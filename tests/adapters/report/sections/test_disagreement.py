"""Where model and test disagree, as the page tells it."""

from __future__ import annotations

import pytest

from trueup.adapters.report import ReportedRun
from trueup.adapters.report.sections.disagreement import DISAGREEMENT, misfit_tables


@pytest.fixture
def run(answer, discovery, cube):
    return ReportedRun(answer(discovery), cube)


def test_sentence_names_the_best_place_of_each_kind(run):
    body = DISAGREEMENT.body(run)
    assert "mass around grid 8 would explain 40 %" in body
    assert "stiffness around grid 1 would explain 30 %" in body


def test_one_picture_a_map(run):
    for title in ("Seen by the sensors", "If mass were missing", "If stiffness were wrong"):
        assert title in DISAGREEMENT.body(run)
    assert "If mass were missing" not in DISAGREEMENT.body(ReportedRun(run.tables))


def test_tables_by_mode_and_by_sensor_worst_first(run):
    modes, sensors = misfit_tables(run.tables)
    assert modes.rows[0][0].text == "1"
    assert [c.text for c in modes.rows[0]][2:] == ["3.2", "−4.5"]
    assert [row[0].text for row in sensors.rows] == ["11:Z", "12:Z"]
    assert [row[2].text for row in sensors.rows] == ["61.0", "98.0"]


def test_a_run_without_maps_has_no_section(answer, discovery):
    del discovery["misfit"]
    assert DISAGREEMENT.body(ReportedRun(answer(discovery))) == ""
