"""Samples of the posterior of the factors, on models reduced around the optimum."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Floats
from ..errors import InputError
from ..independent import Each, in_turn
from ..noun import Noun
from ..reduction.full_or_reduced import Order, ReducedOrder
from .metropolis import Chains, adaptive_metropolis
from .problem import Configuration, Orders, Problem
from .stages import Stage, Updated
from .updating_numbers import UPDATING


@dataclass(frozen=True, eq=False)
class Sampled(Noun):
    """Samples of the factors that the test determines.

    `parameters` (n,) are their positions; components of `chains` are in the same order.
    """

    parameters: tuple[int, ...]
    chains: Chains

    def without(self, left: Collection[int]) -> Sampled | None:
        """Return the samples of the other parameters; None where none is left."""
        kept = [i for i, k in enumerate(self.parameters) if k not in left]
        chains = replace(self.chains, values=self.chains.values[:, :, kept])
        named = tuple(self.parameters[i] for i in kept)
        return replace(self, parameters=named, chains=chains) if kept else None

    @property
    def doubts(self) -> tuple[str, ...]:
        """What speaks against the samples."""
        least, most = float(self.chains.effective.min()), float(self.chains.spread.max())
        if least >= UPDATING.least_effective and most <= UPDATING.most_spread:
            return ()
        return (
            f"the samples of the posterior are worth {least:.0f} independent ones (chains part by "
            f"{most - 1.0:.1%}); ask for more",
        )


def sample_posterior(
    configurations: Sequence[Configuration],
    stage: Stage,
    done: Updated,
    count: int,
    seed: int = 0,
    each: Each = in_turn,
) -> Sampled | None:
    """Sample exp(−J/2s), J being the objective and s the scatter of the residuals.

    With the residual ``prior`` standard deviations are believed, s is 1 and this is the posterior
    by them; without it nothing is known of the factors but their bounds, s is estimated with ν
    degrees of freedom, and the n factors are Student's (1 + J/νs)^(−(ν+n)/2), J counted from its
    least (Gelman et al. 2013, *Bayesian data analysis*, section 14.2). Where kinds of residual
    scatter apart, factors are turned about the optimum such that the curvature is that of their
    covariance (Ribatet, Cooley, Davison 2012, Statistica Sinica 22, 813). Samples stay within the
    bounds and the reach of the reduced models.

    Parameters
    ----------
    configurations : sequence of Configuration
    stage : Stage
        The residuals of the objective; of its parameters those move that `done` says are
        determined.
    done : Updated
        Where the objective is least.
    count : int
        Samples, at least.
    seed : int
    each : Each
        Runs the chains.

    Returns
    -------
    Sampled, or None where nothing is determined
    """
    problem, residuals = Problem.of(configurations), stage.minimised
    active = [k for k in stage.parameters if k not in done.undetermined]
    if not active:
        return None
    there = problem.at(problem.full, np.array(done.factors), residuals)
    orders = problem.around(there, active)
    top = problem.at(orders, there.factors, residuals)
    scatter = problem.scatter(orders, top, active, residuals)
    if not scatter.variance > 0.0:
        raise InputError("nothing is left of the residuals, so the posterior is a point")
    centre = np.asarray(top.factors)[active]
    lower, upper = (end[active] for end in problem.bounds)
    lower = np.maximum(lower, centre / UPDATING.reach)
    upper = np.minimum(upper, centre * UPDATING.reach)

    A = problem.linearise(orders, top, active, residuals).gradient
    Q = scatter.gradient.T @ scatter.gradient
    density = _Density(
        problem,
        [_to_send(o) for o in orders],
        stage,
        top.factors,
        top.objective,
        active,
        lower,
        upper,
        scatter.variance,
        float(scatter.freedom.min()),
        _turning(A.T @ A, Q),
    )
    normal = scatter.variance * np.linalg.pinv(Q)
    width = np.minimum(1.0, (upper - lower) / np.sqrt(np.maximum(12.0 * np.diag(normal), 1e-300)))
    normal = normal * np.outer(width, width)
    chains = adaptive_metropolis(density, centre, normal, count, seed, each)
    return Sampled(tuple(active), chains)


@dataclass(frozen=True, eq=False)
class _Density:
    """ln of the density of the active factors, within their limits, the others as in `factors`."""

    problem: Problem
    orders: Orders
    stage: Stage
    factors: Floats
    least: float
    active: list[int]
    lower: Floats
    upper: Floats
    variance: float
    freedom: float
    turning: Floats

    def __call__(self, x: Floats) -> float:
        if ((x < self.lower) | (x > self.upper)).any():
            return -np.inf
        p = np.array(self.factors)
        p[self.active] += self.turning @ (x - p[self.active])
        if not (p > 0.0).all():
            return -np.inf
        try:
            found = self.problem.at(self.orders, p, self.stage.minimised)
        except InputError:
            return -np.inf
        above = (found.objective - self.least) / self.variance
        if not np.isfinite(self.freedom):
            return -0.5 * above
        share = max(above / self.freedom, UPDATING.slack - 1.0)
        return -0.5 * (self.freedom + len(self.active)) * float(np.log1p(share))


def _turning(A: Floats, Q: Floats) -> Floats:
    """Return the symmetric C with CᵀAC = Q; one where they are alike, or A sees not all."""
    w, V = np.linalg.eigh(A)
    if np.allclose(A, Q, rtol=UPDATING.alike, atol=0.0) or w[0] <= UPDATING.alike**2 * w[-1]:
        return np.eye(len(A))
    root, back = (V * w**0.5) @ V.T, (V * w**-0.5) @ V.T
    w, V = np.linalg.eigh(root @ Q @ root)
    return np.asarray(back @ (V * np.sqrt(np.maximum(w, 0.0))) @ V.T @ back)


def _to_send(order: Order) -> Order:
    """Return a reduced model without the factorised matrix that it was made by."""
    assert isinstance(order, ReducedOrder)
    bare = replace(order.reduced.solution, factor=None)
    return replace(order, reduced=replace(order.reduced, solution=bare))
