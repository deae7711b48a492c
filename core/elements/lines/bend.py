"""Beams along an arc of a circle as Nastran's CBEND, exact between their ends."""

from dataclasses import dataclass, fields

import numpy as np

from ...arrays import Floats, skew
from ...data.shapes import LINE
from ..batch import congruent, symmetric, transpose
from ..element import Element
from ..quadrature import gauss_line
from .bar import lumped_ends

_X, _W = gauss_line(12)
_X, _W = 0.5 * (_X + 1.0), 0.5 * _W


@dataclass(frozen=True, eq=False)
class Arcs:
    """Lines of centroids.

    Parameters
    ----------
    xa, xb : (n, 3) float
        Ends.
    bulge : (n, 3) float
        Unit vectors across the chord, towards the arc.
    angle : (n,) float
        From end to end [rad], below a full turn.
    """

    xa: Floats
    xb: Floats
    bulge: Floats
    angle: Floats

    @property
    def radius(self) -> Floats:
        """Radii, (n,)."""
        chord = np.linalg.norm(self.xb - self.xa, axis=1)
        return np.asarray(chord / (2.0 * np.sin(0.5 * self.angle)))

    def at(self, fraction: Floats) -> tuple[Floats, Floats]:
        """Return points (n, ..., 3) and axes (n, ..., 3, 3), rows outward, along, across.

        `fraction` counts along the arc, (...).
        """
        shape = (len(self.xa), *[1] * np.ndim(fraction))
        along = (self.xb - self.xa) / np.linalg.norm(self.xb - self.xa, axis=1)[:, None]
        half, R = (0.5 * self.angle).reshape(shape), self.radius.reshape(shape)
        phi = half * (2.0 * fraction - 1.0)
        b, d = (x.reshape(*shape, 3) for x in (self.bulge, along))
        out = np.cos(phi)[..., None] * b + np.sin(phi)[..., None] * d
        on = np.cos(phi)[..., None] * d - np.sin(phi)[..., None] * b
        middle = 0.5 * (self.xa + self.xb).reshape(*shape, 3)
        points = middle + R[..., None] * (out - np.cos(half)[..., None] * b)
        return points, np.stack([out, on, np.cross(out, on)], axis=-2)

    def take(self, rows: object) -> "Arcs":
        """Return some of them."""
        return Arcs(*(getattr(self, f.name)[rows] for f in fields(self)))


@dataclass(frozen=True, eq=False)
class BendSections:
    """Constants of a section, each (n,).

    Parameters
    ----------
    E, G : float
        Moduli.
    A, I1, I2, J : float
        Area, inertias (I1: bending in the plane of the arc), torsion constant.
    k1, k2 : float
        Shear area factors in the plane and across it; 0: no shear flexibility.
    neutral : float
        From the centroid to the neutral axis of bending in the plane, towards the centre.
    """

    E: Floats
    G: Floats
    A: Floats
    I1: Floats
    I2: Floats
    J: Floats
    k1: Floats
    k2: Floats
    neutral: Floats

    def flexibility(self, radius: Floats) -> Floats:
        """Strains from forces and moments about the axes outward, along, across, (n, 6, 6).

        In the plane fibres of the length (1 + y/R) ds (Winkler): with e from centroid to neutral
        axis, 1/(E A) [[1, 1/R], [1/R, 1/(R e)]] for force along and moment across; e = I1/(A R)
        makes the last 1/(E I1).
        """
        S = np.zeros((len(self.A), 6, 6))
        EA, GA = self.E * self.A, self.G * self.A
        for row, k in ((0, self.k1), (2, self.k2)):
            S[:, row, row] = np.where(k > 0.0, 1.0 / (np.where(k > 0.0, k, 1.0) * GA), 0.0)
        S[:, 1, 1], S[:, 1, 5] = 1.0 / EA, 1.0 / (EA * radius)
        S[:, 5, 1], S[:, 5, 5] = S[:, 1, 5], 1.0 / (EA * radius * self.neutral)
        S[:, 3, 3], S[:, 4, 4] = 1.0 / (self.E * self.I2), 1.0 / (self.G * self.J)
        return S


