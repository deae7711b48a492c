"""What a result was made of: the version of trueup, and the files it read."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict

from ..core.files import reading
from ..core.results.correlation import InputRow
from ..core.results.plain import Table
from ..core.version import VERSION
from .sources import Measured, Source

if TYPE_CHECKING:
    from ..adapters.nastran import Deck


class MadeOf(TypedDict):
    """Fields of `RunTables`."""

    version: str
    inputs: Table[InputRow]


def made_of(deck: Deck | None, test: Measured, modes: Source | None = None) -> MadeOf:
    """Return the version, and each file of deck, test and modes with its SHA-256."""
    files = list(deck.files) if deck is not None and deck.on_disk else []
    files += test.files
    files += [Path(modes)] if isinstance(modes, str | Path) else []
    rows = (InputRow(str(f), _hash(f)) for f in dict.fromkeys(files) if f.is_file())
    return {"version": VERSION, "inputs": Table(rows, InputRow)}


def _hash(path: Path) -> str:
    with reading(path), path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
