"""What the sensors of a test would read of an analysis shape."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse as sp

from ..arrays import Bools, Floats, Ints, Numbers, hold, require_shape
from ..data.dofs import Dofs
from ..data.geometry import Geometry
from ..errors import InputError
from ..noun import Noun
from .closest_point import Placement, place
from .facet_interpolation import interpolate
from .outer_surface import Surface, surface_of
from .placement_numbers import PLACEMENT
from .rigid_transform import IDENTITY, Transform

_BY_SENSOR = ("xyz", "nearest_grid", "distance", "within", "tolerance")


@dataclass(frozen=True, eq=False)
class Observation(Noun):
    """The sensor map C: sensor displacements = C @ analysis shapes.

    Parameters
    ----------
    matrix : (n_sensor, n_dof) csr
        For shapes on the analysis dofs (six a grid, basic axes).
    sensors : Dofs
        Test node, component and axis of each sensor, the axis turned into the basic frame of
        the analysis.
    xyz : (n_sensor, 3) float
        Sensor positions in the frame and the length unit of the analysis.
    nearest_grid : (n_sensor,) int
        Number of the grid nearest to the sensor.
    distance : (n_sensor,) float
        From the sensor to the facet (or grid) it was placed on, deck length unit.
    within : (n_sensor,) bool
        Whether the distance is inside the tolerance. What a sensor outside would read is not
        known; leave it out: ``observation.take(observation.within)`` and the same rows of the
        test shapes.
    tolerance : (n_sensor,) float
        What the distance was held against.
    warnings : tuple of str
        Sensors beyond the tolerance.
    """

    matrix: sp.csr_matrix
    sensors: Dofs
    xyz: Floats
    nearest_grid: Ints
    distance: Floats
    within: Bools
    tolerance: Floats
    warnings: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        n = len(self.sensors)
        require_shape(self.matrix, (n, "n"), "the sensor matrix")
        for name in _BY_SENSOR:
            hold(self, name, None, (n, 3) if name == "xyz" else (n,))

    def __len__(self) -> int:
        return len(self.sensors)

    def take(self, rows: Numbers) -> Observation:
        """Return the sensors of the given rows (indices or mask)."""
        own = {name: getattr(self, name)[rows] for name in _BY_SENSOR}
        return replace(self, matrix=self.matrix[rows], sensors=self.sensors.take(rows), **own)


@dataclass(frozen=True, eq=False)
class Grids:
    """Where the motion of each grid of a geometry stands among the analysis dofs.

    Parameters
    ----------
    surface : Surface
        Of the elements all of whose grids have three translations.
    columns : (n_grid, 6) int
        Row of the dofs for each grid and component; -1 where there is none.
    axis : (n_dof, 3) float
        Axis of each dof.
    rotating : (n_grid,) bool
        Grids whose rotations can be used.
    ids : (n_grid,) int
        Grid numbers.
    """

    surface: Surface
    columns: Ints
    axis: Floats
    rotating: Bools
    ids: Ints

    def sensor_matrix(self, placement: Placement, axis: Floats, turns: Bools) -> sp.csr_matrix:
        """Rows (n, n_dof) that read the placed points along `axis` (n, 3).

        `turns` (n,) says which sensors read a rotation instead of a displacement.
        """
        by = interpolate(self.surface, placement, self.rotating)
        choose = turns[:, None, None, None]
        u = np.einsum("nx,ncxy->ncy", axis, np.where(choose, by.tu, by.uu))
        theta = np.einsum("nx,ncxy->ncy", axis, np.where(choose, by.tt, by.ut))
        columns = self.columns[placement.corners]
        dof_axis = self.axis[columns]
        sides = ((u, dof_axis[:, :, :3]), (theta, dof_axis[:, :, 3:]))
        values = np.concatenate([np.einsum("ncy,ncky->nck", a, b) for a, b in sides], axis=2)
        values = np.where(columns >= 0, values, 0.0).reshape(len(placement), -1)
        rows = np.repeat(np.arange(len(placement)), values.shape[1])
        where = columns.reshape(len(placement), -1).ravel()
        keep = values.ravel() != 0.0
        shape = (len(placement), len(self.axis))
        return sp.csr_matrix((values.ravel()[keep], (rows[keep], where[keep])), shape=shape)


def grids_of(geometry: Geometry, dofs: Dofs, motion: Numbers | sp.spmatrix | None = None) -> Grids:
    """Find the dofs of every grid and the surface that can carry sensors.

    Parameters
    ----------
    geometry : Geometry
        Of the analysis.
    dofs : Dofs
        Of the analysis, (n_dof,), six a grid or fewer.
    motion : (n_dof, k) array or sparse, optional
        Mode shapes, or the `expansion` of the model: a grid whose translations move and whose
        rotations are zero in it throughout (a solid, a membrane, a truss) has no rotations of
        its own, and a grid that moves can carry a sensor even where no element is drawn to it.
        Default: all rotations of `dofs` are used.
    """
    row = geometry.index_of(dofs.node)
    columns = np.full((len(geometry.ids), 6), -1, np.int64)
    known = np.flatnonzero((row >= 0) & (dofs.component >= 1) & (dofs.component <= 6))
    columns[row[known], dofs.component[known] - 1] = known
    present = columns >= 0
    rotating = present[:, 3:].all(axis=1)
    alone = None
    if motion is not None:
        moving = _moving(motion)[columns] & present
        alone = moving[:, :3].any(axis=1)
        rotating &= moving[:, 3:].any(axis=1) | ~alone
    surface = surface_of(geometry, present[:, :3].all(axis=1), alone)
    return Grids(surface, columns, dofs.axis, rotating, geometry.ids)


def _moving(motion: Numbers | sp.spmatrix) -> Bools:
    """Whether each row of a matrix holds anything but zeros."""
    if sp.issparse(motion):
        return np.asarray(abs(motion).sum(axis=1)).ravel() > 0
    return np.asarray(np.any(np.asarray(motion) != 0, axis=1))


def default_tolerance(surface: Surface, placement: Placement) -> Floats:
    """Half the local mesh size, at least 0.5 % and at most 3 % of the model's size, (n,)."""
    local = PLACEMENT.local * surface.mesh_size(placement.facet)
    least, most = PLACEMENT.off
    return np.clip(local, least * surface.size, most * surface.size)


