"""Values read from and written to a deck's text, and nothing else changed."""

from collections import defaultdict
from collections.abc import Iterable, Mapping

from ....core.errors import InputError
from ..fields.layouts import field_position
from ..fields.parameter_references import FieldRef
from ..text.deck_text import DeckText
from ..text.real_numbers import parse_real, writable
from .find_cards import Card, find_value
from .rewrite_fields import Value, rewrite_card


def read_value(deck: DeckText, ref: FieldRef) -> float | None:
    """Return a value as the deck holds it, None where the field is blank.

    Raises
    ------
    InputError
        No such card, several such cards, a card that has no such field, text that is no number.
    """
    card = find_value(deck, ref)
    return _value(deck, card, ref, _index(deck, card, ref))


def set_values(deck: DeckText, values: Mapping[FieldRef, float]) -> DeckText:
    """Return the deck with other values; only those fields change.

    Every value is written so that it reads back as `writable` of it: in its own field where the
    field's width holds it exactly, else in a large field (16 columns) on the same line of the
    card. A value that the deck already holds leaves the text as it is.

    Parameters
    ----------
    deck : DeckText
        Not changed.
    values : mapping of FieldRef to float
        In deck units.

    Raises
    ------
    InputError
        As `read_value`; a value that is not finite.
    """
    edits: dict[tuple[int, int], dict[int, Value]] = defaultdict(dict)
    cards: dict[tuple[int, int], Card] = {}
    for ref, value in values.items():
        card = find_value(deck, ref)
        index = _index(deck, card, ref)
        if _value(deck, card, ref, index) == writable(value):
            continue
        cards[card.file, card.rows[0]] = card
        edits[card.file, card.rows[0]][index] = float(value)
    return edit_cards(deck, [(cards[k], edits[k]) for k in edits])


def edit_cards(deck: DeckText, edits: Iterable[tuple[Card, Mapping[int, Value]]]) -> DeckText:
    """Return the deck with other fields in some cards, each by its data field from 0.

    Raises
    ------
    InputError
        What `rewrite_card` cannot do, with the file and line.
    """
    splices: dict[int, list[tuple[int, int, bytes]]] = defaultdict(list)
    for card, fields in edits:
        try:
            lines = rewrite_card(card.lines, fields)
        except InputError as error:
            place = deck.place(card.file, card.rows[0])
            raise place.error(f"{card.name} {card.text(card.shift)}: {error}") from None
        file = deck.files[card.file]
        for row, old, new in zip(card.rows, card.lines, lines, strict=True):
            if new != (old.data,):
                ending = file.terminator(row) or file.newline
                a, b = int(file.lines.starts[row]), int(file.lines.ends[row])
                splices[card.file].append((a, b, ending.join(new)))
    return deck.with_file_data({k: splice(deck.files[k].data, s) for k, s in splices.items()})


def splice(data: bytes, pieces: Iterable[tuple[int, int, bytes]]) -> bytes:
    """Return `data` with the bytes start..stop of each piece replaced by its own."""
    out: list[bytes] = []
    done = 0
    for start, stop, new in sorted(pieces):
        out += [data[done:start], new]
        done = stop
    return b"".join([*out, data[done:]])


def _index(deck: DeckText, card: Card, ref: FieldRef) -> int:
    position = field_position(ref.card, ref.field, card.read)
    if position is None:
        raise deck.place(card.file, card.rows[0]).error(f"this {ref.title} has no {ref.field}")
    return card.index(position)


def _value(deck: DeckText, card: Card, ref: FieldRef, index: int) -> float | None:
    text = card.text(index)
    if not text:
        return None
    try:
        return parse_real(text)
    except ValueError:
        raise deck.place(card.file, card.rows[0]).error(
            f"{ref} is {text!r}, which is not a number"
        ) from None
