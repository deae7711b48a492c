"""Results in the terminal: the report's content, fitted to the width."""

from __future__ import annotations

import io
import re
from typing import Any

import pytest
from rich.console import Console, RenderableType

from trueup.cli import tables

HZ = [10.0, 20.0]


def correlation(n: int = 2, others: int = 0) -> dict[str, Any]:
    """A correlation of n paired test modes and further analysis modes that resemble none."""
    values = [[0.96 * (a == t) + 0.01 for a in range(n + others)] for t in range(n)]
    return {
        "schema": "trueup/correlate/1",
        "pairs": [
            {"test": t, "analysis": t, "test_hz": 10.0 * t, "analysis_hz": 9.5 * t,
             "deviation_percent": -5.0, "mac": 0.97, "cluster": 1, "rotation_deg": 30.0}
            for t in range(1, n + 1)
        ],
        "unpaired_test": [],
        "unpaired_analysis": [],
        "mac": {"values": values},
    }  # fmt: skip


def update() -> dict[str, Any]:
    return {
        "schema": "trueup/update/1",
        "before": correlation(),
        "after": correlation(),
        "parameters": [{"name": "skin", "initial": 1.6, "updated": 1.2, "factor": 0.75,
                        "standard_error": 0.01, "at_bound": True}],
        "history": [{"iteration": 0, "objective": 9.0, "factors": [1.0],
                     "deviations_percent": [-5.0, 3.0]}],
    }  # fmt: skip


def shown(what: RenderableType, width: int = 110, colour: bool = False) -> str:
    out = io.StringIO()
    system = {"color_system": "truecolor", "force_terminal": True} if colour else {}
    Console(file=out, width=width, **system).print(what)  # type: ignore[arg-type]
    return out.getvalue()


@pytest.mark.parametrize("width", [98, 110, 200])
def test_pairs_of_an_update_fit_side_by_side(width: int) -> None:
    table = tables.pairs_table(update())
    assert table is not None
    lines = shown(table, width).splitlines()
    first = next(line for line in lines if line.split()[:2] == ["1", "10.00"])
    assert first.split() == ["1", "10.00", *["1", "9.50", "−5.00", "97.0", "30.0", "1"] * 2]
    assert max(map(len, lines)) <= width


def test_a_narrow_terminal_gets_before_and_after_one_below_the_other() -> None:
    text = "".join(shown(t, 80) for t in tables.result_tables(update(), 80))
    assert "partners, before" in text
    assert "partners, after" in text
    assert text.count("−5.00") == 4
    assert "…" not in text


def test_an_update_shows_everything_in_reading_order() -> None:
    text = "".join(shown(t) for t in tables.result_tables(update()))
    found = [text.index(w) for w in ("Test modes", "MAC %  test", "Parameters", "Iterations")]
    assert found == sorted(found)
    assert "± 0.0100" in text
    assert "at bound" in text


def test_an_empty_result_shows_nothing() -> None:
    assert list(tables.result_tables({})) == []
    for make in (tables.pairs_table, tables.mac_table, tables.history_table, tables.gap_table):
        assert make({}) is None


def test_mac_in_percent_nothing_as_a_dot() -> None:
    matrix = tables.mac_table(correlation())
    assert matrix is not None
    assert [line.split() for line in shown(matrix).splitlines()[2:4]] == [
        ["1", "10.00", "97", "·"],
        ["2", "20.00", "·", "97"],
    ]


def test_mac_is_shaded_where_there_is_colour() -> None:
    matrix = tables.mac_table(correlation())
    assert matrix is not None
    assert re.search(r"\x1b\[38;2;255;255;255;48;2;\d+;\d+;\d+m97", shown(matrix, colour=True))
    assert "\x1b" not in shown(matrix)


def test_wide_mac_leaves_out_modes_like_nothing_and_says_so() -> None:
    matrix = tables.mac_table(correlation(4, others=60), 80)
    assert matrix is not None
    lines = shown(matrix, 80).splitlines()
    assert "left out" in lines[0]
    assert max(map(len, lines)) <= 80
    assert lines[2].split()[2] == "97"


def test_mac_that_cannot_be_cut_without_losing_a_pair_is_left_out() -> None:
    assert tables.mac_table(correlation(40), 80) is None


def test_solve() -> None:
    result = {
        "modes": [{"frequency_hz": 1e-5, "generalized_mass": 1.0}, {"frequency_hz": 71.26832}],
        "rigid_body_modes": 1,
        "mass": 0.0123,
        "centre_of_gravity": [1.0, 2.0, 3.0],
    }
    text = shown(tables.solve_table(result))
    assert re.search(r"1 +1\.0e-05 +1 +rigid body", text)
    assert re.search(r"2 +71\.2683", text)
    assert "mass 0.0123; centre of gravity 1, 2, 3 (deck units)" in text


def test_identify() -> None:
    mode = {"frequency_hz": 33.5, "frequency_std": 0.01, "damping_ratio": 0.012,
            "damping_std": None, "mpc": 0.993, "mpd": 2.0, "quality": 0.9,
            "close_pair_possible": True}  # fmt: skip
    text = shown(tables.identify_table({"modes": [mode]}))
    row = next(line for line in text.splitlines() if "33.50" in line)
    assert row.split()[:8] == ["1", "33.50", "0.01", "1.200", "–", "99.3", "2.0", "0.9"]
    assert "a close pair may hide here" in row


@pytest.mark.parametrize(
    "contents",
    [
        {"grids": 12, "elements": {"CQUAD4": 4}},
        [{"what": "grids", "count": 12}, {"what": "elements", "CQUAD4": 4}],
        ["12 grids", "4 CQUAD4"],
    ],
)
def test_inspect_takes_any_description(contents: Any) -> None:
    entry = {
        "path": "a.bdf", "format": "Nastran deck", "contents": contents,
        "skipped": [{"what": "BOGUS", "line": 7, "why": "unknown card"}],
    }  # fmt: skip
    text = shown(tables.inspect_table(entry))
    for word in ("a.bdf", "Nastran deck", "12", "CQUAD4", "BOGUS (line 7): unknown card"):
        assert word in text


def test_text_from_files_is_not_markup() -> None:
    result = update()
    result["parameters"][0]["name"] = "[red]skin[/red]"
    table = tables.parameters_table(result)
    assert table is not None
    assert "[red]skin[/red]" in shown(table)
    assert "[b]x" in shown(tables.inspect_table({"contents": [{"what": "[b]x"}]}))
