"""Stiffness and mass that drift smoothly over the structure.

Thickness, modulus and density of a real structure are not the same everywhere, and no list of
effects has that. A field multiplies the matrices of all elements by 1 + a q(x), q a polynomial of
the position: one amplitude a each for stiffness and mass, of the rms 1 over the structure's mass,
orthogonal to a change everywhere alike, which is a parameter's.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations_with_replacement

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats, Ints
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
        return replace(self, stiffness=own.T @ self.stiffness @ own, mass=own.T @ self.mass @ own)

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


def smooth_fields(structure: Structure, vectors: Floats) -> Fields:
    """Return the smooth fields of a structure on a basis (n_free, r), the deck's values moved."""
    at, masses, K, M = _by_cells(structure, vectors)
    q, words = _polynomials(at, masses)
    none = np.zeros((q.shape[1], *K.shape[1:]))
    k, m = (np.tensordot(q.T, A, 1) for A in (K, M))
    names = tuple(f"{what} {w}" for what in ("stiffness", "mass") for w in words)
    both = np.ones(len(names))
    fields = np.concatenate([k, none]), np.concatenate([none, m])
    return Fields(names, *fields, both, -MODEL_ERROR.most * both)


def _by_cells(structure: Structure, vectors: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return centres (n, 3), masses (n,), K and M (n, r, r) of parts of the structure."""
    motion = np.asarray(structure.displacement @ vectors)
    centres = [structure.centroids(m) for m in structure.members]
    cell, count = _cells(np.concatenate(centres))
    r = vectors.shape[1]
    K, M = np.zeros((count, r, r)), np.zeros((count, r, r))
    at, weights = np.zeros((count, 3)), np.zeros(count)
    start, everywhere = 0, np.ones(len(structure.model.parameters))
    for m, xyz in zip(structure.members, centres, strict=True):
        own = cell[start : start + len(xyz)]
        start += len(xyz)
        for few in _together(own):
            some = np.flatnonzero(np.isin(own, few))
            matrices = m.stiffness(some, everywhere), m.mass(some, everywhere)
            coordinates = m.coordinates(some)
            for c in few:
                here = own[some] == c
                k, mass = (
                    _reduced(A, coordinates[here], motion)
                    for A in (None if X is None else X[here] for X in matrices)
                )
                K[c] += k
                M[c] += mass
                w = max(float(np.trace(mass)), np.finfo(float).tiny)
                at[c] += w * xyz[some[here]].mean(axis=0)
                weights[c] += w
    return at / weights[:, None], weights, K, M


def _together(cell: Ints) -> list[Ints]:
    """Return the cells of elements (n,), so many at a time as have about so many elements."""
    cells, sizes = np.unique(cell, return_counts=True)
    ends = np.flatnonzero(np.diff(np.cumsum(sizes) // REDUCTION.elements_at_once)) + 1
    return np.split(cells, ends) if len(cells) else []


def _reduced(A: Floats | None, at: Ints, motion: Floats) -> Floats:
    """Return the sum of the matrices of elements (n, m, m) on a basis: at rows (n, m) of `motion`.

    Nothing where they have none.
    """
    if A is None:
        return np.zeros((motion.shape[1],) * 2)
    own, places = np.unique(at, return_inverse=True)
    places = places.reshape(at.shape)
    where = np.repeat(places, at.shape[1], axis=1).ravel(), np.tile(places, at.shape[1]).ravel()
    u = motion[own]
    return np.asarray(u.T @ (sp.csr_matrix((A.ravel(), where), (len(own),) * 2) @ u))


def _cells(xyz: Floats) -> tuple[Ints, int]:
    """Divide points among boxes of a grid over them; number of each point's box, and of boxes."""
    low, size = xyz.min(axis=0), np.ptp(xyz, axis=0).max() or 1.0
    box = ((xyz - low) / size * MODEL_ERROR.cells).astype(np.int64)
    box = np.minimum(box, MODEL_ERROR.cells - 1)
    _, number = np.unique(box, axis=0, return_inverse=True)
    return number.ravel(), int(number.max()) + 1


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
