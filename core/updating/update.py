"""Move parameters so that the analysis meets the test, equations (1)–(6) of the source paper."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from ..arrays import Floats, frozen
from ..correlation.criteria import Criteria
from ..data.parametric_model import Model
from ..eigen.normal_modes import Eigensolution
from ..errors import InputError
from ..reduction.full_or_reduced import FullOrder, Order, reduce_around
from .identifiability import doubts
from .objective import Objective, State
from .residuals import Target, Weights
from .stages import Iteration, Reason, Stage, Stop, Updated
from .updating_numbers import UPDATING

__all__ = ["Iteration", "Reason", "Stage", "State", "Stop", "Target", "Updated", "update"]

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

    The iterations run on a reduced model, made around the point where they start. Where they
    end the full model is solved; unless both agree there, a reduced model is made anew.

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
    criteria, weights = criteria or Criteria(), weights or Weights()
    known = len(model.parameters)
    for s in stages:
        if not all(0 <= k < known for k in s.parameters):
            raise InputError(f"a stage refers to parameter {max(s.parameters)} of {known}")
    full = FullOrder(model, target.sensors, n_modes)
    objective = Objective(model.parameters, target, criteria, weights)
    begin = np.array(model.deck_point if start is None else start)
    before = objective.at(full, begin, stages[0].minimised)
    if before.correlation.pairs and not before.seen.pairs:
        raise InputError("none of the test modes that take part pairs with the model")
    if not before.correlation.pairs:
        raise InputError(
            "no test mode pairs with the model within the MAC limit "
            f"{criteria.mac_min:g} and the frequency tolerance "
            f"{criteria.frequency_tolerance:g}; loosen them or check the alignment"
        )
    history: list[Iteration] = []

    def note(stage: int, s: State) -> None:
        history.append(_entry(len(history), stage, s, len(target.frequencies_hz)))
        progress(history[-1])

    note(0, before)
    state, solves, stopped = before, 1, Stop(Reason.NO_STAGE, "no stage")
    near: Order | None = None
    before = _without_factor(before)
    for number, stage in enumerate(stages):
        state = replace(state, objective=objective.value(state.seen, stage.minimised))
        state, near, used, stopped = _work_off(
            objective, full, state, stage, tolerance, partial(note, number)
        )
        solves += used
    active = sorted({k for s in stages for k in s.parameters})
    if near is None or active != sorted(stages[-1].parameters):
        assert isinstance(state.solution, Eigensolution)
        near = reduce_around(full, state.factors, state.solution, active)
    last = stages[-1].minimised
    there = objective.at(near, state.factors, last)
    said = objective.identified(near, there, active, last)
    error, covariance = np.full(known, np.nan), np.full((known, known), np.nan)
    doubtful: tuple[str, ...] = ()
    if said is not None:
        error[active] = said.standard_error
        covariance[np.ix_(active, active)] = said.covariance
        names = [model.parameters[k].name for k in active]
        doubtful = tuple(doubts(names, np.asarray(state.factors)[active], said))
    determined = () if said is None else tuple(active[i] for i in said.determined)
    lower, upper = objective.bounds
    bounds = (np.isclose(state.factors, bound, rtol=UPDATING.at_bound) for bound in (lower, upper))
    moved = frozen(state.factors), frozen(error), frozen(np.any([*bounds], axis=0))
    told = (*doubtful, *_lost_pairs(before, state), *_unfinished(stopped, len(history) - 1))
    after = _without_factor(state)
    open_ = tuple(k for k in active if k not in determined)
    return Updated(
        *moved, before, after, tuple(history), solves, stopped, told, open_, doubtful, covariance
    )


def _work_off(
    objective: Objective,
    full: FullOrder,
    state: State,
    stage: Stage,
    tolerance: float,
    note: Callable[[State], None],
) -> tuple[State, Order | None, int, Stop]:
    """Work off a stage.

    Returned are where it ends, in full, the reduced model that was last used, how many full solves
    it took, and why it stopped.
    """
    solves, left = 0, stage.max_iterations
    near: Order | None = None
    while left:
        assert isinstance(state.solution, Eigensolution)
        near = reduce_around(full, state.factors, state.solution, stage.parameters)
        trail, stop = _walk(objective, near, state, stage, left, tolerance)
        if not trail:
            assert stop is not None
            return state, near, solves, stop
        arrived = objective.at(full, trail[-1].factors, stage.minimised)
        solves += 1
        if not objective.closer(arrived, state, stage.minimised):
            found, used = _descend(objective, full, state, stage)
            solves += used
            if found is None:
                return state, near, solves, _NO_STEP
            trail, stop, arrived = [found], None, found
        for s in trail[:-1]:
            if abs(s.objective - arrived.objective) > UPDATING.same * arrived.objective:
                note(s)
        note(arrived)
        left -= len(trail)
        state = arrived
        if stop and _agree(trail[-1], arrived, UPDATING.agree * tolerance):
            return state, near, solves, stop
    most = Stop(Reason.MOST_ITERATIONS, f"{stage.max_iterations} iterations")
    return state, near, solves, most


def _walk(
    objective: Objective, near: Order, start: State, stage: Stage, most: int, tolerance: float
) -> tuple[list[State], Stop | None]:
    """Iterate on a reduced model; return the states and why it ended, None if it should go on."""
    state = objective.at(near, start.factors, stage.minimised)
    trail: list[State] = []
    while len(trail) < most:
        trial, _ = _descend(objective, near, state, stage)
        if trial is None:
            return trail, _NO_STEP
        moved = float(np.max(np.abs(trial.factors / state.factors - 1.0)))
        state = trial
        trail.append(trial)
        if moved < tolerance:
            return trail, Stop(Reason.SETTLED, f"factors moved less than {tolerance:g}")
        if np.max(np.abs(np.log(state.factors / start.factors))) > np.log(UPDATING.reach):
            break
    return trail, None


def _descend(
    objective: Objective, order: Order, state: State, stage: Stage
) -> tuple[State | None, int]:
    """Take the step, halved until it is one; return where it leads and how many were tried."""
    lower, upper = objective.bounds
    step = objective.step(order, state, stage.parameters, stage.minimised)
    for halving in range(UPDATING.halvings):
        p = np.clip(state.factors + step / 2**halving, lower, upper)
        trial = objective.at(order, p, stage.minimised)
        if objective.closer(trial, state, stage.minimised):
            return trial, halving + 1
    return None, UPDATING.halvings


def _agree(reduced: State, full: State, tolerance: float) -> bool:
    """Whether both pair alike, with eigenvalues that are the same to a tolerance."""
    by_test = [{q.test: q.analysis_hz for q in s.correlation.pairs} for s in (reduced, full)]
    if by_test[0].keys() != by_test[1].keys():
        return False
    ratio = [(by_test[0][k] / by_test[1][k]) ** 2 - 1.0 for k in by_test[0]]
    return bool(np.max(np.abs(ratio), initial=0.0) < max(tolerance, UPDATING.agree_least))


def _without_factor(state: State) -> State:
    assert isinstance(state.solution, Eigensolution)
    return replace(state, solution=replace(state.solution, factor=None))


def _entry(iteration: int, stage: int, s: State, n_test: int) -> Iteration:
    deviations = np.full(n_test, np.nan)
    for q in s.correlation.pairs:
        deviations[q.test] = q.deviation_percent
    return Iteration(iteration, stage + 1, s.objective, s.factors, frozen(deviations))


def _lost_pairs(before: State, after: State) -> tuple[str, ...]:
    lost = sorted(
        {q.test + 1 for q in before.correlation.pairs}
        - {q.test + 1 for q in after.correlation.pairs}
    )
    if not lost:
        return ()
    modes = f"mode{'s' if len(lost) > 1 else ''} {', '.join(map(str, lost))}"
    return (f"test {modes} paired with the model as given, not with the updated one",)


def _unfinished(stopped: Stop, iterations: int) -> tuple[str, ...]:
    if stopped.reason is Reason.MOST_ITERATIONS:
        return (f"the update had not settled after {stopped}; allow more (max_iterations)",)
    if not iterations:
        return ("no step of the parameters brings the model closer to the test; nothing changed",)
    return ()
