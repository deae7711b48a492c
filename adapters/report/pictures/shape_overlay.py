"""The paired shapes, analysis over test, reduced to what a page can carry."""

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Floats, Numbers
from ....core.data.dofs import Dofs
from ....core.data.geometry import Geometry
from ....core.data.modes import Modes
from ....core.results.correlation import Compared
from ....core.results.paired_shapes import Overlay as Overlay
from .seen_surface import coarsened, surface


def overlay(
    found: Compared,
    geometry: Geometry,
    analysis: Modes,
    test: Modes,
    observation: sp.csr_matrix | None,
    transformation: Floats | None = None,
    *,
    most: int = 800,
) -> Overlay | None:
    """Return the pairs of a correlation as shapes; None without pairs or sensor map.

    Parameters
    ----------
    found : Compared
        The correlation; its criteria tell which side was turned.
    geometry : Geometry
        Of the analysis.
    analysis : Modes
        On the analysis dofs.
    test : Modes
        At the sensors, (n_sensor) dofs.
    observation : (n_sensor, n_dof) sparse, optional
        Sensor map; without it there is nothing to lay over.
    transformation : (n, n) float, optional
        What the shapes of the turned side are multiplied by.
    most : int
        Faces and lines of the mesh, about.
    """
    if observation is None or not found.pairs:
        return None
    t, a = np.array([(p.test - 1, p.analysis - 1) for p in found.pairs]).T
    full, measured = np.real(analysis.shapes), np.asarray(test.shapes)
    if transformation is not None and found.criteria.rotate == "analysis":
        full = full @ transformation
    elif transformation is not None and found.criteria.rotate == "test":
        measured = real_shapes(measured)
        length = np.maximum(np.linalg.norm(measured, axis=0), 1e-300)
        measured = measured / length @ transformation
    full, measured = full[:, a], measured[:, t]
    mesh = coarsened(surface(geometry), most)
    nodal = nodal_shapes(geometry, analysis.dofs, full)
    size = np.maximum(np.linalg.norm(nodal[:, mesh.original], axis=2).max(axis=1), 1e-300)
    nodal /= size[:, None, None]
    model = np.asarray(observation @ full).T / size[:, None]
    return Overlay(
        mesh,
        nodal[:, mesh.original],
        np.array([s.xyz for s in found.alignment.sensors]),
        np.asarray(test.dofs.axis),
        model,
        _fitted(real_shapes(measured), model.T).T,
        tuple(found.pairs),
        nodal,
    )


def model_shapes(geometry: Geometry, modes: Modes, *, most: int = 1500) -> Overlay:
    """Return the shapes of a model alone: an overlay without pairs and sensors."""
    mesh = coarsened(surface(geometry), most)
    moved = nodal_shapes(geometry, modes.dofs, np.real(modes.shapes))[:, mesh.original]
    size = np.maximum(np.linalg.norm(moved, axis=2).max(axis=1), 1e-300)
    none = np.zeros((0, 3))
    still = np.zeros((len(modes), 0))
    return Overlay(mesh, moved / size[:, None, None], none, none, still, still, ())


def real_shapes(shapes: Numbers) -> Floats:
    """Shapes turned to their principal phase, real part."""
    phase = np.angle(np.sum(shapes**2, axis=0)) / 2.0
    return np.asarray(np.real(shapes * np.exp(-1j * phase)))


def _fitted(b: Floats, a: Floats) -> Floats:
    scale = np.sum(a * b, axis=0) / np.maximum(np.sum(b * b, axis=0), 1e-300)
    return np.asarray(b * scale)


def nodal_shapes(geometry: Geometry, dofs: Dofs, full: Floats) -> Floats:
    """Return translations by node of the geometry, (n_mode, n_node, 3), from whatever axes."""
    moved = np.zeros((len(geometry.ids), 3, full.shape[1]))
    rows = np.flatnonzero(dofs.component <= 3)
    node = geometry.index_of(dofs.node[rows])
    rows, node = rows[node >= 0], node[node >= 0]
    np.add.at(moved, node, dofs.axis[rows][:, :, None] * full[rows][:, None, :])
    return moved.transpose(2, 0, 1)
