"""Which adapter describes which file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ..core.errors import InputError


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
    from ..adapters.store import describe_store, is_store

    return describe_store(path) if is_store(path) else _results(path)


_READERS: dict[str, Callable[[Path], dict[str, Any]]] = {
    ".bdf": _deck,
    ".dat": _deck,
    ".nas": _deck,
    ".blk": _deck,
    ".inc": _deck,
    ".unv": _universal,
    ".uff": _universal,
    ".uf": _universal,
    ".op2": _results,
    ".h5": _store,
}


def describe(path: Path) -> dict[str, Any]:
    """Return {path, format, contents, skipped, ...} of any known file.

    Raises
    ------
    InputError
        A file that does not exist or is of no known format.
    """
    if not path.is_file():
        raise InputError(f"{path} does not exist or is not a file")
    reader = _READERS.get(path.suffix.lower()) or _sniffed(path)
    return {"path": str(path), **reader(path)}


def _sniffed(path: Path) -> Callable[[Path], dict[str, Any]]:
    with path.open("rb") as stream:
        head = stream.read(4096)
    if head.lstrip()[:2] == b"-1":
        return _universal
    text = head.decode("latin-1").upper()
    if any(word in text for word in ("BEGIN BULK", "CEND", "GRID")) and "\0" not in text:
        return _deck
    raise InputError(
        f"{path}: the format is not recognised; known suffixes are {', '.join(sorted(_READERS))}"
    )
