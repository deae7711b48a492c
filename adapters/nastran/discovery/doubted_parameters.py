"""Which known properties compete in a discovery beside those that the user names."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .study import Study

_NAMED = 0.4
"""Spread of ln p of a parameter that the user names."""


@dataclass(frozen=True, eq=False)
class Doubted:
    """Parameters of a discovery: those named, the usual ones, and from `first` on concentrated.

    `spreads` are those of ln p.
    """

    specs: tuple[Any, ...]
    spreads: tuple[float, ...]
    first: int


def doubted(study: Study, deck: Any) -> Doubted:
    """Return every known property that may be wrong; a field that is named has no other."""
    from ..adapters.nastran import parse_parameter
    from ..adapters.nastran.concentrated import SPREAD, concentrated_parameters
    from ..adapters.nastran.structure import known_parameters, used_parameters

    named = [parse_parameter(p) for p in study.parameters]
    taken = {f for s in named for f in s.fields}
    usual = [
        (s, w) for s, w in zip(*known_parameters(deck), strict=True) if not taken & {*s.fields}
    ]
    every = [s for s in concentrated_parameters(deck) if not taken & {*s.fields}]
    small = [every[k] for k in used_parameters(deck, every)]
    return Doubted(
        (*named, *(s for s, _ in usual), *small),
        (*(_NAMED for _ in named), *(w for _, w in usual), *(SPREAD for _ in small)),
        len(named) + len(usual),
    )


def settled(
    deck: Any, structure: Any, solution: Any, hz: Any, every: Doubted
) -> tuple[Any, Doubted]:
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
    from ..adapters.nastran.concentrated import SPREAD, alike, joined
    from ..core.discovery.noticing import noticeable, shifts, tied

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
