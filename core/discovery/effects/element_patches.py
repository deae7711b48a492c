"""Patches of neighbouring elements."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import Any, TypeGuard

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ...arrays import Floats, Ints
from ..reduction.elements_and_supports import (
    Members,
    Structure,
    connected,
    placed,
    thinned,
    unit,
)
from ..reduction.reduction_numbers import REDUCTION
from ..reduction.search_basis import Basis
from ..reduction.strain_energies import Energies
from .candidates import Candidates
from .effect_kind import EffectKind
from .effect_laws import FactorLaw, Law, Rows
from .effect_numbers import EFFECTS


@dataclass(frozen=True, eq=False)
class Patch:
    """Elements of one card around a centre; `first` where the first scan looks at it."""

    member: int
    rows: Ints
    xyz: Floats
    first: bool


def patches_of(structure: Structure, size: float, radii: tuple[float, ...]) -> list[Patch]:
    """Patches of shell elements of several sizes all over each sheet of the structure."""
    out: dict[tuple[int, bytes], Patch] = {}
    for number, m in enumerate(structure.members):
        if m.element.dimension != 2 or not len(m.ids):
            continue
        every = structure.centroids(m)
        frames = _frames(structure.model.geometry.xyz[m.corners])
        for sheet in _sheets(structure.model.geometry.xyz, m.corners):
            for patch in _on_sheet(structure, size, radii, number, sheet, every, frames):
                key = number, patch.rows.tobytes()
                if len(patch.rows) < EFFECTS.patch_largest * len(every) and not (
                    key in out and out[key].first >= patch.first
                ):
                    out[key] = patch
    return sorted(out.values(), key=lambda p: not p.first)


def _on_sheet(
    structure: Structure,
    size: float,
    radii: tuple[float, ...],
    number: int,
    sheet: Ints,
    every: Floats,
    frames: Floats,
) -> Iterator[Patch]:
    """Patches of the elements `sheet` (n,) of one card, all of whose are `every` and `frames`."""
    xyz, member = every[sheet], structure.members[number]
    tree = cKDTree(xyz)
    sides = [np.where(np.arange(3) == k, *EFFECTS.patch_sides) for k in (0, 1)]
    middles = xyz[structure.in_order(xyz)]
    grids = structure.model.geometry.xyz[np.unique(member.corners[sheet])]
    centres = np.concatenate([middles, grids[structure.in_order(grids)]])
    nearest = sheet[tree.query(centres)[1]]
    for k, r in enumerate(radii):
        apart, within = EFFECTS.spacing * r * size, np.linalg.norm(sides[0]) * r * size
        wider = EFFECTS.patch_first * apart
        coarse = set(_centres(middles, wider)) if k % 3 == 1 else set()
        some = np.array(sorted({*_centres(centres, apart), *coarse}))
        around = tree.query_ball_point(centres[some], within, return_sorted=True)
        of = np.repeat(np.arange(len(some)), [len(reach) for reach in around])
        own, c = sheet[np.concatenate(around).astype(np.int64)], some[of]
        away = np.einsum("nij,nj->ni", frames[nearest[c]], every[own] - centres[c])
        away = np.abs(away) / (r * size)
        inside = [np.linalg.norm(away, axis=1) <= 1.0]
        inside += [np.all(away <= s, axis=1) for s in sides]
        shapes = zip(*(_parts(own[i], of[i], len(some), every) for i in inside), strict=True)
        for centre, each in zip(some.tolist(), shapes, strict=True):
            for shape, (rows, middle) in enumerate(each):
                if len(rows):
                    first = shape == 0 and centre in coarse
                    yield Patch(number, rows, middle, first)


def _parts(rows: Ints, of: Ints, count: int, xyz: Floats) -> Iterator[tuple[Ints, Floats]]:
    """Give rows by which of `count` sets they are `of`, in order, and the middle of their xyz."""
    size = np.bincount(of, minlength=count)
    total = np.stack([np.bincount(of, x, count) for x in xyz[rows].T], axis=1)
    middles = total / np.maximum(size, 1)[:, None]
    yield from zip(np.split(rows, np.cumsum(size)[:-1]), middles, strict=True)


def _sheets(xyz: Floats, corners: Ints) -> list[Ints]:
    """Return the elements of each sheet: those that go on without a bend across a shared side.

    What a crack, a repair or a doubler changes is one skin, not also the web behind it.
    """
    n, k = corners.shape
    sides = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2))
    across = unit(np.repeat(xyz[corners].mean(axis=1), k, axis=0) - xyz[sides].mean(axis=1))
    order = np.lexsort(sides.T)
    pairs = [np.zeros((2, 0), np.int64)]
    for step in range(1, len(order)):
        a, b = order[:-step], order[step:]
        on = np.all(sides[a] == sides[b], axis=1)
        if not on.any():
            break
        on &= np.sum(across[a] * across[b], axis=1) < -EFFECTS.sheet_bend
        pairs.append(np.stack([a[on], b[on]]) // k)
    return connected(n, *np.concatenate(pairs, axis=1))


def _frames(corners: Floats) -> Floats:
    """Return the first side of shells (n, k, 3), what is across it, and the normal, (n, 3, 3)."""
    along, side = corners[:, 1] - corners[:, 0], corners[:, -1] - corners[:, 0]
    normal = np.cross(along, side)
    return unit(np.stack([along, np.cross(normal, along), normal], axis=1))


def _centres(xyz: Floats, spacing: float) -> Ints:
    chosen = thinned(xyz, spacing)
    while len(chosen) > EFFECTS.patch_centres:
        spacing *= EFFECTS.patch_thinned * np.sqrt(len(chosen) / EFFECTS.patch_centres)
        chosen = thinned(xyz, spacing)
    return chosen


class PatchRows:
    """Rows of a root of each patch's matrix on a basis, made when asked for, then kept.

    A root takes as many rows as pivoted Cholesky needs to leave next to nothing of the trace
    (Higham, *Accuracy and Stability of Numerical Algorithms*, section 10.3); patches that are
    asked for together get rows of zeros where they need fewer.
    """

    def __init__(self, candidates: PatchCandidates, basis: Basis) -> None:
        self._candidates = candidates
        self._motion = np.asarray(candidates.structure.displacement @ basis.vectors)
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
            patch = self._candidates.patches[i]
            W, mass = self._member(patch.member)
            w = W[patch.rows].reshape(-1, W.shape[2])
            scale = 1.0 / np.sqrt(mass[patch.rows].sum()) if self._candidates.law.on == "M" else 1.0
            self._kept[i] = scale * root_of(w.T @ w)
        return self._kept[i]

    def _member(self, number: int) -> tuple[Floats, Floats]:
        """Roots of the matrices of the elements of one card times their motion; their masses."""
        if number not in self._members:
            member = self._candidates.structure.members[number]
            every = np.arange(len(member.ids))
            X = self._candidates.matrices(member, every)
            values, vectors = np.linalg.eigh(X)
            counts = values > REDUCTION.nil * values[:, -1:]
            rank = int(np.max(np.sum(counts, axis=1), initial=1))
            R = vectors[:, :, -rank:] * np.sqrt(np.maximum(values[:, None, -rank:], 0.0))
            W = np.matmul(R.transpose(0, 2, 1), self._motion[member.coordinates(every)])
            self._members[number] = W, masses(X)
        return self._members[number]


def root_of(A: Floats, least: float = EFFECTS.patch_left) -> Floats:
    """Return rows U (q, r) with UᵀU = A (r, r), positive semidefinite, up to a tiny trace."""
    R, pivots, rank, _ = la.lapack.dpstrf(A.T, tol=least * float(np.trace(A)))
    root = np.zeros((rank, len(A)))
    root[:, pivots - 1] = np.triu(R[:rank])
    return root


Described = Callable[[Structure, Sequence[Patch]], tuple[dict[str, Any], ...]]


@dataclass(frozen=True, eq=False, kw_only=True)
class PatchCandidates(Candidates):
    """Candidates whose matrix is the stiffness of a patch of elements, or its mass scaled to one.

    `described` says where patches are, `energies` what their elements hold and how known
    parameters change it, None where the law does not ask.
    """

    structure: Structure
    patches: tuple[Patch, ...]
    described: Described
    energies: Energies | None = None

    @property
    def first(self) -> Ints:
        """Patches marked for a first scan."""
        return np.flatnonzero([p.first for p in self.patches])

    def with_patches(self, patches: Sequence[Patch]) -> PatchCandidates:
        """Return the candidates with further patches after those they have."""
        more = replace(
            self,
            xyz=np.concatenate([self.xyz, [p.xyz for p in patches]]),
            where=(*self.where, *self.described(self.structure, patches)),
            patches=(*self.patches, *patches),
        )
        return more if self.energies is None else more.following(self.energies)

    def following(self, energies: Energies) -> PatchCandidates:
        """Return the candidates as factors on a stiffness that known parameters change."""
        held = np.array([energies[p.member][p.rows].sum(axis=0) for p in self.patches])
        slopes = held[:, 1:] / np.maximum(held[:, :1], np.finfo(float).tiny)
        return replace(self, law=FactorLaw(slopes), energies=energies)

    def extended(self, known: Rows) -> PatchRows:
        """Return the rows of these candidates from those of the first of them."""
        assert isinstance(known, PatchRows)
        return known.of(self)

    def factors(self, basis: Basis) -> PatchRows:
        """Return the leading rows of a root of each patch's matrix on the basis."""
        return PatchRows(self, basis)

    def acting(self, row: int) -> sp.csr_matrix:
        """Return A of one place, (n_free, n_free)."""
        patch = self.patches[row]
        member = self.structure.members[patch.member]
        X = self.matrices(member, patch.rows)
        X = X / masses(X).sum() if self.law.on == "M" else X
        D = self.structure.displacement
        A = placed(D.shape[0], member.coordinates(patch.rows), X)
        return (D.T @ A @ D).tocsr()

    def matrices(self, member: Members, rows: Ints) -> Floats:
        """Return the matrices of some elements that the effect changes, (n, m, m)."""
        of = member.stiffness if self.law.on == "K" else member.mass
        return of(rows, self.structure.model.deck_point)


