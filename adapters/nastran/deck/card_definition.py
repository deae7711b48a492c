"""What a bulk data card holds, declared as the Quick Reference Guide prints it.

A layout is a row of words, one a field from the second on; ``/`` starts the next line:

==================  ==============================================================================
``MID:i``           name in the guide and kind of value; None where the deck leaves it blank
``MID:i!``          must be given
``T:r=0.``          value where it is blank; ``=EID`` takes that of another field
``TS/T>shear:r``    the attribute is `shear`; without ``>`` it is the name in small letters
``X1,X2,X3>x:r``    several fields of one attribute, which is a tuple; they may stand apart too
``-``               a field without a meaning
``G>nodes:*``       numbers to the end of the card: ``a THRU b BY c`` becomes a `range`
``[G:i C:c]``       repeated to the end of the card: tuples, blank repetitions left out; ``=^``
                    takes the value of the repetition before
``...``             what follows is not read
==================  ==============================================================================

Kinds: ``i`` integer, ``r`` real, ``w`` word, ``c`` components (digits in order, as text), ``ir``
integer or real, ``iw`` integer or word, ``x`` the text in capitals.
"""

from __future__ import annotations

import re
from collections import namedtuple
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from operator import itemgetter
from typing import Any, NamedTuple

from ....core.elements import ELEMENTS, Element
from ....core.errors import InputError
from ..text.real_numbers import parse_real
from .movable_values import Moves

Fields = list[str | None]
"""Text of a card's fields, the name first; None where blank."""

Values = Any
"""A card as read: a named tuple with the attributes of its definition."""

Known = Mapping[str, Any]
"""Values read so far, by attribute."""


class Field(NamedTuple):
    """One field of a layout.

    Parameters
    ----------
    name : str
        As the guide prints it.
    attribute : str
        Of the card as read.
    kind : str
        See the module.
    default : object
        Value where blank; a `Taken` names the field it is copied from, `MISSING` is an error.
    """

    name: str
    attribute: str
    kind: str
    default: Any


class Taken(str):
    """Name of the field whose value a blank one takes; ``^``: that of the repetition before."""


MISSING = object()


class FieldError(ValueError):
    """A field that does not hold what it should: position, name in the guide, what is wrong."""

    def __init__(self, index: int, name: str, what: str) -> None:
        super().__init__(what)
        self.index, self.name, self.what = index, name, what


@dataclass(frozen=True, eq=False)
class Card:
    """The definition of one kind of card.

    Parameters
    ----------
    name : str
        In capitals.
    layout : str
        See the module.
    number : str
        Attribute that holds its number; "" where it has none of its own (it is kept in a list).
    several : int
        Fields apart of several on one card; 0 where there is one.
    unique : bool
        Whether no two cards may have the same number.
    space : str
        What its number counts together with other kinds of cards ("shell property", ...).
    blanks_from : str
        Card whose fields stand for blank ones (GRDSET, BAROR, BEAMOR).
    more : callable, optional
        Reads what no row of words can tell: gets the fields and the values read so far by
        attribute, and returns values of the attributes in `extra`, in their order.
    extra : str
        Attributes that `more` gives.
    grids : str
        Attributes that hold numbers of grids or scalar points.
    ignored, refused : str
        Why a card is left out, or stops the assembly; "" where it is read.
    warned : bool
        Whether leaving it out is said in a warning.
    elements : str
        Elements of the core that it stands for: without and with middle nodes.
    properties : str
        Cards that its PID may refer to, in the order they are looked for.
    companions : str
        Cards of the same number that say more of it.
    moves : Moves or None
        Its reals may be parameters, and what else is known of them.
    """

    name: str
    layout: str = ""
    number: str = ""
    several: int = 0
    unique: bool = True
    space: str = ""
    blanks_from: str = ""
    more: Callable[[Fields, Known], Sequence[Any]] | None = None
    extra: str = ""
    grids: str = "nodes scalars"
    ignored: str = ""
    refused: str = ""
    warned: bool = False
    elements: str = ""
    properties: str = ""
    companions: str = ""
    moves: Moves | None = None

    @cached_property
    def fields(self) -> tuple[Field, ...]:
        """Fields from the second on; those that are repeated follow in `repeated`."""
        return tuple(_parse(self.layout.partition("[")[0]))

    @cached_property
    def repeated(self) -> tuple[Field, ...]:
        """Fields of one repetition."""
        return tuple(_parse(self.layout.partition("[")[2].partition("]")[0]))

    @cached_property
    def reals(self) -> dict[str, int]:
        """Its real values by name, each with its data field: 0 is the first after the name."""
        return {f.name: k for k, f in enumerate(self.fields) if f.kind == "r"}

    @cached_property
    def repeated_reals(self) -> dict[str, int]:
        """Likewise in a repetition."""
        return {f.name: k for k, f in enumerate(self.repeated) if f.kind == "r"}

    @cached_property
    def others(self) -> dict[str, int]:
        """Its numbers and options by name, each with its data field."""
        return {f.name: k for k, f in enumerate(self.fields) if f.kind not in ("", "r")}

    @property
    def element(self) -> Element | None:
        """Element of the core that it stands for, that without middle nodes."""
        return ELEMENTS[self.elements.split()[0]] if self.elements else None

    @cached_property
    def grid_fields(self) -> tuple[int, ...]:
        """Data fields that hold grids."""
        held = self.grids.split()
        return tuple(k for k, f in enumerate(self.fields) if f.attribute in held)

    @cached_property
    def type(self) -> type[Any]:
        """Class of the cards as read."""
        fields = (f for f in (*self.fields, *self.repeated) if f.kind)
        names = (*dict.fromkeys(f.attribute for f in fields), *self.extra.split())
        return namedtuple(self.name, names)

    @cached_property
    def read(self) -> Callable[[Fields], Values]:
        """Routine from a card's fields to the card as read; raises `FieldError`."""
        return _compile(self)

    def grids_of(self, card: Values) -> list[int]:
        """Grids and scalar points that a card refers to."""
        held = [getattr(card, name) for name in self.grids.split() if hasattr(card, name)]
        found: list[int] = []
        while held:
            part = held.pop(0)
            if isinstance(part, tuple):
                held = [*part, *held]
            elif part:
                found.append(part)
        return found


