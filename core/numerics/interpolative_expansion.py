"""Write a matrix that depends on parameters as few constant matrices times scalar functions.

The functions are products of Chebyshev series, one a parameter. Found numerically: along each
parameter the samples are expanded in Chebyshev polynomials until the series has ended; the space
that the coefficients span is reduced to a basis (monomials where three or fewer suffice, otherwise
singular vectors); the products of the bases that do not occur are dropped; and as many points are
chosen as there are products left, so that the matrices follow from evaluations at these points
alone (an interpolative decomposition: Cheng, Gimbutas, Martinsson, Rokhlin, SIAM J. Sci. Comput.
26, 2005).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.polynomial import chebyshev

from ..arrays import Floats
from ..errors import CheckError

Sample = Callable[[Floats], Floats]
"""Features (n_point, n_feature) at points (n_point, k)."""

_SIZES = (5, 9, 17, 33, 65)
_LARGEST_PRODUCT = 4096
_MOST_LINES = 40


@dataclass(frozen=True, eq=False)
class Expansion:
    """Functions, points and weights of an expansion over k parameters.

    Parameters
    ----------
    series : tuple of tuple of (coefficients or None)
        For each function, for each parameter, its Chebyshev coefficients on the parameter's
        interval; None where the function does not depend on the parameter.
    points : (n_point, k) float
        Where the matrices are to be evaluated; as many as there are functions.
    weights : (n_function, n_point) float
        The constant matrix of each function is the weighted sum of the evaluations.
    """

    series: tuple[tuple[tuple[float, ...] | None, ...], ...]
    points: Floats
    weights: Floats

    def values(self, points: Floats, lower: Floats, upper: Floats) -> Floats:
        """Values of the functions at `points`, (n_point, k): (n_point, n_function)."""
        x = (2.0 * points - lower - upper) / (upper - lower)
        out = np.ones((len(points), len(self.series)))
        for f, product in enumerate(self.series):
            for i, coefficients in enumerate(product):
                if coefficients is not None:
                    out[:, f] *= chebyshev.chebval(x[:, i], coefficients)
        return out


def expand(sample: Sample, lower: Floats, upper: Floats, tolerance: float) -> Expansion:
    """Expand features that depend on k parameters.

    Parameters
    ----------
    sample : callable
        Features at points, (n_point, k) -> (n_point, n_feature); scaled so that an absolute error
        of `tolerance` in a feature does not matter.
    lower, upper : (k,) float
        The parameters' intervals.
    tolerance : float
        Absolute error allowed in a feature.

    Raises
    ------
    CheckError
        A dependence too steep for its interval; too many parameters on the same elements.
    """
    k = len(lower)
    generator = np.random.default_rng(20240229)
    bases = [_basis(sample, i, lower, upper, generator, tolerance) for i in range(k)]
    sizes = [len(b) for b in bases]
    if np.prod(sizes) > _LARGEST_PRODUCT:
        raise CheckError(
            f"{k} parameters act on the same elements with {int(np.prod(sizes))} combined terms: "
            "join some of them into one parameter or give narrower bounds"
        )
    pivots = [_pivots(b) for b in bases]
    grid = np.stack(np.meshgrid(*pivots, indexing="ij"), axis=-1).reshape(-1, k)
    values = np.ones((1, 1))
    for basis, x in zip(bases, pivots, strict=True):
        values = np.kron(values, np.stack([chebyshev.chebval(x, c) for c in basis], axis=1))
    points = 0.5 * (lower + upper) + 0.5 * (upper - lower) * grid
    weights = np.linalg.inv(values)
    size = np.abs(weights @ sample(points)).max(axis=1) * np.abs(values).max(axis=0)
    kept = np.flatnonzero(size > tolerance)
    if not len(kept):
        return Expansion((), points[:0], np.zeros((0, 0)))
    chosen = scipy.linalg.qr(values[:, kept].T, mode="r", pivoting=True)[1][: len(kept)]
    indices = np.stack(np.unravel_index(kept, sizes), axis=1)
    own = ([bases[i][j] for i, j in enumerate(product)] for product in indices)
    series = tuple(tuple(tuple(c.tolist()) if c[1:].any() else None for c in cs) for cs in own)
    return Expansion(series, points[chosen], np.linalg.inv(values[np.ix_(chosen, kept)]))


def _basis(
    sample: Sample,
    i: int,
    lower: Floats,
    upper: Floats,
    generator: np.random.Generator,
    tolerance: float,
) -> Floats:
    """Chebyshev coefficients (n_function, n_coefficient) of the functions of parameter i.

    The other parameters stand at both ends, then at random values, until two more random values
    bring nothing new.
    """
    k = len(lower)
    others = [0.5 * (lower + upper)] if k == 1 else [lower, upper]
    lines = [_line(sample, i, lower, upper, other, tolerance) for other in others]
    while True:
        degree = max(len(line) for line in lines)
        basis = _reduce(
            np.concatenate([_pad(c, degree) for c in lines], axis=1), lower[i], upper[i], tolerance
        )
        if k == 1:
            return basis
        trials = lower + (upper - lower) * generator.random((2, k))
        new = [_line(sample, i, lower, upper, trial, tolerance) for trial in trials]
        degree = max(basis.shape[1], *(len(c) for c in new))
        Q = np.linalg.qr(_pad(basis.T, degree))[0]
        left = [np.abs(c - Q @ (Q.T @ c)).sum(axis=0).max() for c in (_pad(c, degree) for c in new)]
        if max(left) <= 4.0 * tolerance:
            return basis
        lines.extend(new)
        if len(lines) > _MOST_LINES:
            raise CheckError(
                "several parameters on the same elements act together in a way that cannot be "
                "expanded over their bounds: give narrower bounds or join them into one"
            )


def _line(
    sample: Sample, i: int, lower: Floats, upper: Floats, other: Floats, tolerance: float
) -> Floats:
    """Chebyshev coefficients (n_coefficient, n_feature) along parameter i through `other`."""
    known = np.zeros((0, 0))
    for n in _SIZES:
        x = np.cos(np.pi * np.arange(n) / (n - 1))
        points = np.repeat(other[None, :], n, axis=0)
        points[:, i] = 0.5 * (lower[i] + upper[i]) + 0.5 * (upper[i] - lower[i]) * x
        if len(known):  # the points of half as many intervals are every second of these
            new = sample(points[1::2])
            values = np.empty((n, new.shape[1]))
            values[::2], values[1::2] = known, new
        else:
            values = sample(points)
        known = values
        coefficients = np.linalg.solve(chebyshev.chebvander(x, n - 1), values)
        above = np.flatnonzero(np.abs(coefficients).max(axis=1) > tolerance)
        degree = int(above[-1]) if len(above) else 0
        if degree <= n - 3:
            return np.asarray(coefficients[: degree + 1])
    raise CheckError(
        f"the matrices depend on a parameter too steeply between {lower[i]:g} and {upper[i]:g} "
        "times its value: give narrower bounds"
    )


def _pad(coefficients: Floats, length: int) -> Floats:
    return np.pad(coefficients, ((0, length - len(coefficients)), (0, 0)))


def _reduce(coefficients: Floats, lower: float, upper: float, tolerance: float) -> Floats:
    degree = len(coefficients) - 1
    if degree <= 3:
        monomials = _monomials(degree, lower, upper)
        amounts = np.linalg.solve(monomials.T, coefficients)
        size = np.abs(amounts).max(axis=1) * max(abs(lower), abs(upper)) ** np.arange(degree + 1)
        kept = np.flatnonzero(size > tolerance)
        return monomials[kept] if len(kept) else monomials[:1]
    u, s, _ = np.linalg.svd(coefficients, full_matrices=False)
    rest = coefficients.copy()
    rank = 0
    while np.abs(rest).sum(axis=0).max() > tolerance and rank < len(s):
        rest -= np.outer(u[:, rank], u[:, rank] @ coefficients)
        rank += 1
    u = u[:, :rank]
    constant = np.zeros(degree + 1)
    constant[0] = 1.0
    inside = u @ (u.T @ constant)
    if np.linalg.norm(inside - constant) * float(s[0]) < 10.0 * tolerance:
        rest = np.linalg.svd(u - np.outer(constant, constant @ u), full_matrices=False)[0]
        u = np.column_stack([constant, rest[:, : u.shape[1] - 1]])
    return np.ascontiguousarray(u.T)


def _monomials(degree: int, lower: float, upper: float) -> Floats:
    """Chebyshev coefficients of 1, p, p**2, ... on lower..upper, (degree + 1, degree + 1)."""
    p = np.array([0.5 * (lower + upper), 0.5 * (upper - lower)])
    rows = [np.array([1.0])]
    for _ in range(degree):
        rows.append(chebyshev.chebmul(rows[-1], p))
    out = np.zeros((degree + 1, degree + 1))
    for k, row in enumerate(rows):
        out[k, : len(row)] = row
    return out


def _pivots(basis: Floats) -> Floats:
    """Points in -1..1 at which the functions of a basis are best told apart."""
    n = max(33, 2 * basis.shape[1] + 1)
    x = np.cos(np.pi * np.arange(n) / (n - 1))
    values = np.stack([chebyshev.chebval(x, c) for c in basis], axis=0)
    values /= np.abs(values).max(axis=1, keepdims=True)
    order = scipy.linalg.qr(values, mode="r", pivoting=True)[1]
    return np.asarray(np.sort(x[order[: len(basis)]])[::-1])
