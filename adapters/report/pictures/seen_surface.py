"""What of a mesh is seen in a picture: outer faces, made coarse enough, hidden ones left out."""

from dataclasses import dataclass

import numpy as np

from ....core.arrays import Bools, Floats, Ints
from ....core.data.geometry import Geometry
from ....core.results.paired_shapes import DrawnMesh
from ....core.sensors.outer_surface import outer_faces, padded


def surface(geometry: Geometry) -> DrawnMesh:
    """Return the faces of shells, the outer faces of solids, and the lines of a geometry."""
    tables = geometry.elements
    shells = [tables[shape] for shape in ("tria", "quad") if shape in tables]
    faces = [padded(corners) for corners in (*shells, *outer_faces(geometry))]
    lines = tables.get("line", np.zeros((0, 2), np.int64))
    return DrawnMesh(
        np.asarray(geometry.xyz),
        np.vstack([np.zeros((0, 4), np.int64), *faces]),
        np.asarray(lines),
        np.arange(len(geometry.ids)),
        np.arange(len(geometry.ids)),
    )


def coarsened(fine: DrawnMesh, most: int) -> DrawnMesh:
    """Return a mesh of at most about `most` faces and lines, or the mesh itself if it is small.

    Nodes in one cell of a regular grid become one: the member nearest their mean, so that it
    stays on the structure, free edges and lines first, so that outlines stay. Faces that
    collapse or coincide go.

    References
    ----------
    Rossignac, Borrel (1993), vertex clustering.
    """
    count = len(fine.faces) + len(fine.lines)
    if count <= most or fine.size <= 0.0:
        return fine
    coarse, cells, inner = fine, 3.0 * np.sqrt(max(most, 1)), ~_on_edge(fine)
    while count > most and cells >= 2.0:
        coarse = _clustered(fine, fine.size / cells, inner)
        count = len(coarse.faces) + len(coarse.lines)
        cells *= min(0.94, 0.97 * np.sqrt(most / max(count, 1)))  # a surface: cells² of them
    return coarse


@dataclass(frozen=True, eq=False)
class View:
    """A parallel projection: `axes` rows are right, down and away from the eye."""

    axes: Floats

    def project(self, xyz: Floats) -> Floats:
        """Return (n, 3): right, down, depth."""
        return np.asarray(xyz @ self.axes.T)


def isometric(*, behind: bool = False) -> View:
    """Return the view from the front right above, z up; or from the opposite side."""
    away = np.array([-0.62, 0.72, -0.50]) * np.where([behind, behind, False], -1.0, 1.0)
    away /= np.linalg.norm(away)
    right = np.cross(away, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    return View(np.vstack([right, np.cross(away, right), away]))


@dataclass(frozen=True, eq=False)
class DepthBuffer:
    """Distance of the nearest face by picture cell; infinite where there is none."""

    depth: Floats
    origin: Floats
    pitch: float

    def sees(self, projected: Floats, slack: float) -> Bools:
        """Return which points (n, 3) no face hides by more than `slack`."""
        return np.asarray(projected[:, 2] <= self.depth[self._cells(projected)] + slack)

    def _cells(self, projected: Floats) -> tuple[Ints, ...]:
        """Return row and column of the cell of each point, each by itself: short rows are slow."""
        sides = zip(projected.T[:2], self.origin, self.depth.shape, strict=True)
        cells = (((x - low) / self.pitch, n - 1) for x, low, n in sides)
        return tuple(np.clip(cell.astype(np.int64), 0, last) for cell, last in cells)


def depth_buffer(projected: Floats, faces: Ints, cells: int = 320) -> tuple[DepthBuffer, Bools]:
    """Return the depth buffer of faces and which of the faces are seen at all.

    Parameters
    ----------
    projected : (n, 3) float
        Right, down, depth.
    faces : (n_face, 4) int
    cells : int
        Resolution of the longer side.

    References
    ----------
    Catmull (1974), z-buffer; here filled by sampling every face.
    """
    low = projected[:, :2].min(axis=0)
    extent = np.ptp(projected[:, :2], axis=0)
    pitch = float(max(extent.max(), 1e-30)) / cells
    shape = np.maximum(np.ceil(extent / pitch).astype(int), 1) + 1
    buffer = DepthBuffer(np.full(shape, np.inf), low, pitch)
    if not len(faces):
        return buffer, np.zeros(0, bool)
    corners = projected[faces]
    sides = np.linalg.norm(np.diff(corners[:, [0, 1, 2, 3, 0], :2], axis=1), axis=2).max(axis=0)
    most = max(3, int(np.sqrt(2.5e6 / len(faces))))
    samples = np.clip(np.ceil(1.5 * np.maximum(sides[:2], sides[2:]) / pitch), 3, most)
    along, across = ((np.arange(n) + 0.5) / n for n in samples.astype(int))
    u, v = (g.ravel() for g in np.meshgrid(along, across))
    weights = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v])
    points = np.matmul(weights.T, corners)
    flat = points.reshape(-1, 3)
    cell = np.ravel_multi_index(buffer._cells(flat), buffer.depth.shape)
    nearest = buffer.depth.ravel()
    np.minimum.at(nearest, cell, flat[:, 2])
    seen = flat[:, 2] <= nearest[cell] + 3.0 * pitch
    return buffer, np.asarray(seen.reshape(len(faces), -1).any(axis=1))


