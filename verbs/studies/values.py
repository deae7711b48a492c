"""What is given for a key, by a file or in code, as of the kind that the key has."""

from __future__ import annotations

import datetime
import numbers
import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path
from types import NoneType
from typing import Any, cast, get_args, get_origin, get_type_hints

from ...core.errors import InputError, Place
from .study_tables import ConfigurationRequest, LoadRequest, StageRequest
from .taking_part import READERS

Hertz = tuple[float, float]
"""A band of frequencies; written as "15:60", too."""
TABLES: dict[str, type] = {
    "stages": StageRequest,
    "load_cases": LoadRequest,
    "configurations": ConfigurationRequest,
}
"""Keys that hold tables, and what each is."""


def checked(table: Mapping[str, object], fields: Mapping[str, Any], who: Place) -> dict[str, Any]:
    """Return values as of the kinds of their keys; `InputError` for a key that is not known."""
    values: dict[str, Any] = {}
    for name, value in table.items():
        if name not in fields:
            raise who.error(unknown(name, fields))
        values[name] = converted(name, value, fields[name], who)
    return values


def unknown(name: str, known: Iterable[str]) -> str:
    """Say that a key is not known, and which may have been meant."""
    return f"unknown key '{name}'{meant(name, list(known))}"


def meant(name: str, known: Sequence[str]) -> str:
    """Return the end of a sentence: which name may have been meant, or all that are known."""
    near = get_close_matches(name, known, n=1)
    return f"; did you mean '{near[0]}'?" if near else f"; known: {', '.join(known)}"


def converted(name: str, value: object, kind: Any, who: Place) -> Any:
    """Return a value as of the kind that is wanted; `InputError` where it cannot be."""
    wrong = who.error(f"'{name}' has a value of the wrong type: {value!r}")
    if name in READERS:
        return READERS[name](name, value, who)
    of = get_args(kind)
    if value is None and NoneType in of:
        return None
    if name in TABLES:
        if not isinstance(value, list | tuple):
            raise wrong
        return tuple(_table(TABLES[name], v, who, wrong) for v in value)
    if kind == Hertz:
        ends = value.split(":") if isinstance(value, str) else value
        try:
            low, high = map(float, cast(Iterable[float | str], ends))
        except (TypeError, ValueError):
            raise who.error(f"'{name}' holds {value!r}, which is no band as 15:60 is") from None
        return tuple(converted(name, end, float, who) for end in (low, high))
    if get_origin(kind) is tuple:
        items = value if isinstance(value, list | tuple) else [value]
        return tuple(converted(name, v, of[0], who) for v in items)
    makes = [k for k in of or (kind,) if isinstance(value, _MADE_FROM.get(k, ()))]
    if isinstance(value, bool) != (kind is bool) or not makes:
        raise wrong
    make = makes[0]
    if make is float and not abs(cast(float, value)) <= sys.float_info.max:
        raise who.error(f"'{name}' must be a finite number")
    return make(value)


_MADE_FROM: dict[Any, tuple[type, ...]] = {
    Path: (str, os.PathLike),
    str: (str, datetime.date),
    int: (numbers.Integral,),
    float: (numbers.Real,),
    bool: (bool,),
}
"""What a value of each type may be made from."""


def _table(kind: type, value: object, who: Place, wrong: InputError) -> object:
    if isinstance(value, kind):
        return value
    if not isinstance(value, Mapping):
        raise wrong
    return kind(**checked(value, get_type_hints(kind), who))
