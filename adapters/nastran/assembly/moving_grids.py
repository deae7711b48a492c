"""Positions of grids as parameters: the elements that change with them, made anew by themselves."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ....core.arrays import Bools, Floats, Ints, Matrices
from ....core.errors import InputError
from ..cards import Group
from ..cards.element_group import Key, Routine, numbered
from ..deck.bulk import Bulk
from ..deck.read_deck import Deck
from ..fields.parameter_references import DEFAULT_BOUNDS
from ..properties.deck_constraints import read_constraints
from ..properties.grids import Points, moved_points
from .variation import GRID, Variation

_BLOCK = 5000
"""Elements that are compared at a time."""
_SAME = 1e-11
"""Of an element's largest entry: difference that is rounding."""
_GOLDEN = 0.618034
"""Parameters stand at shares of their bounds that have nothing in common."""
_KNOWN = 200_000
"""Elements that are kept, over all positions that their grids were at."""

Made = Callable[[Bulk, Points], tuple[Group, ...]]
"""The elements of cards, with grids where they are."""
Changed = Sequence[Bools]
"""By group: which elements have other matrices."""


def following_grids(
    deck: Deck, variation: Variation, points: Points, groups: tuple[Group, ...], made: Made
) -> tuple[Group, ...]:
    """Return elements such that those that change with the grids that parameters move follow them.

    All elements are made once more with these grids elsewhere, which tells those that change: at
    a grid, by a shared normal, oriented by it. From then on these alone are made, with their
    neighbours.

    Raises
    ------
    InputError
        A grid of which a constraint, a rigid element, a coordinate system or its own displacement
        system hangs on where it is.
    """
    keys = [key for key in variation.moves if key[0] == GRID]
    if not keys:
        return groups
    grids, moving = np.array([g for _, g in keys]), _parameters(variation, keys)
    away = _away(variation, moving)
    there = variation.at(away)
    elsewhere = moved_points(points, there, grids)
    _require_elements_alone(deck, points, elsewhere, grids)
    changed = _changed(groups, variation.bulk, made(there, elsewhere), there)
    part = _Part(variation, points, grids, made, _around(groups, changed))
    still = [_taken(g, np.flatnonzero(~c)) for g, c in zip(groups, changed, strict=True)]
    own = {(g.card, int(i)) for g, c in zip(groups, changed, strict=True) for i in g.ids[c]}
    by = {k: frozenset(key for key in keys if k in variation.acting_on(key)) for k in moving}
    return (*(g for g in still if len(g.ids)), *part.groups(own, by, away))


