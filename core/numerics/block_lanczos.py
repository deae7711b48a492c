"""Block Lanczos iteration with full reorthogonalisation and thick restart."""

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats
from ..errors import InputError
from .products import product, sparse_product

_EXHAUSTED = 1e-13
"""Directions this much smaller than the largest eigenvalue of the operator are rounding."""

NEGATIVE_MASS = (
    "the mass matrix is not positive semi-definite: "
    "look for negative masses or mass terms that do not belong together"
)


class BlockLanczos:
    """Largest eigenvalues theta of OP = A^-1 M, self-adjoint in the inner product of M.

    With A = K - sigma M these are theta = 1 / (lambda - sigma) of K x = lambda M x (Ericsson and
    Ruhe 1980; Grimes, Lewis and Simon 1994). A block finds repeated eigenvalues up to its width,
    and uses a factorisation several times as well as single vectors do. Restart: Wu and Simon
    (2000), thick restart. M may be singular: vectors are kept in the range of OP, and Ritz
    vectors are purified by the term that the last block contributes (Ericsson and Ruhe 1980, eq.
    for the implicit application of OP).

    Parameters
    ----------
    solve : callable
        A^-1 applied to (n, width).
    M : (n, n) sparse
        Symmetric, positive semi-definite.
    start : (n, width) float
        Any start block; OP is applied to it once.
    locked : (n, n_locked) float
        M-orthonormal eigenvectors already known; the iteration stays M-orthogonal to them.
    max_basis : int
        Vectors kept before a restart; grows where so many are wanted.
    """

    def __init__(
        self,
        solve: Callable[[Floats], Floats],
        M: sp.csr_matrix,
        start: Floats,
        locked: Floats,
        max_basis: int,
    ) -> None:
        n, width = start.shape
        self._solve, self._M, self._locked = solve, M, locked
        self._V = np.empty((n, max_basis + width), order="F")
        self._T = np.zeros((max_basis + width, max_basis + width))
        self._max_basis = max_basis
        self._scale = 0.0
        self.size = 0
        self._width: int = width
        self.solves = width
        first = self._solve(M @ start)
        block, self._M_block, self._R = self._orthonormal(first, None)
        self._append(block)

    @property
    def exhausted(self) -> bool:
        """Whether the whole range of M has been spanned: there are no further eigenvalues."""
        return self._width == 0

    def step(self) -> None:
        """Extend the basis by one block (after a thick restart where it is full)."""
        last = slice(self.size - self._width, self.size)
        image = self._solve(self._M_block)
        self.solves += self._width
        coupling = np.zeros((self.size, self._width))
        block, self._M_block, self._R = self._orthonormal(image, coupling)
        self._T[: self.size, last] = coupling
        self._T[last, : self.size] = coupling.T
        self._last = last
        self._next = block
        self._width = block.shape[1]

    def advance(self) -> None:
        """Take the block that the last `step` made into the basis."""
        self._append(self._next)

    def ritz(self) -> tuple[Floats, Floats]:
        """Return the Ritz values, largest first, and the norms of their residuals, (size,)."""
        theta, self._Y = np.linalg.eigh(self._T[: self.size, : self.size])
        theta, self._Y = theta[::-1], self._Y[:, ::-1]
        self._theta = theta
        residual = np.linalg.norm(self._R @ self._Y[self._last], axis=0)
        return theta, residual

    def taken(self, count: int) -> Floats:
        """Return the Ritz vectors of the `count` largest values, purified, (n, count).

        The basis is given up for them: the iteration is over.
        """
        Y, theta = self._Y[:, :count], self._theta[:count]
        X = product(self._V[:, : self.size], Y)
        self._V = self._M_block = self._V[:, :0].copy()
        if self._width:
            X += self._next @ ((self._R @ Y[self._last]) / theta)
        return X

    def restart(self, keep: int) -> None:
        """Shrink the basis to its `keep` best Ritz vectors (call between `ritz` and `advance`).

        Where that would leave too little room for progress, the room is doubled instead.
        """
        keep = min(keep, self.size)
        if 2 * keep > self._max_basis:
            self._grow()
            return
        self._V[:, :keep] = product(self._V[:, : self.size], self._Y[:, :keep])
        self._T[:] = 0.0
        self._T[np.arange(keep), np.arange(keep)] = self._theta[:keep]
        self.size = keep

    @property
    def full(self) -> bool:
        """Whether the next block does not fit before a restart."""
        return self.size + self._width > self._max_basis

    def _grow(self) -> None:
        spare = self._V.shape[1] - self._max_basis
        self._max_basis *= 2
        room = self._max_basis + spare
        V, T = np.empty((len(self._V), room), order="F"), np.zeros((room, room))
        V[:, : self.size] = self._V[:, : self.size]
        T[: self.size, : self.size] = self._T[: self.size, : self.size]
        self._V, self._T = V, T

    def _append(self, block: Floats) -> None:
        self._width = block.shape[1]
        self._V[:, self.size : self.size + self._width] = block
        self.size += self._width

    def _orthonormal(self, W: Floats, coupling: Floats | None) -> tuple[Floats, Floats, Floats]:
        """Orthonormal block W' with W = locked.. + V coupling + W' R, M W' and R."""
        V = self._V[:, : self.size]
        MW = sparse_product(self._M, W)
        self._scale = max(self._scale, float(np.sqrt(np.abs(np.sum(W * MW, axis=0)).max())))
        R = np.eye(W.shape[1])
        for sweep in range(2):
            if self._locked.shape[1]:
                W = W - self._locked @ (self._locked.T @ MW)
            if self.size:
                h = product(V.T, MW)
                W = W - product(V, h, np.empty_like(W))
                if coupling is not None:
                    coupling += h @ R
            MW = sparse_product(self._M, W)
            size, Q = np.linalg.eigh(W.T @ MW)
            if size.min(initial=0.0) < -1e-8 * self._scale**2:
                raise InputError(NEGATIVE_MASS)
            floor = (_EXHAUSTED * self._scale) ** 2 if sweep == 0 else 0.25
            keep = size > floor
            root = np.sqrt(size[keep])
            R = (root[:, None] * Q[:, keep].T) @ R
            turn = Q[:, keep] / root
            W, MW = W @ turn, MW @ turn
        return W, MW, R
