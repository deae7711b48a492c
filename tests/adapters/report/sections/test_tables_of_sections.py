"""The tables of the report's sections as content, the same on the page and in the terminal."""

from __future__ import annotations

import math
from typing import Any

import pytest

from trueup.adapters.report import SECTIONS, Section, Table
from trueup.adapters.report.sections.alternatives import ALTERNATIVES
from trueup.adapters.report.sections.damping import DAMPING
from trueup.adapters.report.sections.findings import FINDINGS
from trueup.adapters.report.sections.frequency_responses import FREQUENCY_RESPONSES
from trueup.adapters.report.sections.gap import GAP
from trueup.adapters.report.sections.pairs import PAIRS
from trueup.adapters.report.sections.parameters import PARAMETERS
from trueup.adapters.report.sections.unpaired_modes import UNPAIRED_MODES
from trueup.adapters.report.sections.would_decide import WOULD_DECIDE
from trueup.adapters.report.tables.number_formats import few, fixed, general, hz, listed, signed
from trueup.verbs.runs.report import answer_of


def table_of(section: Section[Any], result: dict[str, Any], k: int = 0) -> Table:
    return section.tables_of(answer_of(result))[k]


def texts(table: Table) -> list[list[str]]:
    return [[c.text for c in row] for row in table.rows]


def test_pairs_list_every_test_mode_paired_or_not(correlation: dict[str, Any]) -> None:
    assert texts(table_of(PAIRS, correlation)) == [
        ["1", "10.00", "2", "9.00", "−10.00", "81.0", "30.0", "1"],
        ["2", "20.00", "1", "20.50", "+2.50", "92.0", "", ""],
        ["3", "31.25", "none", "", "", "", "", ""],
    ]


def test_pairs_before_and_after_stand_side_by_side(update: dict[str, Any]) -> None:
    table = table_of(PAIRS, update)
    assert [c.group for c in table.columns] == ["", ""] + ["before"] * 6 + ["after"] * 6
    assert [r[2] for r in texts(table)] == ["2", "1", "none"]
    assert [r[10] for r in texts(table)] == ["+1.00", "+0.50", "−0.80"]


def test_damping_stands_beside_the_pair(correlation: dict[str, Any]) -> None:
    correlation |= {"test_damping": [0.0035, None, 0.01], "test_mpc": [0.998, 0.9, 1.0]}
    correlation["pairs"][0] |= {"analysis_damping": 0.02}
    assert [row[:6] for row in texts(table_of(PAIRS, correlation))] == [
        ["1", "10.00", "0.35", "99.8", "2", "9.00"],
        ["2", "20.00", "–", "90.0", "1", "20.50"],
        ["3", "31.25", "1.00", "100.0", "none", ""],
    ]
    assert [row[6] for row in texts(table_of(PAIRS, correlation))] == ["2.00", "–", ""]


def test_columns_that_say_nothing_are_left_out(correlation: dict[str, Any]) -> None:
    correlation["pairs"][0] |= {"cluster": None, "rotation_deg": None}
    table = table_of(PAIRS, correlation)
    assert [c.heading for c in table.columns][-1] == "MAC %"


def test_unpaired_modes_name_what_they_resemble_most(correlation: dict[str, Any]) -> None:
    table = table_of(UNPAIRED_MODES, correlation)
    assert texts(table) == [
        ["test", "3", "31.25", "analysis 3", "58.0"],
        ["analysis", "3", "30.00", "test 3", "58.0"],
    ]
    assert table.note == "Above the test's range: 1 analysis mode."


def test_parameters(update: dict[str, Any]) -> None:
    assert texts(table_of(PARAMETERS, update)) == [
        ["front flange", "PBAR 11 I1, PBAR 11 I2", "9000, 9000", "15750, 15750", "1.7500",
         "± 0.0123", ""],
        ["skin", "PSHELL 1 T", "1.6", "1.28", "0.8000", "–", "at bound"],
    ]  # fmt: skip


