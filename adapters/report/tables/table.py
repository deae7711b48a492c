"""A table of a run as plain content, rendered alike on the page and in the terminal."""

from dataclasses import dataclass


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


@dataclass(frozen=True)
class Table:
    """A titled table; `note` is what has to be known to read it."""

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""
