"""Patches of neighbouring elements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ...arrays import Floats, Ints
from ..basis import Basis
from ..candidates import Candidates
from ..laws import MassLaw, Rows
from ..structure import Members, Structure, thinned

_LEFT = 1e-5
"""Share of the trace of a patch's matrix that a row of its root is worth at least."""
_ROUNDING = 1e-12
"""Share of the largest eigenvalue of an element matrix below which one is zero."""
_RADII = (0.045, 0.056, 0.07, 0.088, 0.11, 0.14, 0.175, 0.22)
"""Radii of the patches, beside the size of the structure; every third is scanned first."""
_SPACING = 0.35
_MOST = 400
_LONG, _SHORT = 1.25, 0.63
"""Half sides of an elongated patch beside the radius of the round one of the same area."""
_REACH = 1.6


@dataclass(frozen=True, eq=False)
class Patch:
    """Elements of one card around a centre; `first` where the first scan looks at it."""

    member: int
    rows: Ints
    xyz: Floats
    radius: float
    first: bool


def patches_of(structure: Structure, size: float, radii: tuple[float, ...] = _RADII) -> list[Patch]:
    """Patches of shell elements of several sizes all over the structure."""
    out = []
    for number, m in enumerate(structure.members):
        if m.shape not in {"quad", "tria"} or not len(m.ids):
            continue
        xyz = structure.centroids(m)
        tree = cKDTree(xyz)
        wide = np.flatnonzero(np.ptp(xyz, axis=0) > 0.1 * size)
        sides = [np.where(np.arange(3) == k, _LONG, _SHORT) for k in wide] if len(wide) > 1 else []
        centres = np.concatenate([xyz, structure.model.geometry.xyz[np.unique(m.corners)]])
        for k, r in enumerate(radii):
            coarse = set(_centres(xyz, 3.2 * _SPACING * r * size)) if k % 3 == 1 else set()
            for c in sorted({*_centres(centres, _SPACING * r * size), *coarse}):
                reach = np.array(tree.query_ball_point(centres[c], _REACH * r * size), np.int64)
                away = np.abs(xyz[reach] - centres[c]) / (r * size)
                inside = [np.linalg.norm(away, axis=1) <= 1.0]
                inside += [np.all(away <= s, axis=1) for s in sides]
                for shape, which in enumerate(inside):
                    rows = np.sort(reach[which])
                    if 0 < len(rows) < 0.5 * len(xyz):
                        first = shape == 0 and c in coarse
                        middle = xyz[rows].mean(axis=0)
                        out.append(Patch(number, rows, middle, r * size, first))
    return _distinct(out)


def _centres(xyz: Floats, spacing: float) -> Ints:
    chosen = thinned(xyz, spacing)
    while len(chosen) > _MOST:
        spacing *= 1.05 * np.sqrt(len(chosen) / _MOST)
        chosen = thinned(xyz, spacing)
    return chosen


def _distinct(patches: list[Patch]) -> list[Patch]:
    seen: dict[tuple[int, bytes], Patch] = {}
    for p in sorted(patches, key=lambda q: not q.first):
        seen.setdefault((p.member, p.rows.tobytes()), p)
    return list(seen.values())


class PatchRows:
    """Rows of a root of each patch's matrix on a basis, made when asked for, then kept.

    A root takes as many rows as pivoted Cholesky needs to leave next to nothing of the trace
    (Higham, *Accuracy and Stability of Numerical Algorithms*, section 10.3); patches that are
    asked for together get rows of zeros where they need fewer.
    """

    def __init__(self, candidates: PatchCandidates, basis: Basis) -> None:
        self._candidates = candidates
        structure: Structure = candidates.extra["structure"]
        self._motion = np.asarray(structure.displacement @ basis.vectors)
        self._members: dict[int, tuple[Floats, Floats]] = {}
        self._kept: dict[int, Floats] = {}

    def of(self, candidates: PatchCandidates) -> PatchRows:
        """Return the rows of candidates that have these first, and others after them."""
        other = copy(self)
        other._candidates = candidates
        other._kept = dict(self._kept)
        return other

    def __getitem__(self, rows: Ints) -> Floats:
        """Return the rows of some patches, (n, q, r)."""
        roots = [self._one(int(i)) for i in rows]
        most = max((len(root) for root in roots), default=0)
        out = np.zeros((len(roots), most, self._motion.shape[1]))
        for own, root in zip(out, roots, strict=True):
            own[: len(root)] = root
        return out

    def _one(self, i: int) -> Floats:
        if i not in self._kept:
            patch: Patch = self._candidates.extra["patches"][i]
            W, mass = self._member(patch.member)
            w = W[patch.rows].reshape(-1, W.shape[2])
            scale = 1.0 / np.sqrt(mass[patch.rows].sum()) if self._candidates.of_unit_mass else 1.0
            self._kept[i] = scale * root_of(w.T @ w)
        return self._kept[i]

    def _member(self, number: int) -> tuple[Floats, Floats]:
        """Roots of the matrices of the elements of one card times their motion; their masses."""
        if number not in self._members:
            structure: Structure = self._candidates.extra["structure"]
            member = structure.members[number]
            every = np.arange(len(member.ids))
            X = self._candidates.matrices(member, every)
            values, vectors = np.linalg.eigh(X)
            rank = int(np.max(np.sum(values > _ROUNDING * values[:, -1:], axis=1), initial=1))
            R = vectors[:, :, -rank:] * np.sqrt(np.maximum(values[:, None, -rank:], 0.0))
            W = np.matmul(R.transpose(0, 2, 1), self._motion[member.coordinates(every)])
            self._members[number] = W, masses(X)
        return self._members[number]


