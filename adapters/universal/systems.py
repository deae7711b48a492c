"""Coordinate systems (datasets 18 and 2420): positions and displacement axes in the basic frame."""

from dataclasses import dataclass

import numpy as np

from ...core.arrays import Floats, frozen

KINDS = ("cartesian", "cylindrical", "spherical")


@dataclass(frozen=True, eq=False)
class CoordinateSystem:
    """A coordinate system seen from the basic frame.

    Parameters
    ----------
    kind : {"cartesian", "cylindrical", "spherical"}
        Cylindrical: r, theta, z. Spherical: r, theta (from +z), phi (about z), right-handed.
    axes : (3, 3) float
        Unit vectors x, y, z of the system, one a row, in the basic frame.
    origin : (3,) float
        In the basic frame, length unit of the file.
    """

    kind: str
    axes: Floats
    origin: Floats
    name: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "axes", frozen(self.axes, np.float64))
        object.__setattr__(self, "origin", frozen(self.origin, np.float64))

    def positions(self, coordinates: Floats) -> Floats:
        """Return basic positions (n, 3) of coordinates given in this system; angles in degrees."""
        a, b, c = np.asarray(coordinates, np.float64).T
        if self.kind == "cylindrical":
            t = np.deg2rad(b)
            local = np.column_stack([a * np.cos(t), a * np.sin(t), c])
        elif self.kind == "spherical":
            t, f = np.deg2rad(b), np.deg2rad(c)
            local = np.column_stack(
                [a * np.sin(t) * np.cos(f), a * np.sin(t) * np.sin(f), a * np.cos(t)]
            )
        else:
            local = np.column_stack([a, b, c])
        return np.asarray(local @ self.axes + self.origin)

    def frames(self, xyz: Floats) -> Floats:
        """Displacement axes at basic positions `xyz`, (n, 3, 3): row k is the k-th direction."""
        n = len(xyz)
        if self.kind == "cartesian":
            return np.broadcast_to(self.axes, (n, 3, 3)).copy()
        x, y, z = ((xyz - self.origin) @ self.axes.T).T
        azimuth = np.arctan2(y, x)
        ca, sa, zero = np.cos(azimuth), np.sin(azimuth), np.zeros(n)
        if self.kind == "cylindrical":
            local = np.array([[ca, sa, zero], [-sa, ca, zero], [zero, zero, zero + 1.0]])
        else:
            polar = np.arctan2(np.hypot(x, y), z)
            cp, sp = np.cos(polar), np.sin(polar)
            local = np.array([[sp * ca, sp * sa, cp], [cp * ca, cp * sa, -sp], [-sa, ca, zero]])
        return np.asarray(np.moveaxis(local, 2, 0) @ self.axes)

    def on_axis(self, xyz: Floats) -> Floats:
        """Which positions lie where the system's directions are not defined, (n,) bool."""
        if self.kind == "cartesian":
            return np.zeros(len(xyz), bool)
        local = (xyz - self.origin) @ self.axes.T
        size = max(float(np.abs(local).max(initial=0.0)), 1e-300)
        return np.asarray(np.hypot(local[:, 0], local[:, 1]) < 1e-6 * size)


BASIC = CoordinateSystem("cartesian", np.eye(3), np.zeros(3), "basic")


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
    return CoordinateSystem(kind, np.array([x, y, np.cross(x, y)]), origin, name)
