"""Masses and springs of the deck that may have a wrong value: one parameter each, for discovery."""

from collections.abc import Iterator, Sequence

from ....core.errors import InputError
from ..assembly.variation import value_of
from ..deck.read_deck import Deck
from ..fields.layouts import movable
from ..fields.parameter_references import FieldRef, ParameterSpec

_BOUNDS = (0.25, 4.0)
_MOST = 200
"""Values of one card and field that are looked at, the largest."""

SPREAD = 0.4
"""Of ln of a value: how far an analyst may have it wrong."""


def concentrated_parameters(deck: Deck) -> tuple[ParameterSpec, ...]:
    """Return every concentrated mass and spring stiffness of a deck, each value by itself."""
    return tuple(
        ParameterSpec(str(ref), (ref,), *_BOUNDS)
        for card, known in sorted(movable().items(), key=lambda m: "M" not in m[1].concentrated)
        for field in known.concentrated
        for ref, _ in sorted(_of(deck, card, field), key=lambda v: -v[1])[:_MOST]
    )


def _of(deck: Deck, card: str, field: str) -> Iterator[tuple[FieldRef, float]]:
    for number in sorted(deck.bulk.table(card)):
        ref = FieldRef(card, number, field)
        try:
            yield ref, abs(value_of(deck, ref))
        except InputError:
            continue


def alike(deck: Deck, specs: Sequence[ParameterSpec]) -> list[tuple[int, ...]]:
    """Return the numbers of parameters whose one card, field and value are the same."""
    groups: dict[tuple[str, str, float], list[int]] = {}
    for k, spec in enumerate(specs):
        (ref,) = spec.fields
        groups.setdefault((ref.card, ref.field, value_of(deck, ref)), []).append(k)
    return [tuple(g) for g in groups.values()]


def joined(specs: Sequence[ParameterSpec]) -> ParameterSpec:
    """Return one parameter that moves the values of several."""
    fields = tuple(f for s in specs for f in s.fields)
    first = fields[0]
    name = str(first) if len(fields) == 1 else f"{first} and {len(fields) - 1} alike"
    return ParameterSpec(name, fields, specs[0].lower, specs[0].upper, specs[0].weight)
