"""A deck as the text of all its files: nothing is lost, and every line knows its section."""

import contextlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ....core.arrays import Ints
from ....core.errors import InputError, Place
from ....core.noun import Noun
from .includes import locate_include, parse_include
from .source_file import TextFile, key_of

_MARKS = {name: key_of(name) for name in ("CEND", "BEGIN", "ENDDATA", "INCLUDE")}


class Include(NamedTuple):
    """One INCLUDE statement: which file, which lines, what it says, which file it means."""

    parent: int
    row: int
    rows: int
    written: str
    child: int


class Segment(NamedTuple):
    """Consecutive bulk data lines of one file; `part` names a superelement, "" the residual."""

    file: int
    first: int
    stop: int
    part: str


class Stretch(NamedTuple):
    """Consecutive lines of one file as Nastran meets them."""

    file: int
    first: int
    stop: int


@dataclass(frozen=True, eq=False)
class DeckText(Noun):
    """The text of a deck and of all files it includes.

    Parameters
    ----------
    files : tuple of TextFile
        The top deck first, then included files in the order met, each once.
    children : mapping of (int, str) to int
        Which file an INCLUDE of a file means, by what is written.
    """

    files: tuple[TextFile, ...]
    children: Mapping[tuple[int, str], int]

    @cached_property
    def _walked(self) -> "_Walk":
        walk = _Walk(self.files.__getitem__, self._follow)
        walk.through(0, ())
        return walk

    def _follow(self, parent: int, written: str, where: Place) -> int:
        child = self.children.get((parent, written))
        if child is None:
            raise where.error(f"INCLUDE {written!r} was not there when the deck was read")
        return child

    @cached_property
    def segments(self) -> tuple[Segment, ...]:
        """The bulk data in the order Nastran reads it."""
        return self._walked.segments

    @property
    def stretches(self) -> tuple[Stretch, ...]:
        """All lines in the order Nastran reads them, up to ENDDATA, INCLUDE statements left out."""
        return tuple(self._walked.stretches)

    @property
    def includes(self) -> tuple[Include, ...]:
        """The INCLUDE statements in the order met."""
        return tuple(self._walked.includes)

    @property
    def absent(self) -> tuple[tuple[Place, str], ...]:
        """Files that INCLUDE names ahead of CEND and that are not there: place and name."""
        return tuple(self._walked.absent)

    def place(self, file: int, row: int) -> Place:
        """``wing.bdf line 40``, for messages."""
        path = self.files[file].path
        return Place(path, row + 1, shown=path.name)

    def with_file_data(self, changes: Mapping[int, bytes]) -> "DeckText":
        """Return the deck with other text in some of its files."""
        files = tuple(
            f.with_data(changes[k]) if k in changes else f for k, f in enumerate(self.files)
        )
        return DeckText(files, self.children)

    def rows_in(self, segment: Segment, name: str) -> Iterator[tuple[int, int]]:
        """Yield line and number (-1: none) of each card of a name in a segment."""
        rows, ids = self._named(segment, name)
        yield from zip(rows.tolist(), ids.tolist(), strict=True)

    def rows_of(self, segment: Segment, name: str, numbers: int | Ints) -> list[tuple[int, int]]:
        """Return line and number of the cards of a name in a segment that have some numbers."""
        rows, ids = self._named(segment, name)
        mine = np.isin(ids, numbers)
        return list(zip(rows[mine].tolist(), ids[mine].tolist(), strict=True))

    def _named(self, segment: Segment, name: str) -> tuple[Ints, Ints]:
        rows, ids = self.files[segment.file].rows_named(name)
        here = slice(*np.searchsorted(rows, (segment.first, segment.stop)))
        return rows[here], ids[here]


def read_deck_text(path: Path | str) -> DeckText:
    """Read a deck and all its INCLUDE files as text, byte for byte.

    A deck with neither CEND nor BEGIN BULK is bulk data throughout. What follows ENDDATA is kept
    and never looked at.

    Parameters
    ----------
    path : path
        The top deck.

    Raises
    ------
    InputError
        A file that is missing or is no text, an INCLUDE that cannot be followed or includes
        itself.
    """
    top = Path(path).absolute()
    files: list[TextFile] = [_load(top)]
    by_path = {top.resolve(): 0}
    children: dict[tuple[int, str], int] = {}

    def follow(parent: int, written: str, where: Place) -> int:
        if (parent, written) not in children:
            found = locate_include(written, files[parent].path, top, where)
            real = found.resolve()
            if real not in by_path:
                files.append(_load(found, where))
                by_path[real] = len(files) - 1
            children[parent, written] = by_path[real]
        return children[parent, written]

    walk = _Walk(lambda k: files[k], follow)
    walk.through(0, ())
    return DeckText(tuple(files), children)


