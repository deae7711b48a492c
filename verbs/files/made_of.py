"""What a result was made of: the version of trueup, and the files it read."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict

from ...core.errors import InputError
from ...core.files import reading
from ...core.results.made import InputRow, ModeNameRow, WeightRow
from ...core.results.plain import Table
from ...core.version import VERSION
from ..studies.study import Study
from .sources import Measured, Source, read_deck

if TYPE_CHECKING:
    from ...adapters.nastran import Deck
    from ...adapters.nastran.editing.changed_deck import ChangedDeck


class MadeOf(TypedDict):
    """Fields of `MadeTables`."""

    version: str
    inputs: Table[InputRow]


def made_of(deck: Deck | None, test: Measured, modes: Source | None = None) -> MadeOf:
    """Return the version, and each file of deck, test and modes with its SHA-256."""
    files = list(deck.files) if deck is not None and deck.on_disk else []
    files += test.files
    files += [Path(modes)] if isinstance(modes, str | Path) else []
    return made_of_files(files)


def made_of_files(files: Iterable[Path]) -> MadeOf:
    """Return the version, and each file with its SHA-256."""
    rows = (InputRow(str(f), _hash(f)) for f in dict.fromkeys(files) if f.is_file())
    return {"version": VERSION, "inputs": Table(rows, InputRow)}


class Beside(TypedDict):
    """Fields of `RunTables` beside what was found."""

    weight: Table[WeightRow]
    mode_names: Table[ModeNameRow]


def beside(study: Study, unit: str | None, **decks: Deck | ChangedDeck | None) -> Beside:
    """Return what decks weigh that can be assembled, and the names that modes were given."""
    rows: list[WeightRow] = []
    for name, deck in decks.items():
        with suppress(InputError):  # cards that cannot be assembled are told elsewhere
            rows += [] if deck is None else [_weighed(name, read_deck(deck), unit)]
    names = Table((ModeNameRow(*named) for named in study.mode_names), ModeNameRow)
    return {"weight": Table(rows, WeightRow), "mode_names": names}


def _weighed(name: str, deck: Deck, unit: str | None) -> WeightRow:
    from ...adapters.nastran import weight
    from ...adapters.nastran.properties.mass_unit import mass_unit

    found, each = weight(deck), mass_unit(deck, unit).kilograms
    kilograms = None if each is None else found.mass * each
    x, y, z = map(float, found.centre_of_gravity)
    return WeightRow(name, found.mass, kilograms, x, y, z, unit)


def _hash(path: Path) -> str:
    with reading(path), path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