def bend_stiffness(arcs: Arcs, sections: BendSections) -> Floats:
    """Stiffness between the ends, (n, 12, 12), basic frame, by the flexibility of the arc.

    It is exact for forces at the ends: what is integrated are the strains that they make.
    """
    T, F = _motion_of_b(arcs), _motion(arcs, sections, np.ones(1))[:, 0]
    return congruent(np.linalg.inv(symmetric(F)), T)


def bend_mass(
    arcs: Arcs, sections: BendSections, density: Floats, nsm: Floats, coupled: bool
) -> Floats:
    """Mass, (n, 12, 12), basic frame.

    Parameters
    ----------
    arcs, sections
        As for `bend_stiffness`.
    density : (n,) float
        Mass per volume.
    nsm : (n,) float
        Further mass per length.
    coupled : bool
        Consistent with the motion that forces at the ends make, rotary inertia included;
        otherwise half at each end, translations only.
    """
    length = arcs.radius * arcs.angle
    line = density * sections.A + nsm
    if not coupled:
        return lumped_ends(np.stack([0.5 * line * length] * 2, axis=1))
    points, axes = arcs.at(_X)
    F = _motion(arcs, sections, np.append(_X, 1.0))
    rigid = np.zeros((len(length), len(_X), 6, 12))
    rigid[..., :6] = transpose(_carried(points - arcs.xa[:, None]))
    N = rigid + F[:, :-1] @ np.linalg.solve(F[:, -1], _motion_of_b(arcs))[:, None]
    spins = np.stack([sections.I2, sections.I1 + sections.I2, sections.I1], axis=1)
    m = np.concatenate([np.repeat(line[:, None], 3, axis=1), density[:, None] * spins], axis=1)
    local = _both(axes) @ N
    weight = (m * length[:, None])[:, None, :, None] * _W[:, None, None]
    return symmetric((transpose(local) @ (weight * local)).sum(axis=1))


def _motion_of_b(arcs: Arcs) -> Floats:
    """Motion of end B beside that of a body fixed at end A, (n, 6, 12)."""
    T = np.zeros((len(arcs.xa), 6, 12))
    T[:, :, :6] = -transpose(_carried(arcs.xb - arcs.xa))
    T[:, :, 6:] = np.eye(6)
    return T


def _motion(arcs: Arcs, sections: BendSections, fraction: Floats) -> Floats:
    """Motions at places on the arc from forces and moments at end B, A being held, (n, m, 6, 6)."""
    S = sections.flexibility(arcs.radius)
    points, _ = arcs.at(fraction)
    xi, axes = arcs.at(fraction[:, None] * _X)
    local = _both(axes) @ _carried(arcs.xb[:, None, None] - xi)
    strain = transpose(_both(axes)) @ S[:, None, None] @ local
    moved = transpose(_carried(points[:, :, None] - xi)) @ strain
    ds = (arcs.radius * arcs.angle)[:, None, None] * fraction[:, None] * _W
    return np.asarray((moved * ds[..., None, None]).sum(axis=2))


def _carried(arm: Floats) -> Floats:
    """Force and moment from those at the tip of an arm, (..., 6, 6)."""
    A = np.zeros((*arm.shape[:-1], 6, 6))
    A[..., range(6), range(6)] = 1.0
    A[..., 3:, :3] = skew(arm)
    return A


def _both(axes: Floats) -> Floats:
    """Axes for translations and rotations, (..., 6, 6)."""
    T = np.zeros((*axes.shape[:-2], 6, 6))
    T[..., :3, :3] = T[..., 3:, 3:] = axes
    return T


BEND = Element(
    name="bend",
    shape=LINE,
    freedoms=6,
    stiffness=bend_stiffness,
    mass=bend_mass,
    curved=True,
    unknown="mass",
)
