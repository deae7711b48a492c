"""``trueup plan DECK``."""

from pathlib import Path
from typing import Annotated

import typer

from ..console import emit_json, speaks, stdout, tell, working
from ..options import ForceOption, JsonOption, Output, QuietOption, UpToOption, VerboseOption


def plan(
    deck: Annotated[Path, typer.Argument(metavar="DECK")],
    sensors: Annotated[
        int | None, typer.Option("-n", "--sensors", help="How many. [default: 2 a mode]")
    ] = None,
    modes: Annotated[
        list[str] | None, typer.Option("--modes", metavar="7:14", help="Modes the test is for.")
    ] = None,
    fmax: UpToOption = None,
    exciters: Annotated[int, typer.Option("--exciters", help="Places to drive.")] = 2,
    method: Annotated[str, typer.Option("--method", metavar="independence|mac")] = "independence",
    directions: Annotated[str, typer.Option("--directions", help="Axes of sensors.")] = "XYZ",
    grids: Annotated[
        list[str] | None, typer.Option("--grids", metavar="1:100,205", help="That can carry one.")
    ] = None,
    wanted: Annotated[
        list[str] | None, typer.Option("--wanted", metavar="40|40:Z", help="There in any case.")
    ] = None,
    exclude: Annotated[
        list[str] | None, typer.Option("--exclude-sensor", metavar="40|40:Z", help="Never there.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE|DIR", help="Nodes as .unv; or a folder with tables."),
    ] = None,
    json: JsonOption = None,
    force: ForceOption = False,
    quiet: QuietOption = False,
    verbose: VerboseOption = False,
) -> None:
    """Choose where to put sensors and exciters for a modal test."""
    from ...verbs.plan import plan as find

    output = Output(json=json, force=force, quiet=quiet, verbose=verbose)
    with working(f"reading {deck.name}", output) as say:
        found = find(
            deck, sensors, modes=modes or None, fmax=fmax, exciters=exciters, method=method,
            directions=directions, grids=grids or None, wanted=wanted or (),
            exclude=exclude or (), progress=say,
        )  # fmt: skip
    if out is not None and out.suffix in (".unv", ".uff"):
        found.write(out)
    elif out is not None:
        found.save(out, force)
    emit_json(found.to_dict(), output)
    if speaks(output):
        from ..plan_tables import plan_tables

        for table in plan_tables(found):
            stdout().print(table)
    tell(output, "warning", found.warnings)
