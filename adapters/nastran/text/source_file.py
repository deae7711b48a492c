"""One file of a deck as bytes, with an index of its lines made in one pass over the bytes."""

import codecs
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ....core.arrays import Ints
from ....core.noun import Noun

Keys = npt.NDArray[np.uint64]
Bytes = npt.NDArray[np.uint8]

BLANK = 0  # blank lines and comments
CONTINUATION = 1
REPLICATION = 2

_CHUNK = 1 << 17
_ENDS_NAME = np.zeros(256, bool)
_ENDS_NAME[[*b"\0 ,\t'\"$*=+(\r\n"]] = True
_UPPER = np.arange(256, dtype=np.uint8)
_UPPER[ord("a") : ord("z") + 1] -= 32
_FIRST = np.full(256, -1, np.int8)
_FIRST[[*b"$\0"]] = BLANK
_FIRST[[*b"+*,"]] = CONTINUATION
_FIRST[ord("=")] = REPLICATION


def key_of(name: str) -> int:
    """Return a card name as the number that the line index holds for it."""
    return int.from_bytes(name.encode("ascii", "replace")[:8].ljust(8, b"\0"), "big")


def name_of(key: int) -> str:
    """Return the card name of a number of the line index."""
    return int(key).to_bytes(8, "big").rstrip(b"\0").decode("latin-1")


@dataclass(frozen=True, eq=False)
class LineIndex:
    """Where the lines of a file are and what each starts.

    Parameters
    ----------
    starts, ends : (n_line,) int
        Byte offsets; the end is before the line's terminator.
    keys : (n_line,) uint64
        `key_of` the first word in capitals, or BLANK, CONTINUATION, REPLICATION.
    """

    starts: Ints
    ends: Ints
    keys: Keys

    def __len__(self) -> int:
        return len(self.starts)


@dataclass(frozen=True, eq=False)
class TextFile(Noun):
    """One file of a deck.

    Parameters
    ----------
    path : Path
        Absolute, as found.
    data : bytes
        The text as it is now.
    original : bytes
        The text as it was read.
    """

    path: Path
    data: bytes
    original: bytes
    _ids: dict[str, tuple[Ints, Ints]] = field(default_factory=dict, init=False, repr=False)

    @property
    def edited(self) -> bool:
        """Whether the text differs from what was read."""
        return self.data is not self.original and self.data != self.original

    @cached_property
    def lines(self) -> LineIndex:
        """Index of the lines of `data`."""
        return index_lines(self.data)

    @cached_property
    def newline(self) -> bytes:
        """The line end that most lines of the file have."""
        crlf = self.data.count(b"\r\n")
        counts = {
            b"\n": self.data.count(b"\n") - crlf,
            b"\r\n": crlf,
            b"\r": self.data.count(b"\r") - crlf,
        }
        return max(counts, key=lambda end: counts[end])

    @cached_property
    def encoding(self) -> str:
        """``utf-8`` where the bytes are that, else ``latin-1`` (which takes any byte)."""
        try:
            self.data.decode("utf-8")
        except UnicodeDecodeError:
            return "latin-1"
        return "utf-8"

    def line(self, row: int) -> bytes:
        """Return the text of one line without its terminator."""
        return self.data[self.lines.starts[row] : self.lines.ends[row]]

    def terminator(self, row: int) -> bytes:
        """Return the bytes that end one line; none at the end of a file that lacks them."""
        last = row + 1 == len(self.lines)
        stop = len(self.data) if last else int(self.lines.starts[row + 1])
        return self.data[self.lines.ends[row] : stop]

    def rows_named(self, name: str) -> tuple[Ints, Ints]:
        """Return the lines that start a card of this name, and the number in field 2 of each.

        Returns
        -------
        rows, ids : (n,) int
            The number is -1 where the field holds none.
        """
        if name not in self._ids:
            rows = np.flatnonzero(self.lines.keys == np.uint64(key_of(name)))
            self._ids[name] = (rows, _numbers(self, rows))
        return self._ids[name]

    def with_data(self, data: bytes) -> "TextFile":
        """Return the same file with another text."""
        return TextFile(self.path, data, self.original)


def index_lines(data: bytes) -> LineIndex:
    """Find the lines of a text with LF, CRLF, CR or mixed line ends, and their first words."""
    raw = np.frombuffer(data, np.uint8)
    ends, starts = _bounds(data, raw)
    keys = np.empty(len(starts), np.uint64)
    for first in range(0, len(starts), _CHUNK):
        part = slice(first, first + _CHUNK)
        keys[part] = _keys(data, raw, starts[part], ends[part])
    return LineIndex(starts, ends, keys)


