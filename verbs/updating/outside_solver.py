"""The user's own Nastran: run on a deck, its modes read."""

from __future__ import annotations

import os
import shlex
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.data.modes import Modes
from ...core.errors import CheckError, InputError, TrueupError
from ..files.read import RESULTS, STORE, kind_of_file

if TYPE_CHECKING:
    from ...adapters.nastran import Deck
    from ...adapters.nastran.editing.changed_deck import ChangedDeck

_PLACE = "{deck}"
_BEST_FIRST = (".h5", ".op2", ".pch", ".f06")


@dataclass(frozen=True)
class OutsideSolver:
    """A command that solves a deck, in which ``{deck}`` stands for its path.

    It runs in the folder of the deck; what it leaves there is looked through for modes. `limit` is
    in seconds. `work` is the folder for its runs, wherever they are.
    """

    command: str
    limit: float
    work: Path

    def modes(self, changed: ChangedDeck) -> Modes:
        """Return the modes of a deck.

        Raises
        ------
        CheckError
            The command ends with another status than 0, or not in time, or leaves no modes: what
            it said last, and where the deck and its output are kept.
        """
        from ...adapters.nastran import read_deck

        self.work.mkdir(parents=True, exist_ok=True)
        run = Path(tempfile.mkdtemp(prefix="run", dir=self.work))
        path = changed.write(run)
        deck = read_deck(path)
        given = {p for p in run.rglob("*") if p.is_file()}
        log = run / "solver.log"
        words = [w.replace(_PLACE, str(path)) for w in shlex.split(self.command)]
        with log.open("wb") as said:
            try:
                status = _run(words, path.parent, said, self.limit)
            except OSError as error:
                raise InputError(
                    f"the solver '{words[0]}' cannot be run: {error.strerror or error}"
                ) from None
            except subprocess.TimeoutExpired:
                raise CheckError(
                    f"the solver did not end within {self.limit:g} s; {_kept(run)}"
                ) from None
        if status != 0:
            raise CheckError(f"the solver ended with status {status}{_last(log)}; {_kept(run)}")
        left = sorted(set(run.rglob("*")) - given - {log}, key=_rank)
        for file in left:
            try:
                found = _modes_in(file, deck)
            except TrueupError:
                continue
            if found is not None and len(found):
                return found
        fatal = next((line for f in [*left, log] for line in _fatal(f)), "")
        why = f" ('{fatal}')" if fatal else _last(log)
        raise CheckError(f"the solver left no modes{why}; {_kept(run)}")


@contextmanager
def outside_solver(command: str, limit: float) -> Iterator[OutsideSolver]:
    """Give a solver with a folder of its own, which stays where something fails.

    Raises
    ------
    InputError
        A command that does not say where the deck goes.
    """
    if _PLACE not in command:
        raise InputError(f"solver is '{command}'; say where the deck goes: 'nastran {_PLACE}'")
    work = Path(tempfile.mkdtemp(prefix="trueup-solver-"))
    yield OutsideSolver(command, limit, work)
    shutil.rmtree(work, ignore_errors=True)


def _run(words: list[str], folder: Path, said: object, limit: float) -> int:
    """Run a command; what it started ends with it where it takes too long."""
    process = subprocess.Popen(
        words, cwd=folder, stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.STDOUT,
        start_new_session=True,
    )  # type: ignore[call-overload]  # fmt: skip
    try:
        return int(process.wait(limit))
    except BaseException:
        if hasattr(os, "killpg"):
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
        process.wait()
        raise


def _modes_in(file: Path, deck: Deck) -> Modes | None:
    if not file.is_file():
        return None
    kind = kind_of_file(file)
    if kind is RESULTS:
        from ...adapters.nastran import read_modes

        return read_modes(file, deck)
    if kind is STORE:
        from ...adapters.store import read_store

        return next(iter(read_store(file).modes.values()), None)
    return None


def _rank(file: Path) -> tuple[int, str]:
    suffix = file.suffix.lower()
    return (_BEST_FIRST.index(suffix) if suffix in _BEST_FIRST else len(_BEST_FIRST), str(file))


def _lines(file: Path) -> list[str]:
    if not file.is_file():
        return []
    text = file.read_bytes().decode("latin-1")
    return [line.strip() for line in text.splitlines() if line.strip()]


def _fatal(file: Path) -> list[str]:
    return [line for line in _lines(file) if "FATAL" in line and line.isprintable()]


def _last(log: Path) -> str:
    lines = _lines(log)
    return f" ('{lines[-1]}')" if lines else ""


def _kept(run: Path) -> str:
    return f"the deck as it was then and what the solver left are in {run}"
