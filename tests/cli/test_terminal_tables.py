"""Results in the terminal: the report's content, fitted to the width."""

from __future__ import annotations

import io
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from rich.console import Console, RenderableType

from trueup.cli import terminal_tables
from trueup.core.results.correlation import Compared, RunTables
from trueup.core.results.inspection import FileRow, SkippedRow
from trueup.core.results.modes import Checks, IdentifiedRow, ModeRow, SolveTables
from trueup.core.results.plain import Table
from trueup.verbs.runs.report import answer_of


def correlation(n: int = 2, others: int = 0) -> dict[str, Any]:
    """A correlation of n paired test modes and further analysis modes that resemble none."""
    values = [[0.96 * (a == t) + 0.01 for a in range(n + others)] for t in range(n)]
    modes = list(range(1, n + others + 1))
    matrix = {"test": modes[:n], "analysis": modes, "values": values}
    return {
        "schema": "trueup/correlate/1",
        "deck": "duct.bdf",
        "test": ["duct_test.unv"],
        "pairs": [
            {"test": t, "analysis": t, "test_hz": 10.0 * t, "analysis_hz": 9.5 * t,
             "deviation_percent": -5.0, "mac": 0.97, "cluster": 1, "rotation_deg": 30.0}
            for t in modes[:n]
        ],
        "unpaired_test": [],
        "unpaired_analysis": [],
        "clusters": [],
        "mac": matrix,
        "mac_rotated": matrix,
        "test_hz": [10.0 * t for t in modes[:n]],
        "analysis_hz": [9.5 * a for a in modes],
        "summary": {"pairs": n, "mean_abs_deviation_percent": 5.0,
                    "worst_deviation_percent": 5.0, "mean_mac": 0.97},
        "criteria": {"mac_min": 0.7, "frequency_tolerance": 0.3, "cluster_width": 0.02,
                     "rotate": "analysis"},
        "alignment": {"rotation": np.eye(3).tolist(), "translation": [0.0, 0.0, 0.0],
                      "scale": 1.0, "rms": 0.0, "sensors": []},
        "warnings": [],
    }  # fmt: skip


def compared(n: int = 2, others: int = 0) -> Compared:
    return answer_of(correlation(n, others)).final


def update(name: str = "skin") -> RunTables:
    return answer_of({
        "schema": "trueup/update/1",
        "deck": "deck/duct.bdf",
        "input_deck": "duct.bdf",
        "test": ["duct_test.unv"],
        "before": correlation(),
        "after": correlation(),
        "parameters": [{"name": name, "cards": ["PSHELL 1 T"], "initial": [1.6], "updated": [1.2],
                        "factor": 0.75, "standard_error": 0.01, "at_bound": True}],
        "history": [{"iteration": 0, "stage": 1, "objective": 9.0, "factors": [1.0],
                     "deviations_percent": [-5.0, 3.0]}],
        "weights": None, "eigensolutions": 3, "stopped": "converged", "seconds": 1.0,
        "warnings": [],
    })  # fmt: skip


def shown(what: RenderableType, width: int = 110, colour: bool = False) -> str:
    out = io.StringIO()
    system = {"color_system": "truecolor", "force_terminal": True} if colour else {}
    Console(file=out, width=width, **system).print(what)  # type: ignore[arg-type]
    return out.getvalue()


@pytest.mark.parametrize("width", [98, 110, 200])
def test_pairs_of_an_update_fit_side_by_side(width: int) -> None:
    (table,) = terminal_tables.pairs_tables(update(), width)
    lines = shown(table, width).splitlines()
    first = next(line for line in lines if line.split()[:2] == ["1", "10.00"])
    assert first.split() == ["1", "10.00", *["1", "9.50", "−5.00", "97.0", "30.0", "1"] * 2]
    assert max(map(len, lines)) <= width