def _bounds(data: bytes, raw: Bytes) -> tuple[Ints, Ints]:
    """Return ends (before the terminator) and starts of all lines; an empty last line is none."""
    feeds = [np.flatnonzero(raw[k : k + (1 << 24)] == 10) + k for k in range(0, len(raw), 1 << 24)]
    stops = np.concatenate(feeds) if feeds else np.zeros(0, np.int64)
    if b"\r" not in data:
        ends, nexts = stops, stops + 1
    else:
        returns = np.flatnonzero(raw == 13)
        followed = np.append(raw, 0)[returns + 1] == 10
        ends = np.union1d(returns, stops[(stops == 0) | (raw[stops - 1] != 13)])
        paired = np.isin(ends, returns[followed])
        nexts = ends + 1 + paired
    starts = np.concatenate([[0], nexts]).astype(np.int64)
    ends = np.append(ends, len(raw)).astype(np.int64)
    if starts[-1] == len(raw):
        starts, ends = starts[:-1], ends[:-1]
    if data.startswith(codecs.BOM_UTF8):
        starts[0] = len(codecs.BOM_UTF8)
    return ends, starts


def _gather(raw: Bytes, starts: Ints, ends: Ints, columns: range) -> Bytes:
    """Bytes of each line at the given columns, zero past its end, (n_line, n_column)."""
    at = starts[:, None] + np.asarray(columns)
    inside = at < ends[:, None]
    block: Bytes = np.where(inside, raw[np.minimum(at, len(raw) - 1)], 0).astype(np.uint8)
    return block


def _keys(data: bytes, raw: Bytes, starts: Ints, ends: Ints) -> Keys:
    block = _gather(raw, starts, ends, range(8))
    first = block[:, 0]
    indented = np.flatnonzero((first == 32) | (first == 9))
    block = _UPPER[block]
    block[np.logical_or.accumulate(_ENDS_NAME[block], axis=1)] = 0
    keys = block.view(">u8")[:, 0].astype(np.uint64)
    kind = _FIRST[first]
    keys[kind >= 0] = kind[kind >= 0].astype(np.uint64)
    keys[indented] = _indented_keys(data, raw, starts[indented], ends[indented])
    return keys


def _indented_keys(data: bytes, raw: Bytes, starts: Ints, ends: Ints) -> Keys:
    """Lines that start with a blank: continuation, blank, comment or a card set in a little."""
    keys = np.full(len(starts), CONTINUATION, np.uint64)
    block = _gather(raw, starts, ends, range(24))
    solid = (block != 32) & (block != 0) & (block != 9)
    at = np.argmax(solid, axis=1)
    some = solid.any(axis=1)
    char = block[np.arange(len(block)), at]
    plain = some & (block[:, 0] == 32) & (at >= 8) & (char != ord("$"))
    for k in np.flatnonzero(~plain):
        keys[k] = indented_key(data[starts[k] : ends[k]])
    return keys


def indented_key(line: bytes) -> int:
    """Return the key of a line that starts with a blank or a tab."""
    text = line.split(b"$", 1)[0]
    if not text.strip():
        return BLANK
    head = text[:8]
    word = head.strip()
    if line[:1] == b"\t" or not word or word[:1] in b"+*,":
        return CONTINUATION
    if word[:1] == b"=":
        return REPLICATION
    name = text.lstrip()[:8].upper()
    stop = next((i for i, c in enumerate(name) if _ENDS_NAME[c]), len(name))
    return key_of(name[:stop].decode("latin-1"))


def _numbers(file: TextFile, rows: Ints) -> Ints:
    """Field 2 of each line as a number, -1 where it is none."""
    ids = np.full(len(rows), -1, np.int64)
    raw = np.frombuffer(file.data, np.uint8)
    for first in range(0, len(rows), _CHUNK):
        part = rows[first : first + _CHUNK]
        ids[first : first + _CHUNK] = _chunk_numbers(file, raw, part)
    return ids


def _chunk_numbers(file: TextFile, raw: Bytes, rows: Ints) -> Ints:
    starts, ends = file.lines.starts[rows], file.lines.ends[rows]
    block = _gather(raw, starts, ends, range(24))
    fixed = ~(block[:, :10] == ord(",")).any(axis=1) & ~(block == 9).any(axis=1)
    fixed &= (block[:, 0] != 32) & ~(block == ord("$")).any(axis=1)
    large = (block[:, :8] == ord("*")).any(axis=1)
    cells = block[:, 8:]
    cells[~large, 8:] = 32
    digit = (cells >= 48) & (cells <= 57)
    blank = (cells == 32) | (cells == 0)
    runs = np.diff(digit.astype(np.int8), axis=1, prepend=0) == 1
    good = fixed & (digit | blank).all(axis=1) & (runs.sum(axis=1) == 1)
    ids = np.zeros(len(rows), np.int64)
    for column in range(cells.shape[1]):
        ids = np.where(digit[:, column], 10 * ids + cells[:, column] - 48, ids)
    ids[~good] = -1
    for k in np.flatnonzero(~good):
        ids[k] = _slow_number(file.line(int(rows[k])))
    return ids


def _slow_number(line: bytes) -> int:
    text = line.split(b"$", 1)[0]
    if b"," in text.lstrip()[:10]:
        word = text.split(b",", 2)[1]
    else:
        text = text.expandtabs()
        word = text[8:24] if b"*" in text[:8] else text[8:16]
    word = word.strip()
    return int(word) if word.isdigit() else -1
