"""How well test shapes correlate with analysis shapes when the test stands in a given pose."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, Ints, Numbers
from ..data.geometry import Geometry
from ..data.modes import Modes
from ..sensors.closest_point import place
from ..sensors.sensor_map import Grids, grids_of
from .poses import Poses
from .registration_numbers import ALIGN


@dataclass(frozen=True, eq=False)
class Scorer:
    """Test shapes and the analysis shapes that may explain each.

    Parameters
    ----------
    grids : Grids
        Of the analysis.
    shapes : (n_dof, n_mode) float
        Analysis shapes on its dofs.
    node_xyz : (n_sensor, 3) float
        Sensor positions in the test frame, analysis length unit.
    axis : (n_sensor, 3) float
        Sensor axes in the test frame.
    turns : (n_sensor,) bool
        Sensors that read rotations.
    test : (n_sensor, n_test) float or complex
        Test shapes, each of unit length.
    band : (n_test, k) int
        Columns of `shapes` that may explain each test mode; repeated where there are fewer.
    size : (n_test,) int
        How many of the band differ.
    """

    grids: Grids
    shapes: Floats
    node_xyz: Floats
    axis: Floats
    turns: Numbers
    test: Numbers
    band: Ints
    size: Ints

    def score(self, poses: Poses) -> Floats:
        """Return the mean share of the test shapes that the analysis explains, (n_pose,).

        For each test mode the squared length of its projection on the analysis modes near it in
        frequency (which turns repeated modes into one subspace, as a MAC of single modes would
        not), less what as many random vectors would explain: 1 is perfect, about 0 is chance.
        """
        n = len(self.axis)
        per = max(1, ALIGN.at_once // n)
        parts = [
            self._score(poses.take(np.arange(i, min(i + per, len(poses)))))
            for i in range(0, len(poses), per)
        ]
        return np.concatenate(parts) if parts else np.zeros(0)

    def _score(self, poses: Poses) -> Floats:
        k, n = len(poses), len(self.axis)
        xyz = poses.apply(self.node_xyz).reshape(-1, 3)
        axis = np.einsum("kij,nj->kni", poses.rotation, self.axis).reshape(-1, 3)
        matrix = self.grids.sensor_matrix(
            place(self.grids.surface, xyz), axis, np.tile(self.turns, k)
        )
        X = (matrix @ self.shapes).reshape(k, n, -1)
        length = np.linalg.norm(X, axis=1, keepdims=True)
        X = np.divide(X, length, out=np.zeros_like(X), where=length > 0)
        gram = np.swapaxes(X, 1, 2) @ X
        onto = np.swapaxes(X, 1, 2) @ self.test
        total = np.zeros(k)
        for j, (columns, size) in enumerate(zip(self.band, self.size, strict=True)):
            chosen = columns[:size]
            G = gram[:, chosen[:, None], chosen] + ALIGN.ridge * np.eye(size)
            b = onto[:, chosen, j][..., None]
            explained = np.real(np.conj(np.swapaxes(b, 1, 2)) @ np.linalg.solve(G, b))[:, 0, 0]
            total += 1.0 - (1.0 - np.minimum(explained, 1.0)) * n / max(n - size, 1)
        return total / len(self.band)


def scorer_of(
    geometry: Geometry, modes: Modes, test_geometry: Geometry, test_modes: Modes, scale: float
) -> Scorer:
    """Prepare the score of poses.

    Of the analysis rigid-body modes may be among the modes; those of the test are on the measured
    directions (see `measured_directions`); `scale` is analysis length units in one of the test.
    """
    n = len(test_modes.dofs)  # few of them, evenly through the list
    rows = np.linspace(0, n - 1, min(n, ALIGN.most_sensors)).round().astype(np.int64)
    sensors = test_modes.dofs.take(rows)
    test = test_modes.shapes[rows]
    length = np.linalg.norm(test, axis=0)
    seen = length > 0
    hz, most = np.real(modes.frequencies_hz), len(rows) // ALIGN.sensors_a_mode
    band, size = _bands(hz, test_modes.frequencies_hz[seen], most)
    return Scorer(
        grids_of(geometry, modes.dofs, modes.shapes),
        np.ascontiguousarray(np.real(modes.shapes)),
        scale * test_geometry.xyz[test_geometry.index_of(sensors.node)],
        sensors.axis,
        sensors.component > 3,
        test[:, seen] / length[seen],
        band,
        size,
    )


def _bands(analysis_hz: Floats, test_hz: Floats, most: int) -> tuple[Ints, Ints]:
    """Nearest analysis modes of each test mode by ratio of frequency, (n_test, k), and counts.

    At least two where there are as many, so that a pair is not torn, and at most `most` and six.
    """
    most = int(np.clip(most, 1, min(ALIGN.most_modes, len(analysis_hz))))
    floor = ALIGN.lowest * float(test_hz.max(initial=np.finfo(float).tiny))
    ratio = np.maximum(analysis_hz, floor)[None] / np.maximum(test_hz, floor)[:, None]
    away = np.abs(np.log(ratio))
    nearest = np.argsort(away, axis=1, kind="stable")[:, :most]
    near = np.take_along_axis(away, nearest, axis=1) <= np.log(1 + ALIGN.band)
    return nearest, np.maximum(near.sum(axis=1), min(ALIGN.fewest_modes, most))
