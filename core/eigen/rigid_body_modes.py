"""Rigid-body motions, recognised by the rank of the stiffness and not by a frequency."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.linalg import qr, solve_triangular
from scipy.sparse.csgraph import connected_components

from ..arrays import Bools, Floats, Ints, Numbers
from ..data.parametric_model import Model
from ..errors import CheckError
from ..numerics.factorisation import factorise
from .eigen_numbers import EIGEN
from .pencil import Pencil, magnitudes, same_entries, widest_pattern


@dataclass(frozen=True, eq=False)
class Place:
    """What the rigid motions of a model have of its geometry, at any values of its parameters.

    Parameters
    ----------
    unit : (n_free, 7) float
        Six motions of a rigid body and one common to the scalar points.
    scalar : (n_free,) bool
        Which degrees of freedom move scalar points only.
    label : (n_free,) int
        Which piece each is of, connected by `pattern`.
    pattern : (n_free, n_free) sparse
    """

    unit: Floats
    scalar: Bools
    label: Ints
    pattern: sp.csr_matrix

    @classmethod
    def of(cls, model: Model, pencil: Pencil) -> Place:
        """Find it by the geometry of a model and what K and M connect."""
        return cls(*_geometric(model), _pieces(model, pencil), pencil.pattern)

    def connects(self, pencil: Pencil) -> bool:
        """Whether a pencil connects the same."""
        return same_entries(self.pattern, pencil.pattern)


@dataclass(frozen=True, eq=False)
class RigidBody:
    """What a model can do as a rigid body.

    Parameters
    ----------
    modes : (n_free, n_rigid) float
        Motions without strain energy, M-orthonormal.
    motions : (n_free, k) float
        All rigid motions, with strain energy or without, of the pieces that nothing holds in
        translation, M-orthonormal.
    pieces : tuple of (k,) int
        Rows of each separate piece that has rigid-body modes, the smallest first.
    held : int
        Number of separate pieces that have none.
    unit, force : (n_free, 7) float
        The motions of a rigid body as far as the pieces can follow, and what the stiffness has
        against them: exactly nothing where that is rounding.
    label : (n_free,) int
        Which piece a degree of freedom belongs to.
    place : Place
    """

    modes: Floats
    motions: Floats
    pieces: tuple[Ints, ...]
    held: int
    unit: Floats
    force: Floats
    label: Ints
    place: Place

    def part(self, stiffness: Floats, Z: Floats) -> tuple[Floats, Floats]:
        """Return the part of Z (n_free, k) that pieces make as rigid bodies, and its forces.

        What is left over has the least sum of squares weighted by `stiffness` (n_free,).
        """
        rigid, force = np.zeros_like(Z), np.zeros_like(Z)
        root = np.sqrt(stiffness)[:, None]
        for rows in _rows_of(self.label):
            unit = self.unit[rows]
            c, *_ = np.linalg.lstsq(root[rows] * unit, root[rows] * Z[rows], rcond=None)
            rigid[rows], force[rows] = unit @ c, self.force[rows] @ c
        return rigid, force

    def split(self, pencil: Pencil, Z: Floats) -> tuple[Floats, Floats, Floats]:
        """Tell motions that are nearly those of a rigid body from mechanisms.

        Springs or constraint equations between grids that are not in one place resist a rigid
        rotation, and let the structure turn in another way that costs nothing. M-orthonormal
        motions Z (n_free, k) without strain energy besides `modes` are divided into those that are
        nearly so and mechanisms; with them come the rigid motions that the former stand for.
        """
        M = pencil.M
        G = self.motions - self.modes @ (self.modes.T @ (M @ self.motions))
        value, W = np.linalg.eigh(G.T @ (M @ G))
        G = G @ W[:, value > 0.5]
        u, s, vt = np.linalg.svd((M @ Z).T @ G)
        count = int(np.count_nonzero(s > EIGEN.nearly))
        return Z @ u[:, :count], Z @ u[:, count:], G @ vt[:count].T


def posed(
    model: Model | tuple[sp.spmatrix, sp.spmatrix],
    p: Floats | None,
    place: Place | None,
    for_others: bool,
) -> tuple[Pencil, RigidBody | None]:
    """Return the pencil, on a pattern that others have where it is for them, and its free motions.

    The latter are of a `Model` alone.
    """
    pencil = Pencil.of(model, p)
    if not isinstance(model, Model):
        return pencil, None
    if place is not None:
        pencil = pencil.on(place.pattern)
    elif for_others:
        pencil = pencil.on(widest_pattern(model))
    return pencil, rigid_body(model, pencil, place)


def rigid_body(model: Model, pencil: Pencil, place: Place | None = None) -> RigidBody:
    """Find the rigid-body motions of a model that cost no strain energy by its `pencil`.

    Each piece of the model (connected through K or M) is given the six motions of a rigid body
    as far as its free degrees of freedom can follow; those combinations u count for which every
    row of K u is rounding beside |K| |u|. So a suspension of any softness is stiffness, and a
    body on a hinge line keeps one motion. A `place` that was found for other values of the model's
    parameters serves again where these connect the same.
    """
    if place is None or not place.connects(pencil):
        place = Place.of(model, pencil)
    U, scalar, label = place.unit.copy(), place.scalar, place.label
    _follow(pencil, U, scalar & np.isin(label, label[~scalar]))
    force, size = pencil.K @ U, magnitudes(pencil.K) @ np.abs(U).sum(axis=1)
    noise = max(EIGEN.row_rounding, EIGEN.digits * pencil.precision) * size
    mass = pencil.M @ U
    modes: list[tuple[Ints, Floats]] = []
    motions: list[tuple[Ints, Floats]] = []
    pieces: list[Ints] = []
    held = 0
    for rows in _rows_of(label):
        used = slice(6, 7) if scalar[rows].all() else slice(0, 6)
        u, mu, ku = U[rows, used], mass[rows, used], force[rows, used]
        free = _strain_free(u, mu, ku, noise[rows])
        if free.shape[1]:
            pieces.append(rows)
        else:
            held += 1
        modes.append((rows, free))
        if (np.abs(ku[:, :3]) <= noise[rows, None]).all():
            motions.append((rows, _orthonormal(u, mu)))
    found, moved = (_assembled(parts, pencil.n) for parts in (modes, motions))
    force[np.abs(force) <= noise[:, None]] = 0.0
    found = _again(found, pencil.M)
    return RigidBody(found, moved, tuple(sorted(pieces, key=len)), held, U, force, label, place)


def _rows_of(label: Ints) -> list[Ints]:
    """Rows of each piece."""
    order = np.argsort(label, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(label[order])) + 1)


def _assembled(parts: Sequence[tuple[Ints, Floats]], n: int) -> Floats:
    """Columns of the pieces in one matrix, (n, sum of columns)."""
    out = np.zeros((n, sum(v.shape[1] for _, v in parts)), order="F")
    at = 0
    for rows, v in parts:
        out[rows, at : at + v.shape[1]] = v
        at += v.shape[1]
    return out


def _pieces(model: Model, pencil: Pencil) -> Ints:
    """Which separate piece each free degree of freedom belongs to, (n_free,).

    Connected are those that share an entry of K or M, and all that move one node.
    """
    nodes, row = np.unique(model.dofs.node, return_inverse=True)
    T = abs(sp.csr_matrix(model.expansion))
    node = sp.csr_matrix((np.ones(len(row)), (row, np.arange(len(row)))), (len(nodes), len(row)))
    graph = sp.bmat([[pencil.pattern, None], [node @ T, sp.csr_matrix((len(nodes),) * 2)]])
    return np.asarray(connected_components(graph, directed=False)[1][: pencil.n], np.int64)


def _geometric(model: Model) -> tuple[Floats, Bools]:
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
    normal = (T.T @ T).tocsr()
    idle = normal.diagonal() == 0.0
    least_squares = factorise(normal + sp.diags(idle.astype(float)))
    U = least_squares.solve(T.T @ R)
    U += least_squares.solve(T.T @ (R - T @ U))  # the normal equations alone lose half the digits
    touches_grid = np.asarray(abs(T[~is_scalar]).sum(axis=0)).ravel() > 0.0
    return U, ~touches_grid


def _follow(pencil: Pencil, U: Floats, followers: Numbers) -> None:
    """Let scalar points of a piece with grids follow its motions without strain, in place."""
    if not followers.any():
        return
    rows = sp.csr_matrix(pencil.K)[np.flatnonzero(followers)]
    own = rows[:, np.flatnonzero(followers)]
    loose = sp.diags((own.diagonal() == 0.0).astype(float))
    moved = np.where(followers[:, None], 0.0, U[:, :6])
    try:
        U[followers, :6] = -factorise(own + loose).solve(rows @ moved)
    except CheckError:
        return  # they hang together by themselves: no motion of the grids is theirs


def _strain_free(U: Floats, MU: Floats, KU: Floats, noise: Floats) -> Floats:
    """M-orthonormal basis of the combinations of U whose forces are below the noise."""
    size = np.linalg.norm(U, axis=0)
    basis = size > EIGEN.followed * size.max(initial=0.0)
    if not basis.any():
        return U[:, :0]
    floor = np.where(noise > 0.0, noise, 1.0)
    Z = KU[:, basis] / floor[:, None]
    _, _, vt = np.linalg.svd(qr(Z, mode="r")[0][: Z.shape[1]])
    free = np.abs(Z @ vt.T).max(axis=0) <= 1.0
    C = vt.T[:, free]
    scale = np.sum(U[:, basis] * MU[:, basis], axis=0).max(initial=0.0)
    return _orthonormal(U[:, basis] @ C, MU[:, basis] @ C, scale)


def _again(modes: Floats, M: sp.spmatrix) -> Floats:
    """Make orthonormal modes so once more: a large mass in their products costs them digits."""
    if not modes.shape[1]:
        return modes
    L = np.linalg.cholesky(modes.T @ (M @ modes))
    return np.asarray(solve_triangular(L, modes.T, lower=True).T)


def _orthonormal(V: Floats, MV: Floats, scale: float = 0.0) -> Floats:
    """M-orthonormal basis of V; directions of little mass beside `scale` are left out."""
    value, W = np.linalg.eigh((V.T @ MV + MV.T @ V) / 2.0)
    kept = value > EIGEN.massive * max(scale, value.max(initial=0.0))
    return np.asarray(V @ (W[:, kept] / np.sqrt(value[kept])))
