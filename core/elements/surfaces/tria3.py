"""Three-node shell as Nastran's CTRIA3."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Bools, Floats
from ...data.shapes import TRIA
from ..batch import arms, congruent, translations, transpose, unit
from ..element import Element
from .normals import director_slopes, normal_map
from .quad4 import add_drilling, add_plate, edge_shear_operator
from .section import ShellSection, finite_shear, shell_stiffness

_NODE = 6 * np.arange(3)
_MEMBRANE = np.concatenate([_NODE, _NODE + 1])
_BENDING = np.concatenate([_NODE + 4, _NODE + 3])  # beta_x = ry, beta_y = -rx
_SIGN = np.repeat([1.0, -1.0], 3)
_NO_AREA = 1e-6
LINEAR_MASS = (np.ones((3, 3)) + np.eye(3)) / 12.0


def tria3_axes(xyz: Floats) -> Floats:
    """Element axes (n, 3, 3) of nodes (n, 3, 3) as Nastran's, rows are unit vectors, basic frame.

    x from node 1 to node 2, z normal.
    """
    x = unit(xyz[:, 1] - xyz[:, 0])
    z = unit(np.cross(x, xyz[:, 2] - xyz[:, 0]))
    return np.stack([x, np.cross(z, x), z], axis=1)


def tria3_area(xyz: Floats) -> Floats:
    """Areas, (n,)."""
    normal = np.cross(xyz[:, 1] - xyz[:, 0], xyz[:, 2] - xyz[:, 0])
    return np.asarray(0.5 * np.linalg.norm(normal, axis=1))


def tria3_sound(xyz: Floats) -> Bools:
    """Triangles with an area, (n,)."""
    side = np.linalg.norm(xyz[:, 1] - xyz[:, 0], axis=1)
    return np.asarray(tria3_area(xyz) > _NO_AREA * np.square(side))


def tria3_mass(xyz: Floats, areal_density: Floats, coupled: bool) -> Floats:
    """Mass of three-node shells, (n, 18, 18), translations only.

    Parameters
    ----------
    xyz : (n, 3, 3) float
        Grid positions, basic frame.
    areal_density : (n,) float
        Mass per area, rho t + non-structural mass.
    coupled : bool
        Consistent mass of the linear shape functions; otherwise a third of the mass a grid.
    """
    mass = areal_density * tria3_area(xyz)
    m = mass[:, None, None] * (LINEAR_MASS if coupled else np.eye(3) / 3.0)
    return translations(m, 6)


@dataclass(frozen=True, eq=False)
class Triangle:
    """Flat triangles in their own axes.

    Parameters
    ----------
    axes : (n, 3, 3) float
        Rows are the element axes.
    local : (n, 3, 2) float
        Corners.
    edge : (n, 3, 2) float
        Sides, in turn.
    area : (n,) float
    g : (n, 2, 3) float
        Derivatives of the shape functions by x and y.
    """

    axes: Floats
    local: Floats
    edge: Floats
    area: Floats
    g: Floats

    def corner_motions(self, offset: Floats, normals: Floats | None) -> Floats:
        """Motions that the flat element uses from those of the grids, (n, 18, 18)."""
        n = len(self.area)
        arm = np.zeros((n, 3, 3))
        arm[:, :, 2] = offset[:, None]
        T = arms(self.axes, arm)
        if normals is not None:
            slopes = director_slopes(normals, self.axes)
            if slopes.any():
                T = normal_map(slopes, np.broadcast_to(self.g[:, None], (n, 3, 2, 3))) @ T
        return T


def triangle(xyz: Floats) -> Triangle:
    """Return triangles in their own axes."""
    axes = tria3_axes(xyz)
    local = ((xyz - xyz[:, :1]) @ transpose(axes))[:, :, :2]
    edge = np.stack([local[:, j] - local[:, i] for i, j in TRIA.sides], axis=1)
    area = tria3_area(xyz)
    # gradients of the shape functions: the opposite edge turned by a right angle, over 2 A
    opposite = edge[:, [1, 2, 0]] / (2.0 * area)[:, None, None]
    g = np.stack([-opposite[:, :, 1], opposite[:, :, 0]], axis=1)
    return Triangle(axes, local, edge, area, g)


def _stiffness(
    xyz: Floats, section: ShellSection, k6rot: float, offset: Floats, normals: Floats | None
) -> Floats:
    """Stiffness of three-node shells.

    Constant membrane strain and curvature; transverse shear assumed constant along each edge
    with the flexibility t Z t^T + tr(Z) / 2 between unit edge strains, where t are the edge
    directions and Z = 1 / (G ts) + Z_b holds MacNeal's residual bending flexibility. This law
    was identified from NX Nastran's element matrices, which it reproduces to rounding for right
    isosceles triangles of three thicknesses. K6ROT is a factor on 1e-6 G t 2A.
    """
    t = triangle(xyz)
    K = np.zeros((len(xyz), 18, 18))
    _add_plane(K, section, t.g, t.area)
    _add_shear(K, section, t.edge, t.area)
    drilling = section.drilling * k6rot * 1e-6 * 2.0 * t.area
    at_nodes = np.broadcast_to(t.g[:, None], (len(xyz), 3, 2, 3))
    add_drilling(K, np.repeat(drilling[:, None], 3, axis=1), at_nodes)
    return congruent(K, t.corner_motions(offset, normals))


def _add_plane(K: Floats, section: ShellSection, g: Floats, area: Floats) -> None:
    B = np.zeros((len(K), 3, 6))
    B[:, 0, :3] = B[:, 2, 3:] = g[:, 0]
    B[:, 1, 3:] = B[:, 2, :3] = g[:, 1]
    weighted = transpose(B * area[:, None, None])
    K[:, _MEMBRANE[:, None], _MEMBRANE] += weighted @ section.A @ B
    K[:, _BENDING[:, None], _BENDING] += (weighted @ section.D @ B) * np.outer(_SIGN, _SIGN)
    if section.B.any():
        Kc = (weighted @ section.B @ B) * _SIGN
        K[:, _MEMBRANE[:, None], _BENDING] += Kc
        K[:, _BENDING[:, None], _MEMBRANE] += transpose(Kc)


def _add_shear(K: Floats, section: ShellSection, edge: Floats, area: Floats) -> None:
    D = np.stack([section.D[:, 0, 0], section.D[:, 1, 1]], axis=1)
    bends = (D > 0.0).all(axis=1)
    e = edge * (1.0 / np.sqrt(np.where(D > 0.0, D, 1.0)))[:, None, :]
    S = finite_shear(section, np.sqrt(area))
    S = np.where(bends[:, None, None], S, np.eye(2))
    Z = np.linalg.inv(S) + transpose(e) @ e / 24.0  # the residual bending flexibility
    add_edge_shears(K, edge, area * bends, Z, 0.5 * np.einsum("nii->n", Z))


def add_edge_shears(K: Floats, edge: Floats, area: Floats, Z: Floats, uniform: Floats) -> None:
    """Shears along three edges with the flexibility t Z t^T + uniform between unit edge strains."""
    length = np.linalg.norm(edge, axis=2)
    alike = uniform[:, None, None] * (length[:, :, None] * length[:, None, :])
    C = np.linalg.inv(edge @ Z @ transpose(edge) + alike) * area[:, None, None]
    add_plate(K, edge_shear_operator(edge, TRIA.sides, 3), C)


TRIA3 = Element(
    name="tria3",
    shape=TRIA,
    freedoms=6,
    stiffness=shell_stiffness(_stiffness),
    mass=tria3_mass,
    axes=tria3_axes,
    sound=tria3_sound,
    linear_mass=LINEAR_MASS,
)
