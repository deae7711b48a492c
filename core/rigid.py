"""Rigid-body motions, recognised by the rank of the stiffness and not by a frequency."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy.sparse as sp
from scipy.linalg import qr
from scipy.sparse.csgraph import connected_components

from .arrays import Floats, Ints
from .factor import factorise
from .model import Model
from .pencil import Pencil

_ROUNDING = 1e-13
"""Row forces this small beside the sum of the magnitudes that make them are rounding."""


def rigid_body_modes(model: Model, pencil: Pencil) -> tuple[Floats, int]:
    """Rigid-body motions that cost no strain energy.

    Each piece of the model (connected through K or M) is given the six motions of a rigid body
    as far as its free degrees of freedom can follow; those combinations u count for which every
    row of K u is rounding beside |K| |u|. So a suspension of any softness is stiffness, and a
    body on a hinge line keeps one motion.

    Parameters
    ----------
    model : Model
    pencil : Pencil
        Its K and M.

    Returns
    -------
    V : (n_free, n_rigid) float
        M-orthonormal.
    pieces : int
        Number of separate pieces that have rigid-body motions.
    """
    _, label = connected_components(pencil.pattern, directed=False)
    U, scalar = _geometric(model, label)
    size = sp.csr_matrix((np.abs(pencil.K.data), pencil.K.indices, pencil.K.indptr), pencil.K.shape)
    force = pencil.K @ U
    noise = max(_ROUNDING, 4.0 * precision(pencil.K)) * (size @ np.abs(U).sum(axis=1))
    mass = pencil.M @ U
    columns: list[tuple[Ints, Floats]] = []
    pieces = 0
    for rows in _groups(label):
        used = slice(6, 7) if scalar[rows].all() else slice(0, 6)
        found = _strain_free(U[rows, used], mass[rows, used], force[rows, used], noise[rows])
        pieces += found.shape[1] > 0
        columns += [(rows, v) for v in found.T]
    V = np.zeros((pencil.n, len(columns)))
    for j, (rows, v) in enumerate(columns):
        V[rows, j] = v
    return V, pieces


def precision(K: sp.csr_matrix) -> float:
    """Relative rounding of stored values that came through single precision or few digits.

    Zero for full double precision. A matrix read from a punch file with ten digits restrains its
    rigid-body motions by that rounding. Round numbers typed by hand are exact and do not count:
    most values must need the last digit.
    """
    data = K.data[K.data != 0.0]
    sample = data[:: max(1, len(data) // 2000)]
    if len(sample) < 20:
        return 0.0
    needed = np.array([_digits(v) for v in sample])
    most, typical = int(needed.max()), float(np.median(needed))
    if most <= 12:
        return 0.5 * 10.0 ** (1 - most) if most >= 6 and typical == most else 0.0
    single = sample.astype(np.float32).astype(np.float64)
    return 6e-8 if typical > 12 and np.array_equal(single, sample) else 0.0


def _digits(value: float) -> int:
    """Significant decimal digits that a number needs, at most 17."""
    return len(repr(float(value)).split("e")[0].replace(".", "").strip("-0"))


def _groups(label: Ints) -> Iterator[Ints]:
    """Rows of each piece."""
    order = np.argsort(label, kind="stable")
    yield from np.split(order, np.flatnonzero(np.diff(label[order])) + 1)


def _geometric(model: Model, label: Ints) -> tuple[Floats, Floats]:
    """Six rigid-body motions and one common to the scalar points, (n_free, 7).

    By least squares over `expansion`. The second result, (n_free,), says which free degrees of
    freedom move scalar points only.
    """
    row = model.geometry.index_of(model.dofs.node)
    row = np.where(model.dofs.component > 0, row, -1)
    is_scalar = row < 0
    span = model.geometry.size or 1.0
    axis = model.dofs.axis
    xyz = model.geometry.xyz
    arm = (xyz[row] - xyz.mean(axis=0)) / span if len(xyz) else np.zeros_like(axis)
    translation = (model.dofs.component <= 3)[:, None]
    R = np.zeros((len(model.dofs), 7))
    R[:, :3] = np.where(translation, axis, 0.0)
    R[:, 3:6] = np.where(translation, np.cross(arm, axis), axis / span)
    R[is_scalar, :6] = 0.0
    R[is_scalar, 6] = 1.0
    T = sp.csr_matrix(model.expansion)
    # a dependent row that follows two pieces cannot tell the motion of one
    filled = np.flatnonzero(np.diff(T.indptr))
    low = np.minimum.reduceat(label[T.indices], T.indptr[filled])
    high = np.maximum.reduceat(label[T.indices], T.indptr[filled])
    keep = filled[low == high]
    T, R, is_scalar = T[keep], R[keep], is_scalar[keep]
    normal = (T.T @ T).tocsr()
    idle = normal.diagonal() == 0.0
    U = factorise(normal + sp.diags(idle.astype(float))).solve(T.T @ R)
    touches_grid = np.asarray(abs(T[~is_scalar]).sum(axis=0)).ravel() > 0.0
    return U, ~touches_grid


def _strain_free(U: Floats, MU: Floats, KU: Floats, noise: Floats) -> Floats:
    """M-orthonormal basis of the combinations of U whose forces are below the noise."""
    size = np.linalg.norm(U, axis=0)
    basis = size > 1e-10 * size.max(initial=0.0)
    if not basis.any():
        return U[:, :0]
    floor = np.where(noise > 0.0, noise, 1.0)
    Z = KU[:, basis] / floor[:, None]
    _, _, vt = np.linalg.svd(qr(Z, mode="r")[0][: Z.shape[1]])
    free = np.abs(Z @ vt.T).max(axis=0) <= 1.0
    C = vt.T[:, free]
    V = U[:, basis] @ C
    gram = V.T @ (MU[:, basis] @ C)
    value, vector = np.linalg.eigh((gram + gram.T) / 2.0)
    kept = value > 1e-12 * np.sum(U[:, basis] * MU[:, basis], axis=0).max(initial=0.0)
    return np.asarray(V @ (vector[:, kept] / np.sqrt(value[kept])))
