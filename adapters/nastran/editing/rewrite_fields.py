"""New values in the lines of one card: only the fields' own characters change where they can.

A value that eight columns would round is written in a large field: the line that holds it becomes
two lines of large fields (free format stays free), the rest of the card stays as it is. So the
value read back is the one of `numbers.writable`, whatever the card's format.
"""

from collections.abc import Mapping, Sequence

from ....core.errors import InputError
from ..text.real_numbers import LARGE, SMALL, format_field
from .cells import CONTENT_END, CardLine

Value = float | int | str | None


def rewrite_card(lines: Sequence[CardLine], edits: Mapping[int, Value]) -> list[tuple[bytes, ...]]:
    """Return, for each line of a card, the lines that take its place.

    Parameters
    ----------
    lines : sequence of CardLine
        The card's lines without comments between them.
    edits : mapping of int to value
        By data field, counted from 0 after the name over all lines. A field beyond the card's end
        extends it; continuations are added after its last line.

    Raises
    ------
    InputError
        Half a pair of large-field lines before a small-field line: what follows it cannot be
        counted with certainty. A value longer than its field.
    """
    _require_whole_pairs(lines)
    result: list[tuple[bytes, ...]] = []
    start = 0
    reach = max(edits, default=-1)
    total = sum(line.capacity for line in lines)
    for k, line in enumerate(lines):
        mine = {d - start: v for d, v in edits.items() if start <= d < start + line.capacity}
        last = k == len(lines) - 1 and reach < total
        result.append(_rewrite_line(line, mine, last) if mine else (line.data,))
        start += line.capacity
    beyond = {d: v for d, v in edits.items() if d >= total}
    if beyond:
        result[-1] = (*result[-1], *_continuations(lines[-1], total, beyond))
    return result


def format_card(fields: Sequence[Value]) -> list[bytes]:
    """Return a new card's lines: small fields, or large ones where a value needs them.

    Parameters
    ----------
    fields : sequence of float, int, str or None
        The name, then the data fields in order, None where blank.
    """
    name, data = str(fields[0]).upper(), [*fields[1:]]
    while data and data[-1] is None:
        data.pop()
    small = [format_field(v, SMALL) for v in data]
    star = "*" if None in small else ""
    width, per_line = (LARGE, 4) if star else (SMALL, 8)
    texts = [format_field(v, width) or "" for v in data]
    lines: list[bytes] = []
    for start in range(0, max(len(texts), 1), per_line):
        head = f"{name}{star}" if start == 0 else (star or "+")
        row = "".join(t.ljust(width) for t in texts[start : start + per_line])
        lines.append((head.ljust(8) + row).rstrip().encode("latin-1"))
    return lines


def _require_whole_pairs(lines: Sequence[CardLine]) -> None:
    half = False
    for line in lines:
        if half and not line.large:
            raise InputError(
                f"the large-field line before {line.data.decode('latin-1').strip()!r} lacks its "
                "second half: write the pair in full, then the fields can be counted"
            )
        half = line.large and not half


def _rewrite_line(line: CardLine, edits: Mapping[int, Value], last: bool) -> tuple[bytes, ...]:
    texts = {k: format_field(v, line.width) for k, v in edits.items()}
    if None in texts.values():
        return _as_large(line, edits, last)
    known = {k: (t or "").encode("latin-1") for k, t in texts.items()}
    return (_put_free(line, known) if line.free else _put_fixed(line, known),)


def _put_free(line: CardLine, texts: Mapping[int, bytes]) -> bytes:
    content = line.content
    words = content.rstrip().split(b",")
    blanks = content[len(content.rstrip()) :]
    for k, text in texts.items():
        words.extend([b""] * (k + 2 - len(words)))
        old = words[k + 1]
        left = old[: len(old) - len(old.lstrip())] if old.strip() else b""
        right = old[len(old.rstrip()) :] if old.strip() else b""
        words[k + 1] = left + text + right
    return b",".join(words) + blanks + line.comment


