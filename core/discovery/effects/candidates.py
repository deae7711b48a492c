"""One kind of effect at every place where it could be.

Also the same at places that are each other's images: two engines, a ring of feet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats, Ints
from ..reduction.residual_flexibility import Flexibility, Lost, SharedFlexibility
from ..reduction.search_basis import Basis
from ..symmetry.equivalent_places import images_of, symmetries
from .effect_kind import EffectKind, Words
from .effect_laws import Law, Rows

Ends = tuple[int, int, int]
"""Number of an edge, and of the places on it where a stretch begins and ends."""


@dataclass(frozen=True, eq=False)
class Candidates:
    """All places of one kind of effect.

    Parameters
    ----------
    kind : EffectKind
    xyz : (n, 3) float
        Where, deck units.
    law : Law
    trials : (n_trial, t) float
        Values of θ that the search tries at every place, one θ for each of the t magnitudes.
    root : (n · q, n_free) sparse
        A of place i is the sum of the outer products of its q rows.
    rows_each : int
        q; 0 where the matrix is that of elements, and nothing that a basis lacks matters.
    where : tuple of dict
        ``grids`` or ``elements`` of each place, ``components`` where the kind has them.
    typical, spread : (t,) float
        Prior of θ: normal with these means and standard deviations.
    steps : (t,) float
        What is a step of each θ where a search moves it.
    lower, upper : (t,) float
        Bounds of θ.
    loads, turns : sparse, optional
        `root` is ``turns @ loads``, where few loads make the rows of many places.
    ends : tuple of Ends
        Of each place, where they are stretches of edges.
    single : Candidates, optional
        Of sets of equivalent places (`twins`): the same kind at one place, and
    copies : tuple of tuple of int
        its rows, of each set; the magnitudes are those of each place.
    maps : (m, 3, 3) float, optional
        What takes the first place of a set to each.
    """

    kind: EffectKind
    xyz: Floats
    law: Law
    trials: Floats
    root: sp.csr_matrix
    rows_each: int
    where: tuple[dict[str, Any], ...]
    typical: Floats
    spread: Floats
    steps: Floats = field(default_factory=lambda: np.ones(1))
    lower: Floats = field(default_factory=lambda: np.full(1, -np.inf))
    upper: Floats = field(default_factory=lambda: np.full(1, np.inf))
    loads: sp.csr_matrix | None = None
    turns: sp.csr_matrix | None = None
    ends: tuple[Ends, ...] = ()
    single: Candidates | None = None
    copies: tuple[tuple[int, ...], ...] = ()
    maps: Floats | None = None

    def __len__(self) -> int:
        return len(self.xyz)

    @property
    def spots(self) -> Floats:
        """Return what places are near each other by, (n, d)."""
        return self.xyz

    @property
    def first(self) -> Ints:
        """Places that a first scan may look at."""
        return np.arange(len(self))

    def surprise(self, theta: Floats) -> Floats:
        """Return −2 ln of the prior density of θ (n, t), up to a constant, (n,)."""
        return np.asarray(np.sum(((theta - self.typical) / self.spread) ** 2, axis=-1))

    def like(self, theta: Sequence[float]) -> Floats:
        """Return θ of other candidates as these have it: what those do not have as is typical."""
        return np.append(theta, self.typical[len(theta) :])[: len(self.typical)]

    def around(self, theta: Sequence[float], changes: Floats) -> Floats:
        """Return θ (t,) with each magnitude in turn moved by `changes` (n,) steps, (≤ n·t, t)."""
        moves = changes[:, None, None] * np.diag(self.steps)
        return self.within(theta + np.unique(moves.reshape(-1, len(self.steps)), axis=0))

    def within(self, theta: Floats) -> Floats:
        """Return θ (..., t) moved into the bounds."""
        return np.asarray(np.clip(theta, self.lower, self.upper))

    @property
    def tunings(self) -> int:
        """Number of trial values of all magnitudes but the first, 1 where there is but one."""
        return len({tuple(trial[1:]) for trial in self.trials.tolist()})

    def factors(self, basis: Basis) -> Rows:
        """Return the rows of `root` on the basis, (n, q, r)."""
        U = np.asarray(self.root @ basis.vectors)
        return U.reshape(len(self), self.rows_each, basis.size)

    def told(self, row: int, words: Words) -> Words:
        """Return what is told of one place beside its magnitudes, by their `words`."""
        return self.kind.further(self, row, words)

    def many(self, row: int) -> int:
        """Return the number of places that one of the candidates takes."""
        return len(self.copies[row]) if self.copies else 1

    def acting(self, row: int) -> sp.csr_matrix:
        """Return the rows of `root` of one place, (q, n_free); of elements A itself."""
        return self.root[row * self.rows_each : (row + 1) * self.rows_each]


@dataclass(frozen=True)
class Suspect:
    """One candidate with its magnitudes: kind (number in the catalogue), place, θ of each."""

    kind: int
    row: int
    theta: tuple[float, ...]

    def moved(self, theta: Floats) -> Suspect:
        """Return the candidate with magnitudes `theta` (t,)."""
        return replace(self, theta=tuple(float(v) for v in theta))


def magnitudes(suspects: Sequence[Suspect]) -> Floats:
    """Return θ of all suspects one after the other, (n_magnitude,)."""
    return np.array([v for s in suspects for v in s.theta], dtype=float)


Catalogue = Sequence[Candidates]


def changed(catalogue: Catalogue, suspects: Sequence[Suspect], step: Floats) -> tuple[Suspect, ...]:
    """Return the suspects with `step` (n_magnitude,) added to their magnitudes, within bounds."""
    ends = np.cumsum([len(s.theta) for s in suspects])
    return tuple(
        s.moved(catalogue[s.kind].within(s.theta + d))
        for s, d in zip(suspects, np.split(step, ends)[:-1], strict=True)
    )


def beside(catalogue: Catalogue, suspect: Suspect) -> list[Suspect]:
    """Return stretches that begin or end one place from a suspect's, and those that give otherwise.

    How far a neighbour of a stretch promises to be better shows only once the known parameters
    have followed: one more grid that turns freely changes every mode.
    """
    own = catalogue[suspect.kind]
    if not own.ends:
        return []
    edge, first, last = own.ends[suspect.row]
    rows = _rows(own)
    moved = [(edge, first + a, last + b) for a, b in ((-1, 0), (1, 0), (0, -1), (0, 1))]
    moved += [(edge, first + a, last + a) for a in (-1, 1)]
    out = [Suspect(suspect.kind, rows[e], suspect.theta) for e in moved if e in rows]
    for kind, c in enumerate(catalogue):
        row = _rows(c).get((edge, first, last)) if kind != suspect.kind else None
        if row is not None:
            out.append(Suspect(kind, row, tuple(float(v) for v in c.typical)))
    return out


def _rows(c: Candidates) -> dict[Ends, int]:
    return {e: row for row, e in enumerate(c.ends)}


def with_twins(
    single: Candidates, grids: Floats, size: float, held: Floats
) -> tuple[Candidates, ...]:
    """Return candidates at points, and beside them the same at every set of equivalent ones.

    A set has one magnitude, that of each place. The symmetry is that of the structure's `grids`
    (n, 3) and of those that are `held` (m, 3); `size` is its size.
    """
    points = {
        (*sorted(w["grids"]), *w.get("arms", ())): i
        for i, w in reversed(list(enumerate(single.where)))
    }
    once = np.sort(np.fromiter(points.values(), np.int64))
    xyz = single.xyz[once]
    if not len(xyz):
        return (single,)
    sets = [
        together(single, once[rows], np.concatenate([np.eye(3)[None], s.maps]))
        for s in symmetries(grids, size, held)
        for rows in [images_of(s, xyz, size)]
        if len(rows)
    ]
    return (single, *sets)


def together(single: Candidates, rows: Ints, maps: Floats | None = None) -> Candidates:
    """Return candidates at several places each, `rows` (n, m) of those at one.

    `maps` (m, 3, 3) take the first of the places to each.
    """
    q = single.rows_each
    loads = (rows[:, :, None] * q + np.arange(q)).ravel()
    return replace(
        single,
        xyz=single.xyz[rows[:, 0]],
        root=single.root[loads],
        rows_each=q * rows.shape[1],
        where=tuple(single.where[i] for i in rows[:, 0]),
        upper=single.upper - np.log(rows.shape[1]) * (np.arange(len(single.upper)) == 0),
        single=single,
        copies=tuple(map(tuple, rows.tolist())),
        maps=maps,
    )


@dataclass(frozen=True, eq=False)
class RowsTogether:
    """Rows of sets of places on a basis, those of a place (n, q, r) one after the other."""

    each: Rows
    copies: Ints

    def __getitem__(self, rows: Ints) -> Floats:
        """Return the rows of some sets, (n, m · q, r)."""
        sets = self.copies[rows]
        U = self.each[sets.ravel()]
        return U.reshape(len(sets), sets.shape[1] * U.shape[1], U.shape[2])


def factors_of(catalogue: Sequence[Candidates], basis: Basis) -> tuple[Rows, ...]:
    """Return the rows of all candidates on a basis."""
    own: dict[int, Rows] = {id(c): c.factors(basis) for c in catalogue if c.single is None}
    return tuple(
        own[id(c)] if c.single is None else RowsTogether(own[id(c.single)], np.array(c.copies))
        for c in catalogue
    )


def places_of(c: Candidates, row: int) -> list[tuple[Candidates, int]]:
    """Return candidates and row of each place of one of them: more than one of a set of twins."""
    if c.single is None:
        return [(c, row)]
    return [(c.single, i) for i in c.copies[row]]


def apart(a: Candidates, row: int, b: Candidates, other: int) -> float:
    """Return how far any place of one candidate is from the nearest of another, at most.

    One of twins has several: the distance is Hausdorff's.
    """
    both = (places_of(a, row), places_of(b, other))
    here, there = (np.array([c.xyz[k] for c, k in places]) for places in both)
    away = np.linalg.norm(here[:, None] - there, axis=2)
    return float(max(away.min(axis=0).max(), away.min(axis=1).max()))


def lacking(c: Candidates, lost: Lost) -> Flexibility | SharedFlexibility | None:
    """Return the flexibility that a basis lacks for candidates, None where it does not matter."""
    if not c.rows_each:
        return None
    loads = c.root if c.loads is None else c.loads
    turns = sp.identity(c.root.shape[0], format="csr") if c.turns is None else c.turns
    of = SharedFlexibility if c.law.shared else Flexibility
    return of(lost, loads, turns, c.rows_each)
