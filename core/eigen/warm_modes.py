"""The lowest modes from vectors that nearly span them: inverse iteration and a count by one factor.

The shift s lies in a gap above the modes that are asked for. The signs of the factor of K - s M
count the modes below s (Sylvester's law of inertia). Ritz values never see more modes below s than
there are: when they see as many as the count, none was missed.

That count makes the bound of errors quadratic. Of OP = (K - s M)^-1 M the modes below s are all
that is negative; a Ritz vector x of value theta = 1 / (lambda - s) and residual r = OP x - theta x
has an eigenvalue within |r|^2 / |theta|, since nothing outside all of them is below zero but by
another such square (Mathias 1998, SIAM Journal on Matrix Analysis 19, 541).
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg as sl

from ..arrays import Floats
from ..errors import CheckError
from ..numerics.factorisation import Backend, factorise
from .eigen_numbers import EIGEN
from .pencil import Pencil, Spectrum, widest_gap


@dataclass(frozen=True, eq=False)
class Near:
    """What is known of the elastic modes before they are solved for.

    Parameters
    ----------
    values : (k,) float
        Rough eigenvalues, ascending, some more than are wanted: a gap is looked for there.
    vectors : (n_free, m) float
        Span the lowest modes nearly, m <= k.
    """

    values: Floats
    vectors: Floats


def warm_modes(
    pencil: Pencil, rigid: Floats, near: Near, elastic: int, backend: Backend, seed: int
) -> Spectrum | None:
    """Find the `elastic` lowest modes that are M-orthogonal to `rigid`, (n, n_rigid).

    Vectors drawn at random begin beside those that are near, so that a mode is found of which
    these know nothing.

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
    s = float(low + EIGEN.within[0] * (high - low))
    try:
        factor = factorise(pencil.shifted(s), False, backend, pencil.groups)
        below = factor.negative - rigid.shape[1]
    except CheckError:
        return None
    X, values = near.vectors, near.values[: near.vectors.shape[1]]
    fresh = np.random.default_rng(seed).standard_normal((pencil.n, EIGEN.guard))
    for _ in range(EIGEN.warm_steps):
        Y = factor.solve(pencil.M @ np.hstack([X, fresh]))
        Y -= rigid @ (rigid.T @ (pencil.M @ Y))
        if np.count_nonzero(values < s) == below and not fresh.shape[1]:
            found = _polished(pencil, s, X[:, :below], Y[:, :below], elastic)
            if found is not None:
                return found
        Y[:, : len(values)] = X - Y[:, : len(values)] * (values - s)
        values, X = _ritz(pencil, np.hstack([X, Y]), max(below, elastic) + EIGEN.guard)
        fresh = fresh[:, :0]
    return None


def _polished(pencil: Pencil, s: float, X: Floats, Y: Floats, elastic: int) -> Spectrum | None:
    """Ritz pairs of Y = (K - s M)^-1 M X, X being as many as there are modes below s.

    None where those of X are not accurate, or a mode is so near to s that its sign is rounding.
    """
    MX, MY = pencil.M @ X, pencil.M @ Y
    stiff = MX.T @ Y
    rho, turn = np.linalg.eigh((stiff + stiff.T) / 2.0)
    rho, turn = rho[::-1], turn[:, ::-1]  # 1 / (lambda - s): the lowest mode is next to zero
    if rho[0] >= 0.0:
        return None
    alpha, C = sl.eigh((stiff + stiff.T) / 2.0, Y.T @ MY)
    R, MR = Y @ turn - (X @ turn) * rho, MY @ turn - (MX @ turn) * rho
    off = np.abs(1.0 / rho**3) * np.einsum("ij,ij->j", R, MR) + np.abs(alpha - 1.0 / rho)
    values, first = s + alpha, slice(elastic)
    sigma = -max(pencil.least_shift, EIGEN.nearer[0] * float(values[0]))
    error = off / (values - sigma)
    if error[first].max() > EIGEN.warm:
        return None
    X = Y @ C
    size = float((np.abs(pencil.k_diagonal) @ X**2).max())
    backward = pencil.backward_error(values, X, pencil.K @ X, MY @ C)
    if backward > EIGEN.backward or -alpha[-1] <= EIGEN.signs * size:
        return None
    return Spectrum(values[first], X[:, first], error[first], sigma, complete=False, missed=0)


def _ritz(pencil: Pencil, S: Floats, most: int) -> tuple[Floats, Floats]:
    """Find the `most` lowest Ritz pairs in the span of S (n, k)."""
    stiff, mass = S.T @ (pencil.K @ S), S.T @ (pencil.M @ S)
    massive = mass.diagonal() > 0.0
    lowest = (stiff.diagonal()[massive] / mass.diagonal()[massive]).min()
    shift = max(pencil.least_shift, float(lowest))
    A = stiff + shift * mass
    scale = 1.0 / np.sqrt(A.diagonal())
    size, W = np.linalg.eigh(A * np.outer(scale, scale))
    kept = size > EIGEN.spanned * size[-1]
    W = scale[:, None] * W[:, kept] / np.sqrt(size[kept])
    theta, C = np.linalg.eigh(W.T @ mass @ W)
    theta, C = theta[::-1][:most], C[:, ::-1][:, :most]
    massive = theta > EIGEN.zero * theta[0]
    C = W @ (C[:, massive] / np.sqrt(theta[massive]))
    return 1.0 / theta[massive] - shift, S @ C
