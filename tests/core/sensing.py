"""Small meshes with sensors on and near them."""

import numpy as np
from scipy.spatial.transform import Rotation

from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry

RNG = np.random.default_rng(7)


def geometry(xyz, **elements):
    xyz = np.asarray(xyz, float)
    return Geometry(np.arange(1, len(xyz) + 1), xyz, "mm", elements)


def six_a_grid(geo):
    n = len(geo.ids)
    return Dofs(np.repeat(geo.ids, 6), np.tile(np.arange(1, 7), n))


def triaxial(geo):
    n = len(geo.ids)
    return Dofs(np.repeat(geo.ids, 3), np.tile([1, 2, 3], n))


def plate(nx=6, ny=4, jitter=0.25, kind="quad", lx=6.0, ly=4.0):
    """A flat mesh with inner grids pushed about in its plane."""
    x, y = np.meshgrid(np.linspace(0, lx, nx + 1), np.linspace(0, ly, ny + 1), indexing="ij")
    inner = (x > 0) & (x < lx) & (y > 0) & (y < ly)
    rng = np.random.default_rng(3)
    x = x + jitter * inner * rng.uniform(-1, 1, x.shape)
    y = y + jitter * inner * rng.uniform(-1, 1, x.shape)
    k = np.arange((nx + 1) * (ny + 1)).reshape(nx + 1, ny + 1)
    quads = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], axis=-1).reshape(-1, 4)
    xyz = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    if kind == "tria":
        return geometry(xyz, tria=np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))
    return geometry(xyz, quad=quads)


def box(n=3):
    k = np.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)
    a, b = k[:-1, :-1, :-1].ravel(), k[:-1, :-1, 1:].ravel()
    base = np.stack([a, a + (n + 1) ** 2, a + (n + 1) ** 2 + n + 1, a + n + 1], axis=1)
    g = np.arange(n + 1.0)
    xyz = np.stack(np.meshgrid(g, g, g, indexing="ij"), axis=-1).reshape(-1, 3)
    return geometry(xyz, hexa=np.concatenate([base, base + (b - a)[:, None]], axis=1))


def beam():
    turn = Rotation.random(random_state=4).as_matrix()
    xyz = np.array([[0, 0, 0], [2, 0, 0], [5, 0, 0], [5, 0, 3]]) @ turn.T
    return geometry(xyz, line=np.array([[0, 1], [1, 2], [2, 3]]))


def sensors_on(geo, rng, n=40, off=0.0):
    """Random points on the elements of a geometry, pushed off by up to `off` in any direction."""
    corners = np.concatenate(list(geo.elements.values()))
    weights = rng.dirichlet(np.ones(corners.shape[1]), n)
    xyz = np.einsum("nc,ncx->nx", weights, geo.xyz[rng.choice(corners, n)])
    return geometry(xyz + off * rng.uniform(-1, 1, xyz.shape))


def read(obs, geo, displacement, rotation=None):
    """C @ shape for fields given as functions of position, as (n_node, 3)."""
    values = np.zeros((len(geo.ids), 6))
    values[:, :3] = displacement(geo.xyz)
    if rotation is not None:
        values[:, 3:] = rotation(geo.xyz)
    return (obs.matrix @ values.ravel()).reshape(-1, 3)


MESHES = {
    "quads": plate(),
    "trias": plate(kind="tria"),
    "solids": box(),
    "beams": beam(),
}
