"""Move parameters so that the analysis meets the test, equations (1)–(6) of the source paper."""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from ..arrays import Floats, frozen
from ..correlation.criteria import Criteria
from ..data.parametric_model import Model
from ..errors import InputError
from ..reduction.full_or_reduced import ReducedOrder
from .identifiability import doubts
from .problem import Configuration, Orders, Point, Problem
from .residuals import Residual, Target, Weights
from .stages import Iteration, Reason, Stage, Stop, Updated
from .updating_numbers import UPDATING

__all__ = [
    "Configuration", "Iteration", "Point", "Reason", "Stage", "Stop", "Target", "Updated", "update",
    "update_configurations",
]  # fmt: skip

_NO_STEP = Stop(Reason.NO_STEP, "no step lowers the objective further")


def update(
    model: Model,
    target: Target,
    stages: Sequence[Stage],
    criteria: Criteria | None = None,
    weights: Weights | None = None,
    n_modes: int = UPDATING.modes,
    tolerance: float = UPDATING.tolerance,
    progress: Callable[[Iteration], None] = lambda _: None,
    start: Floats | None = None,
) -> Updated:
    """Minimise ΔzᵀWΔz + pᵀW_p p over the parameters, equations (2)–(4).

    Each iteration pairs the modes anew (clusters are turned onto the test again), linearises
    the residuals and takes the bounded step of (GᵀWG + W_p)Δp = GᵀWΔz₀; a step that does not
    lower the objective is halved. A test mode without a partner costs what a pair at the limits
    of the criteria would, so gaining a pair is always a gain; losing a pair at the MAC limit
    does not stop a step that brings the frequencies of the other pairs closer.

    The iterations run on a reduced model, made around the point where they start and corrected
    on the way by what its modes leave of the full matrices. Where they end the full model is
    solved; unless both agree there, its modes widen the reduced model, or far from where that was
    made it is made anew.

    Parameters
    ----------
    model : Model
        With the parameters that the stages refer to.
    target : Target
    stages : sequence of Stage
        Worked off in order.
    criteria : Criteria
    weights : Weights
    n_modes : int
        Analysis modes per eigensolution.
    tolerance : float
        The iteration ends when no factor moves by more than this fraction.
    progress : callable
        Called with each `Iteration`.
    start : (n_parameter,) float, optional
        Factors to begin with; default the deck's.

    Returns
    -------
    Updated

    Raises
    ------
    InputError
        When no test mode pairs with the model as it is, or a stage names an unknown parameter.
    CheckError
        When an eigensolution fails its own checks.
    """
    only = Configuration(model, target, criteria or Criteria(), weights or Weights(), n_modes)
    return update_configurations([only], stages, tolerance, progress, start)


