"""The lines of a dataset one after another; what is wrong in them is told with file and line."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Self, TypeVar

import numpy as np

from ....core.arrays import Floats
from ..container import Section
from ..open_file import DatasetError, Source
from ..text.number_fields import NotANumber, floats, integers, table, text

T = TypeVar("T")


class Lines:
    """Lines of a dataset; `at` is the next one, counted from 0 behind the line of the number."""

    def __init__(self, source: Source, section: Section, lines: list[bytes]) -> None:
        self.source, self.section, self.lines, self.at = source, section, lines, 0

    @classmethod
    def filled(cls, source: Source, section: Section) -> Self:
        """Return all lines but the blank ones at the end."""
        lines = source.lines(section)
        while lines and not lines[-1].strip(b" \t\x00"):
            lines.pop()
        return cls(source, section, lines)

    def error(self, row: int, why: str) -> DatasetError:
        """Return the error that names the file, a line, and the dataset."""
        line = self.section.line + 1 + row
        return self.source.error(line, f"dataset {self.section.number}: {why}")

    @contextmanager
    def numbers(
        self, first: int = 0, stride: int = 1, why: str = "{} is not a number"
    ) -> Iterator[None]:
        """Tell where a number of a block is none, whose line k is ``first + stride * k``."""
        try:
            yield
        except NotANumber as error:
            raise self.error(first + stride * error.row, why.format(repr(error.text))) from None

    def more(self) -> bool:
        """Whether any line is left."""
        return self.at < len(self.lines)

    def take(self, read: Callable[[bytes], T]) -> T:
        """Return the next line as `read` takes it; a blank one behind the last."""
        self.at += 1
        return read(self.lines[self.at - 1] if self.at <= len(self.lines) else b"")

    def head(self, least: int, why: str) -> tuple[int, list[int]]:
        """Return the row and the integers of the line that starts an entry, `least` or more."""
        row, found = self.at, self.take(integers)
        if len(found) < least:
            raise self.error(row, why)
        return row, found

    def name(self) -> str:
        """Return the next line as text."""
        return self.take(text)

    def gathered(self, count: int, read: Callable[[bytes], Sequence[T]]) -> list[T]:
        """Return what `read` finds on the next lines, until `count` or more are found."""
        found: list[T] = []
        while len(found) < count and self.more():
            found += self.take(read)
        return found

    def positions(self, count: int) -> list[float]:
        """Return the numbers of the next lines, none of them too large for a position."""

        def read(line: bytes) -> list[float]:
            with self.numbers(self.at - 1):
                found = floats([line])
            if not np.all(np.abs(found) < 1e100):
                raise self.error(self.at - 1, "it holds a value that is no position")
            return list(found)

        return self.gathered(count, read)

    def table(self, widths: Sequence[int], stride: int = 1, first: int = 0) -> Floats:
        """Return every `stride`-th line from `first` on as finite numbers, (n_line, n_width)."""
        with self.numbers(first, stride, f"{{}} does not hold {len(widths)} numbers"):
            values = table(self.lines[first::stride], widths)
        bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
        if len(bad):
            raise self.error(first + stride * int(bad[0]), "it holds a value that is not finite")
        return values
