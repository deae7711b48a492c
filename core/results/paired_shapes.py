"""The paired shapes of a run on a mesh that can be drawn."""

from dataclasses import dataclass, field

import numpy as np

from ..arrays import Floats, Ints
from ..noun import Noun
from .correlation import PairRow


@dataclass(frozen=True, eq=False)
class DrawnMesh(Noun):
    """A mesh to draw.

    `xyz` (n, 3); `faces` (n_face, 4) rows of `xyz`, a triangle repeats its last corner;
    `lines` (n_line, 2); `node_of` (n_original,) the row that each original node went to, and
    `original` (n,) the original node that stands at each row.
    """

    xyz: Floats
    faces: Ints
    lines: Ints
    node_of: Ints
    original: Ints

    @property
    def size(self) -> float:
        """Diagonal of the bounding box."""
        return float(np.linalg.norm(np.ptp(self.xyz, axis=0))) if len(self.xyz) else 0.0


@dataclass(frozen=True, eq=False)
class Overlay(Noun):
    """Pairs of shapes on a drawable mesh.

    Parameters
    ----------
    mesh : DrawnMesh
        Coarse enough to embed.
    shapes : (n_pair, n_node, 3) float
        Analysis displacement at the nodes of `mesh`, the largest of each pair 1.
    sensors : (n_sensor, 3) float
        Positions.
    axes : (n_sensor, 3) float
        Measured directions.
    model, test : (n_pair, n_sensor) float
        What each side says the sensors read, in the scale of `shapes`; the test fitted to the
        model by least squares.
    pairs : tuple of PairRow
        As many as there are shapes.
    nodal : (n_pair, n_original, 3) float
        Analysis displacement at all nodes of the geometry, in the scale of `shapes`.
    """

    mesh: DrawnMesh
    shapes: Floats
    sensors: Floats
    axes: Floats
    model: Floats
    test: Floats
    pairs: tuple[PairRow, ...]
    nodal: Floats = field(default_factory=lambda: np.zeros((0, 0, 3)))
