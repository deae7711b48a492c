"""``trueup export-runs DECK -p PARAMETER``."""

from pathlib import Path
from typing import Annotated

import typer

from ...core.errors import InputError
from ..console import emit_json, speaks, stdout, working
from ..options import JsonOption, Output, QuietOption


def export_runs(
    deck: Annotated[Path, typer.Argument(metavar="DECK")],
    parameters: Annotated[
        list[str] | None,
        typer.Option("-p", "--parameter", metavar="PARAMETER", help="As for update; repeatable."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Folder. [default: DECK_runs]")
    ] = None,
    json: JsonOption = None,
    quiet: QuietOption = False,
) -> None:
    """Write the decks from whose exported matrices all derivative matrices follow.

    Run each with your own Nastran in its folder; it punches stiffness and mass. The constant
    matrices of all terms then come from ``trueup convert DIR/runs.json terms.h5`` (or .op4), the
    model with its parameters from trueup.adapters.nastran.read_runs.
    """
    from ...adapters.nastran import parse_parameter, write_runs
    from ...adapters.run_folder.write_run import run_folder

    output = Output(json=json, quiet=quiet)
    if not parameters:
        raise InputError("no parameter was named: give at least one, such as -p 'PSHELL 3 T'")
    specs = [parse_parameter(p) for p in parameters]
    folder = out or Path(f"{deck.stem}_runs")
    with run_folder(folder, force=False) as work, working("writing the decks", output):
        index = write_runs(deck, specs, work)
    emit_json(index, output)
    if speaks(output):
        stdout().print(
            f"{folder}: {len(index['runs'])} decks; run each with Nastran in its own folder",
            markup=False, soft_wrap=True,
        )  # fmt: skip
