"""Places in words."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from ...data.geometry import Geometry
from .narrative_numbers import NARRATIVE


def region(geometry: Geometry, xyz: Floats) -> str:
    """Say where a point is, for round structures by angle and height.

    Parameters
    ----------
    geometry : Geometry
        Of the analysis.
    xyz : (3,) float
    """
    nearest = int(geometry.ids[np.argmin(np.linalg.norm(geometry.xyz - xyz, axis=1))])
    x, y, z = (float(v) for v in xyz)
    axis = _round_axis(geometry.xyz)
    if axis is None:
        return f"near grid {nearest} (x = {x:.4g}, y = {y:.4g}, z = {z:.4g})"
    a, b = ((1, 2), (2, 0), (0, 1))[axis]
    angle = float(np.degrees(np.arctan2(xyz[b], xyz[a]))) % 360.0
    radius = float(np.hypot(xyz[a], xyz[b]))
    return (
        f"near grid {nearest} (θ = {angle:.0f}°, r = {radius:.4g}, {'xyz'[axis]} = {xyz[axis]:.4g})"
    )


def _round_axis(xyz: Floats) -> int | None:
    """Coordinate axis about which a structure is round, None where it is not."""
    for axis in (2, 0, 1):
        a, b = ((1, 2), (2, 0), (0, 1))[axis]
        r = np.hypot(xyz[:, a], xyz[:, b])
        angle = np.arctan2(xyz[:, b], xyz[:, a])
        if not r.max() > 0.0:
            continue
        rim = r > NARRATIVE.rim * r.max()
        filled = np.unique(np.floor((angle[rim] + np.pi) / (np.pi / 12.0))).size
        if filled >= NARRATIVE.rim_filled:
            return axis
    return None
