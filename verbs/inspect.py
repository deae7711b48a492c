"""The verb `inspect`."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from ..core.errors import InputError, Place
from ..core.results.inspection import FileRow, InspectTables
from ..core.results.plain import Table, plain, typed
from .files.read import describe
from .files.sources import Source, file_of
from .studies.options import checked_call


@dataclass(frozen=True, eq=False, kw_only=True)
class Inspected(InspectTables):
    """What `inspect` told: a row a file."""


@checked_call
def inspect(files: Source) -> Inspected:
    """Say what is in decks, results, matrices, universal files and stores.

    Parameters
    ----------
    files : path, Deck or sequence of them

    Returns
    -------
    Inspected

    Raises
    ------
    InputError
        A file that does not exist, is of no known format or cannot be read.
    """
    every = files if isinstance(files, list | tuple) else [files]
    if not every:
        raise InputError("no file is given to inspect")
    rows = (typed(FileRow, plain(describe(_path(f)))) for f in every)
    return Inspected(files=Table(rows, FileRow))


def _path(source: Source) -> Path:
    if isinstance(source, str | os.PathLike):
        return file_of(source, "a file")
    from ..adapters.nastran import Deck

    if not isinstance(source, Deck):
        return file_of(source, "a file")
    if source.changed:
        raise Place(source.path).fault("was changed: write the deck and inspect that")
    return source.path
