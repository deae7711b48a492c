"""What an update leaves open: intervals of each factor, and other optima."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..arrays import Floats
from ..errors import CheckError, InputError
from ..independent import Each, in_turn
from ..noun import Noun
from .problem import Configuration, Orders, Point, Problem
from .residuals import Residual
from .stages import Iteration, Stage, Updated
from .update import update_configurations
from .updating_numbers import UPDATING


@dataclass(frozen=True, eq=False)
class Start(Noun):
    """An update from elsewhere: where it began, where it ended, its objective there.

    `same` says whether that is the optimum found from the deck. The factors (n_parameter,) and the
    objective are NaN where nothing pairs with the test at the start.
    """

    start: Floats
    factors: Floats
    objective: float
    same: bool


@dataclass(frozen=True, eq=False)
class _Near:
    """A problem on models reduced around its optimum, and how far its objective is followed up."""

    problem: Problem
    orders: Orders
    residuals: tuple[Residual, ...]
    rise: float

    def least(self, state: Point, k: int, value: float, others: Sequence[int]) -> Point:
        """Return the optimum of the other parameters where parameter `k` has a value."""
        p = np.array(state.factors)
        p[k] = value
        best = self.problem.at(self.orders, p, self.residuals)
        for _ in range(UPDATING.profile_iterations * bool(others)):
            step = self.problem.step(self.orders, best, others, self.residuals)
            trial = self.problem.at(self.orders, best.factors + step, self.residuals)
            if trial.objective > best.objective - UPDATING.profile_accuracy * self.rise:
                break
            best = trial
        return best


def profile_intervals(
    configurations: Sequence[Configuration], stage: Stage, done: Updated
) -> Floats:
    """Return 95 % intervals of the factors by the profile of the objective, (n_parameter, 2).

    A factor is moved, the others follow, until the objective has risen by the square of Student's t
    times the scatter of the residuals (`Scatter.rises`), 3.84 of χ² where their standard deviations
    are believed. Where the posterior is not Gaussian this is no multiple of the standard error.
    Venzon and Moolgavkar (1988), *A method for computing profile-likelihood-based confidence
    intervals*, Applied Statistics 37(1), 87.

    Parameters
    ----------
    configurations : sequence of Configuration
    stage : Stage
        The residuals of the objective; of its parameters those that `done` says are determined
        have an interval, the others NaN.
    done : Updated
        Where the objective is least.

    Returns
    -------
    (n_parameter, 2) float
        An end is infinite where a bound or the reach of the reduced model comes first.
    """
    problem = Problem.of(configurations)
    residuals, known = stage.minimised, np.full((len(problem.parameters), 2), np.nan)
    active = [k for k in stage.parameters if k not in done.undetermined]
    if not active:
        return known
    there = problem.at(problem.full, np.array(done.factors), residuals)
    orders = problem.around(there, active)
    top = problem.at(orders, there.factors, residuals)
    rises = problem.scatter(orders, top, active, residuals).rises
    lower, upper = problem.bounds
    for k, rise in zip(active, map(float, rises), strict=True):
        near = _Near(problem, orders, residuals, rise)
        others = [j for j in active if j != k]
        centre = float(top.factors[k])
        least = max(lower[k], centre / UPDATING.reach)
        most = min(upper[k], centre * UPDATING.reach)
        first = float(done.standard_error[k])
        step = first if np.isfinite(first) and first > 0.0 else UPDATING.tolerance * centre
        known[k] = [
            _end(near, top, k, others, rise, limit, np.sign(limit - centre) * step)
            for limit in (least, most)
        ]
    return known


def _end(
    near: _Near,
    top: Point,
    k: int,
    others: Sequence[int],
    rise: float,
    limit: float,
    step: float,
) -> float:
    """Find where the profile has risen; ±inf where the limit comes first."""
    centre = float(top.factors[k])
    inside, outside, state = (centre, 0.0), (centre, 0.0), top
    while outside[1] < 1.0:
        inside = outside
        x = inside[0] + step
        x = min(x, limit) if step > 0.0 else max(x, limit)
        state = near.least(state, k, x, others)
        outside = (x, _root(state, top, rise))
        if x == limit and outside[1] < 1.0:
            return float(np.copysign(np.inf, step))
        step *= 2.0
    for _ in range(UPDATING.profile_steps):
        share = (1.0 - inside[1]) / (outside[1] - inside[1])
        x = inside[0] + share * (outside[0] - inside[0])
        state = near.least(state, k, x, others)
        found = (x, _root(state, top, rise))
        if abs(found[1] - 1.0) < UPDATING.profile_accuracy:
            return x
        inside, outside = (found, outside) if found[1] < 1.0 else (inside, found)
    return outside[0]


def _root(state: Point, top: Point, rise: float) -> float:
    """Square root of the share of the rise: linear where the posterior is Gaussian."""
    return float(np.sqrt(max(state.objective - top.objective, 0.0) / rise)) if rise else np.inf


def from_elsewhere(
    configurations: Sequence[Configuration],
    stages: Sequence[Stage],
    done: Updated,
    starts: int,
    seed: int = 0,
    each: Each = in_turn,
) -> tuple[Updated, tuple[Start, ...]]:
    """Update from other factors as well, and say whether the optimum is the only one.

    Parameters
    ----------
    configurations, stages
        As for `update_configurations`.
    done : Updated
        What came of the deck's own values.
    starts : int
        How many more; factors are log-normal about the deck's, within their bounds.
    seed : int
    each : Each
        Does the updates.

    Returns
    -------
    Updated
        `done`, or where another start led to a lower objective what came of that.
    tuple of Start
    """
    rng = np.random.default_rng(seed)
    moving = sorted({k for s in stages for k in s.parameters} - set(done.undetermined))
    left = [replace(s, parameters=p) for s in stages if (p := _kept(s, moving))]
    best, told = done, list[Start]()
    solves = done.eigensolutions
    problem = Problem.of(configurations)
    (lowest, highest), begins = problem.bounds, list[Floats]()
    for _ in range(starts if left else 0):
        begin = np.array(problem.deck_point)
        spread = np.exp(UPDATING.start_spread * rng.standard_normal(len(moving)))
        begin[moving] = np.clip(spread, lowest[moving], highest[moving])
        begins.append(begin)
    ended = each(partial(_updated, configurations, left), begins)
    for begin, other in zip(begins, ended, strict=True):
        if other is None:
            told.append(Start(begin, np.full(len(begin), np.nan), np.nan, False))
            continue
        path, factors, objective, used = other
        solves += used
        told.append(Start(begin, factors, objective, False))
        lower = objective < best.after.objective * (1.0 - UPDATING.least_gain)
        if lower and not _same(factors, best):
            better = update_configurations(configurations, left, start=begin, gone_on=path)
            solves += better.eigensolutions
            best = replace(
                better,
                before=done.before,
                history=(*done.history, *better.history[1:]),
                undetermined=done.undetermined,
            )
    compared = tuple(replace(s, same=_same(s.factors, best)) for s in told)
    return replace(best, eigensolutions=solves), compared


def _updated(
    configurations: Sequence[Configuration], stages: Sequence[Stage], begin: Floats
) -> tuple[tuple[Iteration, ...], Floats, float, int] | None:
    """Update from factors: history, end, objective there and solves; None if nothing pairs."""
    try:
        done = update_configurations(configurations, stages, start=begin)
    except (InputError, CheckError):
        return None
    return done.history, done.factors, done.after.objective, done.eigensolutions


def _same(factors: Floats, best: Updated) -> bool:
    """Whether factors are those of an optimum, to their standard errors."""
    near = np.maximum(UPDATING.same_optimum, np.nan_to_num(best.standard_error))
    return bool((np.abs(factors - best.factors) <= near).all())


def _kept(stage: Stage, moving: Sequence[int]) -> tuple[int, ...]:
    return tuple(k for k in stage.parameters if k in moving)


def remarks(done: Updated, best: Updated, starts: Sequence[Start]) -> tuple[str, ...]:
    """Say whether other starts led elsewhere."""
    if not starts:
        return ()
    found = [s for s in starts if np.isfinite(s.objective)]
    same = sum(s.same for s in found)
    if best.after is not done.after:
        return (
            "another start than the deck led to a better optimum, which is taken: "
            f"{same} of {len(starts)} starts lead there",
        )
    if same == len(starts):
        return ()
    return (
        f"{same} of {len(starts)} other starts lead to this optimum, {len(found) - same} to a "
        f"worse one, {len(starts) - len(found)} pair with nothing",
    )
