"""The shapes of a test alone, as far as its sensors tell them."""

from dataclasses import replace

import numpy as np
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial.distance import pdist, squareform

from ....core.arrays import Floats, Ints
from ....core.data.geometry import Geometry
from ....core.data.modes import Modes
from ....core.results.paired_shapes import Overlay
from .seen_surface import coarsened, surface


def sensor_shapes(geometry: Geometry | None, modes: Modes, *, most: int = 1500) -> Overlay | None:
    """Return real shapes on the lines of the test; None without modes or positions.

    A node moves in the directions that were measured there and in no other, one without a sensor
    not at all. `model` of the overlay is where a sensor rests. Where the test has no lines, places
    measured are joined to neighbours, by the shortest lines that join all.

    Parameters
    ----------
    geometry : Geometry or None
        Of the test.
    modes : Modes
        In the measured directions.
    most : int
        Faces and lines that are drawn, about.
    """
    if geometry is None or not len(modes):
        return None
    at = geometry.index_of(modes.dofs.node)
    rows = np.flatnonzero((at >= 0) & (modes.dofs.component <= 3))
    if not len(rows):
        return None
    at, axes, read = at[rows], modes.dofs.axis[rows], np.real(modes.shapes[rows])
    moved = at_places(at, axes, read, len(geometry.ids))
    size = np.maximum(np.linalg.norm(moved, axis=2).max(axis=1), 1e-300)
    drawn = surface(geometry)
    if not len(drawn.faces) + len(drawn.lines):
        drawn = replace(drawn, lines=joined(geometry.xyz, np.unique(at)))
    mesh = coarsened(drawn, most)
    shapes = moved[:, mesh.original] / size[:, None, None]
    test = (read / size).T
    return Overlay(mesh, shapes, geometry.xyz[at], axes, np.zeros_like(test), test, ())


def joined(xyz: Floats, nodes: Ints) -> Ints:
    """Return lines (n, 2) of the minimum spanning tree of some nodes."""
    ends = minimum_spanning_tree(squareform(pdist(xyz[nodes]))).nonzero()
    return np.asarray(nodes[np.stack(ends, axis=1)], np.int64)


def at_places(at: Ints, axes: Floats, read: Floats, n_node: int) -> Floats:
    """Least displacements of nodes that read so along the axes, (n_mode, n_node, 3)."""
    nodes, of = np.unique(at, return_inverse=True)
    order = np.argsort(of, kind="stable")
    turn = np.empty(len(of), np.int64)
    turn[order] = np.arange(len(of)) - np.searchsorted(of[order], of[order])
    most = int(turn.max(initial=-1)) + 1
    along, values = np.zeros((len(nodes), most, 3)), np.zeros((len(nodes), most, read.shape[1]))
    along[of, turn], values[of, turn] = axes, read
    moved = np.zeros((read.shape[1], n_node, 3))
    moved[:, nodes] = np.matmul(np.linalg.pinv(along), values).transpose(2, 0, 1)
    return moved
