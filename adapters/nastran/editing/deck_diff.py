"""Unified diff of two texts of a deck, fast on meshes of a million lines."""

import bisect
import difflib
from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from ....core.errors import InputError
from ..text.deck_text import DeckText
from ..text.source_file import Bytes, TextFile
from .write_deck import names_in_tree

_CHUNK = 1 << 22
_SMALL = 200_000  # products of line counts that difflib handles at once

Change = tuple[int, int, int, int]


def unified_diff(before: DeckText, after: DeckText, context: int = 3) -> str:
    """Return what changed between two texts of one deck, as ``diff -u`` writes it.

    Files are named by their place in the tree that `write_deck` writes; files that are equal do
    not appear, and two equal decks give "".

    Raises
    ------
    InputError
        The two are not texts of the same deck.
    """
    if [f.path for f in before.files] != [f.path for f in after.files]:
        raise InputError("only two texts of the same deck can be compared")
    out: list[str] = []
    for name, old, new in zip(names_in_tree(before), before.files, after.files, strict=True):
        if old.data != new.data:
            out += [f"--- a/{name}", f"+++ b/{name}", *_hunks(old, new, context)]
    return "".join(line + "\n" for line in out)


def _hunks(old: TextFile, new: TextFile, context: int) -> Iterator[str]:
    for group in _grouped(list(changes(old, new)), context):
        i1, j1 = max(group[0][0] - context, 0), max(group[0][2] - context, 0)
        i2 = min(group[-1][1] + context, len(old.lines))
        j2 = min(group[-1][3] + context, len(new.lines))
        yield f"@@ -{_range(i1, i2)} +{_range(j1, j2)} @@"
        at = i1
        for a1, a2, b1, b2 in group:
            yield from _lines(old, " ", at, a1)
            yield from _lines(old, "-", a1, a2)
            yield from _lines(new, "+", b1, b2)
            at = a2
        yield from _lines(old, " ", at, i2)


def _range(first: int, stop: int) -> str:
    n = stop - first
    start = first + 1 if n else first
    return str(start) if n == 1 else f"{start},{n}"


def _lines(file: TextFile, sign: str, first: int, stop: int) -> Iterator[str]:
    for row in range(first, stop):
        ending = file.terminator(row)
        carriage = "\r" if ending == b"\r\n" else ""
        yield sign + file.line(row).decode(file.encoding, "replace") + carriage
        if not ending:
            yield "\\ No newline at end of file"


def _grouped(changes: list[Change], context: int) -> Iterator[list[Change]]:
    group: list[Change] = []
    for change in changes:
        if group and change[0] - group[-1][1] > 2 * context:
            yield group
            group = []
        group.append(change)
    if group:
        yield group


def changes(old: TextFile, new: TextFile) -> Iterator[Change]:
    """Yield the changed stretches of lines; what is equal at both ends is cut off by the bytes."""
    a, b = np.frombuffer(old.data, np.uint8), np.frombuffer(new.data, np.uint8)
    front = _common(a, b)
    back = min(_common(a[::-1], b[::-1]), min(len(a), len(b)) - front)
    first = max(_rows_to(old, front) - 2, 0)
    i2 = min(_rows_to(old, len(a) - back) + 1, len(old.lines))
    j2 = min(_rows_to(new, len(b) - back) + 1, len(new.lines))
    for i, k, j, m in _changes(_texts(old, first, i2), _texts(new, first, j2)):
        yield i + first, k + first, j + first, m + first


def _common(a: Bytes, b: Bytes) -> int:
    """Return how many bytes are equal from the start on."""
    n = min(len(a), len(b))
    for k in range(0, n, _CHUNK):
        differ = np.flatnonzero(a[k : min(k + _CHUNK, n)] != b[k : min(k + _CHUNK, n)])
        if len(differ):
            return k + int(differ[0])
    return n


def _rows_to(file: TextFile, offset: int) -> int:
    return int(np.searchsorted(file.lines.starts, offset, "right"))


def _texts(file: TextFile, first: int, stop: int) -> list[bytes]:
    starts = [*file.lines.starts[first : stop + 1].tolist(), len(file.data)]
    return [file.data[p:q] for p, q in pairwise(starts[: stop - first + 1])]


def _changes(a: list[bytes], b: list[bytes]) -> Iterator[Change]:
    """Yield the stretches a[i1:i2] that became b[j1:j2].

    Lines that stand once in both are anchors (patience diff, B. Cohen); between them difflib.
    """
    if len(a) * len(b) <= _SMALL:
        for tag, i1, i2, j1, j2 in difflib.SequenceMatcher(None, a, b, False).get_opcodes():
            if tag != "equal":
                yield i1, i2, j1, j2
        return
    at_i, at_j = 0, 0
    anchors = _anchors(a, b)
    for i, j in [*anchors, (len(a), len(b))]:
        old, new = a[at_i:i], b[at_j:j]
        if old != new:
            for i1, i2, j1, j2 in _changes(old, new) if anchors else [(0, len(old), 0, len(new))]:
                yield i1 + at_i, i2 + at_i, j1 + at_j, j2 + at_j
        at_i, at_j = i + 1, j + 1


def _anchors(a: list[bytes], b: list[bytes]) -> list[tuple[int, int]]:
    """Return the longest rising run of pairs of lines that stand once in both."""
    once_a = {line for line, n in Counter(a).items() if n == 1}
    once_b = {line for line, n in Counter(b).items() if n == 1}
    where = {line: j for j, line in enumerate(b) if line in once_b}
    pairs = [(i, where[line]) for i, line in enumerate(a) if line in once_a and line in where]
    ends, last, previous = list[int](), list[int](), [-1] * len(pairs)
    for k, (_, j) in enumerate(pairs):
        at = bisect.bisect_left(ends, j)
        previous[k] = last[at - 1] if at else -1
        ends[at : at + 1] = [j]
        last[at : at + 1] = [k]
    run: list[tuple[int, int]] = []
    k = last[-1] if last else -1
    while k >= 0:
        run.append(pairs[k])
        k = previous[k]
    return run[::-1]
