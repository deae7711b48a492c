"""``trueup solve DECK``."""

from pathlib import Path
from typing import Annotated

import typer

from ...core.errors import InputError
from ...verbs.studies.study import Study, read_study
from ..console import emit_json, speaks, stdout, tell, working
from ..options import (
    ForceOption,
    JsonOption,
    NumberOption,
    Output,
    QuietOption,
    StudyOption,
    UpToOption,
    VerboseOption,
)

_FILES = (".h5", ".unv", ".uff")


def solve(
    deck: Annotated[Path | None, typer.Argument(metavar="DECK")] = None,
    study: StudyOption = None,
    number: NumberOption = None,
    fmax: UpToOption = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE|DIR", help="Modes as .h5 or .unv; or a run folder."),
    ] = None,
    json: JsonOption = None,
    force: ForceOption = False,
    quiet: QuietOption = False,
    verbose: VerboseOption = False,
) -> None:
    """Find the normal modes with the embedded solver."""
    from ...verbs.solve import solve as find

    output = Output(json=json, force=force, quiet=quiet, verbose=verbose)
    asked = read_study(study) if study else Study()
    deck, out = deck or asked.deck, out or asked.out
    if deck is None:
        raise typer.BadParameter("give DECK, or a study file (--study) that names it")
    _check(number, fmax, out, force)
    with working(f"reading {deck.name}", output) as say:
        found = find(deck, number, fmax, study=asked, progress=say)
    if out and out.suffix in _FILES:
        found.write(out)
    elif out:
        found.save(out, force)
    emit_json(found.to_dict(), output)
    if speaks(output):
        from ..terminal_tables import solve_table

        stdout().print(solve_table(found))
    tell(output, "warning", found.warnings)


def _check(number: int | None, fmax: float | None, out: Path | None, force: bool) -> None:
    from ...adapters.run_folder.write_run import refuse_existing

    if number is not None and number < 1:
        raise typer.BadParameter(f"-n is {number}; ask for at least one mode")
    if fmax is not None and not fmax > 0.0:
        raise typer.BadParameter(f"--fmax is {fmax}; give a frequency above 0 Hz")
    if out is not None and out.suffix not in _FILES:
        if out.suffix:
            raise typer.BadParameter(f"--out {out}: modes are written as .h5 or .unv")
        refuse_existing(out, force)
    elif out is not None and not out.parent.is_dir():
        raise InputError(f"--out {out}: the folder {out.parent} does not exist", file=out)
