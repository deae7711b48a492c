"""Four-node shell as Nastran's CQUAD4."""

import numpy as np

from ...arrays import Bools, Floats
from ...data.shapes import QUAD
from ..batch import arms, condense, congruent, symmetric, translations, transpose, unit
from ..element import Element
from .normals import director_slopes, is_warped, normal_map, warp_map
from .section import ShellSection, finite_shear, shell_stiffness, strip_stiffness

XI = np.array([-1.0, 1.0, 1.0, -1.0])
ETA = np.array([-1.0, -1.0, 1.0, 1.0])
_G = 1.0 / np.sqrt(3.0)
# share of the residual flexibility that a linear shear force sees, MacNeal (1978)
EPSILON = 0.025


def _gradients(xi: Floats, eta: Floats) -> Floats:
    """Return the derivatives of the shape functions by xi and eta at some points, (m, 2, 4)."""
    by_xi = 0.25 * XI * (1.0 + ETA * eta[:, None])
    by_eta = 0.25 * ETA * (1.0 + XI * xi[:, None])
    return np.stack([by_xi, by_eta], axis=1)


AT_GAUSS = _gradients(_G * XI, _G * ETA)
AT_CENTRE = _gradients(np.zeros(1), np.zeros(1))[0]
AT_NODES = _gradients(XI, ETA)
# derivatives of the incompatible modes 1 - xi**2 and 1 - eta**2
BUBBLES = np.zeros((4, 2, 2))
BUBBLES[:, 0, 0] = -2.0 * _G * XI
BUBBLES[:, 1, 1] = -2.0 * _G * ETA

_EDGES = ((0, 1), (3, 2), (0, 3), (1, 2))  # two along xi, two along eta
# shear strains at the Gauss points from the four coefficients of the assumed field
_SHEAR_FIELD = np.zeros((4, 2, 4))
_SHEAR_FIELD[:, 0, 0] = _SHEAR_FIELD[:, 1, 2] = 1.0
_SHEAR_FIELD[:, 0, 1] = _G * ETA
_SHEAR_FIELD[:, 1, 3] = _G * XI

_NODE = 6 * np.arange(4)
# local freedoms in the order u, two bubbles, v, two bubbles
_PLANE = np.array([0, 1, 2, 3, 6, 7, 8, 9])
_INNER = np.array([4, 5, 10, 11])
_MEMBRANE = np.concatenate([_NODE, _NODE + 1])
_BENDING = np.concatenate([_NODE + 4, _NODE + 3])  # beta_x = ry, beta_y = -rx
_SIGN = np.repeat([1.0, -1.0], 4)
_FLAT, _FOLDED = 1e-9, 1e-6
LINEAR_MASS = np.array([[4, 2, 1, 2], [2, 4, 2, 1], [1, 2, 4, 2], [2, 1, 2, 4]]) / 36.0


def quad4_axes(xyz: Floats) -> Floats:
    """Element axes (n, 3, 3) of nodes (n, 4, 3) as Nastran's, rows are unit vectors, basic frame.

    x bisects the angle of the diagonals, z is normal to both.
    """
    d1, d2 = unit(xyz[:, 2] - xyz[:, 0]), unit(xyz[:, 3] - xyz[:, 1])
    z = unit(np.cross(d1, d2))
    x = unit(d1 - d2)
    return np.stack([x, np.cross(z, x), z], axis=1)


def quad4_corner_jacobians(xyz: Floats) -> Floats:
    """Parallelogram areas at the corners of the projected quads, (n, 4); <= 0: badly shaped."""
    local, _ = flat(xyz, quad4_axes(xyz))
    J = AT_NODES @ local[:, None]
    return np.asarray(4.0 * np.linalg.det(J))


def quad4_sound(xyz: Floats) -> Bools:
    """Quads with an area and no corner turned inside out, (n,)."""
    xyz = xyz[:, :4]
    d1, d2 = xyz[:, 2] - xyz[:, 0], xyz[:, 3] - xyz[:, 1]
    scale = np.linalg.norm(d1, axis=1) * np.linalg.norm(d2, axis=1)
    flat = np.linalg.norm(np.cross(d1, d2), axis=1) <= _FLAT * scale
    smallest = np.zeros(len(xyz))
    smallest[~flat] = quad4_corner_jacobians(xyz[~flat]).min(axis=1)
    return np.asarray(smallest > _FOLDED * scale)


