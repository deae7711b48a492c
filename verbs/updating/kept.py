"""What a run has done so far, kept in a folder piece by piece, so that it can go on from there."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.errors import Place, path_of
from ...core.files import reading
from ...core.independent import Each, R, T
from ...core.updating.determined import Steps
from ...core.updating.stages import Iteration
from ...core.version import VERSION
from ..files.made_of import MadeOf
from ..studies.executors import executor
from ..studies.study import Study
from ..studies.study_text import study_toml

if TYPE_CHECKING:
    from ..studies.options import Files

_OF = "made_of"
"""The file that says of what run the pieces are."""


@dataclass(frozen=True)
class Kept:
    """The pieces of a run, counted in the order in which they are asked for.

    A piece that is in `folder` is taken from there, another is done and put there. Without a folder
    nothing is kept. `of` is the run that they are of.
    """

    folder: Path | None
    of: str
    _numbers: Iterator[int] = field(default_factory=count)

    def each(self, asked: str) -> Each:
        """Return what does independent pieces of work by an executor, those that are not there."""

        def done(work: Callable[[T], R], items: Sequence[T], /) -> Iterator[R]:
            numbers = [next(self._numbers) for _ in items]
            there = [self._read(n) for n in numbers]
            due = [item for item, value in zip(items, there, strict=True) if value is None]
            with ExitStack() as stack:
                fresh = stack.enter_context(executor(asked))(work, due) if due else iter(())
                for number, value in zip(numbers, there, strict=True):
                    if value is None:
                        value = (next(fresh),)
                        self._write(number, value)
                    yield value[0]

        return done

    def steps(self) -> Steps:
        """Return the steps of the next update as far as it came, and what is told of others."""
        number = next(self._numbers)
        taken: list[Iteration] = [*(self._read(number) or ())]

        def took(step: Iteration) -> None:
            taken.append(step)
            self._write(number, tuple(taken))

        return tuple(taken), took

    def _read(self, number: int) -> tuple[Any, ...] | None:
        if self.folder is None or not (self.folder / str(number)).is_file():
            return None
        found: tuple[Any, ...] = pickle.loads((self.folder / str(number)).read_bytes())
        return found

    def _write(self, number: int, value: tuple[Any, ...]) -> None:
        if self.folder is None:
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / _OF).write_text(self.of)
        part = self.folder / f"{number}.part"
        part.write_bytes(pickle.dumps(value))
        part.replace(self.folder / str(number))


def kept_in(folder: Files | None, asked: Study, made: Iterable[MadeOf]) -> Kept:
    """Return what is kept of a run in a folder, which need not be there yet.

    Raises
    ------
    InputError
        The folder is no such folder, or of another study, deck, test or version.
    """
    plain = replace(asked, deck=None, test=(), out=None, logo=None, source=None)
    files = [row.sha256 for one in made for row in one["inputs"]]
    told = "\n".join((VERSION, *files, study_toml(plain)))
    of = hashlib.sha256(told.encode()).hexdigest()
    if folder is None:
        return Kept(None, of)
    path = path_of(folder, "the folder of what is done")
    if path.exists():
        with reading(path):
            there = (path / _OF).read_text() if (path / _OF).is_file() else ""
        if there != of:
            raise Place(path).fault("is not of this study, deck, test and version; remove it")
    return Kept(path, of)
