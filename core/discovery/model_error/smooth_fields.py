"""Stiffness and mass that drift smoothly over the structure.

Thickness, modulus and density of a real structure are not the same everywhere, and no list of
effects has that. A field multiplies the matrices of all elements by 1 + a q(x), q a polynomial of
the position: one amplitude a each for stiffness and mass, of the rms 1 over the structure's mass,
orthogonal to a change everywhere alike, which is a parameter's.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations_with_replacement

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats, Ints
from ...assembly.element_assembly import CHUNK
from ..reduction.elements_and_supports import Structure
from ..reduction.reduction_numbers import REDUCTION
from .model_error_numbers import MODEL_ERROR


@dataclass(frozen=True, eq=False)
class Fields:
    """Fields on a basis.

    Parameters
    ----------
    names : tuple of str
        As ``stiffness along x``.
    stiffness, mass : (n, r, r) float
        What an amplitude of 1 adds to each.
    spread : (n,) float
        Standard deviation of each amplitude beforehand.
    least : (n,) float
        Least amplitudes.
    """

    names: tuple[str, ...]
    stiffness: Floats
    mass: Floats
    spread: Floats
    least: Floats

    def turned(self, T: Floats) -> Fields:
        """Return the fields on the basis turned by T (≥ r, s); its further vectors are local."""
        own = T[: self.mass.shape[1]]
        stiffness, mass = (_turned(A, own) for A in (self.stiffness, self.mass))
        return replace(self, stiffness=stiffness, mass=mass)

    def of(self, size: float) -> Fields:
        """Return the fields with amplitudes of another size beforehand."""
        return replace(self, spread=size * self.spread)

    def none(self) -> Fields:
        """Return no fields, on the same basis."""
        return Fields((), *(getattr(self, k)[:0] for k in _EACH))

    def and_also(self, other: Fields) -> Fields:
        """Return these fields and more."""
        both = ((getattr(f, k) for f in (self, other)) for k in _EACH)
        return Fields(self.names + other.names, *(np.concatenate(list(b)) for b in both))


_EACH = ("stiffness", "mass", "spread", "least")


def _turned(A: Floats, T: Floats) -> Floats:
    """Return TᵀAT of matrices (n, r, r), many of which are nothing."""
    out, live = np.zeros((len(A), *T.shape[1:] * 2)), A.any(axis=(1, 2))
    out[live] = T.T @ A[live] @ T
    return out


def smooth_fields(structure: Structure, vectors: Floats) -> Fields:
    """Return the smooth fields of a structure on a basis (n_free, r), the deck's values moved."""
    motion = np.asarray(structure.displacement @ vectors)
    cell, middles, rows, *forces = zip(*_parts(structure, motion), strict=True)
    masses = np.array([np.sum(motion[own] * f) for own, f in zip(rows, forces[1], strict=True)])
    masses = np.maximum(masses, np.finfo(float).tiny)
    weights = np.bincount(cell, masses).astype(float)
    at = [np.bincount(cell, masses * x) / weights for x in np.transpose(middles)]
    q, words = _polynomials(np.stack(at, axis=1), weights)
    k, m = (_summed(q[list(cell)], rows, f, motion) for f in forces)
    names = tuple(f"{what} {w}" for what in ("stiffness", "mass") for w in words)
    both, none = np.ones(len(names)), np.zeros_like(k)
    fields = np.concatenate([k, none]), np.concatenate([none, m])
    return Fields(names, *fields, both, -MODEL_ERROR.most * both)


def _parts(
    structure: Structure, motion: Floats
) -> Iterator[tuple[int, Floats, Ints, Floats, Floats]]:
    """Give cell and middle of each card's elements there, their rows of a motion, K, M times it."""
    centres = [structure.centroids(m) for m in structure.members]
    cell = _cells(np.concatenate(centres))
    start, p = 0, structure.model.deck_point
    for m, xyz in zip(structure.members, centres, strict=True):
        own = cell[start : start + len(xyz)]
        start += len(xyz)
        for few in _together(own):
            some = np.flatnonzero(np.isin(own, few))
            places = m.coordinates(some)
            K, M = m.stiffness(some, p), m.mass(some, p)
            for c in few:
                here = own[some] == c
                rows, at = np.unique(places[here], return_inverse=True)
                added = sp.csr_matrix((np.ones(at.size), (at.ravel(), np.arange(at.size))))
                moved = motion[places[here]]
                k, mass = (added @ (A[here] @ moved).reshape(at.size, -1) for A in (K, M))
                yield c, xyz[some[here]].mean(axis=0), rows, k, mass


def _together(cell: Ints) -> list[Ints]:
    """Return the cells of elements (n,), so many at a time as have about so many elements."""
    cells, sizes = np.unique(cell, return_counts=True)
    ends = np.flatnonzero(np.diff(np.cumsum(sizes) // CHUNK)) + 1
    return np.split(cells, ends) if len(cells) else []


def _summed(q: Floats, rows: Sequence[Ints], forces: Sequence[Floats], motion: Floats) -> Floats:
    """Return the matrices of parts on a basis times weights (n, k), added up: (k, r, r)."""
    each = np.empty((REDUCTION.parts_at_once, motion.shape[1], motion.shape[1]))
    out = np.zeros((q.shape[1], each[0].size))
    for first in range(0, len(q), len(each)):
        few = slice(first, first + len(each))
        for own, f, A in zip(rows[few], forces[few], each, strict=False):
            np.matmul(motion[own].T, f, out=A)
        out += q[few].T @ each[: len(q[few])].reshape(-1, each[0].size)
    return out.reshape(-1, *each.shape[1:])


def _cells(xyz: Floats) -> Ints:
    """Divide points among boxes of a grid over them; number of each point's box, (n,)."""
    low, size = xyz.min(axis=0), np.ptp(xyz, axis=0).max() or 1.0
    box = ((xyz - low) / size * MODEL_ERROR.cells).astype(np.int64)
    box = np.minimum(box, MODEL_ERROR.cells - 1)
    _, number = np.unique(box, axis=0, return_inverse=True)
    return np.asarray(number.ravel())


def _said(which: tuple[int, ...]) -> str:
    """Say along what a product of coordinates changes."""
    axes = ["xyz"[i] for i in which]
    if len(axes) == 1:
        return f"along {axes[0]}"
    if len(set(axes)) == 1:
        return f"from the middle to the ends along {axes[0]}"
    return f"from corner to corner in {' and '.join(sorted(set(axes)))}"


def _polynomials(xyz: Floats, weights: Floats) -> tuple[Floats, tuple[str, ...]]:
    """Return polynomials at points, orthogonal by weight and of rms 1, (n, k), and their names."""
    x = xyz - np.average(xyz, axis=0, weights=weights)
    x = x / (np.abs(x).max() or 1.0)
    columns, names = [np.ones(len(x))], [""]
    for degree in range(1, MODEL_ERROR.degree + 1):
        for which in combinations_with_replacement(range(3), degree):
            columns.append(np.prod(x[:, which], axis=1))
            names.append(_said(which))
    w = np.sqrt(weights / weights.sum())
    kept: list[Floats] = []
    words = []
    for column, name in zip(columns, names, strict=True):
        v = w * column
        before = float(np.linalg.norm(v))
        for _ in range(2):
            for k in kept:
                v = v - k * (k @ v)
        length = np.linalg.norm(v)
        if length > MODEL_ERROR.flat * max(before, MODEL_ERROR.flat):
            kept.append(v / length)
            words.append(name)
    return np.array(kept[1:]).T.reshape(len(x), -1) / w[:, None], tuple(words[1:])
