"""``trueup convert SRC... DST``."""

from pathlib import Path
from typing import Annotated, Any

import typer

from ...core.errors import InputError
from ...verbs.files.delivery import TARGETS
from ...verbs.files.exchange import KINDS
from ..console import emit_json, speaks, stdout, tell, working
from ..options import JsonOption, Output, QuietOption


def convert(
    files: Annotated[list[Path], typer.Argument(metavar="SRC... DST", show_default=False)],
    source_format: Annotated[
        str | None,
        typer.Option("--from", metavar="|".join(KINDS), help="Read SRC as this. [default: told "
                     "by the contents]"),
    ] = None,
    target_format: Annotated[
        str | None,
        typer.Option("--to", metavar="|".join(TARGETS), help="Write DST as this. [default: by "
                     "its suffix]"),
    ] = None,
    subcase: Annotated[
        int | None, typer.Option("--subcase", help="Subcase whose modes are meant.")
    ] = None,
    boundary: Annotated[
        str | None,
        typer.Option("--boundary", metavar="GRIDS", help="Reduce a deck to these grids (11, 20-25, "
                     "31:123) and component modes (Craig-Bampton)."),
    ] = None,
    modes: Annotated[
        int | None,
        typer.Option("--modes", "-n", help="Number of component modes [default: 20], or of a "
                     "plant [default: 30]."),
    ] = None,
    fmax: Annotated[
        float | None, typer.Option("--fmax", help="Highest frequency of component modes, upper "
                                   "end of the band of a plant [Hz]."),
    ] = None,
    lossy: Annotated[
        bool, typer.Option("--lossy", help="Leave out what DST cannot hold.")
    ] = False,
    merge: Annotated[
        bool, typer.Option("--merge", help="Write a deck and its INCLUDE files as one file.")
    ] = False,
    inputs: Annotated[
        str | None,
        typer.Option(metavar="GRID:DIR,...", help="Forces and moments into a plant: 1187:+Z,40:RX"),
    ] = None,
    outputs: Annotated[
        str | None,
        typer.Option(metavar="GRID:DIR[:vel|acc],...", help="Motions out of it: tip=40:+X:acc; "
                     "@7:+Z is a sensor of the test of a run."),
    ] = None,
    fmi: Annotated[
        int | None, typer.Option(metavar="2|3", help="Version of FMI. [default: 2]")
    ] = None,
    platforms: Annotated[
        str | None,
        typer.Option(metavar="linux64,win64,...|all", help="What a unit has binaries for. "
                     "[default: whatever a compiler at hand makes]"),
    ] = None,
    damping: Annotated[
        str | None,
        typer.Option(metavar="RATIO|test|deck|K:RATIO,...", help="[default: what test and deck "
                     "know, 0.01 where they do not]"),
    ] = None,
    lines: Annotated[
        int | None,
        typer.Option(help="Of frequency responses (.unv, .uff) up to --fmax. [default: 1600]"),
    ] = None,
    residual: Annotated[
        bool | None,
        typer.Option("--residual/--no-residual", help="Residual modes for what is left out."),
    ] = None,
    rigid_body: Annotated[
        bool | None, typer.Option("--rigid-body/--no-rigid-body", help="Rigid-body modes.")
    ] = None,
    units: Annotated[
        str | None, typer.Option(metavar="si|deck", help="Of a plant. [default: si]")
    ] = None,
    deck_length_unit: Annotated[
        str | None, typer.Option(metavar="m|mm|in|ft", help="Where a deck does not say it.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace DST if it exists.")] = False,
    json: JsonOption = None,
    quiet: QuietOption = False,
) -> None:  # fmt: skip
    """Write what one or several files hold in another format.

    Results, matrices, universal files and stores go into universal files (.unv, .uff), stores
    (.h5), OP4 (.op4) and DMIG (.pch). A deck alone is assembled; beside results or matrices it
    gives them geometry and axes. A deck, a run folder or modes become a unit for simulators (.fmu),
    a state space (.npz, .mat) or frequency responses (.unv, .uff) with --inputs and --outputs.
    A deck goes with its INCLUDE files, byte for byte, into a folder.
    """
    from ...verbs.convert import convert as write

    output = Output(json=json, force=force, quiet=quiet)
    if len(files) < 2:
        raise InputError("give at least one source and the destination: convert SRC... DST")
    *sources, destination = files
    plant = {
        "inputs": inputs, "outputs": outputs, "fmi": fmi, "platforms": platforms,
        "damping": damping, "lines": lines, "residual": residual, "rigid_body": rigid_body,
        "units": units, "deck_length_unit": deck_length_unit,
    }  # fmt: skip
    given: Any = {name: value for name, value in plant.items() if value is not None}
    with working("reading", output) as say:
        done = write(
            sources, destination, from_=source_format, to=target_format, subcase=subcase,
            boundary=boundary, modes=modes, fmax=fmax, lossy=lossy, merge=merge, force=force,
            progress=say, **given,
        )  # fmt: skip
    emit_json(done.to_dict(), output)
    if speaks(output):
        told = "; ".join(f"{k} {v}" for k, v in done.written.items())
        stdout().print(f"{destination} ({done.format}): {told}", markup=False, soft_wrap=True)
    tell(output, "left out", done.lost, wrap=False)
    tell(output, "note", done.warnings, wrap=False)
