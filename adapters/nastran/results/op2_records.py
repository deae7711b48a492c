"""The records of an OP2 file (OUTPUT2): tables and matrices, 32 and 64 bit, both byte orders.

A file is a sequence of Fortran records. One of a single word is a marker: a positive one tells how
many words the next record has, a negative one numbers the logical records of a data block, zero
ends a data block and, in place of a name, the file (MSC Nastran DMAP Programmer's Guide, OUTPUT2).
Nothing is read here but markers, names and trailers; the data stay in the file until asked for.
"""

import mmap
import struct
from array import array
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np

from ....core.arrays import Floats, Ints, Numbers
from ....core.errors import InputError, Place
from ....core.files import reading, release

_STARTS = {b"\4\0\0\0": ("<", 4), b"\0\0\0\4": (">", 4), b"\10\0\0\0": ("<", 8),
           b"\0\0\0\10": (">", 8)}  # fmt: skip
_MARK = 4
_RELEASE = 1 << 22
_LABEL = 3
"""First marker of the label that most files start with: the date has three words."""

Span = tuple[int, int]


@dataclass(frozen=True)
class Op2Record:
    """A logical record: where its parts stand in the file."""

    parts: tuple[Span, ...]

    @property
    def size(self) -> int:
        """Bytes in all."""
        return sum(stop - start for start, stop in self.parts)


@dataclass(frozen=True)
class Op2Block:
    """A data block: its name, the words of its trailer and its records after the header.

    `runs` are those of the columns of a matrix: column and first row (from 0) and the bytes
    between which the values stand, four numbers each.
    """

    name: str
    trailer: tuple[int, ...]
    records: tuple[Op2Record, ...]
    runs: "array[int]"
    n_column: int = 0