def quad4_mass(xyz: Floats, areal_density: Floats, coupled: bool) -> Floats:
    """Mass of four-node shells, (n, 24, 24), translations only.

    Parameters
    ----------
    xyz : (n, 4, 3) float
        Grid positions, basic frame.
    areal_density : (n,) float
        Mass per area, rho t + non-structural mass.
    coupled : bool
        Consistent mass of the bilinear shape functions; otherwise a quarter of the mass a grid.
    """
    local, _ = flat(xyz, quad4_axes(xyz))
    detJ = np.linalg.det(AT_GAUSS @ local[:, None])
    shapes = 0.25 * (1.0 + XI * _G * XI[:, None]) * (1.0 + ETA * _G * ETA[:, None])
    if coupled:
        m = np.einsum("g...,gi,gj->...ij", (detJ * areal_density[:, None]).T, shapes, shapes)
    else:
        quarter = 0.25 * detJ.sum(axis=1) * areal_density
        m = quarter[:, None, None] * np.eye(4)
    return translations(m, 6)


def flat(xyz: Floats, axes: Floats) -> tuple[Floats, Floats]:
    """In-plane positions (n, 4, 2) on the mean plane and heights (n, 4) of the grids above it."""
    local = (xyz - xyz.mean(axis=1, keepdims=True)) @ transpose(axes)
    return local[:, :, :2], local[:, :, 2]


def _stiffness(
    xyz: Floats, section: ShellSection, k6rot: float, offset: Floats, normals: Floats | None
) -> Floats:
    """Stiffness of four-node shells.

    Membrane and bending by the QM6 operator (Taylor, Beresford, Wilson 1976), transverse shear
    assumed along the edges (Dvorkin, Bathe 1984) with MacNeal's residual bending flexibility
    (1978): found to be what NX and MSC Nastran's element matrices hold. A warped quad is its
    projection on the mean plane, see `warp_map`. K6ROT is a factor on 1e-6 G t A.
    """
    axes = quad4_axes(xyz)
    local, height = flat(xyz, axes)
    J = AT_GAUSS @ local[:, None]
    detJ = np.linalg.det(J)
    inverse = np.linalg.inv(J)
    K = np.zeros((len(xyz), 24, 24))
    _add_plane(K, section, local, detJ, inverse)
    add_shear(K, section, local, detJ)
    J = AT_NODES @ local[:, None]
    weight = (section.drilling * k6rot * 1e-6)[:, None] * (4.0 * np.linalg.det(J))
    add_drilling(K, weight, np.linalg.inv(J) @ AT_NODES)
    return congruent(K, corner_motions(axes, local, height, offset, normals))


def corner_motions(
    axes: Floats, local: Floats, height: Floats, offset: Floats, normals: Floats | None
) -> Floats:
    """Motions that the flat element uses from those of the grids, (n, 24, 24)."""
    arm = np.zeros((len(axes), 4, 3))
    arm[:, :, 2] = offset[:, None]
    T = arms(axes, arm)
    warped = is_warped(local, height)
    if not warped and normals is None:
        return T
    gradients = np.linalg.inv(AT_NODES @ local[:, None]) @ AT_NODES
    tilt: Floats | float = 0.0
    if warped:
        W, tilt = warp_map(local, height, gradients)
        T = W @ T
    if normals is not None:
        slopes = director_slopes(normals, axes)
        if slopes.any():
            active = slopes.any(axis=2, keepdims=True)
            T = normal_map(np.where(active, slopes + tilt, 0.0), gradients) @ T
    return T


def _add_plane(
    K: Floats, section: ShellSection, local: Floats, detJ: Floats, inverse: Floats
) -> None:
    """Membrane, bending and their coupling, with the incompatible modes condensed."""
    n = len(K)
    centre = AT_CENTRE @ local
    ratio = np.linalg.det(centre)[:, None] / detJ
    g = np.empty((n, 4, 2, 6))
    g[..., :4] = inverse @ AT_GAUSS
    g[..., 4:] = (np.linalg.inv(centre)[:, None] @ BUBBLES) * ratio[..., None, None]
    B = np.zeros((n, 4, 3, 12))
    B[:, :, 0, :6] = B[:, :, 2, 6:] = g[:, :, 0]
    B[:, :, 1, 6:] = B[:, :, 2, :6] = g[:, :, 1]
    weighted = (B * detJ[..., None, None]).reshape(n, 12, 12)

    def integral(C: Floats) -> Floats:
        return transpose(weighted) @ (C[:, None] @ B).reshape(n, 12, 12)

    Km, Kb = integral(section.A), integral(section.D)
    if section.B.any():
        both = np.block([[Km, Kc := integral(section.B)], [transpose(Kc), Kb]])
        kept = np.concatenate([_PLANE, _PLANE + 12])
        both = condense(both, kept, np.concatenate([_INNER, _INNER + 12]))
        rows, sign = np.concatenate([_MEMBRANE, _BENDING]), np.append(np.ones(8), _SIGN)
        K[:, rows[:, None], rows] += both * np.outer(sign, sign)
        return
    K[:, _MEMBRANE[:, None], _MEMBRANE] += condense(Km, _PLANE, _INNER)
    K[:, _BENDING[:, None], _BENDING] += condense(Kb, _PLANE, _INNER) * np.outer(_SIGN, _SIGN)


