"""Isoparametric solids: stiffness by quadrature, lumped and consistent mass, elastic matrices.

Nodes are numbered as usual: corners of the first face, corners of the second, then middle nodes
edge by edge. Strains stand in the order xx, yy, zz, xy, yz, zx.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...arrays import Bools, Floats, Ints
from ..batch import condense, in_chunks, symmetric, translations, transpose
from ..element import Element
from ..middle_nodes import lumped

PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))
_CHUNK = 128
_FLAT = 1e-9

Rule = tuple[Floats, Floats]
"""Integration points (m, 3), natural coordinates, and weights (m,)."""


Interpolation = Callable[[Floats], tuple[Floats, Floats]]
"""(m, 3) natural coordinates -> shape functions (m, k), derivatives by them (m, 3, k)."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Solid(Element):
    """A solid element by its shape functions.

    Its `stiffness` is ``stiffness(xyz, C, integration=...)`` with positions (n, k, 3) and elastic
    matrices (n, 6, 6), its `mass` ``mass(xyz, density, coupled)``; see `solid_mass`.

    Parameters
    ----------
    interpolation : Interpolation
    rules : mapping of str to Rule
        Plain isoparametric integrations of the stiffness by their words.
    mass_rule : Rule
        Integration of the mass.
    kernel : callable or None
        ``kernel(xyz, C, word)`` for the words that are no plain integration.
    """

    interpolation: Interpolation
    rules: Mapping[str, Rule]
    mass_rule: Rule
    kernel: Callable[[Floats, Floats, str], Floats] | None = None
    freedoms: int = 3
    stiffness: Callable[..., Floats] = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        object.__setattr__(self, "stiffness", partial(solid_stiffness, self))
        object.__setattr__(self, "mass", partial(solid_mass, self))
        object.__setattr__(self, "sound", partial(_sound, self))
        object.__setattr__(self, "integrations", self.integrations or tuple(self.rules))


def strains(xyz: Floats, interpolation: Interpolation, points: Floats) -> tuple[Floats, Floats]:
    """Strains xx, yy, zz, xy, yz, zx from u v w of each node, and determinants of the Jacobian.

    Parameters
    ----------
    xyz : (n, k, 3) float
        Node positions.
    interpolation : Interpolation
    points : (m, 3) float
        Natural coordinates.

    Returns
    -------
    (n, m, 6, 3 k) float, (n, m) float
    """
    derivatives = interpolation(points)[1]
    J = derivatives @ xyz[:, None]
    g = np.linalg.inv(J) @ derivatives
    B = np.zeros((*g.shape[:-2], 6, 3 * g.shape[-1]))
    x, y, z = g[..., 0, :], g[..., 1, :], g[..., 2, :]
    B[..., 0, 0::3] = B[..., 3, 1::3] = B[..., 5, 2::3] = x
    B[..., 1, 1::3] = B[..., 3, 0::3] = B[..., 4, 2::3] = y
    B[..., 2, 2::3] = B[..., 4, 1::3] = B[..., 5, 0::3] = z
    return B, np.linalg.det(J)


def energy(B: Floats, C: Floats, weight: Floats) -> Floats:
    """Sum over points of B^T C B weight: (n, m, 6, k), (n, 6, 6), (n, m) -> (n, k, k)."""
    n, m, _, k = B.shape
    CB = (C[:, None] @ B) * weight[..., None, None]
    return symmetric(transpose(B.reshape(n, m * 6, k)) @ CB.reshape(n, m * 6, k))


