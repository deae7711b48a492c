"""Progress on standard error, results on standard output."""

from __future__ import annotations

import codecs
import io
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.ascii import in_ascii

if TYPE_CHECKING:
    from rich.console import Console

    from .options import Output


_INTERRUPTED = 130
"""Exit status of a program that Ctrl-C ended: 128 and the number of the signal."""


def spell_what_cannot_be_shown() -> None:
    """Let standard output and error spell the signs that their encoding does not have."""

    def spelled(error: UnicodeError) -> tuple[str, int]:
        assert isinstance(error, UnicodeEncodeError)
        return in_ascii(error.object[error.start : error.end]), error.end

    codecs.register_error("trueup.spelled", spelled)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="trueup.spelled")


def stdout() -> Console:
    """Return a console on standard output, as wide as tables need when it is not a terminal."""
    from rich.console import Console

    return Console(file=sys.stdout, width=None if sys.stdout.isatty() else 110, highlight=False)


def stderr() -> Console:
    """Return a console on standard error."""
    from rich.console import Console

    return Console(stderr=True, highlight=False)


def tell(output: Output, word: str, sentences: Iterable[str], wrap: bool = True) -> None:
    """Tell warnings and the like on standard error, one a line; `quiet` leaves the warnings."""
    for sentence in sentences if word == "warning" or not output.quiet else ():
        stderr().print(f"{word}: {sentence}", markup=False, soft_wrap=not wrap)


def speaks(output: Output) -> bool:
    """Whether tables and sentences may go to standard output."""
    return not output.quiet and output.json != "-"


@contextmanager
def working(what: str, output: Output, keep: Path | None = None) -> Iterator[Callable[[str], None]]:
    """Show what is done and the elapsed time on standard error while the block runs.

    `keep` is where the block leaves what it has done when it is interrupted.

    What the block is given takes further words; ``--verbose`` prints them, one a line.
    """

    def told(what: str) -> None:
        if output.verbose:
            stderr().print(what, markup=False)

    with _interruptible(what, keep):
        if output.quiet or not sys.stderr.isatty():
            yield told
            return
        with _shown(what) as show:

            def say(what: str) -> None:
                show(what)
                told(what)

            yield say


@contextmanager
def _interruptible(what: str, keep: Path | None) -> Iterator[None]:
    """Say of an interrupted piece of work what it left."""
    try:
        yield
    except KeyboardInterrupt:
        left = what_is_left(keep) or "; nothing was written"
        sys.stderr.write(f"trueup: interrupted while {what}{left}\n")
        raise SystemExit(_INTERRUPTED) from None


def what_is_left(keep: Path | None) -> str:
    """Say of work that was cut off where what was done is, and how to go on; "" of nothing."""
    there = keep is not None and keep.is_dir()
    return f"; what was done is in {keep}: --resume goes on from there" if there else ""


@contextmanager
def _shown(what: str) -> Iterator[Callable[[str], None]]:
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    with Progress(
        SpinnerColumn(),
        TextColumn("{task.description}", markup=False),
        TimeElapsedColumn(),
        console=stderr(),
        transient=True,
    ) as progress:
        task = progress.add_task(what, total=None)
        yield lambda what: progress.update(task, description=what)


def emit_json(result: Mapping[str, object], output: Output) -> None:
    """Write the result where ``--json`` asks for it."""
    from ..adapters.run_folder.write_run import json_text, write_json

    if output.json == "-":
        sys.stdout.write(json_text(result))
    elif output.json:
        write_json(Path(output.json), result)
