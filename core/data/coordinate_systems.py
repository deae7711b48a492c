"""Coordinate systems: rectangular, cylindrical, spherical; positions and local directions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, hold
from ..errors import InputError
from ..noun import Noun

KINDS = ("rectangular", "cylindrical", "spherical")


@dataclass(frozen=True, eq=False)
class Frame(Noun):
    """A coordinate system given in the basic frame.

    Parameters
    ----------
    kind : {"rectangular", "cylindrical", "spherical"}
        Cylindrical coordinates are r, theta, z; spherical ones r, theta (from the z axis), phi;
        angles in degrees.
    origin : (3,) float
        In the basic frame.
    axes : (3, 3) float
        Rows are the unit vectors of x, y, z in the basic frame, right-handed.
    """

    kind: str
    origin: Floats
    axes: Floats

    def __post_init__(self) -> None:
        hold(self, "origin", np.float64, (3,), "the origin of a coordinate system")
        hold(self, "axes", np.float64, (3, 3), "the axes of a coordinate system")

    @property
    def is_basic(self) -> bool:
        """Whether directions in this frame are the basic ones everywhere."""
        return self.kind == "rectangular" and bool(np.array_equal(self.axes, np.eye(3)))

    def positions(self, coordinates: Floats) -> Floats:
        """Return basic positions, (n, 3), of points given in this frame, (n, 3)."""
        a, b, c = np.asarray(coordinates, dtype=np.float64).reshape(-1, 3).T
        if self.kind == "cylindrical":
            b = np.radians(b)
            a, b = a * np.cos(b), a * np.sin(b)
        elif self.kind == "spherical":
            theta, phi = np.radians(b), np.radians(c)
            a, b, c = (
                a * np.sin(theta) * np.cos(phi),
                a * np.sin(theta) * np.sin(phi),
                a * np.cos(theta),
            )
        local = np.column_stack([a, b, c])
        basic: Floats = self.origin + local @ self.axes
        return basic

    def directions(self, points: Floats) -> Floats:
        """Return the local unit vectors at basic positions `points`, (n, 3): (n, 3, 3).

        Row k of each matrix is the k-th local direction in the basic frame, so that
        ``local = R @ basic``. On the polar axis, where the angle is undefined, it counts as zero.
        """
        points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
        if self.kind == "rectangular":
            return np.broadcast_to(self.axes, (len(points), 3, 3))
        x, y, z = ((points - self.origin) @ self.axes.T).T
        r = np.hypot(x, y)
        scale = np.maximum(np.abs(z), r)
        on_axis = r <= 1e-12 * np.where(scale > 0.0, scale, 1.0)
        safe = np.where(on_axis, 1.0, r)
        cos, sin = np.where(on_axis, 1.0, x / safe), np.where(on_axis, 0.0, y / safe)
        local = np.zeros((len(points), 3, 3))
        if self.kind == "cylindrical":
            local[:, 0, 0], local[:, 0, 1] = cos, sin
            local[:, 1, 0], local[:, 1, 1] = -sin, cos
            local[:, 2, 2] = 1.0
        else:
            distance = np.hypot(r, z)
            at_origin = distance == 0.0
            safe = np.where(at_origin, 1.0, distance)
            sin_t = np.where(at_origin, 0.0, r / safe)
            cos_t = np.where(at_origin, 1.0, z / safe)
            local[:, 0] = np.column_stack([sin_t * cos, sin_t * sin, cos_t])
            local[:, 1] = np.column_stack([cos_t * cos, cos_t * sin, -sin_t])
            local[:, 2, 0], local[:, 2, 1] = -sin, cos
        result: Floats = local @ self.axes
        return result


BASIC = Frame("rectangular", np.zeros(3), np.eye(3))
"""The basic frame."""


def frame_of_points(kind: str, a: Floats, b: Floats, c: Floats) -> Frame:
    """Return the frame with its origin at `a`, its z axis towards `b`, its x-z plane through `c`.

    Raises
    ------
    InputError
        Points that coincide or stand in a line.
    """
    z = np.asarray(b, dtype=np.float64) - a
    span = np.asarray(c, dtype=np.float64) - a
    y = np.cross(z, span)
    if not np.linalg.norm(y) > 1e-10 * np.linalg.norm(z) * np.linalg.norm(span):
        raise InputError("its three points coincide or stand in a line")
    z, y = z / np.linalg.norm(z), y / np.linalg.norm(y)
    return Frame(kind, np.asarray(a), np.vstack([np.cross(y, z), y, z]))
