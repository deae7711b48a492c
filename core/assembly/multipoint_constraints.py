"""Elimination of dependent, fixed and unsupported degrees of freedom."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..arrays import Bools, Floats, Ints
from ..errors import Place
from ..numerics.shared_pattern_sum import select

_ALONG = 1.0 - 1e-6
"""Share of a direction in one component from which it is that component's."""

_NOTHING = 1e-13
"""Stiffness beside the largest of the same grid that is rounding."""


@dataclass(frozen=True, eq=False)
class Equations:
    """Linear constraints, each of which gives one dependent degree of freedom.

    ``u[dependent] = matrix @ u``; the right side may hold other dependent ones.

    Parameters
    ----------
    dependent : (m,) int
        Degree of freedom that each equation gives.
    matrix : (m, n_dof) sparse
        Coefficients.
    owner : tuple of Place
        Which element or card makes each equation, for messages.
    """

    dependent: Ints
    matrix: sp.csr_matrix
    owner: tuple[Place, ...]


@dataclass(frozen=True, eq=False)
class Reduction:
    """Displacements u of all degrees of freedom from those that are left, u = expansion @ q.

    Parameters
    ----------
    expansion : (n_dof, n_free) csr_matrix
        Identity in the rows `kept`, combinations in the dependent rows, zero in fixed rows.
    kept : (n_free,) int
        Which degree of freedom each q is.
    """

    expansion: sp.csr_matrix
    kept: Ints

    def apply(self, matrices: Sequence[sp.csr_matrix]) -> list[sp.csr_matrix]:
        """Return E^T A E for symmetric A, several at a time.

        Cheap for matrices without entries at dependent degrees of freedom: a part of each.
        """
        n, n_free = self.expansion.shape
        if n_free == n:
            return list(matrices)
        others = np.diff(self.expansion.indptr) > 0
        others[self.kept] = False
        rows = np.flatnonzero(others)
        out = select(matrices, self.kept)
        if not len(rows):
            return out
        D = self.expansion[rows]
        for k, matrix in enumerate(matrices):
            part = matrix[rows]
            if part.nnz:
                cross = D.T @ part[:, self.kept]
                out[k] = (out[k] + cross + cross.T + D.T @ part[:, rows] @ D).tocsr()
        return out

    def drop(self, free: Ints) -> Reduction:
        """Fix the free degrees of freedom of the given numbers as well."""
        left = np.setdiff1d(np.arange(len(self.kept)), free)
        return Reduction(self.expansion[:, left].tocsr(), self.kept[left])


def reduction(
    n_dof: int, equations: Equations, fixed: Bools, label: Callable[[int], str]
) -> Reduction:
    """Eliminate dependent and fixed degrees of freedom.

    Parameters
    ----------
    n_dof : int
        Number of degrees of freedom.
    equations : Equations
        Chains (a dependent degree of freedom on the right side) are resolved.
    fixed : (n_dof,) bool
        Degrees of freedom held at zero.
    label : callable
        Names a degree of freedom in messages.

    Raises
    ------
    InputError
        A degree of freedom that two equations give, or one equation and a constraint; equations
        that depend on each other without solution.
    """
    m = len(equations.dependent)
    _check_single(equations, fixed, label)
    is_dependent = np.zeros(n_dof, dtype=bool)
    is_dependent[equations.dependent] = True
    kept = np.flatnonzero(~is_dependent & ~np.asarray(fixed))
    free = sp.csr_matrix(
        (np.ones(len(kept)), (kept, np.arange(len(kept)))), shape=(n_dof, len(kept))
    )
    if not m:
        return Reduction(free, kept)
    right = equations.matrix.tocsr()
    chained = right[:, equations.dependent]
    direct = (right @ sp.diags((~is_dependent).astype(float))).tocsr()
    combined = _resolve(chained, direct, equations, label)
    place = sp.csr_matrix((np.ones(m), (equations.dependent, np.arange(m))), shape=(n_dof, m))
    expansion = (free + place @ (combined @ free)).tocsr()
    expansion.eliminate_zeros()
    return Reduction(expansion, kept)


def _check_single(equations: Equations, fixed: Bools, label: Callable[[int], str]) -> None:
    owner: dict[int, Place] = {}
    for dof, name in zip(equations.dependent.tolist(), equations.owner, strict=True):
        if dof in owner:
            both = f"{owner[dof]} and {name}" if owner[dof] != name else f"{name} twice"
            raise name.about(
                f"{label(dof)} (grid:component) is made dependent by {both}: it can be dependent "
                "on one only"
            )
        owner[dof] = name
    both_ways = [d for d in owner if fixed[d]]
    if both_ways:
        raise owner[both_ways[0]].about(
            f"{label(both_ways[0])} (grid:component) is dependent in {owner[both_ways[0]]} and "
            "constrained by an SPC as well: constrain the independent grid instead"
        )


def _resolve(
    chained: sp.csr_matrix, direct: sp.csr_matrix, equations: Equations, label: Callable[[int], str]
) -> sp.csr_matrix:
    """Solve G = direct + chained G."""
    chained.eliminate_zeros()
    if not chained.nnz:
        return direct
    from scipy.sparse import csgraph

    n_parts, part = csgraph.connected_components(chained, connection="strong")
    if n_parts < chained.shape[0] or chained.diagonal().any():
        return _resolve_cycle(chained, direct, equations, part)
    combined, power = direct, direct
    while power.nnz:
        power = chained @ power
        combined = combined + power
    return combined.tocsr()


