"""Samples of a density by adaptive Metropolis, and how many of them are independent."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..arrays import Floats
from ..independent import Each, in_turn
from ..noun import Noun
from .updating_numbers import UPDATING


@dataclass(frozen=True, eq=False)
class Chains(Noun):
    """Chains of samples, (n_chain, n_step, n), and the share of proposals that were taken."""

    values: Floats
    accepted: float

    @property
    def samples(self) -> Floats:
        """All samples, (n_chain · n_step, n)."""
        return self.values.reshape(-1, self.values.shape[2])

    @property
    def effective(self) -> Floats:
        """Independent samples that would tell each mean as well, (n,).

        Gelman et al. (2013), *Bayesian Data Analysis*, section 11.5: autocorrelations from the
        variances within and between chains, summed up to the first pair that is not positive
        (Geyer 1992, Statistical Science 7, 473).
        """
        m, n, _ = self.values.shape
        within = self.values.var(axis=1, ddof=1).mean(axis=0)
        total = (n - 1) / n * within + self._between
        total = np.where(total > 0.0, total, 1.0)
        centred = self.values - self.values.mean(axis=1, keepdims=True)
        spectrum = np.abs(np.fft.rfft(centred, 2 * n, axis=1)) ** 2
        covariance = np.fft.irfft(spectrum, 2 * n, axis=1)[:, :n].mean(axis=0) / n
        rho = 1.0 - (within - covariance) / total
        pairs = rho[0 : 2 * (n // 2) : 2] + rho[1 : 2 * (n // 2) : 2]
        until = np.cumprod(pairs > 0.0, axis=0)
        return np.asarray(m * n / np.maximum(2.0 * np.sum(pairs * until, axis=0) - 1.0, 1.0))

    @property
    def spread(self) -> Floats:
        """Potential scale reduction of each component, (n,): 1 where the chains tell the same."""
        n = self.values.shape[1]
        within = self.values.var(axis=1, ddof=1).mean(axis=0)
        return np.asarray(np.sqrt((n - 1) / n + self._between / np.where(within > 0, within, 1.0)))

    @property
    def _between(self) -> Floats:
        return np.asarray(self.values.mean(axis=1).var(axis=0, ddof=1))


@dataclass(frozen=True, eq=False)
class _Walker:
    """Where a chain is, the logarithm of the density there, and its random numbers."""

    point: Floats
    height: float
    rng: np.random.Generator


Density = Callable[[Floats], float]
"""Logarithm of a density at a point (n,), up to a constant; −inf where nothing is."""


def adaptive_metropolis(
    log_density: Density,
    start: Floats,
    covariance: Floats,
    count: int,
    seed: int = 0,
    each: Each = in_turn,
) -> Chains:
    """Sample a density that is known up to a factor.

    Chains run side by side from around `start`. In the first part, which is thrown away, the
    covariance of the proposals follows that of all of them; then it stays, so that what is kept has
    the density exactly. Haario, Saksman, Tamminen (2001), *An adaptive Metropolis algorithm*,
    Bernoulli 7(2), 223; Roberts, Rosenthal (2001), Statistical Science 16, 351, for the scale.

    Parameters
    ----------
    log_density : callable
    start : (n,) float
        Where the density is not nothing.
    covariance : (n, n) float
        About that of the density.
    count : int
        Samples to keep, at least.
    seed : int
        Each chain has random numbers of its own, so that it is the same wherever it runs.
    each : Each
        Runs the chains once the proposals are learnt.

    Returns
    -------
    Chains
    """
    n, chains = len(start), UPDATING.chains
    keep = -(-count // chains)
    learn = max(int(UPDATING.learning * keep), UPDATING.least_learning)
    width = UPDATING.proposal / np.sqrt(n)
    own = [np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(chains)]
    root, past = _root(covariance), np.empty((chains, 0, n))
    walkers: Sequence[_Walker] = [
        _begin(log_density, np.asarray(start, float), root, rng) for rng in own
    ]
    while past.shape[1] < learn:
        steps = partial(_walk, log_density, width * root, min(UPDATING.relearn, learn))
        values, walkers, _ = zip(*map(steps, walkers), strict=True)
        past = np.concatenate([past, np.array(values)], axis=1)
        late = past[:, past.shape[1] // 2 :].reshape(-1, n)
        weight = UPDATING.prior_steps * n
        C = (len(late) * np.cov(late.T).reshape(n, n) + weight * covariance) / (len(late) + weight)
        root = _root(C)
    steps = partial(_walk, log_density, width * root, keep)
    values, _, taken = zip(*each(steps, walkers), strict=True)
    return Chains(np.array(values), sum(taken) / (keep * chains))


def _walk(
    log_density: Density, step: Floats, count: int, begin: _Walker
) -> tuple[Floats, _Walker, int]:
    """Walk on by so many steps: the points (count, n), where it ends, how many moved it."""
    point, height, rng = begin.point, begin.height, begin.rng
    values, taken = np.empty((count, len(point))), 0
    for k in range(count):
        trial = point + step @ rng.standard_normal(len(point))
        odds = log_density(trial)
        if np.log(rng.uniform()) < odds - height:
            point, height, taken = trial, odds, taken + 1
        values[k] = point
    return values, _Walker(point, height, rng), taken


def _begin(log_density: Density, start: Floats, root: Floats, rng: np.random.Generator) -> _Walker:
    """Begin a chain around `start`, or there."""
    point = start + root @ rng.standard_normal(len(start))
    height = log_density(point)
    if np.isfinite(height):
        return _Walker(point, height, rng)
    return _Walker(start, log_density(start), rng)


def _root(covariance: Floats) -> Floats:
    """R with R Rᵀ = covariance, singular ones too."""
    value, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.maximum(value, 0.0)))