def solid_stiffness(solid: Solid, xyz: Floats, C: Floats, integration: str | None = None) -> Floats:
    """Stiffness of solids, (n, 3 k, 3 k).

    Parameters
    ----------
    solid : Solid
        Which element.
    xyz : (n, k, 3) float
        Node positions, basic frame.
    C : (n, 6, 6) float
        Elastic matrices, basic frame.
    integration : str, optional
        One of its `integrations`, by default the first.
    """
    word = integration or solid.integrations[0]

    def matrices(part: slice) -> Floats:
        if solid.kernel and word not in solid.rules:
            return solid.kernel(xyz[part], C[part], word)
        points, weights = solid.rules[word]
        B, detJ = strains(xyz[part], solid.interpolation, points)
        return energy(B, C[part], detJ * weights)

    return in_chunks(len(xyz), 3 * solid.nodes, matrices, _CHUNK // (1 + (solid.nodes > 10)))


def solid_mass(
    solid: Solid, xyz: Floats, density: Floats, coupled: bool, there: Floats | None = None
) -> Floats:
    """Mass of solids, (n, 3 k, 3 k).

    Parameters
    ----------
    solid : Solid
        Which element.
    xyz : (n, k, 3) float
        Node positions, basic frame.
    density : (n,) float
    coupled : bool
        Consistent mass; otherwise lumped by row sums, none of it negative.
    there : (nodes, k) float, optional
        All nodes from those that are there; see `middle_nodes.lumped`.
    """
    k = solid.nodes if there is None else there.shape[1]

    def matrices(part: slice) -> Floats:
        points, weights = solid.mass_rule
        N, derivatives = solid.interpolation(points)
        detJ = np.linalg.det(derivatives @ xyz[part][:, None])
        weight = detJ * weights * density[part, None]
        m = transpose(N[None] * weight[..., None]) @ N
        return translations(lumped(m, xyz[part], there, coupled), 3)

    return in_chunks(len(xyz), 3 * k, matrices, _CHUNK)


def _sound(solid: Solid, xyz: Floats) -> Bools:
    """Solids that are neither flat nor turned inside out at an integration point, (n,)."""
    _, derivatives = solid.interpolation(solid.rules["full"][0])
    parts = np.array_split(xyz, max(len(xyz) // 4096, 1))
    smallest = [np.linalg.det(derivatives @ part[:, None]).min(axis=1) for part in parts]
    return np.asarray(np.concatenate(smallest) > _FLAT * np.ptp(xyz, axis=1).max(axis=1) ** 3)


def stacked_edges(k: int) -> Ints:
    """Edges of two faces of `k` corners one above the other: below, upright, above."""
    ring = [(i, (i + 1) % k) for i in range(k)]
    upright = [(i, i + k) for i in range(k)]
    return np.array([*ring, *upright, *((i + k, j + k) for i, j in ring)])


def area_coordinates(p: Floats) -> tuple[Floats, Floats]:
    """Linear shape functions of the triangle, (m, 3), and derivatives by the first two, third."""
    L = np.column_stack([1.0 - p[:, 0] - p[:, 1], p[:, 0], p[:, 1]])
    d = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
    return L, np.broadcast_to(d, (len(p), 2, 3))


def isotropic_solid(E: Floats, nu: Floats) -> Floats:
    """Elastic matrices (n, 6, 6) of isotropic materials; shear follows from E and nu as in NX."""
    E, nu = np.broadcast_arrays(np.atleast_1d(E), np.atleast_1d(nu))
    C = np.zeros((len(E), 6, 6))
    G = E / (2.0 * (1.0 + nu))
    C[:, :3, :3] = (2.0 * G * nu / (1.0 - 2.0 * nu))[:, None, None]
    for i in range(3):
        C[:, i, i] += 2.0 * G
        C[:, i + 3, i + 3] = G
    return C


def strain_transform(axes: Floats) -> Floats:
    """Strains in the basis of the rows of `axes` from Cartesian strains, (n, 6, 6).

    E_ij = a_i . e . a_j with engineering shears; the rows (n, 3, 3) need be neither orthogonal
    nor of unit length.
    """
    T = np.empty((*axes.shape[:-2], 6, 6))
    for r, (i, j) in enumerate(PAIRS):
        a, b = axes[..., i, :], axes[..., j, :]
        double = 1.0 if i == j else 2.0
        for c, (k, m) in enumerate(PAIRS):
            if k == m:
                T[..., r, c] = double * a[..., k] * b[..., k]
            else:
                T[..., r, c] = 0.5 * double * (a[..., k] * b[..., m] + a[..., m] * b[..., k])
    return T


def in_basis(C: Floats, basis: Floats) -> tuple[Floats, Floats]:
    """Strains in a `basis` (n, 3, 3) from Cartesian ones, and elastic matrices for those strains.

    Returns
    -------
    (n, 6, 6) float, (n, 6, 6) float
    """
    T = strain_transform(basis)
    inverse = np.linalg.inv(T)
    return T, symmetric(transpose(inverse) @ C @ inverse)


def with_bubbles(B: Floats, bubbles: Floats, C: Floats, weight: Floats) -> Floats:
    """Stiffness from strains of nodes and of internal modes, which are condensed."""
    both = np.concatenate([B, bubbles], axis=3)
    outer, every = B.shape[3], np.arange(both.shape[3])
    return condense(energy(both, C, weight), every[:outer], every[outer:])


def rotate_material(C: Floats, axes: Floats) -> Floats:
    """Elastic matrices in the basic frame from those in material axes.

    Parameters
    ----------
    C : (n, 6, 6) float
        In material axes.
    axes : (n, 3, 3) float
        Rows are the material axes in the basic frame.
    """
    T = strain_transform(axes)
    return symmetric(transpose(T) @ C @ T)
