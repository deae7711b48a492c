"""Coordinate systems (datasets 18 and 2420): positions and displacement axes in the basic frame."""

from dataclasses import dataclass

import numpy as np

from ...core.arrays import Bools, Floats
from ...core.data.coordinate_systems import KINDS as KINDS, Frame


@dataclass(frozen=True, eq=False)
class CoordinateSystem(Frame):
    """A coordinate system, as `Frame`, in the length unit of its file."""

    name: str = ""

    def on_axis(self, xyz: Floats) -> Bools:
        """Which positions lie where the system's directions are not defined, (n,) bool."""
        if self.kind == "rectangular":
            return np.zeros(len(xyz), bool)
        local = (xyz - self.origin) @ self.axes.T
        size = max(float(np.abs(local).max(initial=0.0)), 1e-300)
        return np.asarray(np.hypot(local[:, 0], local[:, 1]) < 1e-6 * size)


BASIC = CoordinateSystem("rectangular", np.zeros(3), np.eye(3), "basic")


def from_points(
    kind: str, reference: CoordinateSystem, points: Floats, name: str
) -> CoordinateSystem:
    """Return the system of dataset 18.

    Parameters
    ----------
    points : (3, 3) float
        Origin, a point on +x and a point in the +xz plane, in the reference system.

    Raises
    ------
    ValueError
        Points that lie on one line.
    """
    origin, on_x, in_xz = reference.positions(points)
    x = on_x - origin
    y = np.cross(in_xz - origin, x)
    if not np.linalg.norm(y) > 1e-9 * np.linalg.norm(x) * np.linalg.norm(in_xz - origin):
        raise ValueError("the three points lie on one line")
    x = x / np.linalg.norm(x)
    y = y / np.linalg.norm(y)
    return CoordinateSystem(kind, origin, np.array([x, y, np.cross(x, y)]), name)
