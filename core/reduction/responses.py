"""Frequency responses and antiresonances of a model on a basis, and their derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.linalg as sl

from ..arrays import Floats, Numbers
from .damped_poles import Damped
from .derivative_numbers import DERIVATIVES
from .full_or_reduced import FullOrder, ReducedOrder, reduce_around
from .reduced_model import ReducedModes


@dataclass(frozen=True, eq=False)
class Responding:
    """A model in the modes of a basis that holds its static answers to the forces.

    Receptances are C (Λ − ω² + iH + iωD)⁻¹ Bᵀ; their derivatives −W (K' − ω²M' + iH' + iωD') Y
    with W and Y what is left and right of it, as in D'Ambrogio, Fregolent (2000), *The use of
    antiresonances for robust model updating*, Journal of Sound and Vibration 236, 227. Modes far
    above the frequencies are coupled by damping with those near them, not with one another.

    Parameters
    ----------
    at : Damped
    ratio : float
        Damping ratio of all modes where the model says nothing of damping.
    """

    at: Damped
    ratio: float

    def responses(self, observed: Floats, driven: Floats, omega: Floats) -> Numbers:
        """Return receptances, (n_line, n_out, n_in), at `omega` (n_line,), rad/s.

        `observed` (n_out, n_basis) and `driven` (n_in, n_basis) are rows of sensors and forces as
        `rows` gives them.
        """
        C, B = observed @ self._modes.vectors, driven @ self._modes.vectors
        return np.asarray(C @ self._solved(B, omega))

    def slopes(
        self, observed: Floats, driven: Floats, omega: Floats, parameters: Sequence[int]
    ) -> Numbers:
        """Return their derivatives by some parameters, (n_line, n_out, n_in, n_parameter)."""
        X = self._modes.vectors
        W, Y = self._solved(observed @ X, omega), self._solved(driven @ X, omega)
        w = omega[:, None, None]
        out = np.empty((len(omega), len(observed), len(driven), len(parameters)), complex)
        for k, (dK, dM, dD, dH) in enumerate(zip(*self._changes(parameters), strict=True)):
            moved = (dK + 1j * dH) @ Y - dM @ (w**2 * Y) + dD @ (1j * w * Y)
            out[..., k] = -W.swapaxes(1, 2) @ moved
        return out

    def antiresonances(self, driven: Floats) -> tuple[Floats, Floats]:
        """Return zeros of a driving point, ω² ascending, (n,), and motions in the modes, (s, n).

        They are the natural frequencies of the structure that is held there: `driven` (n_basis,).
        """
        b = driven @ self._modes.vectors
        N = sl.null_space(b[None, :])
        zeros, motions = np.linalg.eigh(N.T @ (self._modes.eigenvalues[:, None] * N))
        return zeros, np.asarray(N @ motions)

    def antiresonance_slopes(
        self, zeros: Floats, motions: Floats, parameters: Sequence[int]
    ) -> Floats:
        """Return ψᵀ(K' − μM')ψ of zeros μ (n,) and motions ψ (s, n), (n, n_parameter)."""
        dK, dM, *_ = self._changes(parameters)
        return np.asarray(
            np.einsum("an,kab,bn->nk", motions, dK, motions)
            - zeros[:, None] * np.einsum("an,kab,bn->nk", motions, dM, motions)
        )

    def rows(self, matrix: object) -> Floats:
        """Return rows over the free degrees of freedom, (n, n_free), on the basis, (n, n_basis)."""
        return self._reduced.reduced.project(matrix.T).T  # type: ignore[attr-defined]

    def _solved(self, B: Floats, omega: Floats) -> Numbers:
        """Z⁻¹ Bᵀ in the modes, (n_line, s, n)."""
        lam, (D, H) = self._modes.eigenvalues, self._damping
        near = lam < (DERIVATIVES.near_modes * omega.max(initial=0.0)) ** 2
        n, w = int(near.sum()), omega[:, None, None]
        own = lam - omega[:, None] ** 2 + 1j * (np.diag(H) + omega[:, None] * np.diag(D))
        near, far = B[:, :n].T, B[:, n:].T / own[:, n:, None]
        across = 1j * H[:n, n:] + 1j * w * D[:n, n:]
        back = across.swapaxes(1, 2) / own[:, n:, None]
        Z = 1j * H[:n, :n] + 1j * w * D[:n, :n] + (lam[:n] - w**2) * np.eye(n) - across @ back
        low = np.linalg.solve(Z, near - across @ far)
        return np.concatenate([low, far - back @ low], axis=1)

    @cached_property
    def _reduced(self) -> ReducedOrder:
        order = self.at.order
        if isinstance(order, FullOrder):
            return reduce_around(order, self.at.p, self.at.solution, ())  # type: ignore[arg-type]
        return order

    @property
    def _damped(self) -> Damped:
        return replace(self.at, order=self._reduced)

    @cached_property
    def _modes(self) -> ReducedModes:
        reduced = self._reduced.reduced
        every = reduced.solve(self.at.p, reduced.size)
        span = every.eigenvalues - reduced.solution.sigma
        return every.take(int(np.count_nonzero(span < DERIVATIVES.mass * span[0])))

    @cached_property
    def _damping(self) -> tuple[Floats, Floats]:
        if self._reduced.model.damped:
            return self._damped.damping_on(self._modes)
        lam = self._modes.eigenvalues
        return np.zeros((len(lam),) * 2), 2.0 * self.ratio * np.diag(np.maximum(lam, 0.0))

    def _changes(self, parameters: Sequence[int]) -> Floats:
        found = self._damped.changes_on(self._modes, parameters)
        if not self._reduced.model.damped:
            found[3] = 2.0 * self.ratio * found[0]
        return found
