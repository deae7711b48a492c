"""A deck's text back to files: a copy of the whole tree, or over the originals with a backup."""

import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ....core.errors import InputError, Place, path_of
from ..text.deck_text import DeckText
from ..text.includes import is_anchored
from ..text.source_file import TextFile, key_of
from .set_values import splice

ELSEWHERE = "included"
_LINE_WIDTH = 72


def write_deck(deck: DeckText, out_dir: Path | str) -> Path:
    """Write a deck with the same file tree and names; return the path of its top deck.

    The tree starts at the deepest folder that holds the top deck and all files it includes by
    relative paths, so ``..`` works as before. A file included by an absolute path or a symbol is
    not copied while nothing in it changes; when it does, the copy goes to its place in the tree or
    to ``included/`` and the INCLUDE statement is changed to name it.

    Parameters
    ----------
    deck : DeckText
        What to write.
    out_dir : path
        Must not exist or be empty; appears complete or not at all.

    Raises
    ------
    InputError
        The folder holds files, or cannot be written.
    """
    out = path_of(out_dir, "the folder of the deck").absolute()
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise Place(out).fault("exists already: choose another folder for the deck")
    places = _places(deck)
    contents = {k: _relocated(deck, k, places) for k in places}
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=".deck-", dir=out.parent) as temporary:
            whole = Path(temporary) / "deck"
            for k, place in places.items():
                target = whole / place
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(contents[k])
            if out.exists():
                out.rmdir()
            whole.rename(out)
    except OSError as error:
        raise InputError(f"cannot write the deck to {out}: {error.strerror}", file=out) from None
    return out / places[0]


def merged(deck: DeckText) -> bytes:
    """Return a deck as one text: what INCLUDE files hold stands in place of the statements.

    Of an included file nothing is taken that follows its ENDDATA, of the top deck everything.
    """
    parts = []
    for file, first, stop in deck.stretches:
        text = deck.files[file]
        if stop > first:
            start, end = int(text.lines.starts[first]), int(text.lines.ends[stop - 1])
            parts.append(text.data[start:end] + text.newline)
    top = deck.files[0]
    ends = np.flatnonzero(np.isin(top.lines.keys, [key_of("ENDDATA")]))
    if len(ends):
        parts.append(top.data[int(top.lines.starts[int(ends[0])]) :])
    elif any(key_of("ENDDATA") in f.lines.keys for f in deck.files):
        parts.append(b"ENDDATA" + top.newline)
    return b"".join(parts)


def write_in_place(deck: DeckText) -> tuple[Path, ...]:
    """Write the files that changed over the originals; return the backups made of them.

    As `write_all_in_place` does of several decks.
    """
    return tuple(write_all_in_place([deck]).values())


def write_all_in_place(decks: Sequence[DeckText]) -> dict[Path, Path]:
    """Write the files of decks that changed over the originals; return the backup of each.

    All files are written beside the originals first and then put in their place; if that fails,
    the originals are restored. A backup is named ``FILE.bak``, ``FILE.bak2`` where that exists.

    Raises
    ------
    InputError
        A file changed on disk since it was read, or cannot be written; a file of several decks
        would be another in each.
    """
    every: dict[Path, TextFile] = {}
    for f in (f for deck in decks for f in deck.files):
        known = every.setdefault(f.path.resolve(), f)
        if known.data != f.data:
            raise Place(f.path).fault(
                "is part of several decks and would be another file in each: nothing is written; "
                "leave --in-place out and take the decks from the run folder"
            )
    edited = [f for f in every.values() if f.edited]
    for f in edited:
        if not f.path.is_file() or f.path.read_bytes() != f.original:
            raise Place(f.path).fault("changed on disk since it was read: nothing is written")
    fresh: list[Path] = []
    backups: dict[Path, Path] = {}
    done: list[Path] = []
    try:
        for f in edited:
            real = f.path.resolve()
            fresh.append(_write_beside(real, f.data))
            backups[real] = _free_name(f.path)
            shutil.copy2(real, backups[real])
        for new, real in zip(fresh, backups, strict=True):
            done.append(real)
            os.replace(new, real)
    except OSError as error:
        for real in done:
            shutil.copy2(backups[real], real)
        for path in (*fresh, *backups.values()):
            path.unlink(missing_ok=True)
        raise InputError(f"cannot write the deck in place: {error.strerror}") from None
    return {f.path: backup for f, backup in zip(edited, backups.values(), strict=True)}


