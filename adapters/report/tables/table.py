"""A table of a run as plain content, rendered alike on the page and in the terminal."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Self


@dataclass(frozen=True)
class Cell:
    """A cell: its text, how it reads (``good``, ``poor``, ``muted`` or plain), a bar of 0..1."""

    text: str
    tone: str = ""
    bar: float | None = None


@dataclass(frozen=True)
class Column:
    """A column: heading, what it stands under, whether its cells are numbers."""

    heading: str
    group: str = ""
    numeric: bool = True


Heading = Column | str


@dataclass(frozen=True)
class Table:
    """A titled table; `note` is what has to be known to read it."""

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""

    @classmethod
    def of(
        cls,
        title: str,
        columns: Sequence[Heading],
        rows: Iterable[Sequence[Cell | str]],
        note: str = "",
    ) -> Self:
        """Return a table in which a plain text is a column of numbers or a plain cell."""
        return cls(
            title,
            tuple(c if isinstance(c, Column) else Column(c) for c in columns),
            tuple(tuple(c if isinstance(c, Cell) else Cell(c) for c in row) for row in rows),
            note,
        )


def left(*headings: str) -> list[Heading]:
    """Return columns of words."""
    return [Column(heading, numeric=False) for heading in headings]
