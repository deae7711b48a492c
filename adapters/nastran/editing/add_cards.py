"""New cards in a deck's text: one commented block in the file that holds their neighbours."""

import textwrap
from collections.abc import Sequence

from ....core.ascii import in_ascii
from ....core.errors import Place
from ..text.deck_text import DeckText, Segment
from .find_cards import find_card
from .rewrite_fields import Value, format_card
from .set_values import splice

_COMMENT_WIDTH = 76


def add_cards(
    deck: DeckText,
    cards: Sequence[Sequence[Value]],
    comment: str,
    near: tuple[str, int] | None = None,
) -> DeckText:
    """Return the deck with new cards at the end of the bulk data of one of its files.

    Parameters
    ----------
    deck : DeckText
        Not changed.
    cards : sequence of cards
        Each the name and then its data fields in order: float, int, str or None (blank). Reals
        are written in small fields where these hold them exactly, else in large ones.
    comment : str
        Says what and why; put before the cards as comment lines.
    near : (str, int), optional
        Name and number of the card whose file (and superelement) takes the new ones; default the
        top deck, or the last file with bulk data where the top has none.

    Raises
    ------
    InputError
        The neighbour is not there, the deck has no bulk data, a value is not finite.
    """
    lines = [line for card in cards for line in format_card(card)]
    return add_lines(deck, lines, comment, near)


def add_lines(
    deck: DeckText, lines: Sequence[bytes], comment: str, near: tuple[str, int] | None
) -> DeckText:
    """Return the deck with lines of bulk data added in the place that `add_cards` describes."""
    segment = _segment_for(deck, near)
    file = deck.files[segment.file]
    block = [*_comment_lines(comment), *lines]
    at = int(file.lines.starts[segment.stop]) if segment.stop < len(file.lines) else len(file.data)
    text = file.newline.join(block)
    ended = file.terminator(segment.stop - 1) != b""
    text = text + file.newline if ended else file.newline + text
    return deck.with_file_data({segment.file: splice(file.data, [(at, at, text)])})


def _segment_for(deck: DeckText, near: tuple[str, int] | None) -> Segment:
    """Return the last stretch of bulk data in the neighbour's file and superelement."""
    if not deck.segments:
        raise Place(deck.files[0].path, shown=deck.files[0].path.name).fault(
            "has no bulk data to add cards to"
        )
    file, part = 0, ""
    if near is not None:
        card = find_card(deck, *near)
        file, part = card.file, card.part
    same = [s for s in deck.segments if s.file == file and s.part == part]
    return (same or list(deck.segments))[-1]


def _comment_lines(comment: str) -> list[bytes]:
    lines = [
        line
        for paragraph in in_ascii(comment).splitlines()
        for line in textwrap.wrap(paragraph, _COMMENT_WIDTH) or [""]
    ]
    return [f"$ {line}".rstrip().encode("ascii") for line in lines]