def update_configurations(
    configurations: Sequence[Configuration],
    stages: Sequence[Stage],
    tolerance: float = UPDATING.tolerance,
    progress: Callable[[Iteration], None] = lambda _: None,
    start: Floats | None = None,
    gone_on: Sequence[Iteration] = (),
) -> Updated:
    """Move one set of parameters so that each configuration meets its test, as `update` does.

    Residuals of all configurations are stacked; each is paired with its own test. Parameters are
    one where their names are: first those of the first configuration, in its order, then what each
    other adds.

    Parameters
    ----------
    configurations : sequence of Configuration
    stages, tolerance, progress, start
        As for `update`; parameters are those of all configurations.
    gone_on : sequence of Iteration
        The history of an update that was cut off: it goes on from its last entry.

    Returns
    -------
    Updated

    Raises
    ------
    InputError
        As `update`, of any configuration; a parameter that two of them know by different values.
    CheckError
        When an eigensolution fails its own checks.
    """
    problem = Problem.of(configurations)
    known, full = len(problem.parameters), problem.full
    for s in stages:
        if not all(0 <= k < known for k in s.parameters):
            raise InputError(f"a stage refers to parameter {max(s.parameters)} of {known}")
    begin = np.array(problem.deck_point if start is None else start)
    before = problem.at(full, begin, stages[0].minimised)
    problem.require_pairs(before)
    history: list[Iteration] = [*gone_on]

    def note(stage: int, at: Point) -> None:
        off = problem.deviations(at)
        history.append(Iteration(len(history), stage + 1, at.objective, at.factors, off))
        progress(history[-1])

    first, point, solves = 0, before, 1
    if gone_on:
        first, solves = gone_on[-1].stage - 1, 2
        point = problem.at(full, gone_on[-1].factors, stages[first].minimised)
    else:
        note(0, before)
    stopped = Stop(Reason.NO_STAGE, "no stage")
    near: list[ReducedOrder] | None = None
    before = before.without_factors()
    for number, stage in list(enumerate(stages))[first:]:
        point = problem.valued(point, stage.minimised)
        left = stage.max_iterations - sum(h.stage == number + 1 for h in gone_on[1:])
        point, near, used, stopped = _work_off(
            problem, point, stage, left, tolerance, partial(note, number)
        )
        solves += used
    active = sorted({k for s in stages for k in s.parameters})
    if near is None or active != sorted(stages[-1].parameters):
        near = problem.around(point, active)
    counted = _moved_by(stages)
    there = problem.at(near, point.factors, counted)
    said = problem.identified(near, there, active, counted)
    error, covariance = np.full(known, np.nan), np.full((known, known), np.nan)
    doubtful: tuple[str, ...] = ()
    if said is not None:
        error[active] = said.standard_error
        covariance[np.ix_(active, active)] = said.covariance
        names = [problem.parameters[k].name for k in active]
        doubtful = tuple(doubts(names, np.asarray(point.factors)[active], said))
    determined = () if said is None else tuple(active[i] for i in said.determined)
    bounds = (np.isclose(point.factors, end, rtol=UPDATING.at_bound) for end in problem.bounds)
    moved = frozen(point.factors), frozen(error), frozen(np.any([*bounds], axis=0))
    astray = problem.farther(before, point, stages[-1].minimised)
    told = (*doubtful, *problem.lost(before, point), *astray)
    told = (*told, *_unfinished(stopped, len(history) - 1))
    after = point.without_factors()
    open_ = tuple(k for k in active if k not in determined)
    solves *= len(configurations)
    return Updated(
        *moved, before, after, tuple(history), solves, stopped, told, open_, doubtful, covariance
    )


def _work_off(
    problem: Problem,
    point: Point,
    stage: Stage,
    left: int,
    tolerance: float,
    note: Callable[[Point], None],
) -> tuple[Point, list[ReducedOrder] | None, int, Stop]:
    """Work off a stage of which so many iterations are left.

    Returned are where it ends, in full, the reduced models that were last used, how many full
    solves of each configuration it took, and why it stopped.
    """
    solves, widened, missed = 0, 0, False
    near: list[ReducedOrder] | None = None
    centre = arrived = point
    while left > 0:
        close = _apart(point, centre) < UPDATING.rebuild
        if near is not None and close and widened < UPDATING.widened:
            near, widened = problem.widened(near, arrived), widened + 1
        else:
            near, centre, widened = None, point, 0  # two bases at a time are memory
            near = problem.around(point, stage.parameters, UPDATING.sketch)
        point, arrived = point.without_factors(), arrived.without_factors()
        most = 1 if missed else left
        trail, near, stop = _walk(problem, near, point, stage, most, tolerance)
        if not trail:
            return point, near, solves, _NO_STEP
        nearly = problem.nearly(near, trail[-1].factors)
        arrived = problem.at(nearly, trail[-1].factors, stage.minimised)
        solves += 1
        if not problem.closer(arrived, point, stage.minimised):
            if missed:
                return point, near, solves, _NO_STEP
            missed = True
            continue
        missed, left = False, left - len(trail)
        for s in trail[:-1]:
            if abs(s.objective - arrived.objective) > UPDATING.same * arrived.objective:
                note(s)
        note(arrived)
        point = arrived
        if stop and _agree(trail[-1], arrived, UPDATING.agree * tolerance):
            return point, near, solves, stop
    ended = Stop(Reason.MOST_ITERATIONS, f"{stage.max_iterations} iterations")
    return point, near, solves, ended


