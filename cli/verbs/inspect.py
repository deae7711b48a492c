"""``trueup inspect FILE...``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from ..console import emit_json, speaks, stdout
from ..formats import describe
from ..options import JsonOption, Output, QuietOption


def inspect(
    files: Annotated[list[Path], typer.Argument(metavar="FILE...")],
    json: JsonOption = None,
    quiet: QuietOption = False,
) -> None:
    """Say what is in a deck, a result file or a universal file."""
    output = Output(json=json, quiet=quiet)
    result: dict[str, Any] = {
        "schema": "trueup/inspect/1",
        "files": [describe(path) for path in files],
    }
    emit_json(result, output)
    if speaks(output):
        from ..tables import inspect_table

        for entry in result["files"]:
            stdout().print(inspect_table(entry))