def test_what_is_known_of_damping_fits_beside_both_states() -> None:
    done = update()
    known = {"test_damping": np.array([0.004, 0.012]), "test_mpc": np.array([1.0, 0.987])}
    done = replace(done, before=replace(done.before, **known), after=replace(done.after, **known))
    (table,) = terminal_tables.pairs_tables(done)
    lines = shown(table).splitlines()
    assert max(map(len, lines)) <= 110
    first = next(line for line in lines if line.split()[:2] == ["1", "10.00"])
    assert first.split()[:6] == ["1", "10.00", "0.40", "100.0", "1", "9.50"]
    assert len(terminal_tables.pairs_tables(done, 100)) == 2


def test_a_narrow_terminal_gets_before_and_after_one_below_the_other() -> None:
    text = "".join(shown(t, 80) for t in terminal_tables.result_tables(update(), 80))
    assert "partners, before" in text
    assert "partners, after" in text
    assert text.count("−5.00") == 4
    assert "…" not in text


def test_an_update_shows_everything_in_reading_order() -> None:
    text = "".join(shown(t) for t in terminal_tables.result_tables(update()))
    found = [text.index(w) for w in ("Test modes", "MAC %  test", "Parameters", "Iterations")]
    assert found == sorted(found)
    assert "± 0.0100" in text
    assert "at bound" in text


def test_mac_in_percent_nothing_as_a_dot() -> None:
    matrix = terminal_tables.mac_table(compared())
    assert matrix is not None
    assert [line.split() for line in shown(matrix).splitlines()[2:4]] == [
        ["1", "10.00", "97", "·"],
        ["2", "20.00", "·", "97"],
    ]


def test_mac_is_shaded_where_there_is_colour() -> None:
    matrix = terminal_tables.mac_table(compared())
    assert matrix is not None
    assert re.search(r"\x1b\[38;2;255;255;255;48;2;\d+;\d+;\d+m97", shown(matrix, colour=True))
    assert "\x1b" not in shown(matrix)


def test_wide_mac_leaves_out_modes_like_nothing_and_says_so() -> None:
    matrix = terminal_tables.mac_table(compared(4, others=60), 80)
    assert matrix is not None
    lines = shown(matrix, 80).splitlines()
    assert "left out" in lines[0]
    assert max(map(len, lines)) <= 80
    assert lines[2].split()[2] == "97"


def test_mac_that_cannot_be_cut_without_losing_a_pair_is_left_out() -> None:
    assert terminal_tables.mac_table(compared(40), 80) is None


def test_solve() -> None:
    modes = Table([ModeRow(1e-5, 1.0), ModeRow(71.26832, 1.0)])
    answer = SolveTables(
        deck_file="duct.bdf", modes=modes, rigid_body_modes=1, mass=0.0123,
        centre_of_gravity=np.array([1.0, 2.0, 3.0]), checks=Checks(1e-9, 1e-12, 0, 1e-12, 1e-9),
        degrees_of_freedom=12, backend="dense", seconds=0.1, warnings=(),
    )  # fmt: skip
    text = shown(terminal_tables.solve_table(answer))
    assert re.search(r"1 +1\.0e-05 +1 +rigid body", text)
    assert re.search(r"2 +71\.2683", text)
    assert "mass 0.0123; centre of gravity 1, 2, 3 (deck units)" in text


def test_identify() -> None:
    mode = IdentifiedRow(
        frequency_hz=33.5, damping_ratio=0.012, frequency_std=0.01, damping_std=np.nan, mpc=0.993,
        mpd=2.0, mode_indicator=0.99, quality=0.9, generalized_mass=1.0, close_pair_possible=True,
        rigid_body_share=None, suspension=False, remark="",
    )  # fmt: skip
    text = shown(terminal_tables.identify_table([mode]))
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
    skipped = Table([SkippedRow("BOGUS", 7, "unknown card")])
    file = FileRow("a.bdf", "Nastran deck", contents, skipped)
    text = shown(terminal_tables.inspect_table(file))
    for word in ("a.bdf", "Nastran deck", "12", "CQUAD4", "BOGUS (line 7): unknown card"):
        assert word in text


def test_text_from_files_is_not_markup() -> None:
    tables = terminal_tables.result_tables(update("[red]skin[/red]"))
    assert "[red]skin[/red]" in "".join(map(shown, tables))
    assert "[b]x" in shown(terminal_tables.inspect_table(FileRow("", "", [{"what": "[b]x"}])))
