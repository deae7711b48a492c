"""What an update is asked stage by stage, and what comes of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from ..arrays import Floats, Numbers
from ..errors import InputError
from ..noun import Noun
from .problem import Point, Problem
from .residuals import Residual, residuals_named
from .updating_numbers import UPDATING


@dataclass(frozen=True)
class Stage:
    """One step of a strategy: which parameters move on which residuals.

    Parameters
    ----------
    parameters : tuple of int
        Positions in ``Model.parameters``.
    residuals : str
        A name of `RESIDUALS`, several with commas between, or ``both``: frequencies and shapes.
    max_iterations : int
    """

    parameters: tuple[int, ...]
    residuals: str = "both"
    max_iterations: int = UPDATING.iterations

    def __post_init__(self) -> None:
        residuals_named(self.residuals)
        if not self.parameters:
            raise InputError("a stage of the update names no parameter")

    @property
    def minimised(self) -> tuple[Residual, ...]:
        """The residuals of the stage."""
        return residuals_named(self.residuals)


class Reason(Enum):
    """Why an update ended."""

    SETTLED = "settled"
    NO_STEP = "no step"
    MOST_ITERATIONS = "most iterations"
    NO_STAGE = "no stage"
    NOTHING_DETERMINED = "nothing determined"


@dataclass(frozen=True)
class Stop:
    """Why an update ended, and the same in words."""

    reason: Reason
    sentence: str

    def __str__(self) -> str:
        return self.sentence


@dataclass(frozen=True, eq=False)
class Iteration(Noun):
    """One entry of the history; stages count from 1.

    `deviations_percent` (n_test,) is NaN for a test mode without partner; of several configurations
    they stand one after the other.
    """

    iteration: int
    stage: int
    objective: float
    factors: Floats
    deviations_percent: Floats


@dataclass(frozen=True, eq=False)
class Updated(Noun):
    """The outcome of an update.

    `standard_error` (n_parameter,) belongs to the factors (NaN where the data say nothing);
    `at_bound` (n_parameter,) bool; `before` and `after` are of full order, of all configurations;
    `stopped` says why the iteration ended; `undetermined` are the positions of parameters that the
    test does not determine beside the others, `doubts` the warnings that say so; `combined` are
    those that moved although they are known in combination with such alone;
    `covariance` (n_parameter, n_parameter) of the factors, NaN likewise.
    """

    factors: Floats
    standard_error: Floats
    at_bound: Numbers
    before: Point
    after: Point
    history: tuple[Iteration, ...]
    eigensolutions: int
    stopped: Stop
    warnings: tuple[str, ...]
    undetermined: tuple[int, ...] = ()
    doubts: tuple[str, ...] = ()
    covariance: Floats | None = None
    combined: tuple[int, ...] = ()

    def of(self, problem: Problem, k: int) -> Updated:
        """Return what came of one of several configurations, with its own parameters alone."""
        own, ends = problem.parts[k].own, np.cumsum([0, *problem.tests])
        history = tuple(
            replace(
                i,
                factors=i.factors[own],
                deviations_percent=i.deviations_percent[ends[k] : ends[k + 1]],
            )
            for i in self.history
        )
        at = {int(n): position for position, n in enumerate(own)}
        return replace(
            self,
            factors=self.factors[own],
            standard_error=self.standard_error[own],
            at_bound=self.at_bound[own],
            before=self.before.of(k),
            after=self.after.of(k),
            history=history,
            undetermined=tuple(at[n] for n in self.undetermined if n in at),
            covariance=None if self.covariance is None else self.covariance[np.ix_(own, own)],
        )
