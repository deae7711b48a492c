"""A table goes to dictionaries, CSV and pandas, and shows itself shortly."""

from __future__ import annotations

import pickle
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from trueup.core.errors import InputError
from trueup.core.late_imports import optional
from trueup.core.results.correlation import MacTable
from trueup.core.results.plain import Table, Tables


@dataclass(frozen=True)
class Place:
    region: str
    grids: tuple[int, ...]


@dataclass(frozen=True)
class Row:
    mode: int
    test_hz: float
    rotation_deg: float | None
    distance: float = field(metadata={"unit": "mm"})
    where: Place = Place("", ())


ROWS = Table([
    Row(1, 33.25, None, 0.1, Place("near the “rim”, above", (4, 5))),
    Row(2, 34.0, -2.5, float("nan")),
])  # fmt: skip


def test_columns_have_units() -> None:
    assert [str(c) for c in ROWS.columns] == [
        "mode", "test_hz [Hz]", "rotation_deg [°]", "distance [mm]", "where",
    ]  # fmt: skip


def test_rows_are_found_by_number_and_by_slice() -> None:
    assert (len(ROWS), ROWS[1].mode, [r.mode for r in ROWS]) == (2, 2, [1, 2])
    assert isinstance(ROWS[:1], Table)
    assert ROWS[2:].columns == ROWS.columns
    assert Table((), Row).columns == ROWS.columns
    assert pickle.loads(pickle.dumps(ROWS)).columns == ROWS.columns


def test_dictionaries_are_plain() -> None:
    assert ROWS.to_dict()[0] == {
        "mode": 1, "test_hz": 33.25, "rotation_deg": None, "distance": 0.1,
        "where": {"region": "near the “rim”, above", "grids": [4, 5]},
    }  # fmt: skip
    assert ROWS.to_dict()[1]["distance"] is None


def test_csv_is_utf8_with_units_in_its_header(tmp_path: Path) -> None:
    path = tmp_path / "rows.csv"
    ROWS.to_csv(path)
    assert path.read_bytes().decode("utf-8").splitlines() == [
        "mode,test_hz [Hz],rotation_deg [°],distance [mm],where.region,where.grids",
        '1,33.25,,0.1,"near the “rim”, above",4; 5',
        "2,34.0,-2.5,,,",
    ]
    with pytest.raises(InputError, match=r"^cannot write .*rows\.csv: "):
        ROWS.to_csv(tmp_path / "none" / "rows.csv")


def test_a_matrix_is_a_table_too(tmp_path: Path) -> None:
    mac = MacTable((1, 2), (7, 9, 8), np.array([[1.0, 0.0, 0.5], [0.0, 1.0, 0.25]]))
    mac.to_csv(tmp_path / "mac.csv")
    assert (tmp_path / "mac.csv").read_text() == (
        "test mode,analysis mode 7,analysis mode 9,analysis mode 8\n1,1.0,0.0,0.5\n2,0.0,1.0,0.25\n"
    )


@dataclass(frozen=True, eq=False)
class Answer(Tables):
    pairs: Table[Row]
    nothing: Table[Row]
    before: MacTable


def test_an_answer_writes_each_of_its_tables(tmp_path: Path) -> None:
    mac = MacTable((1,), (7,), np.ones((1, 1)))
    answer = Answer(ROWS, Table(), mac)
    answer.write_tables(tmp_path / "tables")
    assert sorted(p.name for p in (tmp_path / "tables").iterdir()) == ["before.csv", "pairs.csv"]
    with pytest.raises(InputError, match=r"^cannot make "):
        answer.write_tables(tmp_path / "tables")


def test_pandas_where_it_is() -> None:
    pytest.importorskip("pandas")
    frame = ROWS.to_pandas()
    assert list(frame.columns) == [c.name for c in ROWS.columns]
    assert frame["test_hz"].tolist() == [33.25, 34.0]
    assert frame.attrs["units"]["distance"] == "mm"


def test_a_package_that_is_not_there_is_said_in_one_sentence() -> None:
    with pytest.raises(InputError, match=r"^nosuchpackage is not installed: .*trueup\[plot\]'$"):
        optional("nosuchpackage.part", "plot")


def test_a_table_shows_itself_in_a_line_and_on_a_page() -> None:
    assert repr(ROWS) == "Table(2 rows: mode, test_hz, rotation_deg, distance, where)"
    page = ROWS._repr_html_()
    assert "<th>test_hz [Hz]</th>" in page
    assert "<td>33.25</td><td>–</td><td>0.1</td>" in page
    assert "<td>region near the “rim”, above; grids 4, 5</td>" in page
    long = Table([ROWS[1]] * 60)._repr_html_()
    assert (long.count("<tr>"), "10 more rows" in long) == (51, True)
    assert "&lt;b&gt;" in Table([Row(1, 1.0, None, 0.0, Place("<b>", ()))])._repr_html_()
