"""``trueup inspect FILE...``."""

from pathlib import Path
from typing import Annotated

import typer

from ..console import emit_json, speaks, stdout
from ..options import JsonOption, Output, QuietOption


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
        from ..inspecting import condensed
        from ..terminal_tables import inspect_table

        for file in told.files:
            stdout().print(f"{file.path}: {file.format}", markup=False, soft_wrap=True)
            stdout().print(inspect_table(condensed(file)))
