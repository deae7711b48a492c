"""Parameters that a deck for SOL 200 names itself: its design variables."""

import re
from collections import defaultdict
from collections.abc import Iterator

import numpy as np

from ....core.errors import InputError
from ..deck.read_deck import Deck
from ..editing.find_cards import Card, card_at
from ..editing.set_values import read_value
from ..fields.parameter_references import DEFAULT_BOUNDS, FieldRef
from ..text.deck_text import DeckText
from ..text.real_numbers import parse_real
from .relations import RELATIONS, value_named

_HIGH = 1e6
"""Factors above which a bound is none."""
_SAME = 1e-6
"""Relative difference of a value on its card and by its design variables that is rounding."""


def design_parameters(deck: Deck) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the design variables of a deck as parameters, as a user would write them, and remarks.

    A variable is a parameter where the values that it moves are proportional to it: bounds are
    its own, over its initial value. What else relates values to design variables is remarked on:
    constants, several variables for one value, equations, values that differ on their cards.
    """
    text = deck.text
    variables = {c.text(0): c for c in _cards(text, "DESVAR")}
    moved: dict[str, list[FieldRef]] = defaultdict(list)
    remarks: list[str] = []
    for relation in RELATIONS:
        for card in _cards(text, relation):
            try:
                variable, ref = _related(text, card, variables)
                moved[variable].append(ref)
            except InputError as error:
                where = text.place(card.file, card.rows[0])
                remarks.append(f"{where}: {relation} {card.text(0)} is no parameter: {error}")
    told, names = [], set[str]()
    for number, refs in moved.items():
        card = variables[number]
        label = re.sub(r"\W", "", card.text(1)) or number
        name = f"{label} {number}" if label in names else label
        names.add(name)
        lower, upper = _bounds(card)
        told.append(f"{name} = {', '.join(map(str, refs))} [{lower:.9g}, {upper:.9g}]")
    return tuple(told), tuple(remarks)


def _cards(text: DeckText, name: str) -> Iterator[Card]:
    for segment in text.segments:
        for row, _ in text.rows_in(segment, name):
            yield card_at(text, segment, row, name)


def _related(text: DeckText, card: Card, variables: dict[str, Card]) -> tuple[str, FieldRef]:
    """Return the variable of a relation, and the value that is proportional to it."""
    if card.text(10):
        raise InputError("several design variables move its value")
    if _real(card.text(6), 0.0):
        raise InputError("its value is not proportional to the design variable (C0)")
    if card.text(8) not in variables:
        raise InputError(f"there is no DESVAR {card.text(8)}")
    number = card.text(2)
    if not number.isdigit():
        raise InputError(f"'{number}' is no number of a card")
    ref = value_named(card.text(1), int(number), card.text(3))
    value = read_value(text, ref)
    if value is None or value == 0.0:
        raise InputError(f"{ref} is blank or zero")
    start = _real(variables[card.text(8)].text(2), None)
    factor = value if card.text(9) == "PVAL" else _real(card.text(9), 1.0)
    if abs(factor * start - value) > _SAME * abs(value):
        raise InputError(f"{ref} is {value:g}, its design variable says {factor * start:g}")
    return card.text(8), ref


def _bounds(card: Card) -> tuple[float, float]:
    """Return factors that keep a variable within its bounds; those of any parameter without."""
    start = _real(card.text(2), None)
    ends = sorted(_real(card.text(k), np.inf) / start for k in (3, 4))
    lower, upper = DEFAULT_BOUNDS
    return ends[0] if 0.0 < ends[0] <= 1.0 else lower, ends[1] if ends[1] <= _HIGH else upper


def _real(text: str, default: float | None) -> float:
    if not text and default is not None:
        return default
    try:
        return parse_real(text)
    except ValueError:
        raise InputError(f"'{text}' is no real number") from None
