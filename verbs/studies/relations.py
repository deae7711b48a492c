"""What a user knows of parameters beside one another: "skin / web = 2 ± 0.1"."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np

from ...core.arrays import Floats
from ...core.data.parameter import Parameter
from ...core.errors import InputError
from ...core.updating.residuals import Relation
from .values import meant

_FORM = re.compile(r"(?P<left>.+)=(?P<value>[^=±]+?)(?:±|\+-)(?P<sigma>[^=±]+)")
_EXAMPLE = "write it as in 'skin / web = 2 ± 0.1' or 'front + rear = 12.5 +- 0.2'"


def read_relation(text: str, parameters: Sequence[Parameter]) -> Relation:
    """Return a ratio of two parameters, or a sum of some, as the core takes it.

    Names are those of the parameters; values are in the deck's unit.

    Raises
    ------
    InputError
        Anything malformed; a name that no parameter has; a parameter that moves several values.
    """
    (top, *bottom), value, sigma = _parts(text)
    above = _sum(top, text, parameters)
    below = _sum(bottom[0], text, parameters) if bottom else np.zeros(len(parameters))
    return Relation(above, below, value, sigma)


def names_in(text: str) -> set[str]:
    """Return the names of the parameters that a relation speaks of; `InputError` if malformed."""
    return {name for side in _parts(text)[0] for _, name in _terms(side)}


def _parts(text: str) -> tuple[list[str], float, float]:
    """Return the sum, or both of a ratio, what it is, and the standard deviation of that."""
    match = _FORM.fullmatch(text.strip())
    if match is None:
        raise InputError(f"relation '{text}' cannot be understood: {_EXAMPLE}")
    try:
        value, sigma = float(match["value"]), float(match["sigma"])
    except ValueError:
        raise InputError(f"relation '{text}' cannot be understood: {_EXAMPLE}") from None
    if not (math.isfinite(value) and math.isfinite(sigma)):
        raise InputError(f"relation '{text}': what is known of it is no finite number")
    if not sigma > 0.0:
        raise InputError(f"relation '{text}': behind ± stands a standard deviation, above 0")
    sides = re.split(r"\s/\s", match["left"].strip())
    if len(sides) > 2:
        raise InputError(f"relation '{text}' is a ratio of more than two: {_EXAMPLE}")
    return sides, value, sigma


def _terms(side: str) -> list[tuple[float, str]]:
    """Return sign and name of each term of ``a + b - c``."""
    parts = re.split(r"\s([+-])\s", side.strip())
    signs = [1.0, *(1.0 if sign == "+" else -1.0 for sign in parts[1::2])]
    return [(sign, name.strip()) for sign, name in zip(signs, parts[::2], strict=True)]


def _sum(side: str, text: str, parameters: Sequence[Parameter]) -> Floats:
    """Return what each factor counts in ``a + b - c``."""
    names, out = [q.name for q in parameters], np.zeros(len(parameters))
    for sign, name in _terms(side):
        if name not in names:
            lacks = f"relation '{text}' names '{name}', which is no parameter"
            raise InputError(lacks + meant(name, names))
        q = parameters[names.index(name)]
        if len({*q.deck_values}) > 1:
            raise InputError(f"relation '{text}': {name} moves several values, so has none itself")
        out[names.index(name)] += sign * q.deck_values[0]
    return out
