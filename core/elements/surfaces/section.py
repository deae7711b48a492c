"""Stiffness of a shell per unit length: what an element needs to know of its property.

A plate element with assumed edge shears is too stiff where the moment varies along it. MacNeal
(1978), *A simple quadrilateral shell element*, Computers & Structures 8, 175-183, adds what is
missing to the shear flexibility: l**2 / (12 D) for a shear force that is constant over the
element, D being the bending stiffness of the strip of length l with every other curvature held.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...arrays import Floats, Numbers, hold
from ..batch import CHUNK, in_chunks, symmetric, transpose

_RIGID = 1e9


@dataclass(frozen=True, eq=False)
class ShellSection:
    """Force and moment resultants per strain and curvature, in the *element* axes.

    With strain(z) = strain + z curvature, z along the element normal, and
    curvature = (d ry/dx, -d rx/dy, d ry/dy - d rx/dx):
    N = A strain + B curvature, M = B strain + D curvature, Q = S gamma.

    Parameters
    ----------
    A, B, D : (n, 3, 3) float
        Membrane, coupling and bending stiffness (classical laminate theory: integrals of
        Q dz, Q z dz and Q z**2 dz). Zero A or D: no membrane, or no bending and shear.
    S : (n, 2, 2) float
        Transverse shear stiffness; infinite on the diagonal: rigid in shear.
    """

    A: Floats
    B: Floats
    D: Floats
    S: Floats

    def __post_init__(self) -> None:
        n = len(np.asarray(self.A))
        for name, shape in (("A", (3, 3)), ("B", (3, 3)), ("D", (3, 3)), ("S", (2, 2))):
            hold(self, name, np.float64, (n, *shape), f"shell stiffness {name}")

    def __len__(self) -> int:
        return len(self.A)

    @property
    def drilling(self) -> Floats:
        """Reference stiffness for the rotation about the normal: shear in element axes, (n,)."""
        return self.A[:, 2, 2]

    def take(self, rows: slice | Numbers) -> ShellSection:
        """Return the sections of the given elements (slice, indices or mask)."""
        return ShellSection(self.A[rows], self.B[rows], self.D[rows], self.S[rows])


def rotate_section(section: ShellSection, angle: Floats) -> ShellSection:
    """Turn a section from material axes to element axes.

    Parameters
    ----------
    section : ShellSection
        In material axes.
    angle : (n,) float
        Angle [rad] of the material x axis from the element x axis, positive about the normal.
    """
    angle = np.broadcast_to(np.asarray(angle, float), (len(section),))
    c, s = np.cos(angle), np.sin(angle)
    # strains along the material axes from those along the element axes
    T = np.empty((len(section), 3, 3))
    T[:, 0] = np.stack([c * c, s * s, s * c], axis=1)
    T[:, 1] = np.stack([s * s, c * c, -s * c], axis=1)
    T[:, 2] = np.stack([-2.0 * s * c, 2.0 * s * c, c * c - s * s], axis=1)
    R = np.empty((len(section), 2, 2))
    R[:, 0] = np.stack([c, s], axis=1)
    R[:, 1] = np.stack([-s, c], axis=1)
    rigid = np.isinf(section.S).any(axis=(1, 2))
    S = np.where(rigid[:, None, None], np.eye(2), section.S)
    S = symmetric(transpose(R) @ S @ R)
    S[rigid] = section.S[rigid]
    return ShellSection(
        A=symmetric(transpose(T) @ section.A @ T),
        B=symmetric(transpose(T) @ section.B @ T),
        D=symmetric(transpose(T) @ section.D @ T),
        S=S,
    )


def strip_stiffness(D: Floats, direction: Floats) -> tuple[Floats, Floats]:
    """Bending stiffness along and across a direction, each (n,).

    Parameters
    ----------
    D : (n, 3, 3) float
        Bending stiffness in element axes.
    direction : (n, 2) float
        In element axes, any length.
    """
    c, s = (direction / np.linalg.norm(direction, axis=1, keepdims=True)).T
    along = np.stack([c * c, s * s, 2.0 * s * c], axis=1)
    across = np.stack([s * s, c * c, -2.0 * s * c], axis=1)
    D1 = np.einsum("ni,nij,nj->n", along, D, along)
    D2 = np.einsum("ni,nij,nj->n", across, D, across)
    return D1, D2


def finite_shear(section: ShellSection, size: Floats) -> Floats:
    """S with "infinite" replaced by a number that is large beside 12 D / size**2."""
    rigid = np.isinf(section.S).any(axis=(1, 2))
    if not rigid.any():
        return section.S
    D = np.maximum(section.D[:, 0, 0], section.D[:, 1, 1])
    large = (_RIGID * D / size**2)[:, None, None] * np.eye(2)
    return np.where(rigid[:, None, None], large, section.S)


Kernel = Callable[[Floats, ShellSection, float, Floats, Floats | None], Floats]
"""Stiffness of some shells: positions, sections, K6ROT, offsets (n,), grid normals."""


def shell_stiffness(kernel: Kernel, chunk: int = CHUNK) -> Callable[..., Floats]:
    """Return the stiffness routine of a shell whose kernel makes a chunk of elements at a time."""

    def stiffness(
        xyz: Floats,
        section: ShellSection,
        k6rot: float = 100.0,
        offset: Floats | float = 0.0,
        normals: Floats | None = None,
    ) -> Floats:
        """Stiffness of shells, (n, 6 k, 6 k), basic frame; u v w rx ry rz of node 1, of node 2...

        Parameters
        ----------
        xyz : (n, k, 3) float
            Node positions, basic frame.
        section : ShellSection
            Of each element, in its axes.
        k6rot : float
            Factor on the stiffness about the normal, for the elements that have one by it.
        offset : (n,) float
            Distance of the reference surface from the nodes along the element normal.
        normals : (n, k, 3) float, optional
            Grid normals at the corners, basic frame, NaN where a grid has none (`grid_normals`).
        """
        n, nodes = xyz.shape[:2]
        z = np.broadcast_to(np.asarray(offset, float), (n,))

        def matrices(part: slice) -> Floats:
            at = None if normals is None else normals[part]
            return kernel(xyz[part], section.take(part), k6rot, z[part], at)

        return in_chunks(n, 6 * nodes, matrices, chunk)

    return stiffness
