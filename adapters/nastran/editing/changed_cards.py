"""The cards by which one text of a deck differs from another, as they stand there."""

from collections.abc import Iterator

from ..text.deck_text import DeckText
from ..text.source_file import TextFile
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
    done = 0
    for _, _, first, stop in changes(old, new):
        row = max(_head(new, first), done)
        while row < stop:
            end = _end(new, row)
            if not _comment(new, row):
                yield "\n".join(
                    new.line(r).decode(new.encoding, "replace").rstrip()
                    for r in range(row, end)
                    if not _comment(new, r)
                )
            row = done = end


def _comment(file: TextFile, row: int) -> bool:
    line = file.line(row).lstrip()
    return not line or line.startswith(b"$")


def _continues(file: TextFile, row: int) -> bool:
    """Whether a line goes on with the card before it."""
    line = file.line(row)
    return not _comment(file, row) and (
        line[:1] in (b"+", b"*", b",", b"\t") or not line[:8].strip()
    )


def _head(file: TextFile, row: int) -> int:
    while row > 0 and row < len(file.lines) and _continues(file, row):
        row -= 1
    return row


def _end(file: TextFile, row: int) -> int:
    """Return the first row that is no longer of the card, or comment, at `row`."""
    end = row + 1
    if _comment(file, row):
        return end
    for r in range(row + 1, len(file.lines)):
        if _continues(file, r):
            end = r + 1
        elif not _comment(file, r):
            break
    return end
