"""Vectors that carry a reduced model, and the projection of its matrices onto them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Floats, Ints
from ..data.parametric_model import Model
from ..eigen.normal_modes import Eigensolution
from ..numerics.factorisation import Factorisation

_DEPENDENT = 1e-10
"""Energy beside the largest below which a direction is dependent on the others."""

_BLOCK = 64


def static_answers(
    model: Model,
    p0: Floats,
    solution: Eigensolution,
    factor: Factorisation,
    targets: Sequence[int] | Ints,
    parameters: Sequence[int],
    most: int,
    least: float,
) -> Floats:
    """Find the static answers of modes to parameters, A^-1 (K' - lambda M') phi.

    Each is weighted by the energy of its mode, so that parameters, all factors on the deck's
    values, compare; of their principal directions those of largest energy are kept.

    Parameters
    ----------
    model, p0, solution, targets, parameters
        As in `reduced.build_reduced`.
    factor : Factorisation
        Of A = K - sigma M.
    most : int
        Most vectors kept.
    least : float
        Least energy of those kept, beside that of a mode, for a factor moved by one.

    Returns
    -------
    (n_free, k) float
        A-orthonormal, A-orthogonal to the modes, k <= `most`.
    """
    chosen = np.asarray(targets, np.int64)
    span = solution.eigenvalues - solution.sigma
    X, lam = solution.vectors[:, chosen], solution.eigenvalues[chosen]
    weight = 1.0 / np.sqrt(span[chosen])
    n, m = X.shape
    group = max(1, _BLOCK // max(m, 1))
    groups = [parameters[k : k + group] for k in range(0, len(parameters), group)]
    ends = np.cumsum([0] + [m * len(g) for g in groups])

    def loads(members: Sequence[int]) -> Floats:
        parts = [model.dK(i, p0) @ X - (model.dM(i, p0) @ X) * lam for i in members]
        return np.hstack([part * weight for part in parts])

    S = np.empty((n, ends[-1]), order="F")
    energy = np.zeros((ends[-1],) * 2)
    modal = np.empty((len(span), ends[-1]))
    for members, start, end in zip(groups, ends[:-1], ends[1:], strict=True):
        F = loads(members)
        S[:, start:end] = factor.solve(F)
        energy[:end, start:end] = S[:, :end].T @ F
        energy[start:end, :start] = energy[:start, start:end].T
        modal[:, start:end] = (solution.vectors.T @ F) / span[:, None]
    energy -= modal.T @ (span[:, None] * modal)
    value, W = np.linalg.eigh((energy + energy.T) / 2.0)
    best = np.argsort(-value)[:most]
    best = best[value[best] > max(least, _DEPENDENT * value.max(initial=0.0))]
    W = W[:, best] / np.sqrt(value[best])
    return np.asarray(S @ W - solution.vectors @ (modal @ W))
