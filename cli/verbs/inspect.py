"""``trueup inspect FILE...``."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from ...core.results.inspection import FileRow, SkippedRow
from ...core.results.plain import Json, Table
from ..console import emit_json, speaks, stdout
from ..options import JsonOption, Output, QuietOption

_MOST, _SHOWN, _ROWS = 14, 8, 2
"""Entries of a list on the screen, the first of a long one of numbers, and of one of rows."""


def inspect(
    files: Annotated[list[Path], typer.Argument(metavar="FILE...")],
    json: JsonOption = None,
    quiet: QuietOption = False,
) -> None:
    """Say what is in a deck, results, matrices, a universal file or a store."""
    from ...verbs.inspect import inspect as tell

    output = Output(json=json, quiet=quiet)
    told = tell(files)
    emit_json(told.to_dict(), output)
    if speaks(output):
        from ..terminal_tables import inspect_table

        for file in told.files:
            stdout().print(f"{file.path}: {file.format}", markup=False, soft_wrap=True)
            stdout().print(inspect_table(_condensed(file)))


def _condensed(file: FileRow) -> FileRow:
    """Shorten long lists, and list what was skipped for one reason on one line."""
    warnings = file.warnings or ()
    left = len(warnings) - _MOST
    more = (f"and {left} more warnings",) if left > 0 else ()
    return replace(
        file,
        path="",
        format="",
        contents=_short(file.contents),
        skipped=_grouped(file.skipped),
        warnings=(*warnings[:_MOST], *more),
    )


def _short(value: Json) -> Json:
    if isinstance(value, Mapping):
        return {k: _short(v) for k, v in value.items() if v is not None}
    if not isinstance(value, list):
        return value
    if len(value) > _MOST and any(isinstance(v, str) and ": " in v for v in value):
        return [*value[:_ROWS], f"and {len(value) - _ROWS} more, see --json -"]
    if len(value) <= _MOST:
        return [_short(v) for v in value]
    numbers = all(isinstance(v, int | float) for v in value)
    if numbers:
        return [*value[:_SHOWN], f"... {len(value) - _SHOWN - 1} more ...", value[-1]]
    if all(isinstance(v, str) for v in value):
        return [*value[:_MOST], f"and {len(value) - _MOST} more"]
    return [*(_short(v) for v in value[:_MOST]), {"what": f"and {len(value) - _MOST} more"}]


def _grouped(skipped: Sequence[SkippedRow]) -> Table[SkippedRow]:
    reasons: dict[str, list[SkippedRow]] = {}
    for item in skipped:
        reasons.setdefault(item.why, []).append(item)
    rows = []
    for why, items in reasons.items():
        told = [i.what + (f" (line {i.line})" if i.line is not None else "") for i in items]
        more = f" and {len(told) - _MOST} more" if len(told) > _MOST else ""
        rows.append(SkippedRow(", ".join(told[:_MOST]) + more, None, why))
    return Table(rows, SkippedRow)
