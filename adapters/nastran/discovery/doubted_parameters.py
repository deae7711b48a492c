"""Which known properties compete in a discovery beside those that the user names."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ....core.arrays import Floats
from ....core.discovery.reduction.elements_and_supports import Structure
from ....core.discovery.screening.parameter_screening import noticeable, shifts, tied
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
    """Parameters of a discovery: those named, the usual ones, and from `first` on concentrated.

    `spreads` are those of ln p.
    """

    specs: tuple[ParameterSpec, ...]
    spreads: tuple[float, ...]
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
        len(named) + sum(k < len(usual) for k in used),
    )


def _usual(deck: Deck) -> Iterator[tuple[ParameterSpec, float]]:
    """Return what an analyst would doubt first, and how far each may be off (spread of ln p).

    Moduli of materials, thicknesses of shells and bending inertias of bars (both axes together).
    """
    for name, doubt in ((n, m.doubt) for n, m in movable().items() if m.doubt):
        for number, card in sorted(deck.bulk.table(name).items()):
            held = tuple(f for f in doubt.fields if getattr(card, f.lower()))
            if held:
                refs = tuple(FieldRef(name, number, f) for f in held)
                called = f"{name} {number} {'+'.join(held)}"
                yield ParameterSpec(called, refs, doubt.lower, doubt.upper), doubt.spread


def _used(deck: Deck, specs: Sequence[ParameterSpec]) -> list[int]:
    """Numbers of the parameters on which at least one element depends."""
    parts = read_structure(deck, read_variation(deck, specs))
    return sorted(
        {k for b in parts.blocks for i in np.unique(b.depends_of) for k in b.depends[int(i)]}
    )


def settled(
    deck: Deck, structure: Structure, solution: Eigensolution, hz: Floats, every: Doubted
) -> tuple[Structure, Doubted]:
    """Keep of the concentrated properties those that the measured modes notice.

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
    first, small = every.first, every.specs[every.first :]
    if not small:
        return structure, every
    rows = range(first, len(every.specs))
    slopes = shifts(structure.model, solution, (float(np.min(hz)), float(np.max(hz))), rows)
    chosen = noticeable(slopes, alike(deck, small), SPREAD)
    groups = [*((k,) for k in range(first)), *(tuple(first + k for k in g) for g in chosen)]
    specs = (*every.specs[:first], *(joined([small[k] for k in g]) for g in chosen))
    spreads = (*every.spreads[:first], *(SPREAD for _ in chosen))
    left = Doubted(specs, spreads, first)
    return tied(structure, groups, [s.name for s in specs]), left


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
