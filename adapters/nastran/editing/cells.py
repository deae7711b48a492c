"""One line of a card: its format, and where each of its fields stands among its bytes."""

from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, pairwise
from typing import NamedTuple

from ..text.real_numbers import LARGE, SMALL

CONTENT_END = 72


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
    def content(self) -> bytes:
        """What stands before a comment."""
        return self.data.split(b"$", 1)[0]

    @property
    def comment(self) -> bytes:
        """The comment from its dollar sign on."""
        return self.data[len(self.content) :]

    @cached_property
    def free(self) -> bool:
        """Whether the fields are separated by commas (a name may be set in a little)."""
        word = self.content[:8].strip()
        named = word and word[:1] not in b"+*,"
        return b"," in (self.content.lstrip() if named else self.content)[:10]

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
        return tuple(self._free_cells() if self.free else self._fixed_cells())

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

    def _free_cells(self) -> list[Cell]:
        words = self.content.split(b",")[: 1 + self.capacity]
        stops = list(accumulate(len(word) + 1 for word in words))
        return [Cell(a, b - 1) for a, b in pairwise(stops)]

    def _fixed_cells(self) -> list[Cell]:
        columns = range(8, CONTENT_END, self.width)
        found = [Cell(self._byte_at(c), self._byte_at(c + self.width)) for c in columns]
        return [cell for cell in found if cell.start < len(self.content)]

    def _byte_at(self, column: int) -> int:
        """Which byte stands at a column, tabs taken as Nastran does (every 8 columns)."""
        if b"\t" not in self.content:
            return min(column, len(self.content))
        at = 0
        for k, byte in enumerate(self.content):
            if at >= column:
                return k
            at = (at // 8 + 1) * 8 if byte == 9 else at + 1
        return len(self.content)
