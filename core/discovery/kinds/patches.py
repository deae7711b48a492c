"""Patches of neighbouring elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ...arrays import Floats, Ints
from ..basis import Basis
from ..candidates import Candidates
from ..structure import Structure, thinned

_RANK = 36
_RADII = (0.05, 0.08, 0.13)
_SPACING = 0.35
_MOST = 350


@dataclass(frozen=True, eq=False)
class Patch:
    """Elements of one card around a centre."""

    member: int
    rows: Ints
    xyz: Floats
    radius: float


def patches_of(structure: Structure, size: float, radii: tuple[float, ...] = _RADII) -> list[Patch]:
    """Patches of shell elements of several sizes all over the structure."""
    out = []
    for number, m in enumerate(structure.members):
        if m.shape not in {"quad", "tria"} or not len(m.ids):
            continue
        xyz = structure.centroids(m)
        tree = cKDTree(xyz)
        for r in radii:
            for c in _centres(xyz, _SPACING * r * size):
                rows = np.array(sorted(tree.query_ball_point(xyz[c], r * size)), dtype=np.int64)
                if len(rows) < 0.5 * len(xyz):
                    out.append(Patch(number, rows, xyz[rows].mean(axis=0), r * size))
    return _distinct(out)


def _centres(xyz: Floats, spacing: float) -> Ints:
    chosen = thinned(xyz, spacing)
    while len(chosen) > _MOST:
        spacing *= 1.05 * np.sqrt(len(chosen) / _MOST)
        chosen = thinned(xyz, spacing)
    return chosen


def _distinct(patches: list[Patch]) -> list[Patch]:
    seen: dict[tuple[int, bytes], Patch] = {}
    for p in patches:
        seen.setdefault((p.member, p.rows.tobytes()), p)
    return list(seen.values())


@dataclass(frozen=True, eq=False)
class PatchCandidates(Candidates):
    """Candidates whose matrix is the stiffness or the mass of a patch of elements."""

    def factors(self, basis: Basis) -> Floats:
        """Return the leading rows of a root of each patch's matrix on the basis, (n, q, r)."""
        structure: Structure = self.extra["structure"]
        motion = np.asarray(structure.displacement @ basis.vectors)
        q = min(_RANK, basis.size)
        out = np.zeros((len(self), q, basis.size))
        for i, patch in enumerate(self.extra["patches"]):
            A = np.zeros((basis.size, basis.size))
            member = structure.members[patch.member]
            X = self._matrices(patch)
            u = motion[member.coordinates(patch.rows)]
            A = np.einsum("nir,nij,njs->rs", u, X, u, optimize=True)
            values, vectors = np.linalg.eigh(A)
            out[i] = (vectors[:, -q:] * np.sqrt(np.maximum(values[-q:], 0.0))).T
        return out

    def full(self, row: int) -> sp.csr_matrix:
        """Return A of one place, (n_free, n_free)."""
        structure: Structure = self.extra["structure"]
        patch = self.extra["patches"][row]
        at = structure.members[patch.member].coordinates(patch.rows)
        X = self._matrices(patch)
        m = at.shape[1]
        n = structure.displacement.shape[0]
        A = sp.csr_matrix(
            (X.ravel(), (np.repeat(at, m, axis=1).ravel(), np.tile(at, (1, m)).ravel())), (n, n)
        )
        D = structure.displacement
        return (D.T @ A @ D).tocsr()

    def _matrices(self, patch: Patch) -> Floats:
        structure: Structure = self.extra["structure"]
        member = structure.members[patch.member]
        p = np.ones(len(structure.model.parameters))
        K, M = member.matrices(patch.rows, p)
        if self.law.on == "K":
            assert K is not None
            return K
        assert M is not None
        per_area = self.extra["share"](patch, M)
        return np.asarray(M * per_area)


def where_of(structure: Structure, patches: list[Patch]) -> tuple[dict[str, list[int]], ...]:
    """Element numbers of each patch."""
    return tuple(
        {"elements": structure.members[p.member].ids[p.rows].tolist()} for p in patches
    )
