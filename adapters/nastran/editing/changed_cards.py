"""The cards by which one text of a deck differs from another, as they stand there."""

from collections.abc import Iterator

from ..text.deck_text import DeckText
from ..text.source_file import BLANK, CONTINUATION, TextFile
from .deck_diff import changes


def written_cards(before: DeckText, after: DeckText) -> tuple[str, ...]:
    """Return every new or changed card of `after`, line by line, comments left out.

    Parameters
    ----------
    before, after : DeckText
        Two texts of one deck.

    Returns
    -------
    tuple of str
        One entry a card, its continuation lines after newlines.
    """
    return tuple(
        card
        for old, new in zip(before.files, after.files, strict=True)
        if old.data != new.data
        for card in _cards(old, new)
    )


def _cards(old: TextFile, new: TextFile) -> Iterator[str]:
    keys, done = new.lines.keys, 0
    for _, _, first, stop in changes(old, new):
        row = first
        while 0 < row < len(keys) and keys[row] == CONTINUATION:
            row -= 1
        row = max(row, done)
        while row < stop:
            rows = [row]
            if keys[row] != BLANK:
                for k in range(row + 1, len(keys)):
                    if keys[k] > CONTINUATION:
                        break
                    if keys[k] == CONTINUATION:
                        rows.append(k)
                lines = [new.line(r).rstrip() for r in rows]
                # new cards may end with the lines of the one before them
                as_before = rows[0] < first and b"\n".join([*lines, b""]) in old.data
                if not as_before:
                    yield b"\n".join(lines).decode(new.encoding, "replace")
            row = done = rows[-1] + 1