@dataclass(frozen=True, eq=False)
class _Part:
    """The elements of some cards: made alone, with grids where the parameters put them."""

    variation: Variation
    points: Points
    grids: Ints
    made: Made
    cards: Mapping[str, frozenset[int]]
    _known: dict[bytes, tuple[Group, ...]] = field(default_factory=dict)

    def at(self, values: Bulk) -> tuple[Group, ...]:
        """Return them with the grids where these cards have them."""
        there = moved_points(self.points, values, self.grids)
        tag = there.xyz[np.searchsorted(there.ids, self.grids)].tobytes()
        if tag not in self._known:
            if len(self._known) >= max(2, _KNOWN // max(1, sum(map(len, self.cards.values())))):
                self._known.clear()
            self._known[tag] = self.made(self._alone, there)
        return self._known[tag]

    @cached_property
    def _alone(self) -> Bulk:
        bulk = self.variation.bulk
        own = {
            card: {k: v for k, v in bulk.table(card).items() if k in kept}
            for card, kept in self.cards.items()
        }
        return replace(bulk, tables={**bulk.tables, **own})

    def groups(
        self, own: set[Key], by: Mapping[int, frozenset[Key]], away: Floats
    ) -> Iterator[Group]:
        """Give those of the elements `own`, each following what it changes with."""
        base, there = self.variation.bulk, self.variation.at(away)
        follow = [[frozenset[Key]()] * len(g.ids) for g in self.at(base)]
        for k, keys in by.items():
            p = away.copy()
            p[k] = 1.0
            back = self.variation.at(p)
            for n, changed in enumerate(_changed(self.at(there), there, self.at(back), back)):
                for row in np.flatnonzero(changed):
                    follow[n][row] |= keys
        for n, group in enumerate(self.at(base)):
            rows = np.flatnonzero([(group.card, int(i)) in own for i in group.ids])
            if len(rows):
                sources = (group.sources[group.source_of[row]] | follow[n][row] for row in rows)
                of, each = numbered(sources)
                moved = replace(group, matrices=self._routine(n))
                yield replace(_taken(moved, rows), sources=of, source_of=each)

    def _routine(self, number: int) -> Routine:
        def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
            return self.at(values)[number].matrices(values, rows, wanted)

        return matrices


def _parameters(variation: Variation, keys: Sequence[Key]) -> list[int]:
    found = {m.parameter for key in keys for m in variation.moves[key]}
    for k in sorted(found):
        q = variation.parameters[k]
        if (q.lower, q.upper) == DEFAULT_BOUNDS:
            raise InputError(
                f"parameter {q.name!r}: say how far {q.handle[0]} may move, such as "
                f"'{q.handle[0]} [={0.95 * q.deck_values[0]:g}, ={1.05 * q.deck_values[0]:g}]'"
            )
    return sorted(found)


def _away(variation: Variation, moving: Sequence[int]) -> Floats:
    """Factors at which these parameters have left the deck, each by another share."""
    p = np.ones(len(variation.parameters))
    lower, upper = variation.bounds
    for n, k in enumerate(moving):
        end = upper[k] if upper[k] > 1.0 else lower[k]
        p[k] += (end - 1.0) * (1.0 + n * _GOLDEN % 1.0) / 2.0
    return p


def _changed(
    groups: Sequence[Group], before: Bulk, others: Sequence[Group], values: Bulk
) -> list[Bools]:
    out = []
    for base, there in zip(groups, others, strict=True):
        changed = np.zeros(len(base.ids), bool)
        for first in range(0, len(changed), _BLOCK):
            rows = np.arange(first, min(first + _BLOCK, len(changed)))
            both = (g.matrices(v, rows, (True, True)) for g, v in ((base, before), (there, values)))
            for old, new in zip(*both, strict=True):
                if old is not None and new is not None:
                    size = _SAME * np.abs(old).max(axis=(1, 2), initial=0.0)
                    changed[rows] |= np.abs(new - old).max(axis=(1, 2), initial=0.0) > size
        out.append(changed)
    return out


def _around(groups: Sequence[Group], changed: Changed) -> dict[str, frozenset[int]]:
    """Return the elements that change and those at their grids, whose normals they share."""
    at = {int(g) for group, c in zip(groups, changed, strict=True) for g in group.nodes[c].flat}
    found: dict[str, frozenset[int]] = {}
    for group in groups:
        near = np.isin(group.nodes, [*at]).any(axis=1)
        kept = frozenset(group.ids[near].tolist())
        found[group.card] = found.get(group.card, frozenset()) | kept
    return found


def _taken(group: Group, rows: Ints) -> Group:
    """Return some elements of a group."""

    def matrices(values: Bulk, of: Ints, wanted: tuple[bool, bool]) -> Matrices:
        return group.matrices(values, rows[of], wanted)

    return replace(
        group,
        ids=group.ids[rows],
        nodes=group.nodes[rows],
        matrices=matrices,
        source_of=group.source_of[rows],
    )


def _require_elements_alone(deck: Deck, points: Points, moved: Points, grids: Ints) -> None:
    named = {g for kind in "RCS" for c in deck.bulk.table(f"CORD1{kind}").values() for g in c.nodes}
    held, now = (read_constraints(deck, p).equations.matrix for p in (points, moved))
    what = ""
    if named & {*grids.tolist()}:
        what = "a coordinate system turns"
    elif np.any(moved.directions != points.directions):
        what = "the displacement system of one turns"
    elif held.shape != now.shape or (held != now).nnz:
        what = "a rigid element changes"
    if what:
        shown = ", ".join(map(str, grids[:5])) + (", ..." if len(grids) > 5 else "")
        raise InputError(
            f"of the grids whose positions are parameters ({shown}) {what} as they move, which the "
            "matrices of elements do not tell; move grids of elements alone"
        )