def observe(
    geometry: Geometry,
    dofs: Dofs,
    test_geometry: Geometry,
    sensors: Dofs,
    transform: Transform = IDENTITY,
    tolerance: float | None = None,
    motion: Numbers | sp.spmatrix | None = None,
) -> Observation:
    """Place sensors on a model and make the matrix that reads them off an analysis shape.

    Every sensor is projected on the element it lies on and reads that element's interpolated
    motion along its own axis, with the lever arm where it stands off (see
    `interpolation.interpolate`). A sensor of component 4 to 6 reads a rotation.

    Parameters
    ----------
    geometry, dofs : Geometry, Dofs
        Of the analysis.
    test_geometry, sensors : Geometry, Dofs
        Of the test: nodes, and one row per measured direction with its axis in the test's
        basic frame.
    transform : Transform
        From test to analysis coordinates, for example an `Alignment`'s.
    tolerance : float, optional
        Largest distance of a sensor from the model, deck length unit. Default: see
        `default_tolerance`.
    motion : (n_dof, k) array or sparse, optional
        See `grids_of`.

    Raises
    ------
    InputError
        A sensor's node is not in the test geometry, or hardly any sensor lies on the model.
    """
    grids = grids_of(geometry, dofs, motion)
    nodes = test_geometry.index_of(sensors.node)
    if np.any(nodes < 0):
        raise InputError(
            f"the test measured node {sensors.node[nodes < 0][0]}, "
            "which its geometry does not define; add the file with the test's geometry"
        )
    surface = grids.surface
    xyz = transform.apply(test_geometry.xyz[nodes])
    axis = transform.turn(sensors.axis)
    nearest = _of_same_number(surface, geometry.index_of(sensors.node), xyz)
    placement = place(surface, xyz, own=nearest)
    limit = default_tolerance(surface, placement)
    limit = limit if tolerance is None else np.full(len(xyz), float(tolerance))
    within = placement.distance <= limit
    if len(xyz) and within.mean() < PLACEMENT.fewest:
        raise InputError(_nowhere(surface, xyz, placement, within, limit))
    matrix = grids.sensor_matrix(placement, axis, sensors.component > 3)
    turned = Dofs(sensors.node, sensors.component, axis)
    off, told = placement.distance, _outside(sensors, placement, within, limit)
    return Observation(matrix, turned, xyz, grids.ids[nearest], off, within, limit, told)


def _of_same_number(surface: Surface, own: Ints, xyz: Floats) -> Ints:
    """Return the row of the nearest grid, among several in one place that of the same number."""
    nearest, distance = surface.nearest_grid(xyz)
    apart = np.linalg.norm(surface.xyz[own] - xyz, axis=1)
    as_near = apart <= distance + PLACEMENT.tied * surface.size
    return np.where((own >= 0) & np.isin(own, surface.attached) & as_near, own, nearest)


def _outside(sensors: Dofs, placement: Placement, within: Bools, limit: Floats) -> tuple[str, ...]:
    out = np.flatnonzero(~within)
    if not len(out):
        return ()
    nodes, first = np.unique(sensors.node[out], return_index=True)
    named = [
        f"{n} ({placement.distance[out[i]]:.4g} off, {limit[out[i]]:.4g} allowed)"
        for n, i in zip(nodes[: PLACEMENT.named], first[: PLACEMENT.named], strict=True)
    ]
    more = f" and {len(nodes) - PLACEMENT.named} more" if len(nodes) > PLACEMENT.named else ""
    return (
        f"{len(nodes)} test node(s) lie too far from the model to be used: "
        f"{', '.join(named)}{more}",
    )


def _nowhere(
    surface: Surface, xyz: Floats, placement: Placement, within: Bools, limit: Floats
) -> str:
    low, high = surface.extent
    return (
        f"only {np.count_nonzero(within)} of {len(xyz)} sensors lie on the model (median distance "
        f"{np.median(placement.distance):.4g}, allowed {np.median(limit):.4g}; the model spans "
        f"{_box(low, high)}, the sensors {_box(xyz.min(axis=0), xyz.max(axis=0))}): "
        "check the length units of deck and test, and that both use the same coordinate frame"
    )


def _box(low: Floats, high: Floats) -> str:
    return " x ".join(f"{a:.4g}..{b:.4g}" for a, b in zip(low, high, strict=True))
