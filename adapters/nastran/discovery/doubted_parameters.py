"""Which known properties compete in a discovery beside those that the user names."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ....core.arrays import Floats
from ....core.discovery.reduction.elements_and_supports import Structure
from ....core.discovery.screening.parameter_screening import (
    noticeable,
    shifts,
    tied,
    told_apart,
)
from ....core.eigen.normal_modes import Eigensolution
from ....core.errors import InputError
from ..assembly.deck_elements import read_structure
from ..assembly.variation import read_variation, value_of
from ..deck.read_deck import Deck
from ..fields.layouts import movable
from ..fields.parameter_references import FieldRef, ParameterSpec

_NAMED = 0.4
"""Spread of ln p of a parameter that the user names."""
_BOUNDS = (0.25, 4.0)
_MOST = 200
"""Values of one card and field that are looked at, the largest."""

SPREAD = 0.4
"""Of ln of a value: how far an analyst may have it wrong."""


@dataclass(frozen=True, eq=False)
class Doubted:
    """Parameters of a discovery: those named, then the usual ones, from `first` on concentrated.

    `spreads` are those of ln p; the first `named` are those that the user names.
    """

    specs: tuple[ParameterSpec, ...]
    spreads: tuple[float, ...]
    named: int
    first: int


def doubted(deck: Deck, named: Sequence[ParameterSpec]) -> Doubted:
    """Return every known property that may be wrong; a field that is named has no other."""
    taken = {f for s in named for f in s.fields}
    usual = list(_usual(deck))
    every = [*usual, *((s, SPREAD) for s in concentrated_parameters(deck))]
    free = [k for k, (s, _) in enumerate(every) if not taken & {*s.fields}]
    used = [free[k] for k in _used(deck, [every[k][0] for k in free])]
    return Doubted(
        (*named, *(every[k][0] for k in used)),
        (*(_NAMED for _ in named), *(every[k][1] for k in used)),
        len(named),
        len(named) + sum(k < len(usual) for k in used),
    )


def _usual(deck: Deck) -> Iterator[tuple[ParameterSpec, float]]:
    """Return what an analyst would doubt first, and how far each may be off (spread of ln p).

    Moduli of materials, thicknesses of shells and bending inertias of bars, each by itself.
    """
    for name, doubt in ((n, m.doubt) for n, m in movable().items() if m.doubt):
        for number, card in sorted(deck.bulk.table(name).items()):
            bound = bool(doubt.binding and getattr(card, doubt.binding.lower()))
            fields = (*doubt.fields, doubt.binding) if bound else doubt.fields
            refs = (FieldRef(name, number, f) for f in fields if getattr(card, f.lower()))
            each = [ParameterSpec(str(r), (r,), doubt.lower, doubt.upper) for r in refs]
            yield from ((s, doubt.spread) for s in ([joined(each)] if bound else each))


def _used(deck: Deck, specs: Sequence[ParameterSpec]) -> list[int]:
    """Numbers of the parameters on which at least one element depends."""
    parts = read_structure(deck, read_variation(deck, specs))
    return sorted(
        {k for b in parts.blocks for i in np.unique(b.depends_of) for k in b.depends[int(i)]}
    )


def settled(
    deck: Deck, structure: Structure, solution: Eigensolution, hz: Floats, every: Doubted
) -> tuple[Structure, Doubted]:
    """Keep of the properties that nobody named those that the measured modes notice.

    Values of one property that the modes do not tell apart, such as both inertias of a bar that
    bends in one plane, move together.

    Parameters
    ----------
    deck : Deck
    structure : Structure
        With the parameters `every`.
    solution : Eigensolution
        Of the deck as it is.
    hz : (n_test,) float
        Measured frequencies.
    every : Doubted

    Returns
    -------
    structure : Structure
        With those that are left.
    left : Doubted
    """
    named, first, specs = every.named, every.first, every.specs
    band = float(np.min(hz)), float(np.max(hz))
    slopes = shifts(structure.model, solution, band, range(named, len(specs)))
    usual, small = slopes[: first - named], slopes[first - named :]
    own = [g for one in _of_one_card(specs[named:first]) for g in told_apart(usual, one, SPREAD)]
    concentrated = noticeable(small, alike(deck, specs[first:]), SPREAD)
    groups = [
        *((k,) for k in range(named)),
        *(tuple(named + k for k in g) for g in own),
        *(tuple(first + k for k in g) for g in concentrated),
    ]
    left = Doubted(
        tuple(joined([specs[k] for k in g]) for g in groups),
        tuple(every.spreads[g[0]] for g in groups),
        named,
        named + len(own),
    )
    return tied(structure, groups, [s.name for s in left.specs]), left


def _of_one_card(specs: Sequence[ParameterSpec]) -> list[tuple[int, ...]]:
    """Return numbers of the parameters of each card."""
    cards: dict[tuple[str, int], list[int]] = {}
    for k, spec in enumerate(specs):
        ref = spec.fields[0]
        cards.setdefault((ref.card, ref.id), []).append(k)
    return [tuple(g) for g in cards.values()]


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
    if len(specs) == 1:
        return specs[0]
    fields = tuple(f for s in specs for f in s.fields)
    first = fields[0]
    name = f"{first} and {len(fields) - 1} alike"
    if len({(f.card, f.id) for f in fields}) == 1:
        name = f"{first.title} {'+'.join(f.field for f in fields)}"
    return ParameterSpec(name, fields, specs[0].lower, specs[0].upper, specs[0].weight)
