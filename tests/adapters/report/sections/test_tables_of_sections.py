"""The paper's tables as content."""

from __future__ import annotations

import math
from typing import Any

import pytest

from trueup.adapters.report import discovery as found
from trueup.adapters.report import reading, tables
from trueup.adapters.report.formats import fixed, general, hz, listed, signed


def texts(table: tables.Table | None) -> list[list[str]]:
    assert table is not None
    return [[c.text for c in row] for row in table.rows]


def test_pairs_list_every_test_mode_paired_or_not(correlation: dict[str, Any]) -> None:
    assert texts(tables.pairs(correlation)) == [
        ["1", "10.00", "2", "9.00", "−10.00", "81.0", "30.0", "1"],
        ["2", "20.00", "1", "20.50", "+2.50", "92.0", "", ""],
        ["3", "31.25", "none", "", "", "", "", ""],
    ]


def test_pairs_before_and_after_stand_side_by_side(update: dict[str, Any]) -> None:
    table = tables.pairs(update)
    assert table is not None
    assert [c.group for c in table.columns] == ["", ""] + ["before"] * 6 + ["after"] * 6
    assert [r[2] for r in texts(table)] == ["2", "1", "none"]
    assert [r[10] for r in texts(table)] == ["+1.00", "+0.50", "−0.80"]


def test_columns_that_say_nothing_are_left_out(correlation: dict[str, Any]) -> None:
    correlation["pairs"][0] |= {"cluster": None, "rotation_deg": None}
    table = tables.pairs(correlation)
    assert table is not None
    assert [c.heading for c in table.columns][-1] == "MAC %"


def test_unpaired_modes_name_what_they_resemble_most(correlation: dict[str, Any]) -> None:
    table = tables.unpaired(correlation)
    assert texts(table) == [
        ["test", "3", "31.25", "analysis 3", "58.0"],
        ["analysis", "3", "30.00", "test 3", "58.0"],
    ]
    assert table is not None
    assert table.note == "Above the test's range: 1 analysis mode."


def test_parameters(update: dict[str, Any]) -> None:
    assert texts(tables.parameters(update)) == [
        ["front flange", "PBAR 11 I1, PBAR 11 I2", "9000, 9000", "15750, 15750", "1.7500",
         "± 0.0123", ""],
        ["skin", "PSHELL 1 T", "1.6", "1.28", "0.8000", "–", "at bound"],
    ]  # fmt: skip


def test_a_parameter_that_the_data_do_not_identify_is_marked(update: dict[str, Any]) -> None:
    table = tables.parameters(update)
    assert table is not None
    assert "hardly identify" not in table.note
    update["parameters"][0]["standard_error"] = 0.9
    table = tables.parameters(update)
    assert table is not None
    assert [row[5].tone for row in table.rows] == ["poor", ""]
    assert "hardly identify" in table.note


def test_history_takes_lists_and_names_alike(update: dict[str, Any]) -> None:
    by_list = texts(tables.history(update))
    assert by_list[0] == ["0", "900", "6.25", "10.00", "1.0000", "1.0000"]
    for step in update["history"]:
        step["factors"] = dict(zip(["front flange", "skin"], step["factors"], strict=True))
    assert texts(tables.history(update)) == by_list


def test_findings_give_size_with_interval_and_count_the_places(
    discovery: dict[str, Any],
) -> None:
    rows = texts(found.findings(discovery))
    assert rows[0] == [
        "model", "attached mass", "the far corner", "mass 0.00062 (0.00058 to 0.00066)", "97", "3",
    ]  # fmt: skip
    assert rows[1][1:3] == ["sensor polarity", "sensor 108"]


def test_alternatives_say_what_where_and_how_likely(discovery: dict[str, Any]) -> None:
    table = found.alternatives(discovery)
    assert table is not None
    assert [c.heading for c in table.columns] == ["what", "where", "beside what was found"]
    assert texts(table) == [
        ["local stiffness", "local stiffness at the near edge", "41 times less likely"],
        ["nothing missing", "the known parameters alone", "200 times less likely"],
    ]


def test_what_would_decide_is_listed(discovery: dict[str, Any]) -> None:
    assert found.would_decide(discovery) is None
    table = found.would_decide(discovery | {"would_decide": ["a sensor at grid 7", "mode 9"]})
    assert table is not None
    assert texts(table) == [["a sensor at grid 7"], ["mode 9"]]


