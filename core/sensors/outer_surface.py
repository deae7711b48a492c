"""The outer surface of a model: what a sensor can lie on."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..arrays import Bools, Floats, Ints, Numbers
from ..data.geometry import Geometry
from ..data.shapes import SHAPES
from ..errors import InputError
from ..noun import Noun

POINT, LINE, TRIA, QUAD = 1, 2, 3, 4
"""Shape of a facet, equal to its number of corners."""


@dataclass(frozen=True, eq=False)
class Surface(Noun):
    """Facets of a geometry with the trees that find them.

    Parameters
    ----------
    xyz : (n_grid, 3) float
        All grids of the geometry.
    corners : (n_facet, 4) int
        Rows of `xyz`; the last corner is repeated where a facet has fewer than four.
    kind : (n_facet,) int
        `POINT`, `LINE`, `TRIA` or `QUAD`.
    solid : (n_facet,) bool
        Whether the facet is the face of a solid, where grids have no rotations of their own.
    attached : (n_attached,) int
        Rows of the grids that belong to an element.
    size : float
        Diagonal of the bounding box of the attached grids.
    levels : tuple of (tree, facets, radius)
        Facet centres sorted into classes of like size, so that a search can be bounded tightly.
    grid_tree : cKDTree
        Over `xyz[attached]`.
    """

    xyz: Floats
    corners: Ints
    kind: Ints
    solid: Bools
    attached: Ints
    size: float
    levels: tuple[tuple[cKDTree, Ints, float], ...]
    grid_tree: cKDTree

    def nearest_grid(self, points: Floats) -> tuple[Ints, Floats]:
        """Row of the nearest attached grid, (n,), and its distance, (n,)."""
        distance, found = self.grid_tree.query(points)
        return self.attached[found], distance

    def mesh_size(self, facets: Ints) -> Floats:
        """Length of the longest side of each facet, (n,); 0 for points."""
        p = self.xyz[self.corners[facets]]
        return np.asarray(np.sqrt(((np.roll(p, -1, axis=1) - p) ** 2).sum(axis=2).max(axis=1)))

    def directions(self, facets: Ints, Ns: Floats, Nt: Floats) -> Floats:
        """Return unit normals of faces, directions of lines, zero for points, (n, 3).

        Where derivatives of the shape functions are `Ns` and `Nt`, each (n, 4).
        """
        kind, p = self.kind[facets], self.xyz[self.corners[facets]]
        gs, gt = np.einsum("nc,ncx->nx", Ns, p), np.einsum("nc,ncx->nx", Nt, p)
        along = np.where((kind >= TRIA)[:, None], np.cross(gs, gt), gs)
        along = np.where((kind == POINT)[:, None], 0.0, along)
        length = np.asarray(np.linalg.norm(along, axis=1, keepdims=True))
        return np.divide(along, length, out=np.zeros_like(along), where=length > 0)

    @property
    def extent(self) -> Floats:
        """Bounding box of the attached grids, (2, 3): smallest and largest coordinates."""
        used = self.xyz[self.attached]
        return np.array([used.min(axis=0), used.max(axis=0)])

    def samples(self, count: int) -> tuple[Floats, Ints]:
        """Return about `count` points spread evenly over the facets, (n, 3), and their facets.

        Facet centres, thinned or repeated at quarter points so that no region is left out. Only
        a first guess for a search; exact feet come from `place`.
        """
        weight = _content(self.xyz, self.corners, self.kind)
        if not np.any(weight > 0):
            weight = np.ones(len(self.kind))
        steps = np.cumsum(weight) / weight.sum()
        where = (np.arange(count) + 0.5) / count
        facets = np.searchsorted(steps, where).clip(0, len(self.kind) - 1)
        # Golden-ratio (R2) sequence inside the facets: even without a random generator.
        s = (np.arange(count) * 0.7548776662466927) % 1.0
        t = (np.arange(count) * 0.5698402909980532) % 1.0
        s, t = fold_tria(self.kind[facets], s, t)
        N = shape_functions(self.kind[facets], s, t)[0]
        return np.einsum("nc,ncx->nx", N, self.xyz[self.corners[facets]]), facets


def surface_of(
    geometry: Geometry, usable: Bools | None = None, alone: Bools | None = None
) -> Surface:
    """Make the surface of a geometry: shells, beams, points and the outer faces of solids.

    Parameters
    ----------
    geometry : Geometry
        Elements by shape. A geometry without elements becomes one point facet a grid.
    usable : (n_grid,) bool, optional
        Grids that may carry a sensor (default all); elements with any other corner are left out.
    alone : (n_grid,) bool, optional
        Grids that a sensor may sit on though no element is drawn to them, such as the end of a
        rigid element (default none).

    Raises
    ------
    InputError
        No grid can carry a sensor.
    """
    xyz = geometry.xyz
    usable = np.ones(len(xyz), bool) if usable is None else np.asarray(usable, bool)
    if not usable.any():
        raise InputError("the analysis model has no grid with displacements to place a sensor on")
    parts: list[tuple[Ints, int, bool]] = []
    for name, kind in (("quad", QUAD), ("tria", TRIA), ("line", LINE), ("point", POINT)):
        if name in geometry.elements:
            parts.append((geometry.elements[name].reshape(-1, kind), kind, False))
    parts += [(faces, faces.shape[1], True) for faces in outer_faces(geometry)]
    if alone is not None:
        drawn = np.zeros(len(xyz), bool)
        for c, _, _ in parts:
            drawn[c] = True
        parts.append((np.flatnonzero(alone & ~drawn)[:, None], POINT, False))
    parts = [(c[usable[c].all(axis=1)], kind, solid) for c, kind, solid in parts]
    parts = [part for part in parts if len(part[0])]
    if not parts:
        parts = [(np.flatnonzero(usable)[:, None], POINT, False)]
    corners = np.concatenate([padded(c) for c, _, _ in parts])
    kinds = np.concatenate([np.full(len(c), k, np.int64) for c, k, _ in parts])
    solid = np.concatenate([np.full(len(c), s) for c, _, s in parts])
    attached = np.unique(corners)
    size = float(np.linalg.norm(np.ptp(xyz[attached], axis=0)))
    tree = cKDTree(xyz[attached], balanced_tree=False, compact_nodes=False)
    return Surface(xyz, corners, kinds, solid, attached, size, _levels(xyz, corners), tree)


def shape_functions(kind: Ints, s: Floats, t: Floats) -> tuple[Floats, Floats, Floats]:
    """Shape functions and their derivatives by s and t, each (n, 4).

    Quads are bilinear on 0..1 x 0..1, corners in turn at (0,0) (1,0) (1,1) (0,1); trias have
    N = (1-s-t, s, t); lines N = (1-s, s); points N = (1).
    """
    n = len(s)
    N, Ns, Nt = np.zeros((n, 4)), np.zeros((n, 4)), np.zeros((n, 4))
    q = kind == QUAD
    a, b = s[q], t[q]
    N[q] = np.stack([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b], axis=1)
    Ns[q] = np.stack([b - 1, 1 - b, b, -b], axis=1)
    Nt[q] = np.stack([a - 1, -a, a, 1 - a], axis=1)
    q = kind == TRIA
    N[q, :3] = np.stack([1 - s[q] - t[q], s[q], t[q]], axis=1)
    Ns[q, :2] = [-1, 1]
    Nt[q, 0], Nt[q, 2] = -1, 1
    q = kind == LINE
    N[q, :2] = np.stack([1 - s[q], s[q]], axis=1)
    Ns[q, :2] = [-1, 1]
    N[kind == POINT, 0] = 1
    return N, Ns, Nt


def fold_tria(kind: Ints, s: Floats, t: Floats) -> tuple[Floats, Floats]:
    """Fold points of the unit square into the unit triangle where the facet is a tria."""
    out = (kind == TRIA) & (s + t > 1)
    return np.where(out, 1 - s, s), np.where(out, 1 - t, t)


def padded(corners: Ints) -> Ints:
    """Return the corners of facets four a row, the last one repeated."""
    last = np.repeat(corners[:, -1:], 4 - corners.shape[1], axis=1)
    return np.concatenate([corners, last], axis=1)


def _content(xyz: Floats, corners: Ints, kind: Ints) -> Floats:
    """Area of faces, length of lines; mixed models get lines of a width that makes them count."""
    p = xyz[corners]
    area = 0.5 * np.linalg.norm(np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1]), axis=1)
    tria = 0.5 * np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)
    area = np.where(kind == TRIA, tria, area)
    length = np.linalg.norm(p[:, 1] - p[:, 0], axis=1)
    surface = kind >= TRIA
    width = np.sqrt(np.median(area[surface])) if surface.any() else 1.0
    return np.where(surface, area, np.where(kind == LINE, length * width, 0.0))


def _levels(xyz: Floats, corners: Ints) -> tuple[tuple[cKDTree, Ints, float], ...]:
    centre = xyz[corners].mean(axis=1)
    radius = np.sqrt(((xyz[corners] - centre[:, None]) ** 2).sum(axis=2).max(axis=1))
    smallest = radius[radius > 0].min() if np.any(radius > 0) else 1.0
    level = np.log2(np.maximum(radius / smallest, 1.0)).astype(np.int64)
    levels = []
    for k in np.unique(level):
        rows = np.flatnonzero(level == k)
        tree = cKDTree(centre[rows], balanced_tree=False, compact_nodes=False)
        levels.append((tree, rows, float(radius[rows].max())))
    return tuple(levels)


def outer_faces(geometry: Geometry) -> list[Ints]:
    """Return the faces that belong to one solid only, as rows of the nodes; trias, quads apart."""
    found = [
        elements[:, list(face)]
        for name, elements in geometry.elements.items()
        for face in (SHAPES[name].faces if len(elements) else ())
    ]
    if not found:
        return []
    keys = [_face_key(corners, len(geometry.ids)) for corners in found]
    _, group, count = np.unique(np.concatenate(keys), return_inverse=True, return_counts=True)
    outer = np.split(count[group] == 1, np.cumsum([len(f) for f in found])[:-1])
    kept = [f[o] for f, o in zip(found, outer, strict=True)]
    by_size = [[f for f in kept if f.shape[1] == n] for n in (TRIA, QUAD)]
    return [np.concatenate(group) for group in by_size if group]


def _face_key(corners: Ints, n_grid: int) -> Numbers:
    """One number a face; its three smallest corners tell it from every other of a valid mesh."""
    low, bits = np.sort(corners, axis=1)[:, :3], 21
    if n_grid < 1 << bits:
        return (low[:, 0] << 2 * bits) | (low[:, 1] << bits) | low[:, 2]
    return np.ascontiguousarray(low).view([("a", np.int64), ("b", np.int64), ("c", np.int64)])[:, 0]
