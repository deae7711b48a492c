"""What a field of a card holds: its word in a layout, its kind, the value of a text."""

import re
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import Any, NamedTuple

from ....core.errors import InputError
from ..text.real_numbers import parse_real

Fields = list[str | None]
"""Text of a card's fields, the name first; None where blank."""


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


def value_of(field: Field, at: int, text: str | None) -> Any:
    """Return the value of a text, that of a blank one; raises `FieldError`."""
    if text is None:
        if field.default is MISSING:
            raise FieldError(at, field.name, "must be given")
        return field.default
    try:
        return CONVERT[field.kind](text)
    except ValueError:
        what = f"holds {text!r}, {WRONG[field.kind]}"
        if len(text.split()) > 1:
            what = (
                f"holds {text!r}, several values run together: in free fields commas "
                "part them all, in fixed fields each has its columns"
            )
        raise FieldError(at, field.name, what) from None


def take(fields: Fields, at: int, word: str) -> Any:
    """Return the value at a position, as a word of a layout says it: ``take(fields, 3, "K1:r")``.

    Raises
    ------
    FieldError
        It does not hold what it should.
    """
    return value_of(field_of(word), at, fields[at] if at < len(fields) else None)


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
        first = value_of(_NUMBER, k, text)
        if len(words) < 2 or words[0][1] != "THRU":
            out.append(first)
            continue
        last, step = value_of(_NUMBER, *words[1]), 1
        words = words[2:]
        if len(words) > 1 and words[0][1] == "BY":
            step = value_of(_NUMBER, *words[1])
            words = words[2:]
        out.append(range(first, last + 1, max(step, 1)))
    return tuple(out)


def parse(layout: str) -> Iterator[Field]:
    """Yield the fields of a layout, without those that are repeated."""
    count = 0
    for word in layout.removesuffix("...").split():
        if word == "/":
            yield from [BLANK] * (-count % 8)
            count += -count % 8
            continue
        names = word.partition(":")[0].partition(">")[0].split(",")
        field = field_of(word)
        yield from (field._replace(name=n) if n != "-" else BLANK for n in names)
        count += len(names)


@cache
def field_of(word: str) -> Field:
    """Return the field that a word of a layout says."""
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
    value = parse_real(text)
    if text.isdigit() or abs(value) > MOST:
        raise ValueError(text)
    return value


def integer_or_real(text: str) -> int | float:
    """Return what the text is."""
    return int(text) if text.lstrip("+-").isdigit() else real(text)


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


MOST = 1e38
"""Reals beyond it are no numbers of Nastran's (single precision), and their powers none at all."""

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
    "r": "which is not a real number (with a decimal point, below 1.E38)",
    "w": "which is not a word",
    "c": "which are not components (digits from 1 to 6, each once)",
    "ir": "which is not a number",
    "iw": "which is neither an integer nor a word",
}
"""By kind: what is said of a text that is not of it."""

BLANK = Field("-", "-", "", None)
"""A field without a meaning."""
_NUMBER = Field("ID", "id", "i", MISSING)
