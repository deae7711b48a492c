"""The lowest modes from vectors that nearly span them: inverse iteration and a count by one factor.

The shift s lies in a gap above the modes that are asked for. The signs of the factor of K - s M
count the modes below s (Sylvester's law of inertia). Ritz values never see more modes below s than
there are: when they see as many as the count, none was missed.

That count bounds the errors from both sides. Of OP = (K - s M)^-1 M the modes below s are all that
is negative. On vectors X it has Ritz values rho; where as many are negative, none lies below
that which it stands for, so that 1 / rho <= lambda - s. Rayleigh's quotients alpha of K - s M on
OP X are too large, and what is returned: lambda - s <= alpha (Lehmann 1963, Numerische Mathematik
5, 246). Their difference goes by the square of the error of X.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.linalg as sl

from ..arrays import Floats
from ..errors import CheckError
from ..numerics.factorisation import Backend, Factorisation, factorise
from ..numerics.products import product, sparse_product
from .eigen_numbers import EIGEN
from .pencil import Pencil, Spectrum, widest_gap
from .rigid_body_modes import Place


@dataclass(frozen=True, eq=False)
class Kept:
    """What one solution of a model leaves for the next, at other values of its parameters.

    Parameters
    ----------
    place : Place
    counter : Factorisation
        Of K - s M, by which modes were counted.
    """

    place: Place
    counter: Factorisation


@dataclass(frozen=True, eq=False)
class Near:
    """What is known of the elastic modes before they are solved for, by the method of Ritz.

    Parameters
    ----------
    values : (k,) float
        Rough eigenvalues, ascending, some more than are wanted: a gap is looked for there.
    vectors : (n_free, m) float
        Those of the first m <= k, mass-orthonormal and orthogonal by the stiffness.
    kept : Kept, optional
        Of a solution of the same model: its counter is factorised anew.
    """

    values: Floats
    vectors: Floats
    kept: Kept | None = None


@dataclass(frozen=True, eq=False)
class _Step:
    """Vectors Z (n, k) and Y = (K - s M)^-1 M Z, with M Z, M Y and what products of them need.

    No product with K is wanted: Z^T K Y and Y^T K Y follow from these.
    """

    Z: Floats
    Y: Floats
    MZ: Floats
    MY: Floats

    @cached_property
    def grams(self) -> tuple[Floats, Floats, Floats]:
        """Z^T M Z, Z^T M Y and Y^T M Y."""
        crossed = product(self.MZ.T, self.Y)
        massive, moved = product(self.Z.T, self.MZ), product(self.Y.T, self.MY)
        return massive, (crossed + crossed.T) / 2.0, moved


def warm_modes(
    pencil: Pencil, rigid: Floats, near: Near, elastic: int, backend: Backend, seed: int
) -> Spectrum | None:
    """Find the `elastic` lowest modes that are M-orthogonal to `rigid`, (n, n_rigid).

    Where these show fewer modes than the count, vectors drawn at random go on beside them.

    Returns
    -------
    Spectrum or None
        None where no gap is in sight or not all modes below it converge soon: a search from
        nothing is due.
    """
    above = widest_gap(near.values, elastic)
    if above is None:
        return None
    low, high = near.values[above - 1 : above + 1]
    s = float(low + EIGEN.within[0] * min(high - low, EIGEN.known_gap * abs(low)))
    try:
        factor = _factor(pencil, s, backend, near.kept)
        below = factor.negative - rigid.shape[1]
    except CheckError:
        return None
    X, values = near.vectors, near.values[: near.vectors.shape[1]]
    MX, rigid_mass = sparse_product(pencil.M, X), pencil.M @ rigid
    rng = np.random.default_rng(seed)
    for _ in range(EIGEN.warm_steps):
        counted = np.count_nonzero(values < s) == below
        if not counted:
            fresh = rng.standard_normal((pencil.n, EIGEN.guard))
            fresh -= rigid @ (rigid_mass.T @ fresh)
            X, MX = np.hstack([X, fresh]), np.hstack([MX, pencil.M @ fresh])
        Y = factor.solve(MX)
        Y -= rigid @ (rigid_mass.T @ Y)
        step = _Step(X, Y, MX, sparse_product(pencil.M, Y))
        found = _polished(pencil, s, step, below, elastic) if counted else None
        if found is not None:
            return replace(found, count_factor=factor)
        values, C = _ritz(pencil, s, values, step, max(below, elastic) + EIGEN.guard)
        k = X.shape[1]
        X = product(X, C[:k])
        product(Y, C[k:], X, add=True)
        MX = sparse_product(pencil.M, X)
    return None


def _factor(pencil: Pencil, s: float, backend: Backend, kept: Kept | None) -> Factorisation:
    """Return the factor of K - s M, by what is kept of one on that pattern."""
    if kept is None or kept.counter.backend != backend:
        return factorise(pencil.shifted(s), False, backend, pencil.groups)
    kept.counter.refactorise(pencil.shifted(s))
    return kept.counter


def _polished(pencil: Pencil, s: float, step: _Step, below: int, elastic: int) -> Spectrum | None:
    """Ritz pairs in the span of Y, as many as there are modes below s.

    None where those of Z are not accurate, or a mode is so near to s that its sign is rounding.
    """
    mass, stiff, moved = step.grams
    rho = sl.eigh(stiff, mass, eigvals_only=True)[:below]  # 1 / (lambda - s)
    rho = rho[::-1]  # the lowest mode is next to zero
    if rho[0] >= 0.0:
        return None
    alpha, C = sl.eigh(stiff, moved, subset_by_index=(0, below - 1))
    off = np.abs(alpha - 1.0 / rho)
    values, first = s + alpha, slice(elastic)
    sigma = -max(pencil.least_shift, EIGEN.nearer[0] * float(values[0]))
    error = off / (values - sigma)
    if error[first].max() > EIGEN.warm:
        return None
    X = product(step.Y, C)
    size = float((np.abs(pencil.k_diagonal) @ X**2).max())
    X, few = X[:, first], C[:, first]
    left = product(step.MZ, few)  # (K - lambda M) X
    left -= product(step.MY, few * alpha[first])
    backward = pencil.backward_error(values[first], X, left)
    if backward > EIGEN.backward or -alpha[-1] <= EIGEN.signs * size:
        return None
    return Spectrum(values[first], X, error[first], sigma, complete=False, missed=0)


def _ritz(
    pencil: Pencil, s: float, values: Floats, step: _Step, most: int
) -> tuple[Floats, Floats]:
    """Find the `most` lowest Ritz pairs in the span of Z and Y: coefficients, (2 k, most).

    The first vectors of Z are Ritz vectors of `values`; the others are taken by their Y alone.
    """
    k, m = step.Z.shape[1], len(values)
    massive, crossed, moved = step.grams
    mass = np.block([[massive, crossed], [crossed, moved]])
    mixed = massive + s * crossed
    stiff = np.block(
        [[np.diag(np.append(values, np.zeros(k - m))), mixed], [mixed.T, crossed + s * moved]]
    )
    taken = np.r_[:m, k : 2 * k]
    stiff, mass = (whole[np.ix_(taken, taken)] for whole in (stiff, mass))
    positive = mass.diagonal() > 0.0
    lowest = (stiff.diagonal()[positive] / mass.diagonal()[positive]).min()
    shift = max(pencil.least_shift, float(lowest))
    A = stiff + shift * mass
    scale = 1.0 / np.sqrt(A.diagonal())
    size, W = np.linalg.eigh(A * np.outer(scale, scale))
    kept = size > EIGEN.spanned * size[-1]
    W = scale[:, None] * W[:, kept] / np.sqrt(size[kept])
    theta, C = np.linalg.eigh(W.T @ mass @ W)
    theta, C = theta[::-1][:most], C[:, ::-1][:, :most]
    finite = theta > EIGEN.zero * theta[0]
    out = np.zeros((2 * k, np.count_nonzero(finite)))
    out[taken] = W @ (C[:, finite] / np.sqrt(theta[finite]))
    return 1.0 / theta[finite] - shift, out