def _compile(card: Card) -> Callable[[Fields], Values]:
    """Make the routine that reads a card."""
    places: dict[str, list[int]] = {}
    for k, f in enumerate(card.fields):
        if f.kind:
            places.setdefault(f.attribute, []).append(k)
    gather = [itemgetter(*p) for p in places.values()]
    flat, make, size, more = _flat(card), card.type._make, len(card.fields) + 1, card.more
    units, stride = _units(card.repeated), len(card.repeated)

    def read(fields: Fields) -> Values:
        found = flat(fields)
        values = [g(found) for g in gather]
        if stride:
            values += _repeat(units, stride, fields, size)
        if more is not None:
            values += more(fields, dict(zip(places, values, strict=True)))
        return make(values)

    return read


def _flat(card: Card) -> Callable[[Fields], list[Any]]:
    """Make the routine that reads the fields that stand once, blank ones filled."""
    fixed = card.fields
    size = len(fixed) + 1
    converts = [CONVERT[f.kind] for f in fixed]
    defaults = [f.default for f in fixed]
    listed = bool(fixed) and fixed[-1].kind == "*"
    taken = [(k, _place(fixed, f.default)) for k, f in enumerate(fixed) if type(f.default) is Taken]
    needed = MISSING in defaults
    open_end = bool(card.repeated) or card.more is not None or card.layout.endswith("...") or listed

    def read(fields: Fields) -> list[Any]:
        try:
            flat = [
                default if text is None else convert(text)
                for convert, default, text in zip(converts, defaults, fields[1:size], strict=False)
            ]
        except ValueError:
            raise _wrong(fixed, fields) from None
        flat += defaults[len(fields) - 1 :]
        if listed:
            flat[-1] = numbers(fields, size - 1)
        elif len(fields) > size and not open_end:
            raise FieldError(size, "", f"there are more fields than {card.name} has")
        if needed and MISSING in flat:
            k = flat.index(MISSING)
            raise FieldError(k + 1, fixed[k].name, "must be given")
        for k, source in taken:
            if type(flat[k]) is Taken:
                flat[k] = flat[source]
        return flat

    return read


def _wrong(fixed: Sequence[Field], fields: Fields) -> FieldError:
    for k, (field, text) in enumerate(zip(fixed, fields[1:], strict=False), start=1):
        if text is not None:
            try:
                CONVERT[field.kind](text)
            except ValueError:
                return FieldError(k, field.name, f"holds {text!r}, {WRONG[field.kind]}")
    return FieldError(0, "", "the card cannot be read")


def _place(fields: Sequence[Field], name: str) -> int:
    return next(k for k, f in enumerate(fields) if f.name == name)


def _units(repeated: Sequence[Field]) -> list[list[tuple[int, Field]]]:
    """Fields of a repetition with their places, divided where the attributes start again."""
    units: list[list[tuple[int, Field]]] = []
    for k, field in enumerate(repeated):
        if field.kind:
            if not units or any(field.attribute == f.attribute for _, f in units[-1]):
                units.append([])
            units[-1].append((k, field))
    return units


def _repeat(
    units: list[list[tuple[int, Field]]], stride: int, fields: Fields, start: int
) -> list[tuple[Any, ...]]:
    columns: list[list[Any]] = [[] for _ in units[0]]
    padded = [*fields, *[None] * stride]
    for first in range(start, len(fields), stride):
        for unit in units:
            if all(padded[first + k] is None for k, _ in unit):
                continue
            for column, (k, field) in zip(columns, unit, strict=True):
                value = _one(field, first + k, padded[first + k])
                if type(value) is Taken:
                    value = column[-1] if column else None
                column.append(value)
    return [tuple(column) for column in columns]


