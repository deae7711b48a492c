"""Static answers A^-1 f, A = K - sigma M: to parameters, to forces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Ints
from ..data.parametric_model import Model
from ..eigen.normal_modes import Eigensolution
from ..numerics.factorisation import Factorisation
from ..numerics.products import product, sparse_product
from .derivative_numbers import DERIVATIVES
from .reduced_sum import own_part


def answers_to(forces: sp.csr_matrix, factor: Factorisation, Q: Floats) -> Floats:
    """Find the static answers to forces beside those in a basis, A^-1 f, A-orthonormal."""
    F = np.ascontiguousarray(forces.T.toarray())
    known = product(Q.T, F)
    S = np.asarray(factor.solve(F)) - product(Q, known)
    value, W = np.linalg.eigh(product(S.T, F))
    kept = value > DERIVATIVES.dependent * np.max(np.sum(known**2, axis=0), initial=0.0)
    return product(S, W[:, kept] / np.sqrt(value[kept]))


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
    """Find the static answers of modes to parameters, A^-1 (K' - lambda M') phi, (n_free, k).

    Each is weighted by the energy of its mode, so that parameters, all factors on the deck's
    values, compare; of their principal directions at `most` so many are kept, those of largest
    energy, of at `least` a share of that of a mode for a factor moved by one. A-orthonormal,
    A = K - sigma M being what `factor` is of, and A-orthogonal to the modes.
    """
    chosen = np.asarray(targets, np.int64)
    span = solution.eigenvalues - solution.sigma
    X, lam = solution.vectors[:, chosen], solution.eigenvalues[chosen]
    weight = 1.0 / np.sqrt(span[chosen])
    n, m = X.shape
    group = max(1, DERIVATIVES.block // max(m, 1))
    groups = [parameters[k : k + group] for k in range(0, len(parameters), group)]
    ends = np.cumsum([0] + [m * len(g) for g in groups])

    S = np.empty((n, ends[-1]), order="F")
    energy = np.zeros((ends[-1],) * 2)
    modal = np.empty((len(span), ends[-1]))
    for members, start, end in zip(groups, ends[:-1], ends[1:], strict=True):
        F = np.zeros((n, end - start))
        for first, i in enumerate(members):
            at = slice(first * m, (first + 1) * m)
            for rows, part in _loads(model, p0, i, X, lam):
                F[rows, at] += part * weight
        S[:, start:end] = factor.solve(F)
        energy[:end, start:end] = product(S[:, :end].T, F)
        energy[start:end, :start] = energy[:start, start:end].T
        modal[:, start:end] = product(solution.vectors.T, F) / span[:, None]
    energy -= modal.T @ (span[:, None] * modal)
    value, W = np.linalg.eigh((energy + energy.T) / 2.0)
    best = np.argsort(-value)[:most]
    best = best[value[best] > max(least, DERIVATIVES.dependent * value.max(initial=0.0))]
    W = W[:, best] / np.sqrt(value[best])
    answers = product(S, W)
    answers -= product(solution.vectors, modal @ W)
    return answers


def drawn_loads(
    model: Model,
    p: Floats,
    parameters: Sequence[int],
    X: Floats,
    lam: Floats,
    weight: Floats,
    count: int,
    rng: np.random.Generator,
) -> Floats:
    """Draw so many combinations of (K' - lambda M') phi, weighted by mode, (n_free, count)."""
    F = np.zeros((len(X), count))
    for i in parameters:
        drawn = weight[:, None] * rng.standard_normal((len(lam), count))
        for rows, part in _loads(model, p, i, X, lam):
            F[rows] += product(part, drawn)
    return F


def _loads(
    model: Model, p: Floats, i: int, X: Floats, lam: Floats
) -> Iterator[tuple[slice | Ints, Floats]]:
    """Find (K' - lambda M') phi of modes by a parameter: two parts, on the rows that each has."""
    for change, times in ((model.dK(i, p), np.ones(len(lam))), (model.dM(i, p), -lam)):
        if change.nnz:
            rows, own = own_part(change)
            yield rows, sparse_product(own, X) * times
