"""How likely measured damping ratios are, with and without a dashpot.

What a structure has of damping by itself nobody predicts: the ratios scatter, ln ζ around an
unknown level that may rise or fall with frequency, by an unknown spread, with tails (one joint
that rubs is no dashpot). All three are integrated out over a grid, so that hypotheses compare by
marginal likelihood. A dashpot adds its part to the level; the part is known as well as the shapes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from ...arrays import Floats, Ints
from .damper_numbers import DAMPERS


@dataclass(frozen=True, eq=False)
class Levels:
    """What the ratios of a structure by itself may be, and how likely beforehand.

    Parameters
    ----------
    levels : (n_grid, n_mode) float
        Ratios around which the modes scatter.
    spreads : (n_grid,) float
        Standard deviation of ln ζ.
    log_prior : (n_grid,) float
        Logarithms of weights that sum to 1.
    course : (n_grid,) int
        Which course over frequency.
    """

    levels: Floats
    spreads: Floats
    log_prior: Floats
    course: Ints

    def take(self, rows: Ints) -> Levels:
        """Return part of the grid, weights as they are."""
        return Levels(
            self.levels[rows], self.spreads[rows], self.log_prior[rows], self.course[rows]
        )


def levels_for(measured: Floats, omega: Floats) -> Levels:
    """Return the grid of levels for measured ratios, (n_mode,), all positive."""
    size = np.geomspace(DAMPERS.lowest_level * measured.min(), measured.max(), DAMPERS.levels)
    x = omega / np.exp(np.mean(np.log(omega)))
    course = np.array([share * x**e + (1.0 - share) * x**-e for e, share, _ in DAMPERS.courses])
    course = course / np.exp(np.mean(np.log(course), axis=1, keepdims=True))
    number = (len(size), len(course), len(DAMPERS.spreads))
    levels = np.broadcast_to((size[:, None, None] * course)[:, :, None], (*number, len(x)))
    weight = np.broadcast_to(np.array(DAMPERS.courses)[None, :, 2, None], number).ravel()
    spreads = np.broadcast_to(np.array(DAMPERS.spreads), number).ravel()
    which = np.broadcast_to(np.arange(len(course))[None, :, None], number).ravel()
    prior = np.log(weight / weight.sum())
    return Levels(levels.reshape(-1, len(x)), spreads, prior, which)


def log_likelihood(measured: Floats, grid: Levels, part: Floats, error: Floats) -> Floats:
    """Return ln p of all ratios `measured` (n_mode,) at every level, (..., n_grid).

    `part` (..., n_mode) is what dashpots add to the ratios, `error` its standard deviation. The
    densities of a few modes at a time are multiplied before their log is taken.
    """
    alone = np.ascontiguousarray(grid.levels.T)
    a, da = (np.ascontiguousarray(np.moveaxis(x, -1, 0))[..., None] for x in (part, error))
    first = (len(alone), *(1,) * (part.ndim - 1), -1)
    mean = alone.reshape(first) + a
    v = ((grid.spreads * alone) ** 2).reshape(first) + da**2
    v /= mean**2
    v += DAMPERS.measured**2
    mean /= measured.reshape(len(alone), *(1,) * part.ndim)
    off = np.log(mean, out=mean)
    off *= off
    off += DAMPERS.tails * v
    near, far = (_log_of_product(x) for x in (v, off))
    above = DAMPERS.tails + 1.0
    constant = above * np.log(DAMPERS.tails) * len(alone)
    return np.asarray(0.5 * (DAMPERS.tails * near - above * far + constant))


def _log_of_product(x: Floats) -> Floats:
    """Return ln of the product over the first axis."""
    parts = np.array_split(x, range(DAMPERS.multiplied, len(x), DAMPERS.multiplied))
    return np.asarray(sum(np.log(np.multiply.reduce(part, axis=0)) for part in parts))


def marginal(measured: Floats, grid: Levels, part: Floats, error: Floats) -> Floats:
    """Return ln of the likelihood of all ratios, levels integrated out, (...)."""
    each = log_likelihood(measured, grid, part, error)
    return np.asarray(np.logaddexp.reduce(each + grid.log_prior, axis=-1))


def expected_level(measured: Floats, grid: Levels, part: Floats, error: Floats) -> Floats:
    """Return the posterior mean level of each mode (of ln), (n_mode,), at one `part`."""
    each = log_likelihood(measured, grid, part, error) + grid.log_prior
    weight = np.exp(each - logsumexp(each))
    return np.asarray(np.exp(weight @ np.log(grid.levels)))
