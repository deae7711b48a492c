"""Three-node beams on a curve as Nastran's CBEAM3."""

from dataclasses import dataclass, fields

import numpy as np

from ...arrays import Floats, skew
from ...data.shapes import LINE
from ..batch import symmetric, transpose, unit
from ..element import Element
from ..quadrature import gauss_line

_EDGES = np.array([[0, 1]])
_STIFFNESS, _MASS = gauss_line(2), gauss_line(4)


@dataclass(frozen=True, eq=False)
class Curves:
    """Lines of shear centres through three points, end A, end B, between.

    Parameters
    ----------
    xyz : (n, 3, 3) float
        The points.
    v : (n, 3) float
        Orientation vectors: element y lies in the plane of the tangent and v.
    twist : (n, 3) float
        Angles by which y and z are turned about the tangent at the points [rad].
    """

    xyz: Floats
    v: Floats
    twist: Floats

    def at(self, xi: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Shape functions (m, 3), derivatives by length (n, m, 3), axes (n, m, 3, 3), ds/dxi."""
        N = np.stack([0.5 * xi * (xi - 1.0), 0.5 * xi * (xi + 1.0), 1.0 - xi**2], axis=1)
        dN = np.stack([xi - 0.5, xi + 0.5, -2.0 * xi], axis=1)
        along = dN @ self.xyz
        stretch = np.linalg.norm(along, axis=2)
        x = unit(along)
        z = unit(np.cross(x, self.v[:, None]))
        y = np.cross(z, x)
        c, s = (f(self.twist @ N.T)[..., None] for f in (np.cos, np.sin))
        axes = np.stack([x, c * y + s * z, c * z - s * y], axis=2)
        return N, dN / stretch[..., None], axes, stretch


@dataclass(frozen=True, eq=False)
class CurveSections:
    """Section constants at the three points, each (n, 3) but E, G and the shear factors, (n,).

    Parameters
    ----------
    E, G, ky, kz : float
        Moduli, shear factors along y and z.
    A, Iz, Iy, Iyz, J : float
        Area, inertias about the neutral axis (Iz: bending in x-y), torsion constant.
    ny, nz : float
        Neutral axis from the shear centre.
    """

    E: Floats
    G: Floats
    ky: Floats
    kz: Floats
    A: Floats
    Iz: Floats
    Iy: Floats
    Iyz: Floats
    J: Floats
    ny: Floats
    nz: Floats

    def at(self, N: Floats) -> "CurveSections":
        """Return the constants interpolated by N (m, 3): (n, m), those of the element (n, 1)."""
        values = (getattr(self, f.name) for f in fields(self))
        return CurveSections(*(v[:, None] if v.ndim == 1 else v @ N.T for v in values))

    def stiffness(self) -> Floats:
        """Return forces and moments by strains and curvatures about x, y, z, (n, m, 6, 6)."""
        C = np.zeros((*self.A.shape, 6, 6))
        C[..., 0, 0] = self.E * self.A
        C[..., 1, 1], C[..., 2, 2] = (self.G * k * self.A for k in (self.ky, self.kz))
        C[..., 3, 3] = self.G * self.J
        C[..., 4, 4], C[..., 5, 5] = self.E * self.Iy, self.E * self.Iz
        C[..., 4, 5] = C[..., 5, 4] = -self.E * self.Iyz
        at_neutral = np.zeros_like(C)
        at_neutral[..., range(6), range(6)] = 1.0
        at_neutral[..., 0, 4], at_neutral[..., 0, 5] = self.nz, -self.ny
        return transpose(at_neutral) @ C @ at_neutral


def beam3_stiffness(curves: Curves, sections: CurveSections) -> Floats:
    """Stiffness on the curve, (n, 18, 18), basic frame; u v w rx ry rz of A, B, the middle.

    Quadratic motions and two integration points, at which the strains of a beam flexible in
    shear do not lock (Bathe, *Finite Element Procedures*, 5.4.1).
    """
    xi, w = _STIFFNESS
    N, dN, axes, stretch = curves.at(xi)
    n, m = stretch.shape
    B = np.zeros((n, m, 6, 3, 6))
    tangent = skew(axes[:, :, 0])
    for k in range(3):
        slope = axes * dN[:, :, k, None, None]
        B[:, :, :3, k, :3] = B[:, :, 3:, k, 3:] = slope
        B[:, :, :3, k, 3:] = N[:, k, None, None] * (axes @ tangent)  # u' - theta x t
    B = B.reshape(n, m, 6, 18)
    C = sections.at(N).stiffness() * (w * stretch)[..., None, None]
    return symmetric((transpose(B) @ C @ B).sum(axis=1))


def beam3_mass(
    curves: Curves,
    masses: Floats,
    centres: Floats,
    inertias: Floats,
    coupled: bool,
) -> Floats:
    """Mass on the curve, (n, 18, 18), basic frame.

    Parameters
    ----------
    curves : Curves
    masses : (n, 3, 2) float
        Mass per length at the three points, structural and not.
    centres : (n, 3, 2, 2) float
        Where it is in the section, y and z from the shear centre.
    inertias : (n, 3, 2, 3) float
        Its inertias per length about axes y, z through its centre, and the product yz.
    coupled : bool
        Consistent; otherwise the same with each point's share (row sums: 1/6, 1/6, 2/3 of a
        straight beam) at the point.
    """
    xi, w = _MASS
    N, _, axes, stretch = curves.at(xi)
    local = np.zeros((*stretch.shape, 6, 6))
    for part in range(2):
        values = (x[:, :, part] for x in (masses, *np.moveaxis(centres, 3, 0)))
        mass, y, z = (v @ N.T for v in values)
        iy, iz, iyz = (x[:, :, part] @ N.T for x in np.moveaxis(inertias, 3, 0))
        own = np.zeros_like(local)
        own[..., range(3), range(3)] = mass[..., None]
        own[..., 3, 3], own[..., 4, 4], own[..., 5, 5] = iy + iz, iy, iz
        own[..., 4, 5] = own[..., 5, 4] = -iyz
        arm = np.zeros_like(local)
        arm[..., range(6), range(6)] = 1.0
        arm[..., :3, 3:] = -skew(np.stack([np.zeros_like(y), y, z], axis=-1))
        local += transpose(arm) @ own @ arm
    T = np.zeros_like(local)
    T[..., :3, :3] = T[..., 3:, 3:] = axes
    line = (transpose(T) @ local @ T) * (w * stretch)[..., None, None]
    share = np.einsum("mk,ml->mkl", N, N)
    if not coupled:
        share = share.sum(axis=2)[:, :, None] * np.eye(3)
    M = np.einsum("mkl,nmij->nkilj", share, line).reshape(-1, 18, 18)
    return symmetric(M)


BEAM3 = Element(
    name="beam3",
    shape=LINE,
    freedoms=6,
    edges=_EDGES,
    stiffness=beam3_stiffness,
    mass=beam3_mass,
    curved=True,
    unknown="stiffness and mass",
)
