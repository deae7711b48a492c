"""``trueup solve DECK``."""

from pathlib import Path
from typing import Annotated

import typer

from ...core.errors import InputError
from ..console import emit_json, speaks, stdout, tell, working
from ..options import JsonOption, Output, QuietOption, VerboseOption


def solve(
    deck: Annotated[Path, typer.Argument(metavar="DECK")],
    number: Annotated[
        int | None, typer.Option("-n", "--number", help="Modes, rigid-body ones included.")
    ] = None,
    fmax: Annotated[float | None, typer.Option("--fmax", help="All modes up to here [Hz].")] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="Modes as .h5 or .unv.")
    ] = None,
    json: JsonOption = None,
    quiet: QuietOption = False,
    verbose: VerboseOption = False,
) -> None:
    """Find the normal modes with the embedded solver."""
    from ...verbs.solve import solve as find

    output = Output(json=json, quiet=quiet, verbose=verbose)
    _check(number, fmax, out)
    with working(f"reading {deck.name}", output) as say:
        found = find(deck, number, fmax, progress=say)
    if out:
        found.write(out)
    emit_json(found.to_dict(), output)
    if speaks(output):
        from ..terminal_tables import solve_table

        stdout().print(solve_table(found))
    tell(output, "warning", found.warnings)


def _check(number: int | None, fmax: float | None, out: Path | None) -> None:
    if number is not None and number < 1:
        raise typer.BadParameter(f"-n is {number}; ask for at least one mode")
    if fmax is not None and not fmax > 0.0:
        raise typer.BadParameter(f"--fmax is {fmax}; give a frequency above 0 Hz")
    if out is not None and out.suffix not in {".h5", ".unv", ".uff"}:
        raise typer.BadParameter(f"--out {out}: modes are written as .h5 or .unv")
    if out is not None and not out.parent.is_dir():
        raise InputError(f"--out {out}: the folder {out.parent} does not exist", file=out)