def test_a_parameter_that_the_data_do_not_identify_is_marked(update: dict[str, Any]) -> None:
    table = table_of(PARAMETERS, update)
    assert "hardly identify" not in table.note
    update["parameters"][0]["standard_error"] = 0.9
    table = table_of(PARAMETERS, update)
    assert [row[5].tone for row in table.rows] == ["poor", ""]
    assert "hardly identify" in table.note


def test_history_tells_the_mean_and_the_worst_deviation_and_every_factor(
    update: dict[str, Any],
) -> None:
    table = table_of(PARAMETERS, update, 1)
    assert texts(table)[0] == ["0", "900", "6.25", "10.00", "1.0000", "1.0000"]
    assert table.note == "Ended: converged."


def test_findings_give_size_with_interval_and_count_the_places(
    discovery: dict[str, Any],
) -> None:
    rows = texts(table_of(FINDINGS, discovery))
    assert rows[0] == [
        "model", "attached mass", "the far corner", "mass 0.00062 (0.00058 to 0.00066)", "97",
        "2 (3 grids)",
    ]  # fmt: skip
    assert rows[1][1:3] == ["sensor polarity", "sensor 108"]
    discovery["findings"][0]["credible_set"] = [
        {"elements": [1, 2, 3], "xyz": [0.0, 0.0, 0.0]}, {"elements": [2, 3, 4], "xyz": [1.0, 0, 0]}
    ]  # fmt: skip
    assert texts(table_of(FINDINGS, discovery))[0][-1] == "2 (4 elements)"
    discovery["findings"][0]["credible_set"] = [
        {"grids": [5, 1, 2, 3], "normal": [0.0, 0.0, 1.0], "xyz": [0.0, 0.0, 0.0]}
    ]
    assert texts(table_of(FINDINGS, discovery))[0][-1] == "1"


def test_alternatives_say_what_where_and_how_likely(discovery: dict[str, Any]) -> None:
    table = table_of(ALTERNATIVES, discovery)
    assert [c.heading for c in table.columns] == ["what", "beside what was found"]
    assert texts(table) == [
        ["local stiffness at the near edge", "41 times less likely"],
        ["the known parameters alone", "200 times less likely"],
    ]


def test_alternatives_of_older_runs_are_told_by_their_sentence(discovery: dict[str, Any]) -> None:
    for a in discovery["alternatives"]:
        del a["where"], a["odds"]
    last = texts(table_of(ALTERNATIVES, discovery))[1]
    assert last == ["the known parameters alone: 200 times less likely", ""]


def test_what_would_decide_is_listed(discovery: dict[str, Any]) -> None:
    assert WOULD_DECIDE.tables_of(answer_of(discovery)) == []
    table = table_of(WOULD_DECIDE, discovery | {"would_decide": ["a sensor at grid 7", "mode 9"]})
    assert texts(table) == [["a sensor at grid 7"], ["mode 9"]]


def test_an_undecided_run_says_that_the_deck_was_left(
    discovery: dict[str, Any], update: dict[str, Any]
) -> None:
    for verdict, left in (("undecided", True), ("effect", False)):
        result = discovery | {"parameters": update["parameters"], "verdict": verdict}
        for section in (GAP, PARAMETERS):
            assert ("deck was left as it was" in table_of(section, result).note) is left


def test_what_differs_though_nothing_was_written_comes_of_corrected_sensors(
    discovery: dict[str, Any],
) -> None:
    same = {"before": discovery["gap"]["before"], "after": discovery["gap"]["before"]}
    for held, said in ((same, False), (discovery["gap"]["held_out"], True)):
        gap = discovery["gap"] | same | {"held_out": discovery["gap"]["held_out"] | held}
        note = table_of(GAP, discovery | {"verdict": "undecided", "gap": gap}).note
        assert ("corrected for the comparison" in note) is said


def test_a_share_is_told_as_far_as_it_is_known(discovery: dict[str, Any]) -> None:
    for adequacy, said in ((1e-20, "fewer than 0.1 %"), (0.123, "12 %"), (0.9999, "99 %")):
        judgement = discovery["judgement"] | {"adequacy": adequacy, "error": 0.01}
        assert said in table_of(GAP, discovery | {"judgement": judgement}).note


