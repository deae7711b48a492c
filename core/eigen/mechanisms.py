"""Motions that nothing resists: found from a singular factorisation, named for the user.

Or from motions of free grids that look like those of a rigid body, of a structure that is held.
"""

import numpy as np
import scipy.linalg as sl
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from ..arrays import Floats, Ints, Numbers
from ..data.parametric_model import Model
from ..errors import InputError
from ..numerics.factorisation import Backend, Factorisation, factorise
from .eigen_numbers import EIGEN
from .pencil import Pencil

NEGATIVE = (
    "the stiffness is not positive semi-definite: "
    "look for negative springs, moduli or section values near {}"
)


class Massless(InputError):
    """Motions with neither stiffness nor mass; `motions` is (n, n_motion) float."""

    def __init__(self, message: str, motions: Floats) -> None:
        super().__init__(message)
        self.motions = motions


def refuse_unresisted(model: Model | None, pencil: Pencil, sigma: float, f: Factorisation) -> None:
    """Raise `InputError` when A = K - sigma M is singular: a motion with no stiffness or mass.

    One solve with the factor `f` of A is all it takes, unless the answer is suspicious; the model
    is for the message.
    """
    D = pencil.k_diagonal - sigma * pencil.m_diagonal
    if not (D > 0.0).all():
        diagnose(model, pencil, sigma, f.backend)
    b = np.sqrt(D) * np.random.default_rng(3).standard_normal(pencil.n)
    y = f.solve(b)
    if not np.isfinite(y).all() or not float(b @ y) > EIGEN.singular * float(y @ (D * y)):
        diagnose(model, pencil, sigma, f.backend)


def diagnose(
    model: Model | None, pencil: Pencil, sigma: float, backend: Backend | None = None
) -> None:
    """Raise `InputError` that says why K - sigma M is not positive definite, if it is not.

    The question is put to the pencil of A = K - s M and its diagonal D, which has no units: at
    a strong shift s, where only motions without stiffness and mass stay near zero, then at sigma
    for a negative stiffness.
    """
    strong = min(sigma, -float(np.median(pencil.stiffness_over_mass)))
    for shift in (strong, sigma):
        A = (pencil.K - shift * pencil.M).tocsr()
        D = A.diagonal()
        if not (D > 0.0).all():
            names = [pencil.name(int(r)) for r in np.flatnonzero(~(D > 0.0))]
            raise InputError(NEGATIVE.format(", ".join(names[: EIGEN.named])))
        scale = sp.diags(1.0 / np.sqrt(D))
        scaled = (scale @ A @ scale).tocsr()
        dense = pencil.n <= EIGEN.dense
        mu, Y = np.linalg.eigh(scaled.toarray()) if dense else _smallest(scaled, backend)
        X = scale @ Y
        if mu[0] < -max(EIGEN.singular, EIGEN.digits * pencil.precision):
            raise InputError(NEGATIVE.format(where(model, pencil, X[:, :1])))
        X = _of_neither(pencil, X[:, np.abs(mu) <= EIGEN.singular])
        if shift == strong and X.shape[1]:
            raise mechanism(model, pencil, X, massless=True)


def _of_neither(pencil: Pencil, X: Floats) -> Floats:
    """Return combinations of X (n, k) whose energies are both rounding, beside their diagonals."""
    if not X.shape[1]:
        return X
    stiff, massive = ((X.T * np.abs(d)) @ X for d in (pencil.k_diagonal, pencil.m_diagonal))
    usual = np.trace(stiff) / float(np.median(pencil.stiffness_over_mass))
    k, m = np.trace(stiff), max(np.trace(massive), EIGEN.some_mass * usual)
    energy = X.T @ (pencil.K @ X) / k + X.T @ (pencil.M @ X) / m
    size = stiff / k + massive / m
    mu, turn = sl.eigh(energy, size)
    return np.asarray(X @ turn[:, mu <= EIGEN.singular])


def _smallest(scaled: sp.csr_matrix, backend: Backend | None) -> tuple[Floats, Floats]:
    """Lowest eigenpairs of a scaled matrix: a negative one, or else those next to zero."""
    n = scaled.shape[0]
    rng = np.random.default_rng(4)
    factor = factorise(scaled + EIGEN.off_zero * EIGEN.singular * sp.eye(n), False, backend)
    if factor.negative:
        mu, Y = spla.eigsh(
            scaled, k=1, which="SA", tol=EIGEN.negative_found, v0=rng.standard_normal(n)
        )
        return mu, Y
    Y = rng.standard_normal((n, 2 * EIGEN.named))
    for _ in range(EIGEN.sweeps):
        Y = np.linalg.qr(factor.solve(Y))[0]
    mu, turn = np.linalg.eigh(Y.T @ (scaled @ Y))
    return mu, Y @ turn


def mechanism(
    model: Model | None,
    pencil: Pencil,
    X: Floats,
    rigid: Floats | None = None,
    *,
    massless: bool = False,
) -> InputError:
    """Return the error that names where motions X (n, n_motion) without resistance are.

    Of rigid-body modes (n, n_rigid) as much is taken out as leaves most of the structure at rest;
    `massless` says whether the motions have no mass either.
    """
    if rigid is not None and rigid.shape[1]:
        X = _least_motion(X, rigid, _lengths(model, pencil.n))
    without = "neither stiffness nor mass" if massless else "no stiffness"
    message = (
        f"the model is a mechanism: {_motions(X)} with {without} besides the rigid-body modes, at "
        f"{where(model, pencil, X)}; constrain these directions or give them stiffness"
    )
    return Massless(message, X) if massless else InputError(message)


