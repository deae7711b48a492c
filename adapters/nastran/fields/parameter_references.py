"""Values that may move, and how a user names them: ``PBAR 11 I1, PBAR 11 I2 [0.2, 5]``."""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

from ....core.data.parameter import Parameter
from ....core.errors import InputError
from ..text.real_numbers import SMALL, format_real, justified, parse_real
from .layouts import canonical_field

DEFAULT_BOUNDS = (0.2, 5.0)
PARAM = "PARAM"
_FEWEST = 0.05
"""Of a value: the largest error that figures are left out by, so that three stay."""

_FORM = re.compile(r"(?:(?P<name>[^=\[\]]*)=)?(?P<cards>[^=\[\]]*)(?:\[(?P<bounds>[^\[\]]*)\])?\s*")
_EXAMPLE = "write it like 'PSHELL 3 T' or 'front flange = PBAR 11 I1, PBAR 11 I2 [0.2, 5]'"
_REGION = re.compile(r"(?P<cards>[^@]*)@(?P<kind>\w+)(?P<numbers>[^@]*)")
_RANGE = re.compile(r"(?P<first>[1-9]\d*)(?::(?P<last>[1-9]\d*))?", re.ASCII)


@dataclass(frozen=True, order=True)
class FieldRef:
    """One value of the deck: the card's name, its number, the field's name in the guide.

    Of a PARAM the number is 0 and the field its name.

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
        return f"{self.title} {self.field}" if self.id else self.title

    @property
    def title(self) -> str:
        """Name and number of the card."""
        return f"{self.card} {self.id or self.field}"


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


def moved_as_known(
    specs: Iterable[ParameterSpec],
    parameters: Iterable[Parameter],
    factors: Iterable[float],
    errors: Iterable[float],
) -> dict[FieldRef, float]:
    """Return what `moved` does with the figures that eight columns hold and errors justify.

    `errors` are the standard errors of the factors, NaN where unknown; three figures stay whatever
    they are. Where a parameter moves several values it is the factor that is rounded, so that they
    stay together.
    """
    out: dict[FieldRef, float] = {}
    for spec, q, factor, error in zip(specs, parameters, factors, errors, strict=True):
        alone = len(spec.fields) == 1
        error = min(float(error), _FEWEST * abs(factor)) if error == error else math.nan
        if not alone:
            factor = justified(float(factor), error)
        for ref, value in moved([spec], [q], [factor]).items():
            kept = justified(value, error * abs(q.deck_values[0])) if alone else value
            out[ref] = parse_real(format_real(kept, SMALL))
    return out


@dataclass(frozen=True)
class Region:
    """Some elements: those within ranges of numbers, or with their middle in a box.

    Parameters
    ----------
    elements : tuple of (int, int)
        First and last number of each range.
    box : tuple of float or None
        Two opposite corners, x0, y0, z0, x1, y1, z1, basic frame.
    """

    elements: tuple[tuple[int, int], ...] = ()
    box: tuple[float, ...] | None = None


@dataclass(frozen=True)
class NamedValues:
    """A value of one card, or of many: ``PBAR 11 I1``, ``PBAR 11:13 I1``, ``PSHELL * T``.

    Parameters
    ----------
    text : str
        As the user wrote it.
    card, field : str
    numbers : tuple of (int, int) or None
        First and last number, None of all cards.
    region : Region or None
        Elements for which alone the value moves.
    """

    text: str
    card: str
    field: str
    numbers: tuple[int, int] | None
    region: Region | None = None

    @property
    def single(self) -> FieldRef | None:
        """The value where it is one, without looking at a deck."""
        if self.region or self.numbers is None or self.numbers[0] != self.numbers[1]:
            return None
        try:
            return FieldRef(self.card, self.numbers[0], self.field)
        except InputError as error:
            raise InputError(f"parameter {self.text!r}: {error}") from None


@dataclass(frozen=True)
class ParameterRequest:
    """A parameter as the user wrote it: what it moves, and bounds of the factor or of the values.

    `in_units` says whether `lower` and `upper` are in the card's own unit.
    """

    text: str
    name: str
    values: tuple[NamedValues, ...]
    lower: float = DEFAULT_BOUNDS[0]
    upper: float = DEFAULT_BOUNDS[1]
    in_units: bool = False


def parse_request(text: str) -> ParameterRequest:
    """Return the parameter written as ``[name =] CARD NUMBERS FIELD[, ...] [[lower, upper]]``.

    Parameters
    ----------
    text : str
        Values joined by commas are moved by one factor. NUMBERS are a card's number, a range
        ``11:13``, or ``*`` for all; behind FIELD may stand ``@elements 101:160,201`` or ``@box
        x0,y0,z0,x1,y1,z1``: the value moves for these elements alone. The name defaults to the
        cards, the bounds to factors of 0.2 and 5 on the deck's values; ``[=0.8, =2.4]`` are
        bounds in the card's unit.

    Raises
    ------
    InputError
        Anything malformed: what is wrong, and near spellings of cards and fields.
    """
    whole = text.strip()
    match = _FORM.fullmatch(text)
    if not match or not match["cards"].strip():
        raise InputError(f"parameter {whole!r} cannot be understood: {_EXAMPLE}")
    parts = re.split(r",(?!\s*[-+.\d])", match["cards"])
    if not all(part.strip() for part in parts):
        raise InputError(f"parameter {whole!r} has a comma with no card: {_EXAMPLE}")
    values = tuple(_parse_values(part.strip()) for part in parts)
    name = (match["name"] or "").strip()
    if match["name"] is not None and not name:
        raise InputError(f"parameter {whole!r} has an equals sign but no name: {_EXAMPLE}")
    lower, upper, in_units = _parse_bounds(match["bounds"], whole)
    known = [str(v.single or v.text) for v in values]
    return ParameterRequest(whole, name or ", ".join(known), values, lower, upper, in_units)


def parse_parameter(text: str) -> ParameterSpec:
    """Return the parameter written as ``[name =] CARD ID FIELD[, ...] [[lower, upper]]``.

    Raises
    ------
    InputError
        Anything malformed (see `parse_request`), and what only a deck can tell: many cards,
        elements, bounds in units.
    """
    request = parse_request(text)
    fields = [v.single for v in request.values]
    if request.in_units or None in fields:
        raise InputError(f"parameter {request.text!r} hangs on what is in the deck: name each card")
    refs = tuple(f for f in fields if f is not None)
    return ParameterSpec(request.name, refs, request.lower, request.upper)


def _parse_values(text: str) -> NamedValues:
    """Return what ``PBAR 11:13 I1 @elements 5,7`` names."""
    match = _REGION.fullmatch(text)
    region = _parse_region(match["kind"], match["numbers"], text) if match else None
    words = (match["cards"] if match else text).split()
    if len(words) == 2 and words[0].upper() == PARAM and not region:
        return NamedValues(text, PARAM, words[1], (0, 0))
    if len(words) != 3:
        missing = ", ".join(("a card", "a number", "a field")[len(words) :])
        wrong = f"lacks {missing}" if missing else "has too many words"
        raise InputError(f"parameter {text!r} {wrong}: {_EXAMPLE}")
    card, number, field = words
    numbers = None if number == "*" else _parse_range(number, text, "the number of a card")
    return NamedValues(text, card.upper(), field, numbers, region)


def _parse_region(kind: str, numbers: str, text: str) -> Region:
    parts = [part.strip() for part in numbers.split(",")]
    if kind == "elements":
        return Region(tuple(_parse_range(p, text, "a number of elements") for p in parts))
    if kind != "box":
        raise InputError(f"parameter {text!r}: '@{kind}' is not known; write @elements or @box")
    try:
        corners = tuple(float(part) for part in parts)
    except ValueError:
        corners = ()
    if len(corners) != 6 or not all(map(math.isfinite, corners)):
        raise InputError(
            f"parameter {text!r}: a box is six numbers, two corners: @box x0,y0,z0,x1,y1,z1"
        )
    return Region(box=corners)


def _parse_range(number: str, text: str, what: str) -> tuple[int, int]:
    match = _RANGE.fullmatch(number)
    if not match:
        raise InputError(f"parameter {text!r}: {number!r} is not {what}: {_EXAMPLE}")
    first, last = int(match["first"]), int(match["last"] or match["first"])
    if last < first:
        raise InputError(f"parameter {text!r}: the range {number} ends before it begins")
    return first, last


def _parse_bounds(text: str | None, whole: str) -> tuple[float, float, bool]:
    """Return lower and upper bound, and whether they are in the card's unit."""
    if text is None:
        return (*DEFAULT_BOUNDS, False)
    parts = [part.strip() for part in text.split(",")]
    in_units = [part.startswith("=") for part in parts]
    try:
        lower, upper = (float(part.removeprefix("=")) for part in parts)
        if in_units[0] != in_units[1]:
            raise ValueError
    except ValueError:
        raise InputError(
            f"parameter {whole!r}: [{text}] is not two numbers; write the bounds as factors, such "
            "as [0.2, 5], or in the card's unit, such as [=0.8, =2.4]"
        ) from None
    return lower, upper, in_units[0]
