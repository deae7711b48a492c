"""Cards read by their definitions: one from its fields, many column by column."""

from collections.abc import Sequence
from contextlib import suppress
from itertools import chain
from typing import Any

from .card_definition import Card, Values
from .field_values import (
    CONVERT,
    MISSING,
    MOST,
    Field,
    FieldError,
    Fields,
    Taken,
    numbers,
    value_of,
)

Column = Sequence[str]
"""Texts of one field of many cards; no column stands for blanks."""


def read_card(card: Card, fields: Fields) -> Values:
    """Return a card from the text of its fields.

    Raises
    ------
    FieldError
        A field that does not hold what it should.
    """
    size = len(card.fields) + 1
    texts = [*fields[1:size], *[None] * (size - len(fields))]
    pairs = enumerate(zip(card.fields, texts, strict=True), start=1)
    flat = [value_of(field, k, text) for k, (field, text) in pairs]
    if card.fields and card.fields[-1].kind == "*":
        flat[-1] = numbers(fields, size - 1)
    elif len(fields) > size and not card.open_end:
        raise FieldError(size, "", f"there are more fields than {card.name} has")
    flat = [flat[card.place(v)] if type(v) is Taken else v for v in flat]
    values = [
        flat[p[0]] if len(p) == 1 else tuple(flat[k] for k in p) for p in card.places.values()
    ]
    if card.repeated:
        values += _repeat(card.repeated, fields, size)
    if card.more is not None:
        values += card.more(fields, dict(zip(card.places, values, strict=True)))
    return card.type._make(values)


def read_columns(card: Card, columns: Sequence[Column], count: int) -> list[Values] | None:
    """Return `count` cards from their columns, the name's left out.

    None where they must be read one by one: cards that end in what no row of words tells, and
    those of which a field does not hold what it should.
    """
    beyond = columns[len(card.fields) :]
    more = card.repeated or card.more is not None or (card.fields and card.fields[-1].kind == "*")
    if more or (not card.open_end and any(map(str.strip, chain.from_iterable(beyond)))):
        return None
    try:
        there = [*columns, *[()] * len(card.fields)]
        flat = [_column(f, cells, count) for f, cells in zip(card.fields, there, strict=False)]
    except ValueError:
        return None
    for k, field in enumerate(card.fields):
        if type(field.default) is Taken:
            source = flat[card.place(field.default)]
            flat[k] = [s if type(v) is Taken else v for v, s in zip(flat[k], source, strict=True)]
    places = card.places.values()
    gathered = (
        flat[p[0]] if len(p) == 1 else zip(*(flat[k] for k in p), strict=True) for p in places
    )
    return list(map(card.type._make, zip(*gathered, strict=True)))


def _column(field: Field, cells: Column, count: int) -> list[Any]:
    """Values of one field of many cards; ValueError where one is wrong or must be given."""
    text = "".join(cells)
    needed = field.default is MISSING
    if not text.strip():
        if needed:
            raise ValueError(field.name)
        return [field.default] * count
    if "_" not in text:
        with suppress(ValueError):  # some are blank, or as Nastran alone writes them
            if field.kind == "i":
                return list(map(int, cells))
            if field.kind == "r" and all("." in cell for cell in cells):
                values = list(map(float, cells))
                if min(values) >= -MOST and max(values) <= MOST:
                    return values
    texts = [cell.strip() for cell in cells]
    if needed and not all(texts):
        raise ValueError(field.name)
    convert = CONVERT[field.kind]
    return [convert(t) if t else field.default for t in texts]


def _repeat(repeated: Sequence[Field], fields: Fields, start: int) -> list[tuple[Any, ...]]:
    """Values of the repetitions by attribute; blank ones are left out."""
    units = _units(repeated)
    columns: list[list[Any]] = [[] for _ in units[0]]
    padded = [*fields, *[None] * len(repeated)]
    for first in range(start, len(fields), len(repeated)):
        for unit in units:
            if all(padded[first + k] is None for k, _ in unit):
                continue
            for column, (k, field) in zip(columns, unit, strict=True):
                value = value_of(field, first + k, padded[first + k])
                if type(value) is Taken:
                    value = column[-1] if column else None
                column.append(value)
    return [tuple(column) for column in columns]


def _units(repeated: Sequence[Field]) -> list[list[tuple[int, Field]]]:
    """Fields of a repetition with their places, divided where the attributes start again."""
    units: list[list[tuple[int, Field]]] = []
    for k, field in enumerate(repeated):
        if field.kind:
            if not units or any(field.attribute == f.attribute for _, f in units[-1]):
                units.append([])
            units[-1].append((k, field))
    return units
