"""A table's records as CSV, HTML and a pandas frame."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import InputError, path_of
from ..late_imports import optional

_UNITS = {"hz": "Hz", "percent": "%", "deg": "°"}
"""Units of the keys of result.json, by the last word of the key."""
_SHOWN = 50
"""Rows of a table on a page."""

Record = Mapping[str, Any]


class Column(NamedTuple):
    """A column: its key in result.json, and its unit (empty where it has none)."""

    name: str
    unit: str = ""

    @classmethod
    def of(cls, name: str, unit: str = "") -> Column:
        """Return the column of a key, whose last word may be the unit."""
        return cls(name, unit or _UNITS.get(name.rpartition("_")[2], ""))

    def __str__(self) -> str:
        return f"{self.name} [{self.unit}]" if self.unit else self.name


def write_csv(path: Path | str, columns: Sequence[Column], records: Sequence[Record]) -> None:
    """Write records as CSV: UTF-8, a header line with units, ``a.b`` for b within a.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    rows = [dict(_flat(r)) for r in records]
    named = {c.name: c for c in columns}
    keys = list(dict.fromkeys(k for row in rows for k in row)) or list(named)
    header = [str(named.get(k) or Column.of(k)) for k in keys]
    try:
        with path_of(path, "the file").open("w", encoding="utf-8", newline="") as stream:
            writer = csv.writer(stream, lineterminator="\n")
            writer.writerow(header)
            writer.writerows([row.get(k, "") for k in keys] for row in rows)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror or error}", file=path) from error


def _flat(record: Record, above: str = "") -> Iterator[tuple[str, object]]:
    for key, value in record.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{above}{key}.")
        elif isinstance(value, list):
            parts = [json.dumps(v) if isinstance(v, list | dict) else str(v) for v in value]
            yield above + key, "; ".join(parts)
        else:
            yield above + key, "" if value is None else value


def frame(columns: Sequence[Column], records: Sequence[Record]) -> Any:
    """Return records as a pandas DataFrame; its ``attrs["units"]`` holds the units.

    Raises
    ------
    InputError
        pandas is not installed.
    """
    found = optional("pandas", "pandas").DataFrame(records, columns=[c.name for c in columns])
    found.attrs["units"] = {c.name: c.unit for c in columns if c.unit}
    return found


def html(columns: Sequence[Column], records: Sequence[Record]) -> str:
    """Return records as an HTML table, cut where it is long."""
    head = "".join(f"<th>{escape(str(c))}</th>" for c in columns)
    body = "".join(
        f"<tr>{''.join(f'<td>{escape(_short(r.get(c.name)))}</td>' for c in columns)}</tr>"
        for r in records[:_SHOWN]
    )
    more = f"<p>… {len(records) - _SHOWN} more rows</p>" if len(records) > _SHOWN else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def _short(value: object) -> str:
    if value is None:
        return "–"
    if isinstance(value, float):
        return f"{value:.5g}"
    if isinstance(value, list):
        return ", ".join(map(_short, value[:6])) + ", …" * (len(value) > 6)
    if isinstance(value, Mapping):
        return "; ".join(f"{k} {_short(v)}" for k, v in value.items() if v is not None)
    return str(value)
