"""Modes of any file as a test: of another program, of a Nastran run, of a store."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..adapters.universal import ModalTest
from ..core.errors import InputError, Place
from .exchange import load
from .read import DECK, RESULTS, STORE, kind_of_file


def holds_modes(files: Sequence[Path]) -> bool:
    """Whether some of the files are results of a Nastran run or stores."""
    try:
        return any(kind_of_file(f) in (RESULTS, STORE) for f in files)
    except InputError:
        return False


def modes_as_test(files: Sequence[Path]) -> ModalTest:
    """Return modes as a test, on all their grids; a deck among the files gives their positions.

    Of several sets of modes in a store those of a test come first.

    Raises
    ------
    InputError
        No modes, or no positions of their grids.
    """
    cargo = load(files, None, None)
    here = Place(files[0])
    modes = cargo.modes.get("test") or next(iter(cargo.modes.values()), None)
    geometry = cargo.geometry
    if modes is cargo.modes.get("test") and "test_geometry" in cargo.extras:
        geometry = cargo.extras["test_geometry"]
    if modes is None:
        raise here.fault("holds no modes")
    if geometry is None:
        decks = " with" if any(kind_of_file(f) is DECK for f in files) else "; give the deck, too:"
        raise here.fault(f"holds modes and no positions of their grids{decks} a deck that has them")
    return ModalTest(geometry, modes, length_unit=geometry.length_unit, files=tuple(files))