class Op2File:
    """An open OP2 file with its data blocks; a context manager that closes it.

    Raises
    ------
    InputError
        A file that cannot be opened, is no OP2 file, is cut short or damaged.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        with reading(path), path.open("rb") as stream:
            start = _STARTS.get(stream.read(_MARK))
            if start is None:
                raise Place(path).fault("is not an OP2 file: a binary Nastran file is expected")
            self._data = mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ)
        self.order, self.word = start
        self._size = len(self._data)
        self._run = struct.Struct(self.order + ("5i" if self.word == 4 else "iqiiq"))
        self._mark = struct.Struct(f"{self.order}i")
        self._integer = struct.Struct(self.order + ("i" if self.word == 4 else "q"))
        try:
            self.blocks = self._read()
        except BaseException:
            self._data.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(BufferError):  # a view is still held: it closes with the last one
            self._data.close()

    def integers(self, record: Op2Record) -> Ints:
        """Return the words of a record as integers, (n,)."""
        return self._words(record, "i").astype(np.int64)

    def reals(self, record: Op2Record) -> Floats:
        """Return the words of a record as reals, (n,), in the file's precision."""
        return self._words(record, "f")

    def words(self) -> Numbers:
        """Return the whole file as words of four bytes, for picking runs of values; a view."""
        return np.frombuffer(self._data, np.uint32, self._size // 4)

    def raw(self, record: Op2Record) -> bytes:
        """Return the bytes of a record."""
        return b"".join(self._data[start:stop] for start, stop in record.parts)

    def text(self, record: Op2Record, first: int, count: int) -> str:
        """Return words of a record as text."""
        raw = self.raw(record)[first * self.word : (first + count) * self.word]
        return _text(raw, self.word)

    def release(self, record: Op2Record) -> None:
        """Let the system take back the memory of a record that has been read."""
        for start, stop in record.parts:
            self.release_between(start, stop)

    def release_between(self, start: int, stop: int) -> None:
        """Let the system take back the memory of some bytes that have been read."""
        release(self._data, start, stop)

    def _words(self, record: Op2Record, kind: str) -> Numbers:
        if len(record.parts) == 1:
            start, stop = record.parts[0]
            count = (stop - start) // self.word
            return np.frombuffer(self._data, self._dtype(kind), count, start)
        raw = self.raw(record)
        return np.frombuffer(raw[: len(raw) // self.word * self.word], self._dtype(kind))

    def _dtype(self, kind: str) -> np.dtype[np.generic]:
        return np.dtype(f"{self.order}{kind}{self.word}")

    def damaged(self, at: int, why: str) -> InputError:
        """Return the error for something that is wrong at a byte."""
        return Place(self.path).fault(f"cannot be read as OP2: {why} (byte {at})")

    def _record(self, at: int) -> Span:
        """Return where the content of the Fortran record at a byte starts and stops."""
        if at + _MARK > self._size:
            raise self._cut_short(at)
        (size,) = self._mark.unpack_from(self._data, at)
        stop = at + _MARK + size
        if size < 0:
            raise self.damaged(at, "a record has a negative length")
        if stop + _MARK > self._size:
            raise self._cut_short(at)
        if self._mark.unpack_from(self._data, stop)[0] != size:
            raise self.damaged(at, "a record does not close")
        return at + _MARK, stop

    def _cut_short(self, at: int) -> InputError:
        return Place(self.path).fault(f"is cut short: it ends in the record at byte {at}")

    def _marker(self, at: int) -> tuple[int, int]:
        """Return the marker at a byte, and where the next record starts."""
        start, stop = self._record(at)
        if stop - start != self.word:
            raise self.damaged(at, "a marker is expected")
        return self._integer.unpack_from(self._data, start)[0], stop + _MARK

    def _part(self, at: int, words: int) -> tuple[Span, int]:
        """Return a record of some words, and where the next one starts."""
        start, stop = self._record(at)
        if stop - start != words * self.word:
            raise self.damaged(at, f"a record of {words} words is expected")
        return (start, stop), stop + _MARK

    def _read(self) -> tuple[Op2Block, ...]:
        at = 0
        blocks: list[Op2Block] = []
        while at < self._size:
            words, after = self._marker(at)
            if words == 0:  # the end of the file; some programs append another one
                at = after
            elif words == _LABEL and not self._is_name(after):
                at = self._after_label(at)
            elif words > 0:
                block, at = self._block(words, after)
                blocks.append(block)
            else:
                raise self.damaged(at, "the name of a data block is expected")
        return tuple(blocks)

    def _is_name(self, at: int) -> bool:
        start, stop = self._record(at)
        return all(32 <= c < 127 for c in self._data[start:stop])

    def _after_label(self, at: int) -> int:
        """Return where what follows the label (date and program) starts."""
        words, at = self._marker(at)
        while words > 0:
            _, at = self._part(at, words)
            words, at = self._marker(at)
        words, at = self._marker(at)
        if words != 0:
            raise self.damaged(at, "the label does not end")
        return at

    def _block(self, words: int, at: int) -> tuple[Op2Block, int]:
        (start, stop), at = self._part(at, words)
        name = _text(self._data[start:stop], self.word)
        number, at = self._marker(at)
        if number != -1:
            raise self.damaged(at, f"the trailer of {name or 'a data block'} is expected")
        words, at = self._marker(at)
        (start, stop), at = self._part(at, words)
        trailer = np.frombuffer(self._data[start:stop], self._dtype("i"))
        records: list[Op2Record] = []
        runs, n_column, seen = array("q"), 0, at
        number, at = self._marker(at)
        while True:
            if number >= 0:
                raise self.damaged(at, f"a record of {name} is expected")
            one, at = self._marker(at)
            column, at = self._marker(at)
            if one != 1 or column not in (0, 1):
                raise self.damaged(at, f"the markers of a record of {name} are wrong")
            if column:
                number, at = self._column(at, n_column, runs)
                n_column += 1
                if at - seen > _RELEASE:
                    self.release_between(seen, at)
                    seen = at
                continue
            parts: list[Span] = []
            words, at = self._marker(at)
            if words == 0:
                break
            while words > 0:
                part, at = self._part(at, words)
                parts.append(part)
                words, at = self._marker(at)
            records.append(Op2Record(tuple(parts)))
            number = words
        return Op2Block(name, tuple(map(int, trailer)), tuple(records[1:]), runs, n_column), at

    def _column(self, at: int, column: int, runs: "array[int]") -> tuple[int, int]:
        """Note the runs of a column; return the marker after them and what follows it."""
        data, word = self._data, self.word
        while True:
            try:
                before, words, after, size, row = self._run.unpack_from(data, at)
            except struct.error:  # the end of the file, or nearly
                return self._marker(at)
            if before != word or after != word:
                raise self.damaged(at, "a marker is expected")
            at += 2 * _MARK + word
            if words <= 0:
                return words, at
            start, stop = at + _MARK + word, at + _MARK + size
            # the marker of a run does not count the row that leads it
            if size != (words + 1) * word:
                raise self.damaged(at, f"a record of {words + 1} words is expected")
            if stop + _MARK > self._size:
                raise self._cut_short(at)
            if self._mark.unpack_from(data, stop)[0] != size:
                raise self.damaged(at, "a record does not close")
            runs.extend((column, row - 1, start, stop))
            at = stop + _MARK


def _text(raw: bytes, word: int) -> str:
    """Text of words: of 64 bit NX fills four characters of each, MSC (in names) all eight."""
    if word == 8 and not any(raw[k + 4 : k + 8].strip(b" \0") for k in range(0, len(raw), 8)):
        raw = b"".join(raw[k : k + 4] for k in range(0, len(raw), 8))
    return raw.decode("latin-1").strip(" \0")
