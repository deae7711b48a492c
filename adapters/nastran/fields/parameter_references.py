"""How a user names the values that may move: ``PBAR 11 I1, PBAR 11 I2 [0.2, 5]``."""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

from ....core.data.parameter import Parameter
from ....core.errors import InputError
from .layouts import canonical_field

DEFAULT_BOUNDS = (0.2, 5.0)

_FORM = re.compile(r"(?:(?P<name>[^=\[\]]*)=)?(?P<cards>[^=\[\]]*)(?:\[(?P<bounds>[^\[\]]*)\])?\s*")
_EXAMPLE = "write it like 'PSHELL 3 T' or 'front flange = PBAR 11 I1, PBAR 11 I2 [0.2, 5]'"


@dataclass(frozen=True, order=True)
class FieldRef:
    """One value of the deck: the card's name, its number, the field's name in the guide.

    Raises
    ------
    InputError
        The card holds no such value; near spellings are offered.
    """

    card: str
    id: int
    field: str

    def __post_init__(self) -> None:
        card = self.card.upper()
        object.__setattr__(self, "card", card)
        object.__setattr__(self, "field", canonical_field(card, self.field))

    def __str__(self) -> str:
        return f"{self.card} {self.id} {self.field}"


@dataclass(frozen=True)
class ParameterSpec:
    """A parameter as the user asked for it: values moved by one factor, and its bounds.

    Parameters
    ----------
    name : str
        What the user calls it.
    fields : tuple of FieldRef
        At least one.
    lower, upper : float
        Bounds of the factor, 0 < lower <= 1 <= upper.
    weight : float
        Relative weight in the regularisation.

    Raises
    ------
    InputError
        Bounds that are not finite, not positive, or do not hold the deck itself (factor 1).
    """

    name: str
    fields: tuple[FieldRef, ...]
    lower: float = DEFAULT_BOUNDS[0]
    upper: float = DEFAULT_BOUNDS[1]
    weight: float = 1.0

    def __post_init__(self) -> None:
        if not self.fields:
            raise InputError(f"parameter {self.name!r} names no card: {_EXAMPLE}")
        repeated = {str(f) for f in self.fields if self.fields.count(f) > 1}
        if repeated:
            raise InputError(f"parameter {self.name!r} names {min(repeated)} twice")
        if not (math.isfinite(self.lower) and math.isfinite(self.upper)):
            raise InputError(f"parameter {self.name!r}: the bounds must be finite numbers")
        if not 0.0 < self.lower <= 1.0 <= self.upper or self.lower == self.upper:
            raise InputError(
                f"parameter {self.name!r}: the bounds [{self.lower:g}, {self.upper:g}] are factors "
                "on the deck's value and must be positive, with 1 (the deck) between them"
            )
        if not (math.isfinite(self.weight) and self.weight > 0.0):
            raise InputError(f"parameter {self.name!r}: the weight must be a positive number")


def moved(
    specs: Iterable[ParameterSpec], parameters: Iterable[Parameter], factors: Iterable[float]
) -> dict[FieldRef, float]:
    """Return the values of the fields of parameters whose factor is not 1."""
    return {
        ref: value * float(factor)
        for spec, parameter, factor in zip(specs, parameters, factors, strict=True)
        for ref, value in zip(spec.fields, parameter.deck_values, strict=True)
        if abs(factor - 1.0) > 1e-12
    }


def parse_field(text: str) -> FieldRef:
    """Return the value named by a card name, a number and a field name: ``PBAR 11 I1``.

    Raises
    ------
    InputError
        Anything else, with what is wrong.
    """
    words = text.split()
    if len(words) != 3:
        missing = ", ".join(("a card", "a number", "a field")[len(words) :])
        wrong = f"lacks {missing}" if missing else "has too many words"
        raise InputError(f"parameter {text.strip()!r} {wrong}: {_EXAMPLE}")
    card, number, name = words
    if not re.fullmatch(r"[1-9]\d*", number, re.ASCII):
        raise InputError(
            f"parameter {text.strip()!r}: {number!r} is not the number of a card: {_EXAMPLE}"
        )
    try:
        return FieldRef(card, int(number), name)
    except InputError as error:
        raise InputError(f"parameter {text.strip()!r}: {error}") from None


def parse_parameter(text: str) -> ParameterSpec:
    """Return the parameter written as ``[name =] CARD ID FIELD[, ...] [[lower, upper]]``.

    Parameters
    ----------
    text : str
        Cards joined by commas are moved by one factor; the name defaults to the cards, the bounds
        (factors on the deck's values) to 0.2 and 5.

    Raises
    ------
    InputError
        Anything malformed: what is wrong, and near spellings of cards and fields.
    """
    match = _FORM.fullmatch(text)
    if not match or not match["cards"].strip():
        raise InputError(f"parameter {text.strip()!r} cannot be understood: {_EXAMPLE}")
    parts = match["cards"].split(",")
    if not all(part.strip() for part in parts):
        raise InputError(f"parameter {text.strip()!r} has a comma with no card: {_EXAMPLE}")
    fields = tuple(parse_field(part) for part in parts)
    name = (match["name"] or "").strip()
    if match["name"] is not None and not name:
        raise InputError(f"parameter {text.strip()!r} has an equals sign but no name: {_EXAMPLE}")
    lower, upper = _parse_bounds(match["bounds"], text)
    return ParameterSpec(name or ", ".join(str(f) for f in fields), fields, lower, upper)


def _parse_bounds(text: str | None, whole: str) -> tuple[float, float]:
    if text is None:
        return DEFAULT_BOUNDS
    try:
        lower, upper = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(
            f"parameter {whole.strip()!r}: [{text}] is not two numbers; "
            "write the bounds as factors, such as [0.2, 5]"
        ) from None
    return lower, upper