def test_gap_on_searched_and_held_out_data(discovery: dict[str, Any]) -> None:
    assert [r[:3] for r in texts(table_of(GAP, discovery))] == [
        ["searched", "before", "2"],
        ["searched", "after", "3"],
        ["held out", "before", "1"],
        ["held out", "after", "1"],
    ]


def test_the_gap_says_how_far_off_the_model_is_everywhere(discovery: dict[str, Any]) -> None:
    note = table_of(GAP, discovery).note
    assert "off by 0.3 % of its stiffness everywhere (1.9 % with the known parameters" in note
    assert "50 % are off by as much" in note


def test_without_held_out_modes_there_is_no_row_of_them_but_a_reason(
    discovery: dict[str, Any],
) -> None:
    part = discovery["gap"] | {
        "held_out": {"test_modes": [], "sensors": [7], "before": None, "after": None}
    }
    table = table_of(GAP, discovery | {"gap": part})
    assert [r[:2] for r in texts(table)] == [["searched", "before"], ["searched", "after"]]
    assert "fewer than ten" in table.note


def test_a_section_of_another_verb_has_no_table(correlation: dict[str, Any]) -> None:
    told = {s.anchor for s in SECTIONS if s.tables_of(answer_of(correlation))}
    assert told == {"pairs", "unpaired"}


@pytest.mark.parametrize("nothing", [None, math.nan, math.inf])
def test_numbers_are_never_invented(nothing: float | None) -> None:
    assert {f(nothing) for f in (hz, general, lambda v: fixed(v, 1), lambda v: signed(v, 1))} == {
        "–"
    }


def test_numbers_are_written_as_engineers_do() -> None:
    assert [signed(v, 2) for v in (1.5, -1.5, 0.0, -0.001)] == ["+1.50", "−1.50", "0.00", "0.00"]
    assert [general(v) for v in (1e-7, 1234567.0, 13759.6, 0.25, 3)] == [
        "1e−7", "1.235e6", "13760", "0.25", "3",
    ]  # fmt: skip
    assert [hz(v) for v in (0.1234, 33.9, 1234.56)] == ["0.1234", "33.90", "1234.6"]
    assert listed([1, 2]) == "1 and 2"
    assert few(["a", "b", "c", "d"]) == "a, b, c, d"
    assert few([*"abcdef"]) == "a, b, … f (6)"
    assert listed(list(range(9))) == "0, 1, 2, 3, 4 and 4 more"


def test_damping_before_and_after_stands_beside_the_measured(discovery: dict[str, Any]) -> None:
    modes = [
        {"test": 1, "measured": 0.041, "before": 0.01, "after": 0.0405},
        {"test": 3, "measured": 0.006, "before": None, "after": 0.0061},
    ]
    typical = {"before": 4.1, "after": 1.02}
    told = discovery | {"damping": {"modes": modes, "typical_factor": typical}}
    assert texts(table_of(DAMPING, told)) == [
        ["1", "4.10", "1.00", "4.05"],
        ["3", "0.60", "–", "0.61"],
    ]
    assert DAMPING.tables_of(answer_of(discovery)) == []


def test_responses_are_told_by_their_mean_and_their_worst(discovery: dict[str, Any]) -> None:
    each = [
        {"sensor": "1:Z", "before": 0.5, "after": 0.9},
        {"sensor": "2:Z", "before": 0.3, "after": 0.95},
    ]
    frf = {
        "responses": each,
        "references": ["1:Z"],
        "mean_frac": {"before": 0.4, "after": 0.925},
        "log_misfit": {"before": 0.6, "parameters": 0.5, "after": 0.21},
        "lines": 800,
        "independent_lines": 41.3,
    }
    table = table_of(FREQUENCY_RESPONSES, discovery | {"frf": frf})
    assert texts(table)[1:] == [
        ["FRAC %, worst sensor", "30.0", "90.0"],
        ["magnitudes, rms log ratio", "0.600", "0.210"],
    ]
    assert "800 lines at 2 sensors" in table.note
    assert FREQUENCY_RESPONSES.tables_of(answer_of(discovery)) == []