def names_in_tree(deck: DeckText) -> list[str]:
    """Return each file's path below the folder that `write_deck` takes as root, else in full."""
    root = _root(deck, _at_home(deck))
    paths = [f.path for f in deck.files]
    return [(p.relative_to(root) if p.is_relative_to(root) else p).as_posix() for p in paths]


def _root(deck: DeckText, home: set[int]) -> Path:
    return Path(os.path.commonpath([deck.files[k].path.parent for k in home]))


def _write_beside(path: Path, data: bytes) -> Path:
    handle, name = tempfile.mkstemp(prefix=f".{path.name}-", dir=path.parent)
    with os.fdopen(handle, "wb") as stream:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())
    shutil.copymode(path, name)
    return Path(name)


def _free_name(path: Path) -> Path:
    backup, n = path.with_name(f"{path.name}.bak"), 1
    while backup.exists():
        n += 1
        backup = path.with_name(f"{path.name}.bak{n}")
    return backup


def _at_home(deck: DeckText) -> set[int]:
    """Return the files reached from the top deck by relative paths only."""
    home: set[int] = set()
    more = {0}
    while more - home:
        home |= more
        relative = [i for i in deck.includes if not is_anchored(i.written)]
        more = {i.child for i in relative if i.parent in home}
    return home


def _places(deck: DeckText) -> dict[int, Path]:
    """Return the files to write, each with its path below the output folder."""
    home = _at_home(deck)
    root = _root(deck, home)
    copied = {k for k, f in enumerate(deck.files) if f.edited and k not in home}
    for _ in deck.files:
        copied |= {i.parent for i in deck.includes if i.child in copied} - home
    places = {k: deck.files[k].path.relative_to(root) for k in sorted(home)}
    for k in sorted(copied):
        path = deck.files[k].path
        inside = path.is_relative_to(root)
        place = path.relative_to(root) if inside else Path(ELSEWHERE) / path.name
        n = 1
        while place in places.values():
            n += 1
            place = Path(ELSEWHERE) / f"{path.stem}_{n}{path.suffix}"
        places[k] = place
    return places


def _relocated(deck: DeckText, k: int, places: Mapping[int, Path]) -> bytes:
    """Return a file's text with the INCLUDE statements that must name another place."""
    file = deck.files[k]
    home = _at_home(deck)
    pieces: dict[int, tuple[int, int, bytes]] = {}
    for include in deck.includes:
        stays = {k, include.child} <= home and not is_anchored(include.written)
        if include.parent != k or stays:
            continue
        if include.child in places:
            target = os.path.relpath(places[include.child], places[k].parent)
        elif is_anchored(include.written):
            continue
        else:
            target = str(deck.files[include.child].path)
        first, last = include.row, include.row + include.rows - 1
        start, stop = int(file.lines.starts[first]), int(file.lines.ends[last])
        pieces[first] = (start, stop, _statement(target, file.newline))
    return splice(file.data, pieces.values())


def _statement(target: str, newline: bytes) -> bytes:
    """Write an INCLUDE, over several lines where the path is long."""
    lines, current = [], "INCLUDE '"
    parts = target.replace(os.sep, "/").split("/")
    for n, part in enumerate(parts):
        piece = part + ("/" if n < len(parts) - 1 else "'")
        if len(current) + len(piece) > _LINE_WIDTH and not current.endswith("'"):
            lines.append(current)
            current = ""
        current += piece
    return newline.join(line.encode("utf-8") for line in (*lines, current))
