"""Masses and springs of the deck that may have a wrong value: one parameter each, for discovery."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ...core.errors import InputError
from .parameters import FieldRef, ParameterSpec
from .read import Deck
from .variation import value_of

_VALUES = {
    **dict.fromkeys(("CONM2", "CMASS2", "CMASS4", "PMASS"), ("M",)),
    **dict.fromkeys(("CELAS2", "CELAS4", "PELAS", "PBUSH1D"), ("K",)),
    "PBUSH": tuple(f"K{k}" for k in range(1, 7)),
}
_BOUNDS = (0.25, 4.0)
_MOST = 200
"""Values of one card and field that are looked at, the largest."""

SPREAD = 0.4
"""Of ln of a value: how far an analyst may have it wrong."""


def concentrated_parameters(deck: Deck) -> tuple[ParameterSpec, ...]:
    """Return every concentrated mass and spring stiffness of a deck, each value by itself."""
    return tuple(
        ParameterSpec(str(ref), (ref,), *_BOUNDS)
        for card, fields in _VALUES.items()
        for field in fields
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
