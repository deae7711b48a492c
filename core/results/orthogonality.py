"""The tables of orthogonality by the mass of the model at the sensors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..correlation.comparison import Comparison
from ..correlation.orthogonality import REQUIREMENTS, unmet
from ..correlation.pair_expansion import PairExpansion
from ..noun import Noun
from .plain import Table


@dataclass(frozen=True)
class OrthogonalityRow:
    """A pair and its `cross`-orthogonality.

    `beside` is the largest of either of its modes with another pair's, `own` the largest of its
    test mode with another one, `own_with` (None: it is alone).
    """

    test: int
    analysis: int
    cross: float
    beside: float
    own: float
    own_with: int | None


@dataclass(frozen=True)
class RequirementRow:
    """What a contract asks, and what of it is not met."""

    name: str
    deviation_percent: float
    diagonal: float
    off_diagonal: float
    met: bool
    unmet: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class OrthogonalityTables(Noun):
    """Orthogonality of the pairs by the mass of the model reduced to the sensors by `reduction`.

    `own` (n_pair, n_pair) is of the test shapes among themselves, in the order of `pairs`; `cross`
    of test with analysis shapes.
    """

    reduction: str
    pairs: Table[OrthogonalityRow]
    requirements: Table[RequirementRow]
    cross: Floats
    own: Floats


def orthogonality_tables(c: Comparison, found: PairExpansion) -> OrthogonalityTables:
    """Return the tables of expanded pairs."""
    pairs, of = c.correlation.pairs, found.orthogonality
    deviations = np.array([p.deviation_percent for p in pairs])
    lonely = ~np.eye(len(pairs), dtype=bool)
    cross, own = of.cross * lonely, of.own * lonely
    beside = np.maximum(cross.max(axis=0), cross.max(axis=1))
    rows = (
        OrthogonalityRow(
            p.test + 1,
            p.analysis + 1,
            float(of.cross[k, k]),
            float(beside[k]),
            float(own[k].max()),
            pairs[int(own[k].argmax())].test + 1 if len(pairs) > 1 else None,
        )
        for k, p in enumerate(pairs)
    )
    asked = ((r, unmet(of, deviations, r)) for r in REQUIREMENTS)
    return OrthogonalityTables(
        found.method,
        Table(rows),
        Table(RequirementRow(**vars(r), met=not said, unmet=said) for r, said in asked),
        of.cross,
        of.own,
    )
