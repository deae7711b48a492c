"""What a test can say of parameters: from the derivatives of its residuals, before any moves."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats, frozen
from ..noun import Noun
from .updating_numbers import UPDATING


@dataclass(frozen=True, eq=False)
class Identifiability(Noun):
    """What residuals with the derivatives G determine.

    Parameters
    ----------
    standard_error : (n,) float
        Of the factors, all moving together; NaN where a combination with the parameter leaves
        every residual as it is.
    alone : (n,) float
        Likewise, each moving alone; infinite where it moves no residual.
    covariance : (n, n) float
        Likewise.
    information : (n, n) float
        Its inverse where there is one: GᵀG over the scatter.
    correlation : (n, n) float
        Cosines between the columns of G: parameters at 1 or -1 cannot be told apart.
    singular_values : (m,) float
        Of G, largest first, m = min(n_residual, n).
    directions : (m, n) float
        The combinations of parameters that belong to them.
    unseen : (k, n) float
        Combinations that the test does not determine.
    determined : tuple of int
        The largest set found of parameters that it does determine together, those that move the
        residuals most first.
    """

    standard_error: Floats
    alone: Floats
    covariance: Floats
    information: Floats
    correlation: Floats
    singular_values: Floats
    directions: Floats
    unseen: Floats
    determined: tuple[int, ...]


def identifiability(gradient: Floats, scatter: float, limit: Floats | float) -> Identifiability:
    """Say what weighted residuals determine.

    Singular values and subset selection: Friswell and Mottershead (1995), *Finite element model
    updating in structural dynamics*, chapters 4 and 5; Lallement and Piranda (1990), *Localisation
    methods for parameter updating of finite element models in elastodynamics*, IMAC 8.

    Parameters
    ----------
    gradient : (n_residual, n) float
        Derivatives of the residuals, each over its standard deviation, by the factors.
    scatter : float
        Variance of the weighted residuals, 1 where the standard deviations are right.
    limit : (n,) float, or float
        Standard error of a factor from which on it is not determined.
    """
    n = gradient.shape[1]
    _, s, vt = np.linalg.svd(gradient, full_matrices=False)
    sound = s > UPDATING.unidentifiable * s.max(initial=1.0)
    covariance = (vt[sound].T / s[sound] ** 2) @ vt[sound] * scatter
    error = np.sqrt(np.diag(covariance).copy())
    unseen = _complement(vt[sound])
    lost = (np.abs(unseen) > UPDATING.part).any(axis=0)
    error[lost] = covariance[lost] = covariance[:, lost] = np.nan
    size = np.linalg.norm(gradient, axis=0)
    unit = gradient / np.where(size > 0.0, size, 1.0)
    with np.errstate(divide="ignore"):
        alone = np.sqrt(scatter) / size
    return Identifiability(
        frozen(error),
        frozen(alone),
        frozen(covariance),
        frozen(gradient.T @ gradient / scatter if scatter > 0.0 else np.zeros((n, n))),
        frozen(unit.T @ unit),
        frozen(s),
        frozen(vt),
        frozen(unseen),
        tuple(_chosen(gradient, scatter, np.broadcast_to(limit, n))),
    )


def doubts(names: Sequence[str], factors: Floats, said: Identifiability) -> Iterator[str]:
    """Say what a test leaves open of parameters that were moved to `factors` (n,)."""
    for direction in said.unseen:
        part = [names[i] for i in np.flatnonzero(np.abs(direction) > UPDATING.part)]
        yield (
            f"the test does not determine {' and '.join(part)}: "
            + ("a common change leaves" if len(part) > 1 else "a change leaves")
            + " every residual the same; fix one of them"
        )
    for k in np.flatnonzero(said.standard_error > unsure(factors)):
        yield (
            f"the test hardly determines {names[k]}: its factor {factors[k]:.3g} has a standard "
            f"error of {said.standard_error[k]:.2g}"
        )
    known = [
        f"{_product(names, e)} (factor {np.exp(e @ np.log(factors)):.4g} ± {error:.2g})"
        for e, error in combinations(factors, said)
    ]
    if known:
        yield (
            f"known together, not one by one: {'; '.join(known)}; name the one that is to move, or "
            "add the residual 'prior'"
        )


def unsure(factors: Floats) -> Floats:
    """Return the standard errors above which factors are not determined, (n,).

    A share of each, as well as the deck knows it; more where the test excludes the deck's value:
    what was fitted beside it would be led astray by that.
    """
    away = np.abs(np.log(factors)) / UPDATING.excluded
    return np.asarray(factors * np.maximum(UPDATING.unsure, away))


def told_alone(factors: Floats, error: Floats) -> Bools:
    """Whether each of all that moved is determined by itself, not in combination alone, (n,)."""
    return np.asarray(np.nan_to_num(error, nan=np.inf) <= unsure(factors))


def combinations(factors: Floats, said: Identifiability) -> Iterator[tuple[Floats, float]]:
    """Give products of powers that the test determines, of parameters that it does not.

    Each is the exponents, (n,), the largest 1, and the relative standard error; best known first.
    They are eigenvectors of the information on the logarithms of these parameters, others free.
    """
    open_ = np.flatnonzero(~told_alone(factors, said.standard_error))
    alone = np.setdiff1d(np.arange(len(factors)), open_)
    N = said.information * np.outer(factors, factors)
    across = N[np.ix_(open_, alone)]
    own = N[np.ix_(open_, open_)] - across @ np.linalg.pinv(N[np.ix_(alone, alone)]) @ across.T
    for w, v in zip(*(x[..., ::-1].T for x in np.linalg.eigh(own)), strict=True):
        size = np.abs(v)
        exponents = v / v[np.argmax(size >= (1.0 - UPDATING.alike) * size.max())]
        part = np.abs(exponents) > UPDATING.part
        error = 1.0 / np.sqrt(max(w, np.finfo(float).tiny)) / np.abs(v).max()
        if part.sum() > 1 and error <= UPDATING.unsure:
            whole = np.zeros(len(factors))
            whole[open_[part]] = exponents[part]
            yield whole, float(error)


def _product(names: Sequence[str], exponents: Floats) -> str:
    size = np.round(np.abs(exponents), 6)
    terms = [(names[k], exponents[k]) for k in np.argsort(-size, kind="stable") if exponents[k]]
    return " · ".join(name if e == 1.0 else f"{name}^{e:.2g}" for name, e in terms)


def _complement(rows: Floats) -> Floats:
    """Orthonormal rows that span what `rows` (k, n), orthonormal, do not."""
    whole = np.linalg.svd(rows, full_matrices=True)[2] if len(rows) else np.eye(rows.shape[1])
    return np.asarray(whole[len(rows) :])


def _chosen(gradient: Floats, scatter: float, limit: Floats) -> Iterator[int]:
    """Choose columns by what they have beside those before, as long as all are determined."""
    left, free, taken = gradient.copy(), set(range(gradient.shape[1])), list[int]()
    while free:
        order = sorted(free)
        size = np.linalg.norm(left[:, order], axis=0)
        k = order[int(np.argmax(size >= (1.0 - UPDATING.alike) * size.max()))]
        free.discard(k)
        more = [*taken, k]
        if size.max() == 0.0 or not all_below(gradient[:, more], scatter, limit[more]):
            continue
        taken.append(k)
        yield k
        q = left[:, k] / np.linalg.norm(left[:, k])
        left -= np.outer(q, q @ left)


def all_below(gradient: Floats, scatter: float, limit: Floats) -> bool:
    """Whether the standard errors of all columns are below their limits."""
    r: Floats = np.asarray(np.linalg.qr(gradient, mode="r"))
    least = UPDATING.unidentifiable * max(np.abs(r).max(), 1.0)
    if r.shape[0] < r.shape[1] or np.abs(np.diag(r)).min() <= least:
        return False
    inverse = np.linalg.inv(r)
    return bool((np.sqrt(scatter * np.sum(inverse**2, axis=1)) <= limit).all())
