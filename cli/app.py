"""The verbs of the command line and the exit statuses."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from .. import __version__

app = typer.Typer(
    name="trueup",
    help="Correlate Nastran models with modal tests, update them, and find what they lack.",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


def _version(asked: bool) -> None:
    if asked:
        typer.echo(f"trueup {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    pass


def _register() -> None:
    from .options import UPDATE, comparing
    from .verbs.convert import convert
    from .verbs.correlate import correlate
    from .verbs.demo import demo
    from .verbs.discover import discover
    from .verbs.export_runs import export_runs
    from .verbs.inspect import inspect
    from .verbs.report import report
    from .verbs.solve import solve
    from .verbs.update import update

    app.command()(inspect)
    app.command()(convert)
    app.command("export-runs")(export_runs)
    app.command()(solve)
    app.command()(comparing(correlate))
    app.command()(comparing(update, UPDATE))
    app.command()(comparing(discover))
    app.command()(report)
    app.command()(demo)


_register()


def run() -> int:
    """Run the command line and return the exit status.

    0 done; 1 the input is at fault; 2 wrong usage; 3 the work did not meet its own check.
    """
    from ..core.errors import CheckError, TrueupError

    try:
        app()
    except SystemExit as stop:
        return stop.code if isinstance(stop.code, int) else 0
    except CheckError as failed:
        sys.stderr.write(f"trueup: {failed}\n")
        return 3
    except TrueupError as fault:
        sys.stderr.write(f"trueup: {fault}\n")
        return 1
    except BrokenPipeError:
        sys.stderr.close()
        return 0
    except MemoryError:
        sys.stderr.write("trueup: the machine's memory does not suffice for this model\n")
        return 1
    return 0
