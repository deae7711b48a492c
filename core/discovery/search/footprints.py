"""The footprint of an attached mass on a shell: its middle and radius, finer than the mesh.

A mass that sits between grids, or is spread over a hand's breadth, moves as the skin under it
does. Put on the nearest grid it hangs on the skin's own softness there, which moves the higher
modes too far, so that it is fitted too small and the known parameters make up for the rest. So the
masses of a hypothesis that earned its place are laid on discs, each grid with its share of the
area, whose middles and radii are fitted together with all else. Places alike get discs alike.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.spatial import Delaunay, QhullError, cKDTree

from ...arrays import Bools, Floats, Ints
from ..effects import distributed_mass, point_mass
from ..effects.candidates import Candidates, Suspect, places_of, together
from ..effects.effect_laws import Law, MassLaw
from ..effects.element_patches import Patch, PatchCandidates
from ..effects.structure_points import translations
from ..likelihood.hypothesis import Fit
from ..reduction.elements_and_supports import Structure
from ..reduction.own_axes import own_axes
from ..reduction.reduction_numbers import REDUCTION
from .moves import Searcher
from .search_numbers import SEARCH

_TURN = np.pi * (3.0 - np.sqrt(5.0))
"""The golden angle: points on a spiral that turn by it fill a disc evenly (Vogel 1979)."""


@dataclass(frozen=True, eq=False)
class Surroundings:
    """The grids of a shell around a place, laid flat.

    Parameters
    ----------
    grids : (n,) int
        Rows of the geometry.
    xyz : (n, 3) float
    middle, axes : (3,), (2, 3) float
        Of the plane that they are laid on.
    place : (3,) float
    mesh : float
        Side of an element.
    """

    grids: Ints
    xyz: Floats
    middle: Floats
    axes: Floats
    place: Floats
    mesh: float

    @cached_property
    def at(self) -> Floats:
        """Return the place laid flat, (2,)."""
        return self.laid(self.place)

    @cached_property
    def cells(self) -> Delaunay:
        """Return the triangles among the grids."""
        return Delaunay(self.laid(self.xyz))

    def shares(self, theta: Floats) -> Floats:
        """Return the shares of the grids in a disc, (n,).

        `theta` (3,): its middle from the place, and ln of its radius, in sides of an element.
        """
        return shares(self.cells, self.at + self.mesh * theta[:2], self.radius(theta))

    def radius(self, theta: Floats) -> float:
        """Return the radius of a disc."""
        return self.mesh * float(np.exp(theta[2]))

    def within(self, theta: Floats, xyz: Floats) -> Bools:
        """Return whether points (n, 3) lie in a disc, (n,)."""
        away = self.laid(xyz) - self.at - self.mesh * theta[:2]
        return np.asarray(np.linalg.norm(away, axis=1) < self.radius(theta))

    def laid(self, xyz: Floats) -> Floats:
        """Return points (n, 3) laid flat, (n, 2)."""
        return np.asarray((xyz - self.middle) @ self.axes.T)


@dataclass(frozen=True, eq=False)
class FootLaw(Law):
    """A mass m = e^θ₀ on a disc, whose middle and radius θ₁ to θ₃ are; see `Surroundings`.

    Of twins the same `around` each of their places. It is for a basis that has the response to
    each grid.
    """

    around: tuple[Surroundings, ...]
    on = "M"

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return the mass at each grid, in each of three directions."""
        each = (np.stack(_padded([a.shares(t[1:]) for a in self.around])) for t in theta)
        return np.array(
            [np.repeat(np.exp(t[0]) * e.ravel(), 3) for t, e in zip(theta, each, strict=True)]
        )

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return its derivatives, those of the shares by central differences."""
        h = SEARCH.foot_step * np.eye(theta.shape[1])[1:]
        moved = [(self.value(theta + d, rows) - self.value(theta - d, rows)) for d in h]
        return np.stack(
            [self.value(theta, rows), *(m / (2.0 * SEARCH.foot_step) for m in moved)], 1
        )


def footed(searcher: Searcher, structure: Structure, state: Fit) -> tuple[Searcher, Fit]:
    """Return a hypothesis with its masses on discs to be fitted, and one who knows them."""
    suspects = []
    point = next((c for c in searcher.problem.catalogue if c.kind is point_mass.KIND), None)
    for s in state.suspects:
        c = searcher.problem.catalogue[s.kind]
        own = c if c.kind is point_mass.KIND else point if c.kind.joins(point_mass.KIND) else None
        around = surroundings_of_each(structure, c, s.row) if own else ()
        if own and around:
            s = Suspect(len(searcher.problem.catalogue), 0, (s.theta[0], *SEARCH.foot[0]))
            searcher = searcher.with_kind(s.kind, _free(structure, own, around))
        suspects.append(s)
    return searcher, replace(state, suspects=tuple(suspects))


def at_the_edge(searcher: Searcher, state: Fit) -> bool:
    """Whether the middle of a fitted disc went as far as it may: there is more beyond."""
    reach = SEARCH.foot_edge * np.array(SEARCH.foot[3][:2])
    laws = ((s, searcher.problem.catalogue[s.kind].law) for s in state.suspects)
    discs = (s for s, law in laws if isinstance(law, FootLaw))
    return any(np.any(np.abs(s.theta[1:3]) > reach) for s in discs)


def settled(searcher: Searcher, structure: Structure, state: Fit) -> tuple[Searcher, Fit]:
    """Return a hypothesis with its masses on the discs that were fitted, and one who knows them.

    On a disc wider than what counts as attached a mass is spread over the elements there.
    """
    suspects = []
    for s in state.suspects:
        c = searcher.problem.catalogue[s.kind]
        if isinstance(c.law, FootLaw):
            (around, *more), theta = c.law.around, np.array(s.theta[1:])
            s = replace(s, theta=s.theta[:1])
            wide = not more and around.radius(theta) > SEARCH.spread_mass * searcher.size
            patched = _spread(searcher, structure, around, theta) if wide else None
            if patched is None:
                searcher = searcher.with_kind(s.kind, _disc(structure, c, c.law.around, theta))
            else:
                searcher, kind = patched
                s = replace(s, kind=kind, row=len(searcher.problem.catalogue[kind]) - 1)
        suspects.append(s)
    return searcher, replace(state, suspects=tuple(suspects))


def _spread(
    searcher: Searcher, structure: Structure, around: Surroundings, theta: Floats
) -> tuple[Searcher, int] | None:
    """Put the elements of a disc among the places of spread masses; None where there are none."""
    kinds = [
        number
        for number, c in enumerate(searcher.problem.catalogue)
        if isinstance(c, PatchCandidates) and c.kind is distributed_mass.KIND
    ]
    near: list[Patch] = []
    for number, m in enumerate(structure.members):
        if m.element.dimension == 2:
            xyz = structure.centroids(m)
            rows = np.flatnonzero(
                around.within(theta, xyz) & np.isin(m.corners, around.grids).all(1)
            )
            near += [Patch(number, rows, xyz[rows].mean(axis=0), False)] if len(rows) else []
    if not kinds or not near:
        return None
    largest = max(near, key=lambda p: len(p.rows))
    return searcher.with_patches(kinds[0], [largest]), kinds[0]


def surroundings_of_each(structure: Structure, c: Candidates, row: int) -> tuple[Surroundings, ...]:
    """Return the surroundings of each place of one of some candidates, none where one has none.

    They lie the same way on each place as on the first.
    """
    found = [surroundings(structure, own.xyz[i]) for own, i in places_of(c, row)]
    kept = [a for a in found if a is not None]
    turns = np.eye(3)[None] if c.maps is None else c.maps
    both = zip(kept, turns, strict=False)
    alike = tuple(replace(a, axes=kept[0].axes @ turn.T) for a, turn in both)
    return alike if len(alike) == len(found) else ()


def surroundings(structure: Structure, xyz: Floats) -> Surroundings | None:
    """Return the grids of shells around a place (3,), None where it is on none."""
    g = structure.model.geometry
    shells = [m.corners.ravel() for m in structure.members if m.element.dimension == 2]
    if not shells:
        return None
    grids = np.unique(np.concatenate(shells))
    tree = cKDTree(g.xyz[grids])
    near, _ = tree.query(g.xyz[grids[tree.query(xyz)[1]]], min(SEARCH.foot_near, len(grids)))
    mesh = float(near[-1])
    if mesh == 0.0 or tree.query(xyz)[0] > mesh:
        return None
    own = grids[tree.query_ball_point(xyz, SEARCH.foot_reach * mesh)]
    middle = g.xyz[own].mean(axis=0)
    found = Surroundings(own, g.xyz[own], middle, _laid_along(g.xyz, own), xyz, mesh)
    try:
        found.shares(np.zeros(3))
    except (QhullError, ValueError):
        return None
    return found


def _laid_along(xyz: Floats, own: Ints) -> Floats:
    """Return the axes of the plane through some grids, along the structure's own, (2, 3).

    A breath askew, so that which diagonal halves a square does not hang on rounding.
    """
    _, _, axes = np.linalg.svd(xyz[own] - xyz[own].mean(axis=0), full_matrices=False)
    flat = own_axes(xyz) @ axes[:2].T @ axes[:2]
    length = np.round(np.linalg.norm(flat, axis=1) / REDUCTION.alike)
    first, second = flat[np.sort(np.argsort(-length, kind="stable")[:2])]
    first = first / np.linalg.norm(first)
    second = second - first * (second @ first)
    second = second / np.linalg.norm(second)
    return np.array([first + SEARCH.foot_askew * second, second])


def shares(cells: Delaunay, middle: Floats, radius: float) -> Floats:
    """Return the shares of the corners of a triangulation in the area of a disc, (n,)."""
    k = np.arange(SEARCH.foot_points) + 0.5
    r, turn = radius * np.sqrt(k / len(k)), k * _TURN
    points = middle + np.stack([r * np.cos(turn), r * np.sin(turn)], axis=1)
    found = cells.find_simplex(points)
    points, found = points[found >= 0], found[found >= 0]
    T = cells.transform[found]
    two = np.einsum("nij,nj->ni", T[:, :2], points - T[:, 2])
    three = np.concatenate([two, 1.0 - two.sum(axis=1, keepdims=True)], axis=1)
    each = np.bincount(
        cells.simplices[found].ravel(), np.maximum(three, 0.0).ravel(), len(cells.points)
    )
    return np.asarray(each / max(each.sum(), np.finfo(float).tiny))


def _free(structure: Structure, c: Candidates, around: Sequence[Surroundings]) -> Candidates:
    """Return a mass on a disc about a place or several, its middle and radius to be fitted."""
    grids = [a.grids for a in around]
    (typical, spread, steps, reach) = map(np.array, SEARCH.foot)
    free = Candidates(
        kind=c.kind,
        xyz=np.array([a.xyz.mean(axis=0) for a in around]),
        law=FootLaw(tuple(around)),
        trials=c.trials[:, :1],
        **_rows(structure, grids, [np.ones(len(g)) for g in grids]),
        where=tuple({"grids": structure.model.geometry.ids[g].tolist()} for g in grids),
        typical=np.append(c.typical[0], typical),
        spread=np.append(c.spread[0], spread),
        steps=np.append(1.0, steps),
        lower=np.append(-np.inf, typical - reach),
        upper=np.append(np.inf, typical + reach),
    )
    return _alike(free, c)


def _disc(
    structure: Structure, c: Candidates, around: Sequence[Surroundings], theta: Floats
) -> Candidates:
    """Return a mass on a disc, or on several alike, that stays."""
    share = [a.shares(theta) for a in around]
    kept = [np.flatnonzero(s > SEARCH.foot_share) for s in share]
    share = [s[k] / s[k].sum() for s, k in zip(share, kept, strict=True)]
    own = [a.grids[k] for a, k in zip(around, kept, strict=True)]
    ids, each = structure.model.geometry.ids, list(zip(around, own, share, strict=True))
    disc = Candidates(
        kind=c.kind,
        xyz=np.array([s @ a.xyz[k] for a, s, k in zip(around, share, kept, strict=True)]),
        law=MassLaw(),
        trials=c.trials[:, :1],
        **_rows(structure, own, [np.sqrt(s) for s in share]),
        where=tuple(
            {"grids": ids[g].tolist(), "shares": s.tolist(), "radius": a.radius(theta)}
            for a, g, s in each
        ),
        typical=c.typical[:1],
        spread=c.spread[:1],
    )
    return _alike(disc, c)


def _rows(structure: Structure, grids: Sequence[Ints], sizes: Sequence[Floats]) -> dict[str, Any]:
    """Return root and number of rows of places on some grids each, those of few padded."""
    n = max(map(len, grids))
    row = np.concatenate([k * n + np.arange(len(g)) for k, g in enumerate(grids)])
    shape = n * len(grids), len(structure.model.geometry.ids)
    points = sp.csr_matrix((np.concatenate(sizes), (row, np.concatenate(grids))), shape)
    return {"root": translations(structure, points), "rows_each": 3 * n}


def _padded(each: Sequence[Floats]) -> list[Floats]:
    n = max(map(len, each))
    return [np.pad(a, (0, n - len(a))) for a in each]


def _alike(each: Candidates, c: Candidates) -> Candidates:
    """Return discs as one where they are those of twins."""
    return each if len(each) == 1 else together(each, np.arange(len(each))[None], c.maps)
