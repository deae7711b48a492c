"""A body that a fit moves: mass, centre and extent are its unknowns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from ...arrays import Floats, Ints, skew
from ..effects.candidates import Candidates
from ..effects.effect_laws import Law
from ..effects.effect_numbers import EFFECTS
from .bodies import Body
from .stands import Stand


@dataclass(frozen=True)
class LooseLaw(Law):
    """A rigid body on six motions, its θ: ln m, its centre (3) and its extent (6), all in one unit.

    Its matrix is one of sums and products of the motions: those are the rows it adds to M.
    `copies` is the number of places alike.
    """

    copies: int = 1
    on = "M"

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return what each row counts, (n, 15 · copies)."""
        found = [_counts(_matrix(t)) for t in theta]
        return np.tile(np.array(found), self.copies)

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return the derivatives by each θ, (n, 10, 15 · copies)."""
        found = [[_counts(A) for A in _slopes(t)] for t in theta]
        return np.tile(np.array(found), self.copies)


_PAIRS = np.array([(i, j) for i, j in combinations(range(6), 2) if j > 2 and j != i + 3])
_SIDES = -skew(np.eye(3))
_EXTENTS = tuple(
    (np.outer(a, b) + np.outer(b, a)) / (2.0 if i == j else np.sqrt(2.0))
    for i, a in enumerate(np.eye(3))
    for j, b in enumerate(np.eye(3)[: i + 1])
)
"""Extents of which any is a sum, its parts squared the same in axes turned as one likes."""


def _counts(A: Floats) -> Floats:
    """Return what six motions squared and sums of two squared count in a matrix of them (6, 6)."""
    i, j = _PAIRS.T
    pairs = A[i, j]
    squares = np.diag(A).copy()
    np.subtract.at(squares, i, pairs)
    np.subtract.at(squares, j, pairs)
    return np.concatenate([squares, pairs])


def _taken_apart(theta: Floats) -> tuple[float, Floats, Floats]:
    """Return mass, centre and extent of a loose body."""
    extent = sum(t * E for t, E in zip(theta[-6:], _EXTENTS, strict=True))
    return float(np.exp(theta[0])), theta[1:-6], np.asarray(extent)


def _matrix(theta: Floats) -> Floats:
    """Return the mass matrix (6, 6) of a loose body."""
    m, centre, extent = _taken_apart(theta)
    G = np.hstack([np.eye(3), -skew(centre)])
    turning = np.zeros((6, 6))
    turning[3:, 3:] = Body(centre, extent).inertia
    return m * (G.T @ G + turning)


def _slopes(theta: Floats) -> list[Floats]:
    """Return its derivatives by each θ."""
    m, centre, extent = _taken_apart(theta)
    G = np.hstack([np.eye(3), -skew(centre)])
    out = [_matrix(theta)]
    for side in _SIDES:
        half = m * G.T @ np.hstack([np.zeros((3, 3)), side])
        out.append(half + half.T)
    for E in _EXTENTS:
        half = extent @ E
        both = np.zeros((6, 6))
        both[3:, 3:] = m * (2.0 * np.trace(half) * np.eye(3) - half - half.T)
        out.append(both)
    return out


_ROWS = np.vstack([np.eye(6), np.eye(6)[_PAIRS].sum(axis=1)])
_UNKNOWN = np.ones(len(_SIDES) + len(_EXTENTS))


def loose(template: Candidates, alike: Sequence[Stand], size: float) -> Candidates:
    """Return one mass whose body is not known, at all the places together, see `LooseLaw`.

    Its unit is `EFFECTS.body` of the structure's `size`, what its centre and extent may be off
    by beforehand.
    """
    unit, free, roots = EFFECTS.body * size, np.inf * _UNKNOWN, []
    for s in alike:
        turns = unit * np.linalg.det(s.turn) * s.turn.T
        own = _ROWS @ la.block_diag(s.turn.T, turns)
        roots.append(sp.csr_matrix(own) @ s.motion)
    return Candidates(
        kind=template.kind,
        xyz=alike[0].xyz[None],
        law=LooseLaw(len(alike)),
        trials=np.zeros((0, 1 + len(_UNKNOWN))),
        root=sp.vstack(roots).tocsr(),
        rows_each=len(_ROWS) * len(alike),
        where=(alike[0].where,),
        typical=np.append(template.typical[:1], 0.0 * _UNKNOWN),
        spread=np.append(template.spread[:1], _UNKNOWN),
        steps=np.ones(1 + len(_UNKNOWN)),
        lower=np.append(template.lower[:1], -free),
        upper=np.append(template.upper[:1], free),
    )


def theta_of(ln_mass: float, body: Body, size: float) -> tuple[float, ...]:
    """Return the θ of a loose body."""
    unit = EFFECTS.body * size
    extent = [float(np.sum(E * body.extent)) / unit for E in _EXTENTS]
    return (ln_mass, *(body.offset / unit).tolist(), *extent)


def body_of(theta: Sequence[float], size: float) -> Body:
    """Return the body that the θ of a loose one say."""
    _, centre, extent = _taken_apart(np.array(theta))
    unit = EFFECTS.body * size
    return Body(unit * centre, unit * extent)
