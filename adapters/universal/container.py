"""The container: where the datasets of a universal file begin and end.

A dataset stands between two lines ``    -1`` (columns 5 and 6); the line after the first holds
its number. Real files leave out line ends, lose or repeat a delimiter, and carry binary blocks
(58b) in which anything may look like text. Nothing here reads what a dataset holds.
"""

import mmap
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...core.files import release
from .text.layout58 import HEADER_LINES, REALS, columns, form, records
from .text.number_fields import integers
from .universal_content import Skipped

_NUMBER = re.compile(rb"[ \t]{0,9}(\d{1,5})(b|B)?(?=[ \t\r\n]|\Z)([^\r\n]*)")
_LINE_END = re.compile(rb"\r\n|\r|\n")
_FIRST = re.compile(rb"[ \t\r\n\x00]*-1[ \t]*(?=[\r\n]|\Z)")
_SPACES = b" \t"
_BLANKS = b" \t\r\n\x00"

Read = Callable[[int, int], bytes]
"""Gives the bytes of a file between two offsets."""


@dataclass(frozen=True)
class Section:
    """One dataset: its number and the bytes ``begin:end`` after the line of the number."""

    number: int
    line: int
    begin: int
    end: int
    binary: bool = False
    header: tuple[int, ...] = ()
    closed: bool = True


def first_lines(read: Read, begin: int, end: int, n: int) -> tuple[list[bytes], int]:
    """Return the first `n` lines with their ends, and the offset of what follows them."""
    room = 100 * (n + 1)
    while True:
        piece = read(begin, min(end, begin + room))
        lines = piece.splitlines(keepends=True)
        if len(lines) > n or begin + room >= end:
            break
        room *= 4
    lines = lines[:n]
    return lines, begin + sum(map(len, lines))


