"""``trueup compare RUN...`` and ``trueup compare DECK|MODES...``."""

from pathlib import Path
from typing import Annotated

import typer

from ..console import emit_json, speaks, stdout, tell, working
from ..options import ForceOption, JsonOption, NumberOption, Output, QuietOption, UpToOption


def compare(
    sources: Annotated[list[Path], typer.Argument(metavar="RUN|DECK|MODES...")],
    number: NumberOption = None,
    fmax: UpToOption = None,
    mac_min: Annotated[float, typer.Option("--mac-min", help="Smallest MAC of a pair.")] = 0.7,
    frequency_tolerance: Annotated[
        float, typer.Option("--frequency-tolerance", help="Largest relative difference of a pair.")
    ] = 0.3,
    cluster_width: Annotated[
        float, typer.Option("--cluster-width", help="Bandwidth within which modes are close.")
    ] = 0.02,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Keep result.json and tables.")
    ] = None,
    json: JsonOption = None,
    force: ForceOption = False,
    quiet: QuietOption = False,
) -> None:
    """Put runs, or decks and files of modes, side by side; the first of these is the reference."""
    from ...verbs.compare import compare as find

    output = Output(json=json, force=force, quiet=quiet)
    with working("comparing", output) as say:
        found = find(
            sources, number, fmax, mac_min=mac_min, frequency_tolerance=frequency_tolerance,
            cluster_width=cluster_width, progress=say,
        )  # fmt: skip
    if out is not None:
        found.save(out, force)
    emit_json(found.to_dict(), output)
    if speaks(output):
        from ..comparison_tables import comparison_tables

        for table in comparison_tables(found):
            stdout().print(table)
    tell(output, "warning", found.warnings)
