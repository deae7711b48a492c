"""Derivatives of mode shapes, exact outside the known modes by preconditioned solves."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Ints
from ..data.parametric_model import Model
from ..eigen.normal_modes import Eigensolution
from ..eigen.pencil import Pencil
from ..errors import InputError
from ..numerics.factorisation import Factorisation, factorise
from .derivative_numbers import DERIVATIVES


def modal_part(
    X: Floats, lam: Floats, cluster: Ints, changes: Sequence[tuple[Any, Any]]
) -> tuple[Floats, Floats, Floats]:
    """Differentiate a cluster within the span of known modes.

    Parameters
    ----------
    X : (n, n_mode) float
        Mass-orthonormal.
    lam : (n_mode,) float
    cluster : (n_cluster,) int
    changes : sequence of (K', M')
        By each of n_parameter parameters, sparse or dense.

    Returns
    -------
    z : (n, n_cluster * n_parameter) float
        Modal sum over the modes outside the cluster, and -Phi_c (Phi_c^T M' Phi_c) / 2.
    b : (n, n_cluster * n_parameter) float
        -(K' - lambda M') phi.
    along : (n_mode, n_cluster * n_parameter) float
        X^T b.
    """
    Xc, lam_c = X[:, cluster], lam[cluster]
    b = np.empty((len(X), len(cluster), len(changes)))
    within = np.empty((len(cluster), len(cluster), len(changes)))
    for i, (dK, dM) in enumerate(changes):
        moved = dM @ Xc
        b[:, :, i] = moved * lam_c - dK @ Xc
        within[:, :, i] = -0.5 * (Xc.T @ moved)
    b = b.reshape(len(X), -1)
    along = X.T @ b
    others = np.setdiff1d(np.arange(len(lam)), cluster)
    distance = lam[others, None] - np.repeat(lam_c, len(changes))
    z = X[:, others] @ (along[others] / distance) + Xc @ within.reshape(len(cluster), -1)
    return z, b, along


def modal_change(lam: Floats, cluster: Ints, K: Floats, M: Floats) -> Floats:
    """Differentiate a cluster of modes that span everything, in their own coordinates.

    Parameters
    ----------
    lam : (n_mode,) float
    cluster : (n_cluster,) int
    K, M : (n_parameter, n_mode, n_cluster) float
        Phi^T K' Phi_c and Phi^T M' Phi_c.

    Returns
    -------
    (n_mode, n_cluster, n_parameter) float
        As `modal_part`.
    """
    along = (M * lam[cluster] - K).transpose(1, 2, 0)
    others = np.setdiff1d(np.arange(len(lam)), cluster)
    z = np.empty_like(along)
    z[others] = along[others] / (lam[others, None] - lam[cluster])[:, :, None]
    z[cluster] = -0.5 * M[:, cluster].transpose(1, 2, 0)
    return z


class ShapeDerivatives:
    """Derivatives of the mass-normalised shapes of clusters of one solution.

    Parameters
    ----------
    model, p, solution
        As in `sensitivity.sensitivities`.
    tolerance : float
        Relative accuracy, in energy, of the part outside all modes of the solution.

    Notes
    -----
    Modal sum over the other known modes; what they leave lies in their M-orthogonal complement,
    where K - lambda M is positive definite: conjugate gradients preconditioned by a factor of
    K - s M, all parameters and modes of a cluster in one block.
    """

    def __init__(self, model: Model, p: Floats, solution: Eigensolution, tolerance: float) -> None:
        self._pencil = Pencil.of(model, p)
        self._solution, self._tolerance = solution, tolerance
        self._X = solution.vectors
        self._MX = np.asarray(self._pencil.M @ solution.vectors)
        self._near: Factorisation | None = None
        self._base: Factorisation | None = solution.factor

    def of(self, cluster: Ints, changes: Sequence[tuple[sp.csr_matrix, sp.csr_matrix]]) -> Floats:
        """Differentiate a cluster as a subspace, without rotation within.

        (n_free, n_cluster, n_parameter), from the derivative matrices (K', M') by each parameter.

        Raises
        ------
        InputError
            The modes above the last of the solution are too close to the cluster.
        """
        lam = self._solution.eigenvalues
        z, b, along = modal_part(self._X, lam, cluster, changes)
        columns = np.repeat(lam[cluster], len(changes))
        size = max(abs(lam[-1]), np.finfo(float).tiny)
        least = DERIVATIVES.rounding**2 * np.sum(along**2, axis=0) / size
        z += self._outside(cluster, b - self._MX @ along, columns, least)
        return z.reshape(len(z), len(cluster), len(changes))

    def _outside(self, cluster: Ints, r: Floats, lam: Floats, least: Floats) -> Floats:
        """(K - lam M)^-1 r on the complement of the known modes; one lam and `least` a column."""
        if self._X.shape[0] == self._X.shape[1]:  # all modes are known: nothing is left of r
            return np.zeros_like(r)
        factor, s = self._factor(cluster, r.shape[1])
        z = np.zeros_like(r)
        for first in range(0, r.shape[1], DERIVATIVES.block):
            part = slice(first, first + DERIVATIVES.block)
            some = r[:, part], lam[part] - s, least[part]
            z[:, part] = self._conjugate_gradients(factor, *some, cluster)
        distance = np.einsum("ij,ij->j", z, r)
        size = np.einsum("ij,ij->j", z, self._pencil.M @ z)
        if (distance < DERIVATIVES.repeated * np.abs(lam) * size).any():
            raise _too_close(cluster)
        return z

    def _conjugate_gradients(
        self, factor: Factorisation, r: Floats, mu: Floats, least: Floats, cluster: Ints
    ) -> Floats:
        """Solve (A - mu M) z = r with the factor of A as preconditioner, column by column.

        Energies r^T A^-1 r below `least` count as none.
        """
        M, X, MX = self._pencil.M, self._X, self._MX
        z, d, Ad = (np.zeros_like(r) for _ in range(3))
        rho, goal = np.ones(r.shape[1]), np.zeros(r.shape[1])
        for k in range(DERIVATIVES.iterations):
            s = factor.solve(r)
            s -= X @ (MX.T @ s)
            new = np.maximum(np.einsum("ij,ij->j", r, s), 0.0)
            if k == 0:
                goal = np.maximum(self._tolerance**2 * new, least)
            active = new > goal
            if not active.any():
                return z
            beta = np.where(active & (k > 0), new / np.where(rho > 0.0, rho, 1.0), 0.0)
            d = s + beta * d
            Ad = r + beta * Ad
            Bd = Ad - M @ (mu * d)
            Bd -= MX @ (X.T @ Bd)
            bend = np.einsum("ij,ij->j", d, Bd)
            if (bend[active] <= 0.0).any():
                break
            alpha = np.where(active, new / np.where(active, bend, 1.0), 0.0)
            z += alpha * d
            r = r - alpha * Bd
            rho = new
        raise _too_close(cluster)

    def _factor(self, cluster: Ints, columns: int) -> tuple[Factorisation, float]:
        """Return a factor of K - s M and s: next to the cluster where many solves follow."""
        solution = self._solution
        if columns < DERIVATIVES.own_factor * len(cluster):
            if self._base is None:
                self._base = factorise(self._pencil.shifted(solution.sigma), True)
            return self._base, solution.sigma
        lam = solution.eigenvalues
        low, high = int(cluster.min()), int(cluster.max())
        below = lam[low] - (lam[low - 1] if low else 2.0 * solution.sigma)
        above = lam[high + 1] - lam[high] if high + 1 < len(lam) else 0.0
        reach = DERIVATIVES.beside * (lam[high] - solution.sigma)
        up = above > below
        s = lam[high if up else low] + (1 if up else -1) * min(max(above, below) / 2.0, reach)
        if self._near is None:
            self._near = factorise(self._pencil.shifted(s), False)
        else:
            self._near.refactorise(self._pencil.shifted(s))
        return self._near, float(s)


def _too_close(cluster: Ints) -> InputError:
    return InputError(
        f"mode {int(cluster.max()) + 1} cannot be told from the modes above the last one "
        "solved: solve for more modes"
    )