@dataclass
class Scan:
    """One pass over the delimiters of a file."""

    path: Path
    data: mmap.mmap
    exact_lines: bool = True
    skipped: list[Skipped] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    _counted: int = 0
    _mapped: int = 0
    _line: int = 1

    def __post_init__(self) -> None:
        sample = self.data[: 1 << 16]
        self._newline = 13 if b"\r" in sample and b"\n" not in sample else 10
        first = _FIRST.match(self.data)
        lead = sample[: first.end()].splitlines()[-1] if first else b"    -1"
        indent = len(lead) - len(lead.lstrip(_SPACES))
        # The delimiter is looked for as this file writes it: columns 5-6 by the book.
        self._mark = b"    -1" if indent >= 4 else lead.rstrip(_SPACES)

    def sections(self) -> Iterator[Section]:
        """Datasets in file order; what stands outside of them goes to `skipped`."""
        at, outside = 0, 0
        while (mark := self._delimiter(at)) is not None:
            start, after = mark
            opened = _NUMBER.match(self.data, after)
            self._report_outside(outside, start)
            if opened is None:
                stray = f"{self.path} line {self._line_at(start)}: a stray -1 was passed over"
                self.warnings.append(stray)
                at = outside = after
                continue
            section, at = self._section(opened)
            yield section
            outside = at
        self._report_outside(outside, len(self.data))

    def _section(self, opened: re.Match[bytes]) -> tuple[Section, int]:
        """Return the dataset whose number line is `opened`, and where to go on."""
        number, line = int(opened[1]), self._line_at(opened.start())
        begin = self._after_line(opened.end())
        binary = opened[2] is not None
        header = tuple(integers(opened[3])) if binary else ()
        whole = self._past_binary(begin, header) if binary else None
        if number == 58 and not binary:
            whole = self._past_text(begin)
        if whole is not None:
            return Section(number, line, begin, whole[0], binary, header), whole[1]
        mark = self._delimiter(begin)
        if mark is None:
            end = self._glued_end(begin, len(self.data))
            last = len(self.data) if end is None else end
            closed = end is not None
            return Section(number, line, begin, last, binary, header, closed), len(self.data)
        start, after = mark
        if _NUMBER.match(self.data, after) is None:
            return Section(number, line, begin, start, binary, header), after
        # This -1 opens the next dataset: the one that closes this dataset is glued to the last
        # line, or was lost.
        end = self._glued_end(begin, start)
        if end is None:
            self.warnings.append(
                f"{self.path} line {line}: the -1 that closes dataset {number} is missing"
            )
        return Section(number, line, begin, start if end is None else end, binary, header), start

    def _past_binary(self, begin: int, header: tuple[int, ...]) -> tuple[int, int] | None:
        """End of a 58b and start of what follows, where the size of its block leads to a -1."""
        if len(header) < 4:
            return None
        at, shape = self._form(begin, header[2])
        # The announced size is wrong in some files: what the points need is tried as well.
        sizes = [shape[1] * sum(r) for r in records(shape[0], shape[2] != 0)] if shape else []
        for size in (header[3], *sizes):
            closing = self._closing(at + size)
            if closing is not None:
                if not self.exact_lines:
                    self._line_at(at)
                    self._counted = at + size
                return closing
        return None

    def _past_text(self, begin: int) -> tuple[int, int] | None:
        """End of an ASCII 58 and start of what follows, where its lines have all one length."""
        at, shape = self._form(begin, HEADER_LINES)
        if not shape or shape[0] not in REALS or shape[1] < 1:
            return None
        width = columns(shape[0], shape[2] != 0)
        n_value = shape[1] * (REALS[shape[0]] + (shape[2] == 0))
        pitch = self._after_line(at) - at
        full, rest = divmod(n_value, len(width))
        end = at + full * pitch
        if full < 2 or end + rest > len(self.data) or self._after_line(end - pitch) != end:
            return None
        last = self._after_line(end) if rest else end
        if rest and self.data[end:last].rstrip(_BLANKS).endswith(self._mark):
            return None  # the closing -1 is glued to the last line
        closing = self._closing(last)
        if closing is None or self.data[last - 1] not in b"\r\n":
            return None
        self._line_at(at)
        self._line += full + (1 if rest else 0)
        self._counted = last
        return closing

    def _form(self, begin: int, n_line: int) -> tuple[int, tuple[int, ...]]:
        """Offset behind the header of a function, and what its seventh line says."""

        def read(start: int, stop: int) -> bytes:
            return self.data[start:stop]

        lines, at = first_lines(read, begin, len(self.data), min(n_line, HEADER_LINES))
        return at, form(lines[6]) if len(lines) > 6 else ()

    def _closing(self, at: int) -> tuple[int, int] | None:
        """Start of a -1 that follows `at` at once or on the next line, and of the line after."""
        if at > len(self.data):
            return None
        tail = self.data[at : at + 200]
        skipped = len(tail) - len(tail.lstrip(b"\r\n"))
        if not tail[skipped:].startswith(self._mark):
            return None
        after = self._blank(at + skipped + len(self._mark), len(self.data))
        return None if after is None else (at, after)

    def _delimiter(self, at: int) -> tuple[int, int] | None:
        """Start of the next line ``-1`` at or after `at`, and the start of the line after it."""
        data, mark = self.data, self._mark
        while (hit := data.find(mark, at)) >= 0:
            after = self._blank(hit + len(mark), len(data))
            start = self._line_start(hit)
            if after is not None and start is not None:
                return start, after
            at = hit + 1
        return None

    def _line_start(self, hit: int) -> int | None:
        """Where the line of a hit starts if only a few blanks stand before it."""
        back = hit
        while back > 0 and hit - back < 2 and self.data[back - 1] in _SPACES:
            back -= 1
        return back if back == 0 or self.data[back - 1] in b"\r\n" else None

    def _glued_end(self, begin: int, start: int) -> int | None:
        """Where the data end when the closing -1 stands at the end of the last data line."""
        tail = self.data[max(begin, start - 300) : start]
        kept = tail.rstrip(b" \t\r\n\x1a")
        if kept.endswith(self._mark) and kept[: -len(self._mark)][-1:] not in b" \t\r\n":
            return start - len(tail) + len(kept) - len(self._mark)
        return None

    def _blank(self, at: int, stop: int) -> int | None:
        """Start of the next line if only blanks stand from `at` to the line end, else None."""
        data = self.data
        while at < stop and data[at] in b" \t\x00\x1a":
            at += 1
        if at >= len(data):
            return len(data)
        if data[at] == 13:
            return at + 2 if data[at + 1 : at + 2] == b"\n" else at + 1
        return at + 1 if data[at] == 10 else None

    def _after_line(self, at: int) -> int:
        stop = _LINE_END.search(self.data, at)
        return stop.end() if stop else len(self.data)

    def _report_outside(self, begin: int, end: int) -> None:
        text = self.data[begin:end].strip(b" \t\r\n\x00\x1a")
        if text:
            shift = self.data[begin:end].index(text[:1])
            what, why = "text outside any dataset", "no -1 and dataset number before it"
            line = self._line_at(begin + shift)
            self.skipped.append(Skipped(what, line, why, str(self.path)))

    def _line_at(self, offset: int) -> int:
        """1-based number of the line that starts at `offset`; offsets come in rising order."""
        step = 1 << 22
        for a in range(self._counted, offset, step):
            piece = np.frombuffer(self.data[a : min(a + step, offset)], np.uint8)
            self._line += int(np.count_nonzero(piece == self._newline))
        if offset - self._mapped > step:
            release(self.data, self._mapped, offset)
            self._mapped = offset
        self._counted = max(self._counted, offset)
        return self._line
