"""Which adapter reads and describes which file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ..core.errors import InputError

DECK, UNIVERSAL, STORE = "deck", "universal", "store"
RESULTS, OP4, PUNCH, RUNS = "results", "op4", "punch", "runs"

_DECK_SUFFIXES = (".bdf", ".dat", ".nas", ".blk", ".inc", ".asm", ".fem", ".pch", ".ecd", ".cmn")
_UNIVERSAL_SUFFIXES = (".unv", ".uff", ".uf", ".bunv")
_HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_HEAD = 20000


def _deck(path: Path) -> dict[str, Any]:
    from ..adapters.nastran import describe_deck

    return describe_deck(path)


def _universal(path: Path) -> dict[str, Any]:
    from ..adapters.universal import describe_universal

    return describe_universal(path)


def _results(path: Path) -> dict[str, Any]:
    from ..adapters.nastran import describe_results

    return describe_results(path)


def _store(path: Path) -> dict[str, Any]:
    from ..adapters.store import describe_store

    return describe_store(path)


def _matrices(path: Path) -> dict[str, Any]:
    from ..adapters.nastran import describe_matrices

    return describe_matrices(path)


def _runs(path: Path) -> dict[str, Any]:
    from ..adapters.nastran import describe_runs

    return describe_runs(path)


_DESCRIBERS: dict[str, Callable[[Path], dict[str, Any]]] = {
    DECK: _deck,
    UNIVERSAL: _universal,
    STORE: _store,
    RESULTS: _results,
    OP4: _matrices,
    PUNCH: _matrices,
    RUNS: _runs,
}


def describe(path: Path) -> dict[str, Any]:
    """Return {path, format, contents, skipped, ...} of any known file.

    Raises
    ------
    InputError
        A file that does not exist or is of no known format.
    """
    return {"path": str(path), **_DESCRIBERS[kind_of_file(path)](path)}


def kind_of_file(path: Path) -> str:
    """Tell what a file is, by its contents first and its suffix where those leave it open.

    Returns
    -------
    {"deck", "universal", "store", "results", "op4", "punch", "runs"}
        ``results`` are those of a Nastran run (OP2, HDF5, F06, punched eigenvectors), ``punch`` is
        a file with DMIG matrices, or of an external superelement, and no deck; ``runs`` is the
        index (``runs.json``) of a folder that export-runs wrote.

    Raises
    ------
    InputError
        A file that does not exist, is empty or of no known format.
    """
    from ..adapters.store import is_store

    if not path.is_file():
        raise InputError(f"{path} does not exist or is not a file")
    try:
        with path.open("rb") as stream:
            head = stream.read(_HEAD)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    if not head.strip():
        raise InputError(f"{path} is empty")
    if head.startswith(_HDF5_SIGNATURE):
        return STORE if is_store(path) else RESULTS
    if head.lstrip()[:3].split() == [b"-1"] or path.suffix.lower() in _UNIVERSAL_SUFFIXES:
        return UNIVERSAL
    return _nastran_kind(path, head)


def _nastran_kind(path: Path, head: bytes) -> str:
    from ..adapters.nastran import is_op4, is_runs

    if is_runs(head):
        return RUNS
    if is_op4(path):
        return OP4
    suffix = path.suffix.lower()
    if b"\0" in head or suffix == ".op2":
        if suffix == ".op2" or head[:4] in _OP2_STARTS:
            return RESULTS
        raise _unknown(path)
    text = head.decode("latin-1").upper()
    if "$TITLE" in text and "$LABEL" in text and suffix not in (".bdf", ".nas"):
        return RESULTS
    if suffix == ".f06" or "N A S T R A N" in text:
        return RESULTS
    if _is_dmig_alone(text, path):
        return PUNCH
    if suffix in _DECK_SUFFIXES or "BEGIN BULK" in text or "\nCEND" in text or "\nGRID" in text:
        return DECK
    raise _unknown(path)


_OP2_STARTS = (b"\x04\0\0\0", b"\0\0\0\x04", b"\x08\0\0\0", b"\0\0\0\x08")


def _is_dmig_alone(text: str, path: Path) -> bool:
    cards = [x for x in text.splitlines() if x[:1].isalpha()]
    is_punch = path.suffix.lower().startswith(".pch") or bool(cards and cards[0][:4] == "DMIG")
    return is_punch and any(x.startswith(("DMIG", "EXTRN")) for x in cards)


def _unknown(path: Path) -> InputError:
    return InputError(
        f"{path}: the format is not recognised; known are Nastran decks, OP2, HDF5, OP4, punch and "
        "F06, universal files and stores of trueup"
    )
