"""Samples of a density by adaptive Metropolis, and how many of them are independent."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
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


def adaptive_metropolis(
    log_density: Callable[[Floats], float],
    start: Floats,
    covariance: Floats,
    count: int,
    seed: int = 0,
) -> Chains:
    """Sample a density that is known up to a factor.

    Chains run side by side from around `start`. In the first part, which is thrown away, the
    covariance of the proposals follows that of all of them; then it stays, so that what is kept has
    the density exactly. Haario, Saksman, Tamminen (2001), *An adaptive Metropolis algorithm*,
    Bernoulli 7(2), 223; Roberts, Rosenthal (2001), Statistical Science 16, 351, for the scale.

    Parameters
    ----------
    log_density : callable
        Of a point (n,); −inf where nothing is.
    start : (n,) float
        Where the density is not nothing.
    covariance : (n, n) float
        About that of the density.
    count : int
        Samples to keep, at least.
    seed : int

    Returns
    -------
    Chains
    """
    rng, n, chains = np.random.default_rng(seed), len(start), UPDATING.chains
    keep = -(-count // chains)
    learn = max(int(UPDATING.learning * keep), UPDATING.least_learning)
    width = UPDATING.proposal / np.sqrt(n)
    root = _root(covariance)
    points, heights = _begin(log_density, np.asarray(start, float), root, rng)
    values, taken = np.empty((learn + keep, chains, n)), 0
    for step in range(learn + keep):
        trial = points + width * rng.standard_normal((chains, n)) @ root.T
        odds = np.array([log_density(p) for p in trial])
        go = np.log(rng.uniform(size=chains)) < odds - heights
        points, heights = np.where(go[:, None], trial, points), np.where(go, odds, heights)
        values[step] = points
        taken += int(go.sum()) if step >= learn else 0
        if step < learn and (step + 1) % UPDATING.relearn == 0:
            past = values[step // 2 : step + 1].reshape(-1, n)
            own, weight = len(past), UPDATING.prior_steps * n
            root = _root(
                (own * np.cov(past.T).reshape(n, n) + weight * covariance) / (own + weight)
            )
    return Chains(values[learn:].swapaxes(0, 1).copy(), taken / (keep * chains))


def _begin(
    log_density: Callable[[Floats], float], start: Floats, root: Floats, rng: np.random.Generator
) -> tuple[Floats, Floats]:
    """Return where chains begin, around `start` or there, and the density, (n_chain,)."""
    points = start + rng.standard_normal((UPDATING.chains, len(start))) @ root.T
    heights = np.array([log_density(p) for p in points])
    lost = ~np.isfinite(heights)
    points[lost], heights[lost] = start, log_density(start)
    return points, heights


def _root(covariance: Floats) -> Floats:
    """R with R Rᵀ = covariance, singular ones too."""
    value, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.maximum(value, 0.0)))