def _resolve_cycle(
    chained: sp.csr_matrix, direct: sp.csr_matrix, equations: Equations, part: Ints
) -> sp.csr_matrix:
    """Equations that refer to each other: solved together, as long as they determine a solution."""
    from scipy.sparse import linalg as spla

    system = (sp.identity(chained.shape[0]) - chained).tocsc()
    counts = np.bincount(part)
    ring = np.flatnonzero(counts[part] > 1)
    ring = ring if len(ring) else np.flatnonzero(chained.diagonal())
    owners = list(dict.fromkeys(equations.owner[k] for k in ring))
    try:
        factor = spla.splu(system)
        pivots = np.abs(factor.U.diagonal())
        if pivots.min() <= 1e-12 * pivots.max():
            raise RuntimeError
    except RuntimeError:
        raise owners[0].about(
            f"{', '.join(map(str, owners[:6]))} depend on each other in a circle, so none of them "
            "is determined: make another grid the dependent one"
        ) from None
    columns = np.unique(direct.indices)
    solved = factor.solve(direct[:, columns].toarray())
    solved[np.abs(solved) < 1e-14 * np.abs(solved).max()] = 0.0
    found = sp.coo_matrix(solved)
    return sp.csr_matrix((found.data, (found.row, columns[found.col])), shape=direct.shape)


def unsupported(
    stiffness: sp.csr_matrix,
    triple: Ints,
    member: Ints,
    mass: sp.csr_matrix | None,
    ratio: float,
    turning: Bools | None = None,
) -> Ints:
    """Find degrees of freedom along which a grid has no stiffness, alone of all its neighbours.

    The three translations of a grid, and its three rotations, are looked at together: for each
    direction in which their 3 x 3 stiffness is singular the strongest component is taken. A weak
    rotation about a direction between the components, as about the normal of a curved shell, is
    left alone unless it has no stiffness at all: to fix one component there would tie the
    structure to the ground by what little there is.

    Parameters
    ----------
    stiffness : (n, n) sparse
        Symmetric.
    triple, member : (n,) int
        Which triple each degree of freedom belongs to (-1: none, looked at alone), and which of
        its three members it is.
    mass : (n, n) sparse or None
        When given, only directions without mass are taken.
    ratio : float
        Smallest stiffness relative to the largest of the same triple that counts as stiffness.
    turning : (n,) bool, optional
        Which are rotations.

    Returns
    -------
    (k,) int
        Degrees of freedom, increasing.
    """
    diagonal = stiffness.diagonal()
    alone = (triple < 0) & (diagonal == 0.0)
    if mass is not None:
        alone &= mass.diagonal() == 0.0
    found = [np.flatnonzero(alone)]
    ids, number = np.unique(triple[triple >= 0], return_inverse=True)
    dof = np.full((len(ids), 3), -1, dtype=np.int64)
    rows = np.flatnonzero(triple >= 0)
    dof[number, member[rows]] = rows
    K = _blocks(stiffness, dof)
    M = None if mass is None else _blocks(mass, dof)
    absent = dof < 0
    turns = np.zeros(len(ids), bool)
    if turning is not None:
        turns[number] = turning[rows]
    for _ in range(3):
        trial = _unit_size(K) if M is None else _unit_size(K) + _unit_size(M)
        trial[absent[:, :, None] & np.eye(3, dtype=bool)] = 1.0
        values, vectors = np.linalg.eigh(trial)
        fixed = ~turns | (np.abs(vectors[:, :, 0]).max(axis=1) > _ALONG)
        weak = values[:, 0] < np.where(fixed, ratio, min(ratio, _NOTHING))
        which = np.flatnonzero(weak & ~absent.all(axis=1))
        if not len(which):
            break
        direction = np.where(absent, 0.0, vectors[:, :, 0])[which]
        strongest = np.argmax(np.abs(direction), axis=1)
        found.append(dof[which, strongest])
        absent[which, strongest] = True
        for X in (K, M):
            if X is not None:
                X[which, strongest, :] = X[which, :, strongest] = 0.0
    return np.sort(np.concatenate(found))


def _unit_size(K: Floats) -> Floats:
    """Blocks scaled so that the largest diagonal term of each is one."""
    size = np.abs(np.einsum("nii->ni", K)).max(axis=1, initial=0.0)
    return np.asarray(K / np.where(size > 0.0, size, 1.0)[:, None, None])


def _blocks(matrix: sp.csr_matrix, dof: Ints) -> Floats:
    """Dense 3 x 3 blocks of a sparse matrix, (n, 3, 3); zero where a member is absent."""
    out = np.zeros((len(dof), 3, 3))
    if not len(dof):
        return out
    place = np.full(matrix.shape[0], -1, dtype=np.int64)
    inside = dof >= 0
    place[dof[inside]] = (np.arange(len(dof))[:, None] * 3 + np.arange(3))[inside]
    entries = matrix.tocoo()
    row, column = place[entries.row], place[entries.col]
    same = (row >= 0) & (column >= 0) & (row // 3 == column // 3)
    out[row[same] // 3, row[same] % 3, column[same] % 3] = entries.data[same]
    return out
