"""One property made two: some of its elements get a copy of it and of its material."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ....core.errors import InputError, Place
from ..cards import definitions, holders
from ..deck.movable_values import position_of
from ..properties.nonstructural import alike
from ..text.deck_text import DeckText
from .add_cards import add_lines
from .cells import CardLine
from .find_cards import Card, card_at, find_card, free_id, names_in
from .rewrite_fields import Value, format_card, rewrite_card
from .set_values import edit_cards


@dataclass(frozen=True, eq=False)
class Split:
    """A deck after a split.

    Parameters
    ----------
    deck : DeckText
        The new text.
    property : int
        Number of the copy.
    materials : mapping of int to int
        Number of each copied material by that of the original.
    """

    deck: DeckText
    property: int
    materials: Mapping[int, int]


def split_property(
    deck: DeckText,
    card: str,
    number: int,
    elements: Collection[int],
    comment: str,
    *,
    copy_materials: bool = True,
) -> Split:
    """Give some elements of a property a copy of it, equal until `set_values` changes it.

    The copies of property and material cards are added in one commented block beside the
    original; of the element cards only the property field changes.

    Parameters
    ----------
    deck : DeckText
        Not changed.
    card, number : str, int
        The property, e.g. ``"PSHELL", 3``.
    elements : collection of int
        Elements that get the copy; each must have this property now.
    comment : str
        Says what and why.
    copy_materials : bool
        Whether the copy gets its own materials too.

    Raises
    ------
    InputError
        A property that no element refers to by number, an element that is not there or has
        another property, non-structural mass given to the property by number.
    """
    card = card.upper()
    if not holders(card):
        every = {p for c in definitions().values() for p in c.properties.split()}
        raise InputError(f"{card} is not a property that can be split: {', '.join(sorted(every))}")
    if not elements:
        raise InputError(f"no elements are named that should get a copy of {card} {number}")
    original = find_card(deck, card, number)
    _require_no_nsm(deck, card, number)
    members = list(_members(deck, card, number, frozenset(elements)))
    new = free_id(deck, "property")
    materials = _material_fields(original) if copy_materials else {}
    first = free_id(deck, "material")
    numbers = {m: first + k for k, m in enumerate(dict.fromkeys(materials.values()))}
    lines = _copy(original, new, {k: numbers[m] for k, m in materials.items()})
    for name in definitions()[card].companions.split():
        lines += [c for o in _cards(deck, name, number) for c in _copy(o, new, {})]
    for name in [n for n in names_in(deck) if n.startswith("MAT")]:
        for m, copy in numbers.items():
            lines += [c for o in _cards(deck, name, m) for c in _copy(o, copy, {})]
    edited = edit_cards(deck, [(member, {1: new}) for member in members])
    return Split(add_lines(edited, lines, comment, (card, number)), new, numbers)


def _copy(card: Card, number: int, fields: Mapping[int, int]) -> list[bytes]:
    """Return a card's lines with another number, in the format they have."""
    known = definitions().get(card.name)
    if known and (stride := known.several):
        texts: list[Value] = [card.text(card.shift + k) or None for k in range(1, stride)]
        return format_card([card.name, number, *texts])
    edits: dict[int, Value] = {0: number, **fields}
    lines = tuple(CardLine(line.data.rstrip()) for line in card.lines)
    return [row for rows in rewrite_card(lines, edits) for row in rows]


def _cards(deck: DeckText, name: str, number: int) -> list[Card]:
    """Return the card of a name and number, or none."""
    found = any(deck.rows_of(segment, name, number) for segment in deck.segments)
    return [find_card(deck, name, number)] if found else []


def _material_fields(card: Card) -> dict[int, int]:
    """Return the materials a property refers to, by data field."""
    known = definitions()[card.name]
    fields = {at for name, at in known.others.items() if name.startswith("MID")}
    for k in [k for k, f in enumerate(known.repeated) if f.name.startswith("MID")]:
        fields.update(range(len(known.fields) + k, card.size, len(known.repeated)))
    texts = {card.shift + at: card.read(position_of(at)) for at in sorted(fields)}
    return {k: int(text) for k, text in texts.items() if text.isdigit() and int(text) > 0}


def _members(deck: DeckText, card: str, number: int, elements: frozenset[int]) -> Iterator[Card]:
    """Yield the cards of the elements, each checked to have the property."""
    wanted = np.array(sorted(elements), np.int64)
    missing = set(elements)
    for name in holders(card):
        for segment in deck.segments:
            for row, element in deck.rows_of(segment, name, wanted):
                member = card_at(deck, segment, row, name)
                _require_member(deck, member, card, number)
                if element not in missing:
                    twice = f"element {element} stands twice in the deck: it is not clear which "
                    raise deck.place(segment.file, row).error(twice + "one is meant")
                missing.discard(element)
                yield member
    if missing:
        raise Place(deck.files[0].path, shown=deck.files[0].path.name).fault(
            f"has no element {min(missing)} that could have a "
            f"{card}: such elements are {', '.join(holders(card))}"
        )


def _require_member(deck: DeckText, member: Card, card: str, number: int) -> None:
    element = member.text(0)
    place = deck.place(member.file, member.rows[0])
    default = definitions()[member.name].blanks_from
    if not member.text(1) and default in names_in(deck) and default:
        raise place.error(
            f"{member.name} {element} takes its property from {default}: write it out"
        )
    has = member.text(1) or element
    if has != str(number):
        raise place.error(f"{member.name} {element} has property {has}, not {card} {number}")


def _require_no_nsm(deck: DeckText, card: str, number: int) -> None:
    """Refuse a property whose non-structural mass is given by its number elsewhere."""
    for name in ("NSM", "NSM1", "NSML", "NSML1"):
        for segment in deck.segments:
            for row, _ in deck.rows_in(segment, name):
                nsm = card_at(deck, segment, row, name)
                if _covers(nsm, card, number):
                    raise deck.place(segment.file, row).error(
                        f"{name} gives mass to {card} {number} by "
                        "its number, which a copy would lose; put the mass on the property card"
                    )


def _covers(nsm: Card, card: str, number: int) -> bool:
    if card not in alike(nsm.text(1)):
        return False
    first = 3 if nsm.name.endswith("1") else 2
    words = [nsm.text(k) for k in range(first, nsm.size)]
    if nsm.name in ("NSM", "NSML"):
        return str(number) in words[::2]
    ids = [int(w) for w in words if w.isdigit()]
    return number in ids or ("THRU" in words and min(ids) <= number <= max(ids))