def _load(path: Path, asked: Place | None = None) -> TextFile:
    by = "" if asked is None else f"{asked}: "
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"{by}cannot read {path}: {error.strerror}", file=path) from None
    if b"\0" in data[:4096]:
        raise InputError(f"{by}{path} is not a text file: a Nastran deck is expected", file=path)
    return TextFile(path, data, data)


class _Walk:
    """Goes through a deck as Nastran does, and notes the bulk data and the INCLUDE statements."""

    def __init__(
        self, file: Callable[[int], TextFile], follow: Callable[[int, str, Place], int]
    ) -> None:
        self._file = file
        self._follow = follow
        self.stretches: list[Stretch] = []
        self.includes: list[Include] = []
        self.absent: list[tuple[Place, str]] = []
        self._bulk: list[Segment] = []
        self._all: list[Segment] = []
        self._in_bulk = False
        self._has_control = False
        self._part = ""
        self._ended = False

    @property
    def segments(self) -> tuple[Segment, ...]:
        """The bulk data; all lines where nothing says where it begins."""
        segments = self._bulk if self._has_control else self._all
        return tuple(s for s in segments if s.stop > s.first)

    def through(self, k: int, parents: tuple[int, ...]) -> None:
        file = self._file(k)
        keys = file.lines.keys
        marked = np.flatnonzero(np.isin(keys, np.array([*_MARKS.values()], np.uint64)))
        done = 0
        for row in marked.tolist():
            if row < done:
                continue
            mark = int(keys[row])
            if mark == _MARKS["INCLUDE"]:
                executive = not self._has_control and bool((keys[row:] == _MARKS["CEND"]).any())
                done = self._include(k, row, done, (*parents, k), executive)
            elif mark == _MARKS["ENDDATA"]:
                self._take(k, done, row)
                self._ended = True
            elif mark == _MARKS["BEGIN"]:
                self._take(k, done, row)
                self._begin(file.line(row))
                self.stretches.append(Stretch(k, row, row + 1))
                done = row + 1
            elif not self._in_bulk:
                self._has_control = True
            if self._ended:
                return
        self._take(k, done, len(file.lines))

    def _take(self, k: int, first: int, stop: int) -> None:
        self.stretches.append(Stretch(k, first, stop))
        self._all.append(Segment(k, first, stop, self._part))
        if self._in_bulk:
            self._bulk.append(self._all[-1])

    def _begin(self, line: bytes) -> None:
        words = line.split(b"$", 1)[0].decode("latin-1").upper().split()
        rest = [w for w in words[1:] if w != "BULK"]
        self._has_control = self._in_bulk = True
        self._part = " ".join(rest)

    def _over_lines(self, k: int, texts: list[str], where: Place) -> tuple[int, str, int]:
        """Follow a name without quotes that goes on in the next line or two."""
        for more in (1, 2):
            written, used = parse_include(texts, where, more)
            if used > 1 and used == 1 + more:
                with contextlib.suppress(InputError):
                    return self._follow(k, written, where), written, used
        written, used = parse_include(texts, where)
        return self._follow(k, written, where), written, used

    def _include(
        self, k: int, row: int, done: int, parents: tuple[int, ...], executive: bool
    ) -> int:
        file = self._file(k)
        where = Place(file.path, row + 1)
        stop = min(row + 60, len(file.lines))
        texts = [file.line(r).decode("latin-1") for r in range(row, stop)]
        if file.encoding == "utf-8":
            texts = [t.encode("latin-1").decode("utf-8") for t in texts]
        written, used = parse_include(texts, where)
        try:
            child = self._follow(k, written, where)
        except InputError:
            try:
                child, written, used = self._over_lines(k, texts, where)
            except InputError:
                if not executive:
                    raise
                self.absent.append((where, written))
                return done
        if child in parents:
            raise where.error(f"INCLUDE {written!r} includes itself")
        self._take(k, done, row)
        self.includes.append(Include(k, row, used, written, child))
        self.through(child, parents)
        return row + used
