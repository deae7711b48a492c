"""How much the deck's values should weigh: the evidence of the test for a prior's width."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Floats
from ..errors import InputError
from ..noun import Noun
from .problem import Configuration, Orders, Point, Problem
from .residuals import Residual
from .residuals.prior import PRIOR
from .stages import Stage, Updated
from .updating_numbers import UPDATING


@dataclass(frozen=True)
class PriorWeighed(Noun):
    """A standard deviation of the prior, and what comes of it.

    `log_evidence` is ln p(test | prior_sigma) up to a constant; `misfit` and `moved` are the parts
    of the objective that test and prior have, the axes of the L-curve, the second without its
    weight; `effective` is the number of parameters that the test determines rather than the prior.
    """

    prior_sigma: float
    log_evidence: float
    misfit: float
    moved: float
    effective: float


def weigh_prior(
    configurations: Sequence[Configuration], stage: Stage, done: Updated
) -> tuple[PriorWeighed, ...]:
    """Find the evidence for standard deviations of the prior, by Laplace's approximation.

    With J at the optimum for a standard deviation s, and G the derivatives of all residuals, prior
    included, ln p = −J/2 − d ln s − ln det(GᵀG)/2; d parameters move. MacKay (1992), *Bayesian
    interpolation*, Neural Computation 4(3), 415; Hansen, O'Leary (1993), SIAM Journal on
    Scientific Computing 14(6), 1487, for the L-curve.

    Parameters
    ----------
    configurations : sequence of Configuration
    stage : Stage
        With the residual ``prior``.
    done : Updated
        The optimum for the standard deviation that was asked for.

    Returns
    -------
    tuple of PriorWeighed
        By standard deviation, ascending.

    Raises
    ------
    InputError
        The stage has no prior.
    """
    residuals, active = stage.minimised, list(stage.parameters)
    if PRIOR not in residuals:
        raise InputError("the evidence weighs a prior: add it to the residuals, 'both, prior'")
    problem = Problem.of(configurations)
    there = problem.at(problem.full, np.array(done.factors), residuals)
    orders = problem.around(there, active)
    own = configurations[0].weights.sigma(PRIOR)
    out, point = {}, there
    for sigmas in (_below(own), _above(own)):
        point = there
        for sigma in sigmas:
            at = _with_prior(problem, sigma)
            point = _settled(at, orders, point.factors, active, residuals)
            out[sigma] = _weighed(at, orders, point, active, residuals, sigma)
    return tuple(out[s] for s in sorted(out))


def best_prior(rows: Sequence[PriorWeighed]) -> float:
    """Return the standard deviation of the largest evidence."""
    return max(rows, key=lambda r: r.log_evidence).prior_sigma


def _below(sigma: float) -> list[float]:
    return [sigma * UPDATING.prior_ratio**-k for k in range(UPDATING.prior_trials + 1)]


def _above(sigma: float) -> list[float]:
    return [sigma * UPDATING.prior_ratio**k for k in range(1, UPDATING.prior_trials + 1)]


def _with_prior(problem: Problem, sigma: float) -> Problem:
    parts = []
    for part in problem.parts:
        weights = part.objective.weights
        other = replace(weights, sigmas={**weights.sigmas, PRIOR.weight: sigma})
        parts.append(replace(part, objective=replace(part.objective, weights=other)))
    return replace(problem, parts=tuple(parts))


def _settled(
    problem: Problem,
    orders: Orders,
    start: Floats,
    active: Sequence[int],
    residuals: Sequence[Residual],
) -> Point:
    """Return the optimum on reduced models."""
    best = problem.at(orders, np.array(start), residuals)
    for _ in range(UPDATING.profile_iterations):
        step = problem.step(orders, best, active, residuals)
        tried = (
            problem.at(orders, np.clip(best.factors + step / 2**k, *problem.bounds), residuals)
            for k in range(UPDATING.halvings)
        )
        least = best.objective - UPDATING.prior_accuracy
        found = next((trial for trial in tried if trial.objective <= least), None)
        if found is None:
            break
        best = found
    return best


def _weighed(
    problem: Problem,
    orders: Orders,
    point: Point,
    active: Sequence[int],
    residuals: Sequence[Residual],
    sigma: float,
) -> PriorWeighed:
    of_prior = problem.linearise(orders, point, active, (PRIOR,))
    both = problem.linearise(orders, point, active, residuals).gradient
    whole, prior = both.T @ both, of_prior.gradient.T @ of_prior.gradient
    moved = float(np.sum(of_prior.values**2))
    _, size = np.linalg.slogdet(whole)
    evidence = -0.5 * point.objective - len(active) * np.log(sigma) - 0.5 * size
    effective = len(active) - float(np.trace(np.linalg.solve(whole, prior)))
    misfit = point.objective - moved
    return PriorWeighed(sigma, float(evidence), misfit, moved * sigma**2, effective)
