"""The verbs of the command line and the exit statuses."""

import os
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
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    pass


def _register() -> None:
    from .options import CORRELATE, DISCOVER, PARAMETERS, UPDATE, comparing
    from .verbs.compare import compare
    from .verbs.comparing import correlate, discover, update
    from .verbs.convert import convert
    from .verbs.demo import demo
    from .verbs.export_runs import export_runs
    from .verbs.identify import identify
    from .verbs.inspect import inspect
    from .verbs.parameters import parameters
    from .verbs.plan import plan
    from .verbs.report import report
    from .verbs.solve import solve

    app.command()(inspect)
    app.command()(convert)
    app.command("export-runs")(export_runs)
    app.command()(solve)
    app.command()(identify)
    app.command()(comparing(correlate, CORRELATE))
    app.command()(comparing(update, UPDATE, changes_deck=True, goes_on=True))
    app.command()(comparing(discover, DISCOVER, changes_deck=True))
    app.command()(comparing(parameters, PARAMETERS, needs_test=False))
    app.command()(plan)
    app.command()(compare)
    app.command()(report)
    app.command()(demo)


_register()


def run() -> int:
    """Run the command line and return the exit status.

    0 done; 1 the input is at fault; 2 wrong usage; 3 the work did not meet its own check; 70 a
    fault of trueup's own. No exception leaves here: each is said in one sentence. With
    TRUEUP_TRACEBACK set, its traceback comes before.
    """
    from ..core.errors import CheckError, TrueupError
    from .console import spell_what_cannot_be_shown

    spell_what_cannot_be_shown()
    try:
        app()
    except SystemExit as stop:
        return stop.code if isinstance(stop.code, int) else 0
    except BrokenPipeError:
        sys.stderr.close()
        return 0
    except CheckError as failed:
        return _say(str(failed), 3)
    except TrueupError as fault:
        return _say(str(fault), 1)
    except MemoryError:
        return _say("the machine's memory does not suffice for this model", 1)
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        return _say(f"{where}{error.strerror or error}", 1)
    except Exception as error:  # noqa: BLE001 - the one place where anything may arrive
        what = " ".join(f"{type(error).__name__}: {error}".split())
        return _say(
            f"a fault of trueup's own, not of your input as far as it can tell ({what}); set "
            f"{_TRACEBACK}=1, run it again and report what is printed",
            70,
        )
    return 0


_TRACEBACK = "TRUEUP_TRACEBACK"
_WORDS = {
    "give force=True": "give --force",
    "give lossy=True": "give --lossy",
    "merge=True": "--merge",
    "another run folder": "another --out",
    " deck_length_unit=": " --deck-length-unit ",
    "with deck_length_unit": "with --deck-length-unit",
    "modes= gives": "--modes gives",
    "leave modes= out, or reduction=": "leave --modes out, or --reduction",
    "reduction= needs": "--reduction needs",
    "from_='": "--from '",
    "to='": "--to '",
}
"""What the library's sentences ask for, as the command line is asked for it."""


def _say(sentence: str, status: int) -> int:
    if os.environ.get(_TRACEBACK):
        import traceback

        traceback.print_exc()
    for library, here in _WORDS.items():
        sentence = sentence.replace(library, here)
    sys.stderr.write(f"trueup: {sentence}\n")
    return status
