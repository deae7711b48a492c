"""The kinds of files that trueup reads: one list, which `read`, ``inspect`` and ``convert`` use."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from ...core.errors import Place, path_of
from ...core.files import reading
from .sources import Source, read_test

_HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_OP2_STARTS = (b"\x04\0\0\0", b"\0\0\0\x04", b"\x08\0\0\0", b"\0\0\0\x08")
_UNIVERSAL_SUFFIXES = (".unv", ".uff", ".uf", ".bunv")
_DECK_SUFFIXES = (".bdf", ".dat", ".nas", ".blk", ".inc", ".asm", ".fem", ".pch", ".ecd", ".cmn")
_HEAD = 20000


@dataclass(frozen=True)
class FileKind:
    """A kind of file.

    Parameters
    ----------
    name : str
        What ``convert --from`` calls it.
    matches : callable
        ``matches(path, head)`` tells it by the first bytes, and by the suffix where those leave
        it open; kinds that stand before it in the list did not match.
    describe : callable
        ``describe(path)`` returns {format, contents, skipped, ...}.
    read : callable
        ``read(path)`` returns its noun.
    """

    name: str
    matches: Callable[[Path, bytes], bool]
    describe: Callable[[Path], dict[str, Any]]
    read: Callable[[Path], object]


def _late(room: str, name: str) -> Callable[[Any], Any]:
    """Return a function of an adapter, which is imported when it is called."""
    return lambda given: getattr(import_module(f"...adapters.{room}", __package__), name)(given)


def _is_store(path: Path, head: bytes) -> bool:
    return head.startswith(_HDF5_SIGNATURE) and bool(_late("store", "is_store")(path))


def _is_universal(path: Path, head: bytes) -> bool:
    if head.startswith(_HDF5_SIGNATURE):
        return False
    return head.lstrip()[:3].split() == [b"-1"] or path.suffix.lower() in _UNIVERSAL_SUFFIXES


def _is_results(path: Path, head: bytes) -> bool:
    suffix, text = path.suffix.lower(), _text(head)
    if head.startswith(_HDF5_SIGNATURE) or suffix == ".op2":
        return True
    if not text:
        return head[:4] in _OP2_STARTS
    punched = "$TITLE" in text and "$LABEL" in text and suffix not in (".bdf", ".nas")
    return punched or suffix == ".f06" or "N A S T R A N" in text


def _is_dmig_alone(path: Path, head: bytes) -> bool:
    cards = [x for x in _text(head).splitlines() if x[:1].isalpha()]
    is_punch = path.suffix.lower().startswith(".pch") or bool(cards and cards[0][:4] == "DMIG")
    return is_punch and any(x.startswith(("DMIG", "EXTRN")) for x in cards)


def _is_deck(path: Path, head: bytes) -> bool:
    text = _text(head)
    marked = any(mark in text for mark in ("BEGIN BULK", "\nCEND", "\nGRID"))
    return marked or bool(text and path.suffix.lower() in _DECK_SUFFIXES)


def _text(head: bytes) -> str:
    """Return text in capitals; empty for binary content."""
    return "" if b"\0" in head else head.decode("latin-1").upper()


def _test(path: Path) -> object:
    """Return a Measurement, or what the file holds where that makes no test."""
    from ...adapters.universal import read_test, read_universal

    content = read_universal(path)
    measured = content.modes is not None or content.frfs is not None
    return read_test(path) if measured and content.geometry is not None else content


def _results(path: Path) -> object:
    """Return Modes, or the matrices of a run that holds no modes."""
    from ...adapters.nastran import describe_results, read_matrices, read_modes

    held = describe_results(path)["contents"]
    return read_modes(path) if held["modes"] or not held.get("matrices") else read_matrices(path)


def _is_op4(path: Path, head: bytes) -> bool:
    return bool(_late("nastran", "is_op4")(path))


def _is_runs(path: Path, head: bytes) -> bool:
    return bool(_late("nastran", "is_runs")(head))


def _runs(path: Path) -> object:
    return _late("nastran", "read_runs")(path.parent)


_matrices = _late("nastran", "describe_matrices"), _late("nastran", "read_matrices")

DECK = FileKind("deck", _is_deck, _late("nastran", "describe_deck"), _late("nastran", "read_deck"))
UNIVERSAL = FileKind("universal", _is_universal, _late("universal", "describe_universal"), _test)
STORE = FileKind("store", _is_store, _late("store", "describe_store"), _late("store", "read_store"))
RESULTS = FileKind("results", _is_results, _late("nastran", "describe_results"), _results)
OP4 = FileKind("op4", _is_op4, *_matrices)
PUNCH = FileKind("punch", _is_dmig_alone, *_matrices)
RUNS = FileKind("runs", _is_runs, _late("nastran", "describe_runs"), _runs)

FILE_KINDS: list[FileKind] = [STORE, UNIVERSAL, RUNS, OP4, RESULTS, PUNCH, DECK]
"""In the order in which a file is held against them.

``results`` are those of a Nastran run (OP2, HDF5, F06, punched eigenvectors), ``punch`` is a file
with DMIG matrices, or of an external superelement, and no deck; ``runs`` is the index
(``runs.json``) of a folder that export-runs wrote.
"""


def kind_of_file(path: Path) -> FileKind:
    """Tell what a file is, by its contents first and its suffix where those leave it open.

    Raises
    ------
    InputError
        A file that does not exist, is empty or of no known format.
    """
    if not path.is_file():
        raise Place(path).fault("does not exist or is not a file")
    with reading(path), path.open("rb") as stream:
        head = stream.read(_HEAD)
    if not head.strip():
        raise Place(path).fault("is empty")
    for kind in FILE_KINDS:
        if kind.matches(path, head):
            return kind
    raise Place(path).error(
        "the format is not recognised; known are Nastran decks, OP2, HDF5, OP4, punch and "
        "F06, universal files and stores of trueup"
    )


def describe(path: Path) -> dict[str, Any]:
    """Return {path, format, contents, skipped, ...} of any known file.

    Raises
    ------
    InputError
        A file that does not exist or is of no known format.
    """
    return {"path": str(path), **kind_of_file(path).describe(path)}


def read(path: Source) -> object:
    """Read any file that ``inspect`` knows, a run folder, or a test of several files.

    Parameters
    ----------
    path : path, or sequence of paths
        Several are the files of one test.

    Returns
    -------
    Deck
        Of a deck.
    Measurement, or UniversalContent
        Of universal files that hold a whole test, or parts of one.
    Modes, or tuple of NastranMatrix
        Of a Nastran run; of OP4 and DMIG files.
    Model
        Of the index of exported runs.
    StoreContent
        Of a store of trueup.
    Correlated, Updated or Discovered
        Of a run folder.

    Raises
    ------
    InputError
        A file that does not exist, is of no known format, or cannot be read.
    """
    from ..runs.open_run import open_run

    if isinstance(path, list | tuple):
        return read_test(path)
    path = path_of(path, "a file")
    return open_run(path) if path.is_dir() else kind_of_file(path).read(path)
