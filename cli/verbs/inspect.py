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
    """Say what is in a deck, results, matrices, a universal file or a store."""
    output = Output(json=json, quiet=quiet)
    result: dict[str, Any] = {
        "schema": "trueup/inspect/1",
        "files": [describe(path) for path in files],
    }
    emit_json(result, output)
    if speaks(output):
        from ..inspecting import condensed
        from ..tables import inspect_table

        for entry in result["files"]:
            stdout().print(f"{entry['path']}: {entry['format']}", markup=False, soft_wrap=True)
            stdout().print(inspect_table(condensed(entry)))