def _one(field: Field, at: int, text: str | None) -> Any:
    if text is None:
        if field.default is MISSING:
            raise FieldError(at, field.name, "must be given")
        return field.default
    try:
        return CONVERT[field.kind](text)
    except ValueError:
        raise FieldError(at, field.name, f"holds {text!r}, {WRONG[field.kind]}") from None


def take(fields: Fields, at: int, word: str) -> Any:
    """Return the value at a position, as a word of a layout says it: ``take(fields, 3, "K1:r")``.

    Raises
    ------
    FieldError
        It does not hold what it should.
    """
    return _one(_field(word), at, fields[at] if at < len(fields) else None)


def numbers(fields: Fields, start: int) -> tuple[int | range, ...]:
    """Return the numbers of a list: ``a THRU b`` and ``a THRU b BY c`` as a `range`.

    Raises
    ------
    FieldError
        A field that is neither a number nor in its place.
    """
    words = [(k, text.upper()) for k, text in enumerate(fields[start:], start) if text is not None]
    out: list[int | range] = []
    while words:
        k, text = words.pop(0)
        first = _one(_NUMBER, k, text)
        if len(words) < 2 or words[0][1] != "THRU":
            out.append(first)
            continue
        last, step = _one(_NUMBER, *words[1]), 1
        words = words[2:]
        if len(words) > 1 and words[0][1] == "BY":
            step = _one(_NUMBER, *words[1])
            words = words[2:]
        out.append(range(first, last + 1, max(step, 1)))
    return tuple(out)


def _parse(layout: str) -> Iterator[Field]:
    count = 0
    for word in layout.removesuffix("...").split():
        if word == "/":
            yield from [_BLANK] * (-count % 8)
            count += -count % 8
            continue
        names = word.partition(":")[0].partition(">")[0].split(",")
        field = _field(word)
        yield from (field._replace(name=n) if n != "-" else _BLANK for n in names)
        count += len(names)


@cache
def _field(word: str) -> Field:
    head, _, tail = word.partition(":")
    name, _, attribute = head.partition(">")
    kind, has_default, default = tail.partition("=")
    value: Any = MISSING if kind.endswith("!") else None
    kind = kind.rstrip("!")
    if kind not in CONVERT:
        raise InputError(f"{word!r}: no kind of value is {kind!r}; known: {' '.join(CONVERT)}")
    if has_default:
        try:
            value = CONVERT[kind](default)
        except ValueError:
            value = Taken(default)
    return Field(name, attribute or name.lower(), kind, value)


def integer(text: str) -> int:
    """Return an integer (ValueError when it is none)."""
    if "_" in text:
        raise ValueError(text)
    return int(text)


def real(text: str) -> float:
    """Return a real: ``1.``, ``1.+3``, ``1D0``; digits alone are an integer (ValueError)."""
    if text.isdigit():
        raise ValueError(text)
    return parse_real(text)


def integer_or_real(text: str) -> int | float:
    """Return what the text is."""
    return int(text) if text.lstrip("+-").isdigit() else parse_real(text)


def word(text: str) -> str:
    """Return a word in capitals; numbers are none (ValueError)."""
    if text[0] in "+-.0123456789" or " " in text:
        raise ValueError(text)
    return text.upper()


def integer_or_word(text: str) -> int | str:
    """Return what the text is."""
    return int(text) if text.lstrip("+-").isdigit() else word(text)


_COMPONENTS = re.compile(r"0+|[1-6]{1,6}")


def components(text: str) -> str:
    """Return components in order: ``213`` is ``123``."""
    if not _COMPONENTS.fullmatch(text) or len(set(text.lstrip("0"))) < len(text.lstrip("0")):
        raise ValueError(text)
    return "".join(sorted(text.lstrip("0"))) or "0"


def _nothing(_: str) -> None:
    return None


CONVERT: Mapping[str, Callable[[str], Any]] = {
    "i": integer,
    "r": real,
    "w": word,
    "c": components,
    "ir": integer_or_real,
    "iw": integer_or_word,
    "x": str.upper,
    "": _nothing,
    "*": _nothing,
}
"""By kind: the value of a text."""

WRONG = {
    "i": "which is not an integer",
    "r": "which is not a finite real number (with a decimal point)",
    "w": "which is not a word",
    "c": "which are not components (digits from 1 to 6, each once)",
    "ir": "which is not a number",
    "iw": "which is neither an integer nor a word",
}
"""By kind: what is said of a text that is not of it."""

_BLANK = Field("-", "-", "", None)
_NUMBER = Field("ID", "id", "i", MISSING)
