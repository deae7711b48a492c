"""Patches of neighbouring elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ...arrays import Floats, Ints
from ..basis import Basis
from ..candidates import Candidates
from ..structure import Members, Structure, thinned

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
        for number, member in enumerate(structure.members):
            own = [i for i, p in enumerate(self.extra["patches"]) if p.member == number]
            if not own:
                continue
            used = np.unique(np.concatenate([self.extra["patches"][i].rows for i in own]))
            X = self._matrices(member, used)
            place = np.full(len(member.ids), -1, np.int64)
            place[used] = np.arange(len(used))
            at = member.coordinates(used)
            for i in own:
                patch: Patch = self.extra["patches"][i]
                rows = place[patch.rows]
                u = motion[at[rows]]
                Xu = np.matmul(X[rows], u)
                A = u.reshape(-1, basis.size).T @ Xu.reshape(-1, basis.size)
                values, vectors = np.linalg.eigh(A * self._share(patch, X[rows]))
                root = vectors[:, -q:] * np.sqrt(np.maximum(values[-q:], 0.0))
                out[i] = root.T
        return out

    def full(self, row: int) -> sp.csr_matrix:
        """Return A of one place, (n_free, n_free)."""
        structure: Structure = self.extra["structure"]
        patch = self.extra["patches"][row]
        member = structure.members[patch.member]
        at = member.coordinates(patch.rows)
        X = self._matrices(member, patch.rows)
        X = X * self._share(patch, X)
        m = at.shape[1]
        n = structure.displacement.shape[0]
        A = sp.csr_matrix(
            (X.ravel(), (np.repeat(at, m, axis=1).ravel(), np.tile(at, (1, m)).ravel())), (n, n)
        )
        D = structure.displacement
        return (D.T @ A @ D).tocsr()

    def _matrices(self, member: Members, rows: Ints) -> Floats:
        structure: Structure = self.extra["structure"]
        K, M = member.matrices(rows, np.ones(len(structure.model.parameters)))
        X = K if self.law.on == "K" else M
        assert X is not None
        return X

    def _share(self, patch: Patch, X: Floats) -> float:
        """Return the factor that gives a patch of masses unit mass; 1 for stiffness."""
        share = self.extra.get("share")
        return 1.0 if share is None else float(share(patch, X))


def where_of(structure: Structure, patches: list[Patch]) -> tuple[dict[str, list[int]], ...]:
    """Element numbers of each patch."""
    return tuple({"elements": structure.members[p.member].ids[p.rows].tolist()} for p in patches)