def hold(
    model: Model | None, pencil: Pencil, X: Floats, rigid: Floats
) -> tuple[Pencil, Floats, str]:
    """Hold motions X (n, n_motion) that have neither stiffness nor mass.

    One degree of freedom of each is sprung to ground. Every other motion can leave it at rest by
    a part of X that costs nothing, so no mode and no frequency notices (MSC Nastran's MECHFIX).
    Returned are the pencil with the springs, the rigid-body modes (n, n_rigid) that leave them
    at rest, and what to tell the user.
    """
    X = np.linalg.qr(X)[0]
    held = sl.qr(X.T, mode="r", pivoting=True)[1][: X.shape[1]]
    rigid = rigid - X @ np.linalg.solve(X[held], rigid[held])
    note = (
        f"{_motions(X)} with neither stiffness nor mass, at {where(model, pencil, X)}, held at "
        f"{_named(pencil, held)}"
    )
    return pencil.sprung(held), rigid, note


def _motions(X: Floats) -> str:
    return "a motion" if X.shape[1] == 1 else f"{X.shape[1]} motions"


def _named(pencil: Pencil, rows: Ints) -> str:
    more = f" and {len(rows) - EIGEN.named} more" if len(rows) > EIGEN.named else ""
    return ", ".join(pencil.name(int(r)) for r in rows[: EIGEN.named]) + more


def _least_motion(X: Floats, rigid: Floats, lengths: Floats) -> Floats:
    """X less the rigid motions that leave the smallest sum of displacements, (n, n_motion).

    Iteratively reweighted least squares.
    """
    scaled, base = X * lengths[:, None], rigid * lengths[:, None]
    for column in scaled.T:
        rest = column.copy()
        for _ in range(EIGEN.reweighted):
            weight = 1.0 / np.sqrt(np.abs(rest) + EIGEN.at_rest * np.abs(column).max())
            c, *_ = np.linalg.lstsq(base * weight[:, None], column * weight, rcond=None)
            rest = column - base @ c
        column[:] = rest
    return np.asarray(scaled / lengths[:, None])


def where(model: Model | None, pencil: Pencil, X: Floats) -> str:
    """Name the degrees of freedom that move most in any of the vectors X, (n, n_vector)."""
    motion = np.abs(X) * _lengths(model, pencil.n)[:, None]
    motion = (motion / motion.max(axis=0)).max(axis=1)
    rows = np.flatnonzero(motion > EIGEN.named_motion)
    rows = rows[np.argsort(-motion[rows], kind="stable")]
    return _named(pencil, rows)


def _lengths(model: Model | None, n: int) -> Floats:
    """Displacement that a unit of each free degree of freedom makes, (n,): 1, or a lever arm."""
    if model is None:
        return np.ones(n)
    arm = EIGEN.arm * (model.geometry.size or 1.0)
    row = np.where((model.dofs.component > 3) & (model.dofs.component <= 6), arm, 1.0)
    moved = abs(sp.csr_matrix(model.expansion)).T @ sp.diags(row)
    length = moved.max(axis=1).toarray().ravel()
    return np.where(length > 0.0, length, 1.0)


def refuse_linkage(model: Model, pencil: Pencil, modes: Floats) -> None:
    """Refuse free motions that bend a linkage: an element turns about a grid that is held.

    The free grids of a four-bar linkage go sideways as in the translation of a rigid body; but
    its cranks turn about the ground. No rigid motion moves the free grids so and leaves at rest
    the grids that are held at the other ends of their elements. (A pendulum is a rigid body.)
    `modes` (n_free, n_mode) are without strain energy and count as rigid-body modes.

    Raises
    ------
    InputError
        With the grids and directions that move.
    """
    still = np.asarray(abs(sp.csr_matrix(model.expansion)).sum(axis=1)).ravel() == 0.0
    if not modes.shape[1] or not still.any():
        return
    moving = [k for k in range(modes.shape[1]) if _turns(model, still, modes[:, k])]
    if moving:
        X = modes[:, moving]
        raise InputError(
            f"the model is a mechanism: {_motions(X)} of parts that are held elsewhere, without "
            f"stiffness, at {where(model, pencil, X)}; constrain these directions or give them "
            "stiffness"
        )


def _turns(model: Model, still: Numbers, u: Floats) -> bool:
    """Whether no rigid motion moves all moving grids so and leaves the held ones at rest."""
    v = np.asarray(model.expansion @ u)
    dofs, geometry = model.dofs, model.geometry
    row = geometry.index_of(dofs.node)
    translation = (dofs.component >= 1) & (dofs.component <= 3) & (row >= 0)
    moving = translation & (np.abs(v) > EIGEN.moved * np.abs(v).max())
    grids = np.unique(row[moving])
    if not len(grids):
        return False
    involved = np.isin(row, np.union1d(grids, _neighbours(model, grids)))
    known = translation & involved & (still | np.isin(row, grids))
    known &= ~(still & np.isin(dofs.node, model.idle))
    rows = np.flatnonzero(known)
    arm = (geometry.xyz[row[rows]] - geometry.xyz[grids].mean(axis=0)) / (geometry.size or 1.0)
    R = np.hstack([dofs.axis[rows], np.cross(arm, dofs.axis[rows])])
    c, *_ = np.linalg.lstsq(R, v[rows], rcond=None)
    return bool(np.abs(R @ c - v[rows]).max() > EIGEN.turned * np.abs(v[rows]).max())


def _neighbours(model: Model, grids: Ints) -> Ints:
    """Grid rows on elements that have any of the given ones."""
    moved = np.zeros(len(model.geometry.ids), bool)
    moved[grids] = True
    rows = [c[moved[c].any(axis=1)].ravel() for c in model.geometry.elements.values()]
    return np.asarray(np.unique(np.concatenate([np.zeros(0, np.int64), *rows])))