def gives(c: Candidates) -> TypeGuard[PatchCandidates]:
    """Whether candidates are patches of more or less stiffness."""
    return isinstance(c, PatchCandidates) and c.law.on == "K"


def masses(M: Floats) -> Floats:
    """Masses of elements with the mass matrices M (n, m, m), six coordinates a node, (n,)."""
    along = M[:, ::6, ::6]
    return np.asarray(along.sum(axis=(1, 2)))


def area_of(structure: Structure, patch: Patch) -> float:
    """Area of the shell elements of a patch."""
    x = structure.model.geometry.xyz[structure.members[patch.member].corners[patch.rows]]
    across = np.cross(x[:, 2] - x[:, 0], x[:, -1] - x[:, 1])
    return float(0.5 * np.linalg.norm(across, axis=1).sum())


def where_of(structure: Structure, patches: Sequence[Patch]) -> tuple[dict[str, Any], ...]:
    """Element numbers of each patch."""
    return tuple({"elements": structure.members[p.member].ids[p.rows].tolist()} for p in patches)


def on_patches(
    kind: EffectKind,
    structure: Structure,
    patches: Sequence[Patch],
    law: Law,
    trials: Floats,
    prior: tuple[Floats, Floats],
    described: Described = where_of,
) -> tuple[PatchCandidates, ...]:
    """Return a kind of effect on patches, none where there are no patches; see `Candidates`.

    `prior` are `typical` and `spread`, each (1,).
    """
    if not patches:
        return ()
    made = PatchCandidates(
        kind=kind,
        xyz=np.array([p.xyz for p in patches]),
        law=law,
        trials=trials,
        root=sp.csr_matrix((0, structure.model.n_free)),
        rows_each=0,
        where=described(structure, patches),
        typical=prior[0],
        spread=prior[1],
        structure=structure,
        patches=tuple(patches),
        described=described,
    )
    return (made,)