def _put_fixed(line: CardLine, texts: Mapping[int, bytes]) -> bytes:
    width = line.width
    data, comment = line.content, line.comment
    inside = {k: t for k, t in texts.items() if k < len(line.cells)}
    for k in sorted(inside, reverse=True):
        start, stop = line.cells[k]
        old, text = data[start:stop], inside[k]
        to_the_right = len(old) == width and old[:1] == b" " and old[-1:] not in b" \t"
        text = text.rjust(width) if to_the_right else text.ljust(_least(old, line))
        if stop < len(data):
            text = text.ljust(width)
        data = data[:start] + text + data[stop:]
    for k in sorted(texts.keys() - inside.keys()):
        column = 8 + k * width
        short = column - len(data.expandtabs())
        data = data + b" " * short + texts[k] if short >= 0 else data[:short] + texts[k]
    if comment and b"\t" not in data:
        data = data.ljust(len(line.content))
    if comment and line.content[-1:] in b" \t" and data[-1:] not in b" \t":
        data += b" "
    return data + comment


def _least(old: bytes, line: CardLine) -> int:
    """Columns to fill so that trailing blanks and a comment behind the field stay in place."""
    if b"\t" in old:
        return line.width
    return len(old) if old[-1:] == b" " or line.comment else 0


def _as_large(line: CardLine, edits: Mapping[int, Value], last: bool) -> tuple[bytes, ...]:
    """Return the two lines of large fields that hold a small-field line with new values."""
    cells = [
        (format_field(edits[k], LARGE) or "") if k in edits else line.text(k) for k in range(8)
    ]
    head = line.head
    star = b"*" + head[1:] if head[:1] in (b"+", b"") else head + b"*"
    one = not any(cells[4:]) and not line.tail and last
    rows = [_row(star, cells[:4], line.free)]
    if not one:
        rows.append(_row(b"*", cells[4:], line.free))
    if line.tail and line.free:
        rows[-1] += b"," * (5 - rows[-1].count(b",")) + line.tail
    elif line.tail:
        rows[-1] = rows[-1].ljust(CONTENT_END) + line.tail
    if line.comment:
        rows[-1] += b" " + line.comment
    return tuple(rows)


def _row(head: bytes, cells: Sequence[str], free: bool) -> bytes:
    texts = [c.encode("latin-1") for c in cells]
    if free:
        return b",".join([head, *texts]).rstrip(b",") + (b"" if any(texts) else b",")
    width = LARGE if head[-1:] == b"*" or head[:1] == b"*" else SMALL
    return (head.ljust(8) + b"".join(t.ljust(width) for t in texts)).rstrip()


def _continuations(last: CardLine, total: int, edits: Mapping[int, Value]) -> list[bytes]:
    """Return the lines that a card lacks for fields beyond its end; blocks of eight fields."""
    tag = last.tail.strip()[:8] if not last.free else last.tail.split(b",")[0].strip()
    tag = tag[1:] if tag[:1] in (b"+", b"*") else b""
    rows: list[bytes] = []
    first = total - total % 8
    for block in range(first, max(edits) + 1, 8):
        wanted = {d - block: edits[d] for d in range(block, block + 8) if d in edits}
        final = block + 8 > max(edits)
        large = last.large or None in [format_field(v, SMALL) for v in wanted.values()]
        texts = [format_field(wanted.get(k), LARGE if large else SMALL) or "" for k in range(8)]
        halves = [texts[:4], texts[4:]] if large else [texts]
        if block == first and total % 8:
            halves = [texts[4:]] if large else halves
        if large and final and len(halves) == 2 and not any(halves[1]):
            halves.pop()
        for half in halves:
            head = (b"*" if large else b"+") + (tag if not rows else b"")
            rows.append(_row(head, half, last.free))
    return rows
