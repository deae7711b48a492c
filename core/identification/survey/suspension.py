"""Which modes of a test are motions of the whole body on its suspension."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from ...data.dofs import Dofs
from ...data.geometry import Geometry
from .survey_numbers import SURVEY


def rigid_share(shapes: Floats, dofs: Dofs, geometry: Geometry | None) -> Floats:
    """Return the share of each shape that rigid-body motions of the sensors explain.

    The squared length of the projection onto the translations and rotations of the sensors, over
    that of the shape: 1 for a body that moves on a soft suspension without deforming.

    Parameters
    ----------
    shapes : (n_dof, n_mode) float
    dofs : Dofs
    geometry : Geometry, optional

    Returns
    -------
    (n_mode,) float
        NaN without geometry, or where the sensors are too few to tell.
    """
    unknown = np.full(shapes.shape[1], np.nan)
    if geometry is None or not len(geometry.ids):
        return unknown
    at = geometry.index_of(dofs.node)
    known = (at >= 0) & (dofs.component <= 3)
    xyz, axis = geometry.xyz[at[known]], dofs.axis[known]
    if not len(xyz):
        return unknown
    arm = (xyz - xyz.mean(axis=0)) / max(float(np.ptp(xyz, axis=0).max()), 1e-300)
    u, s, _ = np.linalg.svd(np.hstack([axis, np.cross(arm, axis)]), full_matrices=False)
    motions = u[:, s > SURVEY.rigid_spanned * s[0]]
    if len(xyz) < SURVEY.rigid_sensors * motions.shape[1]:
        return unknown
    measured = shapes[known]
    total = np.maximum(np.sum(measured**2, axis=0), 1e-300)
    return np.asarray(np.sum((motions.T @ measured) ** 2, axis=0) / total)