def add_shear(
    K: Floats,
    section: ShellSection,
    local: Floats,
    detJ: Floats,
    uniform: float = 1.0,
    epsilon: float = EPSILON,
) -> None:
    """Edge shears as a linear field, its flexibility raised by the residual bending flexibility.

    The field is gamma_x = a0 + a1 eta, gamma_y = a2 + a3 xi in element axes, fixed by the shears
    along the four edges. The residual flexibility belongs to strips along xi and eta whose
    lengths are the projections dx, dy of the mid-side vectors (MacNeal 1978, equations 26, 27);
    `uniform` scales it, `epsilon` is the share that a linear shear force sees.
    """
    area = detJ.sum(axis=1)
    along, across = np.moveaxis(2.0 * AT_CENTRE @ local, 1, 0)
    dx, dy = along[:, 0], across[:, 1]
    D1, D2 = strip_stiffness(section.D, along)
    bends = (D1 > 0.0) & (D2 > 0.0)
    D1, D2 = np.where(bends, D1, 1.0), np.where(bends, D2, 1.0)

    S = finite_shear(section, np.sqrt(area))
    P = _SHEAR_FIELD
    H = transpose(P).reshape(1, 4, 4, 2) @ (S[:, None] @ P)
    H = np.einsum("ng,ngij->nij", detJ, H)
    H[~bends] = np.eye(4)
    x, y = uniform * dx**2 / (12.0 * D1), uniform * dy**2 / (12.0 * D2)
    share_x = epsilon / (epsilon + (1.0 - epsilon) * (dx / dy) ** 2)
    share_y = epsilon / (epsilon + (1.0 - epsilon) * (dy / dx) ** 2)
    shares = (x, 3.0 * share_x * x, y, 3.0 * share_y * y)
    Zb = np.stack(shares, axis=1) / area[:, None]
    C = symmetric(np.linalg.solve(np.eye(4) + H * Zb[:, None, :], H))
    C[~bends] = 0.0
    edge = np.stack([local[:, j] - local[:, i] for i, j in _EDGES], axis=1)
    ends = np.array([-1.0, 1.0, -1.0, 1.0])
    G = np.repeat(edge, 2, axis=2)
    G[:, :2, 1] *= ends[:2]
    G[:, :2, 3] = 0.0
    G[:, 2:, 1] = 0.0
    G[:, 2:, 3] *= ends[2:]
    add_plate(K, np.linalg.solve(G, edge_shear_operator(edge, _EDGES, 4)), C)


def edge_shear_operator(edge: Floats, ends: tuple[tuple[int, int], ...], n_node: int) -> Floats:
    """Shear strain along edges times their length, (n, m, 3 n_node), from w, then rx, then ry."""
    V = np.zeros((len(edge), len(ends), 3 * n_node))
    for k, (i, j) in enumerate(ends):
        V[:, k, i], V[:, k, j] = -1.0, 1.0
        for node in (i, j):
            V[:, k, n_node + node] = -0.5 * edge[:, k, 1]
            V[:, k, 2 * n_node + node] = 0.5 * edge[:, k, 0]
    return V


def add_plate(K: Floats, V: Floats, C: Floats) -> None:
    """Add V^T C V to w, rx and ry of the nodes."""
    plate = np.concatenate([6 * np.arange(K.shape[1] // 6) + d for d in (2, 3, 4)])
    K[:, plate[:, None], plate] += transpose(V) @ C @ V


def add_drilling(K: Floats, weight: Floats, g: Floats) -> None:
    """Penalty on the difference of the grids' rotation and that of the plane, at each node.

    Shapes: `weight` (n, m), gradients `g` (n, m, 2, m) of the plane at the nodes.
    """
    m = g.shape[-1]
    r = np.zeros((len(K), m, 3 * m))
    r[:, :, :m] = 0.5 * g[:, :, 1]
    r[:, :, m : 2 * m] = -0.5 * g[:, :, 0]
    r[:, np.arange(m), 2 * m + np.arange(m)] = 1.0
    rows = np.concatenate([6 * np.arange(m) + d for d in (0, 1, 5)])
    K[:, rows[:, None], rows] += transpose(r * weight[..., None]) @ r


QUAD4 = Element(
    name="quad4",
    shape=QUAD,
    freedoms=6,
    stiffness=shell_stiffness(_stiffness),
    mass=quad4_mass,
    axes=quad4_axes,
    sound=quad4_sound,
    linear_mass=LINEAR_MASS,
)
