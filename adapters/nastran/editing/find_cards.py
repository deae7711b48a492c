"""Cards found by name and number over all files of a deck."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ....core.errors import InputError, Place
from ..cards import definitions
from ..deck.movable_values import index_of
from ..deck.number_spaces import SPACES, space_of
from ..fields.parameter_references import FieldRef
from ..text.deck_text import DeckText, Segment
from ..text.source_file import CONTINUATION, REPLICATION, Keys, name_of
from .cells import CardLine

MOST_DIGITS = 99_999_999
_TAKEN = re.compile(rb"^[^$]*[\s,]==?(?=[\s,$]|$)")


@dataclass(frozen=True, eq=False)
class Card:
    """A card in the text.

    Parameters
    ----------
    name : str
        In capitals.
    file : int
        Index of its file.
    rows : tuple of int
        Its lines, comments between them left out.
    lines : tuple of CardLine
        The text of those lines.
    shift : int
        Data fields before the number that was asked for, where a card holds several properties.
    part : str
        Name of the superelement part it belongs to, "" for the residual structure.
    """

    name: str
    file: int
    rows: tuple[int, ...]
    lines: tuple[CardLine, ...]
    shift: int = 0
    part: str = ""

    def index(self, position: int) -> int:
        """Return the data field (from 0 after the name) of a position of the guide."""
        return index_of(position) + self.shift

    def text(self, index: int) -> str:
        """Return data field `index` (from 0), stripped, in capitals, "" where blank."""
        for line in self.lines:
            if index < line.capacity:
                return line.text(index).upper()
            index -= line.capacity
        return ""

    def read(self, position: int) -> str:
        """Return the text of the field at a position of the guide."""
        return self.text(self.index(position))

    @property
    def size(self) -> int:
        """Number of data fields up to the last that is not blank."""
        total = sum(line.capacity for line in self.lines)
        return next((k + 1 for k in reversed(range(total)) if self.text(k)), 0)


def card_at(deck: DeckText, segment: Segment, row: int, name: str) -> Card:
    """Return the card that starts at a line.

    Raises
    ------
    InputError
        Its continuations are out of order (their tags do not match), or it is replicated by
        the lines after it.
    """
    file = deck.files[segment.file]
    keys = file.lines.keys
    rows = [row]
    for k in range(row, segment.stop):
        if keys[k] == REPLICATION or (keys[k] == keys[row] and _TAKEN.search(file.line(k))):
            raise deck.place(segment.file, k).error(
                f"the {name} {'above' if k > row else 'here'} is replicated by '='; write it out"
            )
        if keys[k] > CONTINUATION and k > row:
            break
        if keys[k] == CONTINUATION:
            rows.append(k)
    lines = tuple(CardLine(file.line(r)) for r in rows)
    _require_matching_tags(deck, segment.file, rows, lines)
    return Card(name, segment.file, tuple(rows), lines, part=segment.part)


def find_card(deck: DeckText, name: str, number: int) -> Card:
    """Return the one card of a name and number.

    Raises
    ------
    InputError
        No such card (its nearest numbers are named), or several.
    """
    name = name.upper()
    found, called = [*_matches(deck, name, number)], f"{name} {number}"
    if not found:
        raise InputError(_missing(deck, name, number), file=deck.files[0].path, card=called)
    if len(found) > 1:
        at = [(deck.place(c.file, c.rows[0]), c.part) for c in found[:3]]
        places = ", ".join(f"{place}" + (f" ({part})" if part else "") for place, part in at)
        raise replace(at[0][0], card=called).about(
            f"{called} stands {len(found)} times in the deck ({places}): it is not clear which "
            "one is meant, give the copies their own numbers"
        )
    return found[0]


def find_value(deck: DeckText, ref: FieldRef) -> Card:
    """Return the one card that holds a value.

    Raises
    ------
    InputError
        As `find_card`.
    """
    if ref.id:
        return find_card(deck, ref.card, ref.id)
    every = (
        card_at(deck, segment, row, ref.card)
        for segment in deck.segments
        for row, _ in deck.rows_in(segment, ref.card)
    )
    found = [card for card in every if card.text(0) == ref.field]
    if len(found) != 1:
        stands = f"stands {len(found)} times in the bulk data; it must stand there once"
        raise InputError(f"{ref} {stands}", file=deck.files[0].path, card=str(ref))
    return found[0]


def names_in(deck: DeckText) -> list[str]:
    """Return the names of all cards of the bulk data."""
    names: set[int] = set()
    for segment in deck.segments:
        names.update(np.unique(_keys(deck, segment)).tolist())
    return sorted(name_of(k) for k in names if k > REPLICATION)


def free_id(deck: DeckText, kind: str) -> int:
    """Return a number that no card of a kind, or of an unknown one, has in any file of the deck.

    Parameters
    ----------
    deck : DeckText
        The deck.
    kind : {"element", "property", "material", "grid", "coordinate", "set"}
        Cards that share one range of numbers: rigid and mass elements are elements, scalar points
        are grids.

    Returns
    -------
    int
        One above the highest; where that has more than eight digits, the lowest that is free.

    Raises
    ------
    InputError
        No such kind; replicated cards, whose numbers are not written out.
    """
    if kind not in SPACES.values():
        raise InputError(f"there are no numbers of {kind!r}: ask for {', '.join(SPACES.values())}")
    used = _used(deck, kind)
    top = max(used, default=0)
    if top < MOST_DIGITS:
        return top + 1
    return next(n for n in range(1, MOST_DIGITS) if n not in used)


def _used(deck: DeckText, kind: str) -> set[int]:
    used: set[int] = set()
    if where := _replicated(deck):
        raise where.error(
            "cards are replicated by '=', so free numbers are not known; write the cards out"
        )
    for name in names_in(deck):
        if space_of(name, definitions()) not in (kind, ""):
            continue
        for segment in deck.segments:
            found = deck.rows_in(segment, name)
            if _stride(name) or name in ("SPOINT", "EPOINT"):
                used.update(*(_all_ids(card_at(deck, segment, row, name)) for row, _ in found))
            else:
                used.update(number for _, number in found)
    return {n for n in used if 0 < n <= MOST_DIGITS}


def _replicated(deck: DeckText) -> Place | None:
    """Return where the first line stands that replicates a card."""
    for segment in deck.segments:
        rows = np.flatnonzero(_keys(deck, segment) == REPLICATION)
        if len(rows):
            return deck.place(segment.file, segment.first + int(rows[0]))
    return None


def _keys(deck: DeckText, segment: Segment) -> Keys:
    return deck.files[segment.file].lines.keys[segment.first : segment.stop]


def _stride(name: str) -> int:
    """Fields from one property to the next on cards that hold several; 0: they hold one."""
    card = definitions().get(name)
    return card.several if card else 0


def _all_ids(card: Card) -> set[int]:
    words = [card.text(k) for k in range(card.size)]
    numbers = {int(w) for w in words[:: _stride(card.name) or 1] if w.isdigit()}
    if "THRU" in words and len(numbers) >= 2:
        numbers |= set(range(min(numbers), max(numbers) + 1))
    return numbers


def _matches(deck: DeckText, name: str, number: int) -> Iterator[Card]:
    stride = _stride(name)
    for segment in deck.segments:
        if not stride:
            for row, _ in deck.rows_of(segment, name, number):
                yield card_at(deck, segment, row, name)
            continue
        for row, _ in deck.rows_in(segment, name):
            card = card_at(deck, segment, row, name)
            for shift in range(0, card.size, stride):
                if card.text(shift) == str(number):
                    yield replace(card, shift=shift)


def _missing(deck: DeckText, name: str, number: int) -> str:
    top = deck.files[0].path.name
    numbers: set[int] = set()
    for segment in deck.segments:
        for row, first in deck.rows_in(segment, name):
            numbers |= _all_ids(card_at(deck, segment, row, name)) if _stride(name) else {first}
    numbers.discard(-1)
    where = _replicated(deck)
    more = f"; those that '=' replicates ({where} first) must be written out" if where else ""
    if not numbers:
        return f"{top} has no {name} {number}: there is no {name} card in the deck{more}"
    near = sorted(sorted(numbers, key=lambda n: (abs(n - number), n))[:5])
    listed = ", ".join(str(n) for n in near) + (", ..." if len(numbers) > len(near) else "")
    return f"{top} has no {name} {number}: its {name} cards are {listed}{more}"


def _require_matching_tags(
    deck: DeckText, file: int, rows: Sequence[int], lines: Sequence[CardLine]
) -> None:
    for k, line in enumerate(lines):
        tag = _tag(line.tail[:8])
        if not tag:
            continue
        if k + 1 < len(lines):
            wrong = _tag(lines[k + 1].head) not in ("", tag)
        else:
            wrong = _stands_elsewhere(deck, tag)
        if wrong:
            raise deck.place(file, rows[k]).error(
                f"the continuation '+{tag}' does not follow its card; "
                "put the lines of the card in order"
            )


def _tag(text: bytes) -> str:
    word = text.strip()
    return word[1:].strip().decode("latin-1").upper() if word[:1] in (b"+", b"*") else ""


def _stands_elsewhere(deck: DeckText, tag: str) -> bool:
    pattern = re.compile(
        rb"(?:^|[\r\n])[+*]" + re.escape(tag.encode("latin-1")) + rb"[ \t,]", re.IGNORECASE
    )
    return any(pattern.search(f.data) for f in deck.files)
