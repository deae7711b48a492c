"""How far residuals scatter, kind by kind, and the errors of the factors that this makes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri, stdtrit

from ..arrays import Floats, Ints, frozen
from ..noun import Noun
from .updating_numbers import UPDATING


@dataclass(frozen=True, eq=False)
class Kind:
    """The weighted residuals of one kind where the objective is least, all configurations.

    `values` (m,), `gradient` (m, n); `data` is how much was measured, `stated` whether the standard
    deviation is known by itself.
    """

    values: Floats
    gradient: Floats
    data: int
    stated: bool


@dataclass(frozen=True, eq=False)
class Scatter(Noun):
    """What residuals scatter by beside the parameters that they determine.

    Parameters
    ----------
    gradient : (m, n) float
        Derivatives such that the covariance of the factors is the inverse of `gradient`ᵀ`gradient`
        times `variance`: those of the residuals, where all kinds scatter alike.
    variance : float
        Of the weighted residuals; the mean, where kinds differ.
    freedom : (n,) float
        Degrees of freedom of the variance of each factor (Welch and Satterthwaite), infinite where
        standard deviations are believed.
    widening : (n,) float
        Variance of each factor over what the objective's curvature makes of `variance`.
    """

    gradient: Floats
    variance: float
    freedom: Floats
    widening: Floats

    @property
    def rises(self) -> Floats:
        """By how much the objective has risen at the ends of 95 % intervals, (n,): t² with s²."""
        return np.asarray(_student(self.freedom) ** 2 * self.variance * self.widening)


def left_over(values: Floats, gradient: Floats, data: int) -> float:
    """Return the variance of values (m,) beside derivatives (m, n); 0 where these explain all.

    `data` is how much was measured, at most m.
    """
    spare = data - gradient.shape[1]
    Q = np.linalg.qr(gradient)[0]
    left = values - Q @ (Q.T @ values)
    return float(left @ left) / spare if spare > 0 else 0.0


def scatter_of(kinds: Sequence[Kind], believed: bool = False) -> Scatter:
    """Estimate how far residuals scatter, each kind by its own where it has enough data.

    The variance of a kind of n data is its sum of squares over n − h, h being the trace of its part
    of the hat matrix, over all kinds the number of parameters; residuals and hat matrix are those
    that the variances themselves make as weights, in turns (Förstner 1979, *Ein Verfahren zur
    Schätzung von Varianz- und Kovarianzkomponenten*, Allgemeine Vermessungs-Nachrichten 86, 446).
    Kinds of few data share one; a kind whose standard deviation is `stated` scatters by no less.
    The objective stays weighed as it was minimised, so that the covariance is
    A⁻¹(Σ s_k² G_kᵀG_k)A⁻¹, A = ΣG_kᵀG_k (White 1982, *Maximum likelihood estimation of misspecified
    models*, Econometrica 50(1), 1).

    Parameters
    ----------
    kinds : sequence of Kind
    believed : bool
        The standard deviations of all are, as those of a posterior are.
    """
    G = np.vstack([k.gradient for k in kinds])
    variance, freedom, pool = np.ones(len(kinds)), np.full(len(kinds), np.inf), _pooled(kinds)
    if not believed:
        variance, freedom = _variances(kinds, pool)
    U, S, Vt = _range(G)
    parts = np.split(U, np.cumsum([len(k.values) for k in kinds])[:-1])
    by_kind = np.array([np.sum((u / S @ Vt) ** 2, axis=0) for u in parts])  # of A⁻¹, per kind
    shares = variance[:, None] * by_kind
    whole = shares.sum(axis=0)
    rough = sum(shares[pool == k].sum(axis=0) ** 2 / freedom[pool == k][0] for k in np.unique(pool))
    with np.errstate(divide="ignore", invalid="ignore"):
        freed = np.where(rough > 0.0, whole**2 / rough, np.inf)
    if np.ptp(variance) == 0.0:
        return Scatter(frozen(G), float(variance[0]), frozen(freed), frozen(np.ones(G.shape[1])))
    W = sum(s * u.T @ u for s, u in zip(variance, parts, strict=True))
    mean = float(np.trace(W)) / len(S)
    turned = np.linalg.solve(np.linalg.cholesky(W / mean), S[:, None] * Vt)
    widening = whole / (mean * by_kind.sum(axis=0))
    return Scatter(frozen(turned), mean, frozen(freed), frozen(widening))


def _range(G: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the singular values that are not rounding, with their vectors."""
    U, S, Vt = np.linalg.svd(G, full_matrices=False)
    seen = UPDATING.unseen * S.max(initial=0.0) < S
    return U[:, seen], S[seen], Vt[seen]


def _spare(kinds: Sequence[Kind]) -> int:
    """Return how many more data there are than parameters that they see."""
    return sum(k.data for k in kinds) - len(_range(np.vstack([k.gradient for k in kinds]))[1])


def _pooled(kinds: Sequence[Kind]) -> Ints:
    """Return which kinds share a variance: those of few data have the number −1."""
    own = [k.stated or _spare([k]) >= UPDATING.enough for k in kinds]
    return np.where(own, np.arange(len(kinds)), -1)


def _variances(kinds: Sequence[Kind], pool: Ints) -> tuple[Floats, Floats]:
    """Return variance and degrees of freedom of each kind, infinite where it is as stated."""
    variance, freedom = np.ones(len(kinds)), np.full(len(kinds), np.inf)
    of = [np.flatnonzero(pool == k) for k in np.unique(pool)]
    open_ = [rows for rows in of if _spare([kinds[k] for k in rows]) > 0]
    sizes = [len(k.values) for k in kinds]
    values, G = np.concatenate([k.values for k in kinds]), np.vstack([k.gradient for k in kinds])
    U = _range(G)[0]
    along = U @ (U.T @ values)  # where bounds or too few iterations end before the least
    for _ in range(UPDATING.weighings):
        before = variance.copy()
        root = np.sqrt(np.repeat(variance, sizes))
        U, y = _range(G / root[:, None])[0], (values - along) / root
        left = np.split(y - U @ (U.T @ y) + along / root, np.cumsum(sizes)[:-1])
        parts = np.split(U, np.cumsum(sizes)[:-1])
        for rows in open_:
            free = sum(kinds[k].data - float(np.sum(parts[k] ** 2)) for k in rows)
            found = variance[rows[0]] * sum(float(np.sum(left[k] ** 2)) for k in rows) / free
            stated = any(kinds[k].stated for k in rows)
            variance[rows] = max(found, UPDATING.least_scatter * (len(kinds) > 1), float(stated))
            freedom[rows] = np.inf if stated and variance[rows[0]] == 1.0 else free
        if np.allclose(variance, before, rtol=UPDATING.same_scatter, atol=0.0):
            break
    return variance, freedom


def _student(freedom: Floats) -> Floats:
    """Return the quantile of Student's t that leaves 2.5 % above, (n,)."""
    top = 0.5 + 0.5 * UPDATING.interval
    finite = np.isfinite(freedom)
    return np.where(finite, stdtrit(np.where(finite, freedom, 1.0), top), ndtri(top))