def _walk(
    problem: Problem,
    near: list[ReducedOrder],
    start: Point,
    stage: Stage,
    most: int,
    tolerance: float,
) -> tuple[list[Point], list[ReducedOrder], Stop | None]:
    """Iterate on reduced models, corrected where they have come far and where they settle.

    Returned are the points, the reduced models, and why it ended, None if it should go on.
    """
    sure = point = problem.at(near, start.factors, stage.minimised)
    trail: list[Point] = []
    kept = 0
    doubted = False
    while len(trail) < most:
        trial = _descend(problem, near, point, stage)
        if trial is None and point is sure:
            return trail, near, _NO_STEP
        stop: Stop | None = _NO_STEP
        if trial is not None:
            moved = float(np.max(np.abs(trial.factors / point.factors - 1.0)))
            settled = Stop(Reason.SETTLED, f"factors moved less than {tolerance:g}")
            stop = settled if moved < tolerance else None
            point = trial
            trail.append(trial)
        far = _apart(point, sure) > UPDATING.correct
        fallen = point.objective < UPDATING.fallen * sure.objective
        due = doubted or (far and fallen) or len(trail) - kept > UPDATING.uncorrected
        if stop is None and not due:
            continue
        if stop is None and len(trail) == most:
            break
        near = problem.corrected(near, point.factors)
        better = problem.at(near, point.factors, stage.minimised)
        if not problem.closer(better, sure, stage.minimised):
            trail = trail[:kept]
            if doubted:
                return trail, near, _NO_STEP
            doubted = True
            sure = point = problem.at(near, sure.factors, stage.minimised)
            continue
        agreed = _agree(point, better, UPDATING.agree * tolerance)
        trail[-1] = sure = point = better
        kept, doubted = len(trail), False
        if stop and agreed:
            return trail, near, stop
        if _apart(point, start) > UPDATING.rebuild:
            break
    return trail, near, None


def _moved_by(stages: Sequence[Stage]) -> tuple[Residual, ...]:
    """Return the residuals that each parameter was last moved by, of all in one."""
    last = {k: stage for stage in stages for k in stage.parameters}
    return tuple(dict.fromkeys(r for stage in last.values() for r in stage.minimised))


def _apart(a: Point, b: Point) -> float:
    """Return the largest ratio of two factors of one parameter, either way."""
    return float(np.exp(np.max(np.abs(np.log(a.factors / b.factors)))))


def _descend(problem: Problem, orders: Orders, point: Point, stage: Stage) -> Point | None:
    """Take the step, halved until it is one; return where it leads, None where none is."""
    lower, upper = problem.bounds
    step = problem.step(orders, point, stage.parameters, stage.minimised)
    for halving in range(UPDATING.halvings):
        p = np.clip(point.factors + step / 2**halving, lower, upper)
        trial = problem.at(orders, p, stage.minimised)
        if problem.closer(trial, point, stage.minimised):
            return trial
    return None


def _agree(reduced: Point, full: Point, tolerance: float) -> bool:
    """Whether both pair alike, with eigenvalues that are the same to a tolerance."""
    least = max(tolerance, UPDATING.agree_least)
    for states in zip(reduced.states, full.states, strict=True):
        own, whole = ({q.test: q.analysis_hz for q in s.correlation.pairs} for s in states)
        if own.keys() != whole.keys():
            return False
        if any(abs((own[k] / whole[k]) ** 2 - 1.0) >= least for k in own):
            return False
    return True


def _unfinished(stopped: Stop, iterations: int) -> tuple[str, ...]:
    if stopped.reason is Reason.MOST_ITERATIONS:
        return (f"the update had not settled after {stopped}; allow more (max_iterations)",)
    if not iterations:
        return ("no step of the parameters brings the model closer to the test; nothing changed",)
    return ()