def test_an_undecided_run_says_that_the_deck_was_left(discovery: dict[str, Any]) -> None:
    moved = {"parameters": [{"name": "PSHELL 1 T", "factor": 0.9, "standard_error": 0.05}]}
    for verdict, left in (("undecided", True), ("effect", False)):
        result = discovery | moved | {"verdict": verdict}
        for table in (found.gap(result), tables.parameters(result)):
            assert table is not None
            assert ("deck was left as it was" in table.note) is left


def test_gap_on_searched_and_held_out_data(discovery: dict[str, Any]) -> None:
    assert [r[:3] for r in texts(found.gap(discovery))] == [
        ["searched", "before", "2"],
        ["searched", "after", "3"],
        ["held out", "before", "1"],
        ["held out", "after", "1"],
    ]


def test_without_held_out_modes_there_is_no_row_of_them_but_a_reason(
    discovery: dict[str, Any],
) -> None:
    part = discovery["gap"] | {
        "held_out": {"test_modes": [], "sensors": [7], "before": None, "after": None}
    }
    table = found.gap(discovery | {"gap": part})
    assert table is not None
    assert [r[:2] for r in texts(table)] == [["searched", "before"], ["searched", "after"]]
    assert "fewer than ten" in table.note


@pytest.mark.parametrize(
    "make",
    [tables.pairs, tables.unpaired, tables.parameters, tables.history, found.findings,
     found.alternatives, found.gap],
)  # fmt: skip
def test_without_content_there_is_no_table(make: Any) -> None:
    assert make({}) is None


def test_numbers_are_never_invented() -> None:
    nothing = [None, math.nan, math.inf, "7", True, [], 10**400]
    assert [reading.number(v) for v in nothing] == [None] * 7
    assert {fixed(v, 1) for v in nothing} == {"–"}
    assert {hz(v) for v in nothing} == {"–"}


def test_a_mac_outside_its_range_is_unknown() -> None:
    matrix = reading.mac_matrix({"mac": {"values": [[0.5, 7.0, -0.1, None]]}}, "mac")
    assert matrix is not None
    assert [v if v == v else None for v in matrix.values[0].tolist()] == [0.5, None, None, None]
    assert matrix.analysis == (1, 2, 3, 4)


@pytest.mark.parametrize("values", [[], [[]], [[1.0], [1.0, 0.5]], None, "x"])
def test_a_ragged_matrix_is_none(values: object) -> None:
    assert reading.mac_matrix({"mac": {"values": values}}, "mac") is None


def test_numbers_are_written_as_engineers_do() -> None:
    assert [signed(v, 2) for v in (1.5, -1.5, 0.0, -0.001)] == ["+1.50", "−1.50", "0.00", "0.00"]
    assert [general(v) for v in (1e-7, 1234567.0, 13759.6, 0.25, 3, "x")] == [
        "1e−7", "1.235e6", "13760", "0.25", "3", "x",
    ]  # fmt: skip
    assert [hz(v) for v in (0.1234, 33.9, 1234.56)] == ["0.1234", "33.90", "1234.6"]
    assert listed([1, 2]) == "1 and 2"
    assert listed(list(range(9))) == "0, 1, 2, 3, 4 and 4 more"


def test_damping_before_and_after_stands_beside_the_measured() -> None:
    modes = [
        {"test": 1, "measured": 0.041, "before": 0.01, "after": 0.0405},
        {"test": 3, "measured": 0.006, "before": None, "after": 0.0061},
    ]
    result = {"damping": {"modes": modes, "typical_factor": {"before": 4.1, "after": 1.02}}}
    assert texts(found.damping(result)) == [
        ["1", "4.10", "1.00", "4.05"],
        ["3", "0.60", "–", "0.61"],
    ]
    assert found.damping({}) is None


def test_responses_are_told_by_their_mean_and_their_worst() -> None:
    each = [
        {"sensor": "1:Z", "before": 0.5, "after": 0.9},
        {"sensor": "2:Z", "before": 0.3, "after": 0.95},
    ]
    frf = {
        "responses": each,
        "mean_frac": {"before": 0.4, "after": 0.925},
        "log_misfit": {"before": 0.6, "parameters": 0.5, "after": 0.21},
        "lines": 800,
        "independent_lines": 41.3,
    }
    table = found.responses({"frf": frf})
    assert texts(table)[1:] == [
        ["FRAC %, worst sensor", "30.0", "90.0"],
        ["magnitudes, rms log ratio", "0.600", "0.210"],
    ]
    assert table is not None
    assert "800 lines at 2 sensors" in table.note
    assert found.responses({}) is None
