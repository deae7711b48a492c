"""Residuals between paired modes and their linearisation by the parameters.

Two kinds stand in Δz of the source paper. The eigenvalue residual, equation (5), is the relative
difference of the eigenvalues of a pair. The shape residual, equation (6), is the part of the
normalised analysis shape that the test shape does not explain, whatever the scaling of the test:
its squared length is 1 − MAC.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import Floats
from .correlate import Pair
from .errors import InputError

KINDS = ("frequencies", "shapes", "both")


@dataclass(frozen=True)
class Weights:
    """Standard deviations that make W = diag(1/σ²), and the regularisation W_p.

    Parameters
    ----------
    frequency : float
        Of a relative frequency difference.
    shape : float
        Of the length of a shape residual, √(1 − MAC).
    regularisation : float
        Standard deviation of a parameter step is 1/√regularisation; 0 leaves W_p out.
    """

    frequency: float = 0.01
    shape: float = 0.1
    regularisation: float = 1e-2

    def __post_init__(self) -> None:
        for name in ("frequency", "shape"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"the standard deviation of {name} must be above 0")
        if self.regularisation < 0.0:
            raise InputError("the regularisation must not be negative")


@dataclass(frozen=True, eq=False)
class Residuals:
    """Weighted residuals W^½Δz, (n_row,), and their derivatives W^½∂(z_a)/∂p, (n_row, n_par)."""

    values: Floats
    gradient: Floats


def eigenvalue_residuals(
    pairs: Sequence[Pair],
    eigenvalues: Floats,
    derivatives: Floats,
    sigma: Floats | float,
) -> Residuals:
    """Relative eigenvalue differences (λ_a − λ_t)/λ_t of each pair, equation (5).

    Parameters
    ----------
    pairs : sequence of Pair
    eigenvalues : (n_pair,) float
        Of the analysis mode of each pair, after rotation the Rayleigh quotient, [rad²/s²].
    derivatives : (n_pair, n_parameter) float
        Of `eigenvalues` by the parameters.
    sigma : float or (n_pair,) float
        Standard deviation of a relative *frequency* difference; an eigenvalue's is twice that.
    """
    test = (2.0 * np.pi * np.array([p.test_hz for p in pairs])) ** 2
    scale = np.ones(len(pairs)) / (2.0 * sigma)
    values = scale * (eigenvalues / test - 1.0)
    return Residuals(values, scale[:, None] * derivatives / test[:, None])


def shape_residuals(
    analysis: Floats,
    derivatives: Floats,
    test: Floats,
    sigma: Floats | float,
) -> Residuals:
    """Part of each normalised analysis shape outside its test shape, equation (6).

    Parameters
    ----------
    analysis, test : (n_sensor, n_pair) float
        Shapes at the sensors, any scaling.
    derivatives : (n_sensor, n_pair, n_parameter) float
        Of `analysis` by the parameters.
    sigma : float or (n_pair,) float
        Standard deviation of the residual's length √(1 − MAC).
    """
    norm = np.linalg.norm(analysis, axis=0)
    a = analysis / norm
    t = test / np.linalg.norm(test, axis=0)
    slope = derivatives / norm[:, None]
    slope = slope - a[:, :, None] * np.einsum("sj,sjp->jp", a, slope)[None]
    slope = slope - t[:, :, None] * np.einsum("sj,sjp->jp", t, slope)[None]
    value = (a - t * np.sum(t * a, axis=0)) / sigma
    slope = slope / (sigma * np.ones(a.shape[1]))[:, None]
    n = value.size
    return Residuals(value.T.reshape(n), slope.transpose(1, 0, 2).reshape(n, -1))
