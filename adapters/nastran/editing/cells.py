"""One line of a card: its format, and where each of its fields stands among its bytes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from .numbers import LARGE, SMALL

CONTENT_END = 72
TAG_END = 80


class Cell(NamedTuple):
    """Bytes `start`..`stop` of a line that hold one field."""

    start: int
    stop: int


@dataclass(frozen=True)
class CardLine:
    """A line of a card without its terminator.

    Fixed format has 8 fields of 8 columns or, with a star in the first field, 4 of 16; free
    format has commas (one within the first ten columns) and as many fields.
    """

    data: bytes

    @cached_property
    def indent(self) -> int:
        """Blanks before a card's name that does not start in column 1."""
        text = self.data
        word = text[:8].strip()
        if text[:1] != b" " or not word or word[:1] in b"+*,":
            return 0
        return len(text) - len(text.lstrip())

    @cached_property
    def content(self) -> bytes:
        """What stands before a comment, from the name on."""
        return self.data[self.indent :].split(b"$", 1)[0]

    @property
    def comment(self) -> bytes:
        """The comment from its dollar sign on."""
        return self.data[self.indent + len(self.content) :]

    @cached_property
    def free(self) -> bool:
        """Whether the fields are separated by commas."""
        return b"," in self.content[:10]

    @cached_property
    def large(self) -> bool:
        """Whether the fields are 16 columns wide (in free format: four a line)."""
        head = self.content.split(b",", 1)[0] if self.free else self.content[:8]
        return b"*" in head

    @property
    def width(self) -> int:
        """Columns of a field."""
        return LARGE if self.large else SMALL

    @property
    def capacity(self) -> int:
        """Number of data fields of this line."""
        return 4 if self.large else 8

    @cached_property
    def cells(self) -> tuple[Cell, ...]:
        """Where each data field that is there stands in `data`; fewer than `capacity` at times."""
        found = self._free_cells() if self.free else self._fixed_cells()
        return tuple(Cell(a + self.indent, b + self.indent) for a, b in found)

    def text(self, k: int) -> str:
        """Return data field `k` (from 0), stripped; "" where blank or beyond the line's end."""
        if k >= len(self.cells):
            return ""
        return self.data[slice(*self.cells[k])].strip().decode("latin-1")

    @property
    def head(self) -> bytes:
        """The first field: the card's name or the tag of a continuation, stripped."""
        if self.free:
            return self.content.split(b",", 1)[0].strip()
        return self.content.expandtabs()[:8].strip()

    @property
    def tail(self) -> bytes:
        """What follows the data fields: the tag of the next line and what comes after it."""
        if self.free:
            words = self.content.split(b",")
            return b",".join(words[1 + self.capacity :]).strip()
        return self.content.expandtabs()[CONTENT_END:].rstrip()

    def _free_cells(self) -> list[tuple[int, int]]:
        words = self.content.split(b",")
        found: list[tuple[int, int]] = []
        at = len(words[0]) + 1
        for word in words[1 : 1 + self.capacity]:
            found.append((at, at + len(word)))
            at += len(word) + 1
        return found

    def _fixed_cells(self) -> list[tuple[int, int]]:
        stops = self._stops()
        columns = range(8, CONTENT_END, self.width)
        found = [(stops(c), stops(c + self.width)) for c in columns]
        return [(a, b) for a, b in found if a < len(self.content)]

    def _stops(self) -> _Stops:
        return _Stops(self.content)


class _Stops:
    """Which byte of a line stands at a column, tabs taken as Nastran does (every 8 columns)."""

    def __init__(self, content: bytes) -> None:
        self._length = len(content)
        self._columns: list[int] | None = None
        if b"\t" in content:
            self._columns = []
            column = 0
            for byte in content:
                self._columns.append(column)
                column = (column // 8 + 1) * 8 if byte == 9 else column + 1

    def __call__(self, column: int) -> int:
        if self._columns is None:
            return min(column, self._length)
        return next((k for k, c in enumerate(self._columns) if c >= column), self._length)
