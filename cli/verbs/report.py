"""``trueup report RUN``."""

from pathlib import Path
from typing import Annotated

import typer

from ..options import QuietOption


def report(run: Annotated[Path, typer.Argument(metavar="RUN")], quiet: QuietOption = False) -> None:
    """Make the report of a run folder again."""
    from ...verbs.runs.report import report as make

    page = make(run)
    if not quiet:
        typer.echo(str(page))
