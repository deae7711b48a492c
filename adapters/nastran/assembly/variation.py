"""Parameters of a deck: which fields they move, and the cards at other values of them.

A card at other parameter values is its own text with the numbers multiplied, read again: what the
deck leaves blank and Nastran derives follows, just as it would in the rewritten deck.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ....core.arrays import Floats
from ....core.data.parameter import Parameter
from ....core.errors import InputError, Place
from ..deck.bulk import Bulk
from ..deck.field_values import Fields
from ..deck.movable_values import index_of
from ..deck.raw_cards import Raw, fields_of
from ..deck.read_deck import Deck
from ..fields.layouts import field_position
from ..fields.parameter_references import FieldRef, ParameterSpec
from ..properties.thermal import Thermal, read_thermal
from ..text.real_numbers import parse_real

Key = tuple[str, int]
GRID = "GRID"


@dataclass(frozen=True)
class _Move:
    """One field that a parameter multiplies."""

    parameter: int
    index: int
    value: float


def _as_it_is(bulk: Bulk) -> Bulk:
    return bulk


@dataclass(frozen=True, eq=False)
class Variation:
    """The parameters of a model and the cards they act on.

    Parameters
    ----------
    bulk : Bulk
        The deck as it is.
    parameters : tuple of Parameter
        In the order asked for.
    moves : mapping of Key to list
        Fields moved, by card.
    thermal : Thermal
        Materials that follow the temperature.
    read_as : callable
        What is made of the cards that were moved.
    """

    bulk: Bulk
    parameters: tuple[Parameter, ...]
    moves: dict[Key, tuple[_Move, ...]]
    thermal: Thermal
    read_as: Callable[[Bulk], Bulk] = _as_it_is
    _known: dict[bytes, Bulk] = field(default_factory=dict, repr=False)

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """Lowest and highest factors, each (n_parameter,)."""
        lower = np.array([q.lower for q in self.parameters])
        return lower, np.array([q.upper for q in self.parameters])

    def acting_on(self, key: Key) -> frozenset[int]:
        """Return the numbers of the parameters that move a field of this card."""
        return frozenset(m.parameter for m in self.moves.get(key, ()))

    def at(self, p: Floats) -> Bulk:
        """Return the cards at the parameter values `p`, (n_parameter,), factors on the deck's."""
        if not self.moves or not np.any(p != 1.0):
            return self.bulk
        tag = np.asarray(p, dtype=np.float64).tobytes()
        if tag not in self._known:
            if len(self._known) > 64:
                self._known.clear()
            self._known[tag] = self.read_as(self._make(p))
        return self._known[tag]

    def describe(self, p: Floats) -> str:
        """Say which parameters are away from the deck, for messages; "" when none is."""
        moved = [
            f"{q.name!r} at {v:g} times its value"
            for q, v in zip(self.parameters, p, strict=True)
            if v != 1.0
        ]
        plural = "s" if moved[1:] else ""
        return f"parameter{plural} {', '.join(moved)}: " if moved else ""

    def _make(self, p: Floats) -> Bulk:
        changed: dict[Key, Fields] = {}
        for key, moves in self.moves.items():
            factors = {m.index: float(p[m.parameter]) for m in moves}
            if all(f == 1.0 for f in factors.values()):
                continue
            fields = self.bulk.fields(*key)
            for m in moves:
                fields[m.index] = repr(m.value * factors[m.index])
            changed[key] = self.thermal.fields(self.bulk, key, fields)
        return self.bulk.replaced(changed)


def read_variation(deck: Deck, specs: Sequence[ParameterSpec]) -> Variation:
    """Find the fields that parameters move, and bring materials to the deck's temperature.

    Raises
    ------
    InputError
        A card or field that does not exist, is blank or zero, or that two parameters move.
    """
    bulk = deck.bulk
    thermal = read_thermal(deck)
    moves: dict[Key, list[_Move]] = {}
    parameters = []
    taken: dict[object, str] = {}
    for number, spec in enumerate(specs):
        values = []
        for ref in spec.fields:
            key = (ref.card, ref.id)
            index, value = _locate(bulk, ref, spec.name)
            where = (key, index) if ref.id else ref
            if where in taken:
                raise InputError(
                    f"{ref} is moved by the parameter {taken[where]!r} and by {spec.name!r}: "
                    "one field can belong to one parameter only"
                )
            taken[where] = spec.name
            if ref.id:
                moves.setdefault(key, []).append(_Move(number, index, value))
            values.append(value)
        named = tuple(str(f) for f in spec.fields)
        bounds = spec.lower, spec.upper
        parameters.append(Parameter(spec.name, named, tuple(values), *bounds, spec.weight))
    every = {k: tuple(v) for k, v in moves.items()}
    return Variation(thermal.applied(bulk), tuple(parameters), every, thermal)


def value_of(deck: Deck, ref: FieldRef) -> float:
    """Return the value that a field of the deck has.

    Raises
    ------
    InputError
        A card or field that does not exist, is blank or zero.
    """
    return _locate(deck.bulk, ref, str(ref))[1]


def _locate(bulk: Bulk, ref: FieldRef, name: str) -> tuple[int, float]:
    """Index among the card's fields, and value, of the field a parameter names."""
    raw = _raw(bulk, ref)
    if raw is None:
        known = sorted(bulk.numbered.get(ref.card, {}))
        shown = ", ".join([*map(str, known[:8]), *["..."] * (len(known) > 8)])
        there = f"; the deck has {ref.card} {shown}" if known else ""
        card = ref.title
        said = f"parameter {name!r}: there is no {card} in the deck{there}"
        raise Place(bulk.files[0]).error(said, card)
    fields = fields_of(raw.lines)
    shift = bulk.definitions[ref.card].several * raw.part

    def read(position: int) -> str:
        return str(_at(fields, 1 + index_of(position)) or "").upper()

    position = field_position(ref.card, ref.field, read)
    place = replace(bulk.at(raw), card=ref.title)

    def wrong(what: str) -> InputError:
        return place.about(f"parameter {name!r}: {what}")

    if position is None:
        raise wrong(f"{place} has no value {ref.field}")
    index = 1 + shift + index_of(position)
    text = _at(fields, index)
    if text is None:
        raise wrong(
            f"{ref.field} is blank on {place}, so there is no value to move: "
            "give it one, or move the values it follows from"
        )
    try:
        value = parse_real(text)
    except ValueError:
        raise wrong(f"{ref.field} on {place} is {text!r}, no number") from None
    if value == 0.0:
        raise wrong(f"{ref.field} is zero on {place}, and a factor cannot move it")
    return index, value


def _raw(bulk: Bulk, ref: FieldRef) -> Raw | None:
    if ref.id:
        return bulk.numbered.get(ref.card, {}).get(ref.id)
    both = zip(bulk.listed(ref.card), bulk.raw.get(ref.card, ()), strict=True)
    return next((raw for card, raw in both if card.n == ref.field), None)


def _at(fields: Fields, index: int) -> str | None:
    return fields[index] if index < len(fields) else None