def root_of(A: Floats) -> Floats:
    """Return rows U (q, r) with UᵀU = A (r, r), positive semidefinite, up to a tiny trace."""
    L, pivots, rank, _ = la.lapack.dpstrf(A, tol=_LEFT * float(np.trace(A)), lower=1)
    root = np.zeros((rank, len(A)))
    root[:, pivots - 1] = np.tril(L)[:, :rank].T
    return root


@dataclass(frozen=True, eq=False)
class PatchCandidates(Candidates):
    """Candidates whose matrix is the stiffness or the mass of a patch of elements.

    `described` says where patches are.
    """

    described: Callable[[Structure, Sequence[Patch]], tuple[dict[str, Any], ...]] = field(
        default=lambda structure, patches: where_of(structure, patches)
    )

    def with_patches(self, patches: Sequence[Patch]) -> PatchCandidates:
        """Return the candidates with further patches after those they have."""
        structure: Structure = self.extra["structure"]
        extra = {**self.extra, "patches": [*self.extra["patches"], *patches]}
        if "areas" in extra:
            areas = [area_of(structure, p) for p in patches]
            extra["areas"] = np.concatenate([extra["areas"], areas])
        return replace(
            self,
            xyz=np.concatenate([self.xyz, [p.xyz for p in patches]]),
            where=(*self.where, *self.described(structure, patches)),
            extra=extra,
        )

    def extended(self, known: Rows) -> PatchRows:
        """Return the rows of these candidates from those of the first of them."""
        assert isinstance(known, PatchRows)
        return known.of(self)

    def factors(self, basis: Basis) -> PatchRows:
        """Return the leading rows of a root of each patch's matrix on the basis."""
        return PatchRows(self, basis)

    def full(self, row: int) -> sp.csr_matrix:
        """Return A of one place, (n_free, n_free)."""
        structure: Structure = self.extra["structure"]
        patch = self.extra["patches"][row]
        member = structure.members[patch.member]
        at = member.coordinates(patch.rows)
        X = self.matrices(member, patch.rows)
        X = X / masses(X).sum() if self.of_unit_mass else X
        m = at.shape[1]
        n = structure.displacement.shape[0]
        A = sp.csr_matrix(
            (X.ravel(), (np.repeat(at, m, axis=1).ravel(), np.tile(at, (1, m)).ravel())), (n, n)
        )
        D = structure.displacement
        return (D.T @ A @ D).tocsr()

    def matrices(self, member: Members, rows: Ints) -> Floats:
        """Return the matrices of some elements that the effect changes, (n, m, m)."""
        structure: Structure = self.extra["structure"]
        K, M = member.matrices(rows, np.ones(len(structure.model.parameters)))
        X = K if self.law.on == "K" else M
        assert X is not None
        return X

    @property
    def of_unit_mass(self) -> bool:
        """Whether the matrix of a patch is scaled to unit mass."""
        return isinstance(self.law, MassLaw)


def masses(M: Floats) -> Floats:
    """Masses of elements with the mass matrices M (n, m, m), six coordinates a node, (n,)."""
    along = M[:, ::6, ::6]
    return np.asarray(along.sum(axis=(1, 2)))


def area_of(structure: Structure, patch: Patch) -> float:
    """Area of the shell elements of a patch."""
    x = structure.model.geometry.xyz[structure.members[patch.member].corners[patch.rows]]
    last = x[:, 3] if x.shape[1] == 4 else x[:, 0]
    diagonals = np.cross(x[:, 2] - x[:, 0], last - x[:, 1])
    return float(0.5 * np.linalg.norm(diagonals, axis=1).sum())


def where_of(structure: Structure, patches: Sequence[Patch]) -> tuple[dict[str, list[int]], ...]:
    """Element numbers of each patch."""
    return tuple({"elements": structure.members[p.member].ids[p.rows].tolist()} for p in patches)