def with_neighbours(chosen: Bools, mesh: DrawnMesh) -> Bools:
    """Return the chosen faces and those that share a node with one, (n_face,)."""
    touched = np.zeros(len(mesh.xyz), bool)
    touched[mesh.faces[chosen].ravel()] = True
    return np.asarray(touched[mesh.faces].any(axis=1))


def _clustered(fine: DrawnMesh, pitch: float, inner: Bools) -> DrawnMesh:
    cell = np.floor((fine.xyz - fine.xyz.min(axis=0)) / pitch + 0.5).astype(np.int64)
    _, group = np.unique(_keys(cell), return_inverse=True)
    n = int(group.max()) + 1
    members = np.bincount(group, minlength=n)
    mean = np.stack(
        [np.bincount(group, weights=fine.xyz[:, k], minlength=n) / members for k in range(3)], 1
    )
    order = np.lexsort((np.linalg.norm(fine.xyz - mean[group], axis=1), inner, group))
    first = order[np.searchsorted(group[order], np.arange(n))]
    return DrawnMesh(
        fine.xyz[first],
        _distinct(group[fine.faces], 3),
        _distinct(group[fine.lines], 2),
        group[fine.node_of],
        fine.original[first],
    )


def _on_edge(mesh: DrawnMesh) -> Bools:
    """Nodes on a free edge or on a line."""
    sides = mesh.faces[:, [0, 1, 1, 2, 2, 3, 3, 0]].reshape(-1, 2)
    sides = np.sort(sides[sides[:, 0] != sides[:, 1]], axis=1)
    _, first, counts = np.unique(_keys(sides), return_index=True, return_counts=True)
    found = np.zeros(len(mesh.xyz), bool)
    found[sides[first[counts == 1]].ravel()] = True
    found[mesh.lines.ravel()] = True
    return found


def _keys(rows: Ints) -> Ints:
    """Return one number a row of non-negative numbers, equal only for equal rows."""
    keys = np.zeros(len(rows), np.int64)
    for column in rows.T:
        keys = np.unique(keys, return_inverse=True)[1].ravel() if _full(keys, column) else keys
        keys = keys * (int(column.max(initial=0)) + 1) + column
    return keys


def _full(keys: Ints, column: Ints) -> bool:
    return (int(keys.max(initial=0)) + 1) * (int(column.max(initial=0)) + 1) >= 2**62


def _distinct(elements: Ints, corners: int) -> Ints:
    """Elements with at least so many different corners, each set of corners once."""
    if not len(elements):
        return elements
    ordered = np.sort(elements, axis=1)
    different = 1 + np.count_nonzero(np.diff(ordered, axis=1), axis=1)
    kept = np.flatnonzero(different >= corners)
    _, first = np.unique(_keys(ordered[kept]), return_index=True)
    return np.asarray(elements[kept[np.sort(first)]])
