"""Where model and test disagree, as the page tells it."""

from __future__ import annotations

from trueup.adapters.report import disagreement


def test_sentence_names_the_best_place_of_each_kind(discovery, cube):
    section = disagreement.section(discovery, cube)
    assert section is not None
    assert "mass around grid 8 would explain 40 %" in section.body
    assert "stiffness around grid 1 would explain 30 %" in section.body


def test_one_picture_a_map(discovery, cube):
    section = disagreement.section(discovery, cube)
    assert section is not None
    for title in ("Seen by the sensors", "If mass were missing", "If stiffness were wrong"):
        assert section.body.count(title) >= 1
    bare = disagreement.section(discovery, None)
    assert bare is not None
    assert "If mass were missing" not in bare.body


def test_tables_by_mode_and_by_sensor_worst_first(discovery):
    modes, sensors = disagreement.modes(discovery), disagreement.sensors(discovery)
    assert modes is not None
    assert modes.rows[0][0].text == "1"
    assert [c.text for c in modes.rows[0]][2:] == ["3.2", "−4.5"]
    assert sensors is not None
    assert [row[0].text for row in sensors.rows] == ["11:Z", "12:Z"]
    assert [row[2].text for row in sensors.rows] == ["61.0", "98.0"]


def test_a_run_without_maps_has_no_section(discovery):
    assert disagreement.section({k: v for k, v in discovery.items() if k != "misfit"}, None) is None
