"""Poles of a damped model on its undamped modes, and their derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..arrays import Floats, Numbers
from .eigenpair_derivatives import Spectral
from .full_or_reduced import Order


@dataclass(frozen=True, eq=False)
class Damped:
    """A model at the factors `p` (n_parameter,), and its undamped modes there.

    In coordinates of the modes (unit modal mass) poles s and complex modes x are those of
    s² x + s D x + (Λ + iH) x = 0. D, H and so the left vectors are symmetric, and

        ds = −xᵀ(s² M' + s D' + K' + iH') x / xᵀ(2s + D) x.

    Tisseur, Meerbergen (2001), *The quadratic eigenvalue problem*, SIAM Review 43, 235; Adhikari
    (1999), *Rates of change of eigenvalues and eigenvectors in damped dynamic systems*, AIAA
    Journal 37(11), 1452.
    """

    order: Order
    p: Floats
    solution: Spectral

    def poles(self, turned: Floats) -> Numbers:
        """Return the pole of each of some combinations of modes, (n,), rad/s.

        `turned` (n_mode, n) are their coefficients, one pole each: that of the complex mode in
        which they take the largest part. Where so many are overdamped that none is left it is the
        critically damped one.
        """
        return self._of(turned)[0]

    def slopes(self, turned: Floats, parameters: Sequence[int]) -> Numbers:
        """Return the derivatives of these poles by some parameters, (n, n_parameter)."""
        s, X = self._of(turned)
        D, _ = self._damping
        dK, dM, dD, dH = self.changes_on(self.solution, parameters)
        parts = ((s**2, dM), (s, dD), (np.ones_like(s), dK + 1j * dH))
        moved = sum(w[:, None] * np.einsum("aj,iab,bj->ji", X, A, X) for w, A in parts)
        size = 2.0 * s * np.sum(X**2, axis=0) + np.einsum("aj,ab,bj->j", X, D, X)
        return np.asarray(-moved / np.where(s.imag > 0.0, size, 1.0)[:, None])

    def damping_on(self, modes: Spectral) -> tuple[Floats, Floats]:
        """Return D and H on modes, each (n_mode, n_mode); ratios of modes stand in H."""
        D, H = self.order.damping_on_modes(self.p, modes)
        lam = np.maximum(modes.eigenvalues, 0.0)
        return D, H + 2.0 * np.diag(self._ratios(modes) * lam)

    def changes_on(self, modes: Spectral, parameters: Sequence[int]) -> Floats:
        """Return K', M', D' and H' on modes, (4, len(parameters), n_mode, n_mode).

        Ratios of modes stay as their frequencies move.
        """
        found = self.order.changes_on_modes(self.p, modes, parameters)
        ratios = self._ratios(modes)
        found[3] += (ratios[:, None] + ratios) * found[0]
        return found

    def _ratios(self, modes: Spectral) -> Floats:
        say, lam = self.order.model.ratios, modes.eigenvalues
        if say is None:
            return np.zeros(len(lam))
        return say(np.sqrt(np.maximum(lam, 0.0)) / (2.0 * np.pi))

    @cached_property
    def _damping(self) -> tuple[Floats, Floats]:
        return self.damping_on(self.solution)

    @cached_property
    def _complex(self) -> tuple[Numbers, Numbers]:
        """Poles with Im > 0 and complex modes (n_mode, n)."""
        D, H = self._damping
        n = len(D)
        K = np.diag(self.solution.eigenvalues) + 1j * H
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-K, -D]])
        values, vectors = np.linalg.eig(A)
        up = np.flatnonzero(values.imag > 0.0)
        return values[up], vectors[:n, up]

    def _of(self, turned: Floats) -> tuple[Numbers, Numbers]:
        """Poles and complex modes of combinations; a pole without any has a mode of zeros."""
        found, X = self._complex
        share = np.abs(turned.T @ X) ** 2 / np.sum(np.abs(X) ** 2, axis=0)
        s = -np.sqrt(np.maximum(self.solution.eigenvalues @ turned**2, 0.0)).astype(complex)
        own, taken = linear_sum_assignment(-share)
        s[own], shapes = found[taken], np.zeros(turned.shape, complex)
        shapes[:, own] = X[:, taken]
        return s, shapes


def ratios(poles: Numbers) -> Floats:
    """Return the damping ratios −Re s / |s| of poles."""
    return np.asarray(-poles.real / np.abs(poles))


def ratio_slopes(poles: Numbers, slopes: Numbers) -> Floats:
    """Return the derivatives of damping ratios from those of the poles, (n, n_parameter)."""
    s = poles[:, None]
    along = np.real(np.conj(s) * slopes) / np.abs(s) ** 2
    return np.asarray((-slopes.real + s.real * along) / np.abs(s))
