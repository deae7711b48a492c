"""Move parameters so that the analysis meets the test, equations (1)–(6) of the source paper."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.optimize import lsq_linear

from .arrays import Floats, Numbers, frozen
from .correlate import Correlation, Criteria, Pair, correlate
from .correlation import realised
from .eigen import Eigensolution, solve
from .errors import InputError
from .model import Model
from .residuals import KINDS, Residuals, Weights, eigenvalue_residuals, shape_residuals
from .sensitivity import sensitivities

_UNIDENTIFIABLE = 1e-4
_LEAST_GAIN = 1e-3
_KEPT = 0.75
"""Share of the pairs that a step must keep to be judged by those alone."""


@dataclass(frozen=True)
class Stage:
    """One step of a strategy: which parameters move on which residuals.

    Parameters
    ----------
    parameters : tuple of int
        Positions in ``Model.parameters``.
    residuals : {"frequencies", "shapes", "both"}
    max_iterations : int
    """

    parameters: tuple[int, ...]
    residuals: str = "both"
    max_iterations: int = 10

    def __post_init__(self) -> None:
        if self.residuals not in KINDS:
            raise InputError(f"residuals is '{self.residuals}'; give one of {', '.join(KINDS)}")
        if not self.parameters:
            raise InputError("a stage of the update names no parameter")


@dataclass(frozen=True, eq=False)
class Target:
    """The test at its sensors: what the update aims at.

    Parameters
    ----------
    frequencies_hz : (n_test,) float
    shapes : (n_sensor, n_test) float or complex
    sensors : (n_sensor, n_free) sparse
        Sensor displacements from the free degrees of freedom of the model.
    modes : tuple of int, optional
        Test modes that the update may use; default all.
    """

    frequencies_hz: Floats
    shapes: Numbers
    sensors: sp.csr_matrix
    modes: tuple[int, ...] | None = None


@dataclass(frozen=True, eq=False)
class Iteration:
    """One entry of the history; `deviations_percent` by test mode (NaN where unpaired)."""

    iteration: int
    stage: int
    objective: float
    factors: Floats
    deviations_percent: Floats


@dataclass(frozen=True, eq=False)
class State:
    """The model at one parameter point, correlated."""

    factors: Floats
    solution: Eigensolution
    correlation: Correlation
    objective: float


@dataclass(frozen=True, eq=False)
class Updated:
    """The outcome of an update.

    `standard_error` (n_parameter,) belongs to the factors (NaN where the data say nothing);
    `at_bound` (n_parameter,) bool; `stopped` says why the iteration ended.
    """

    factors: Floats
    standard_error: Floats
    at_bound: Numbers
    before: State
    after: State
    history: tuple[Iteration, ...]
    eigensolutions: int
    stopped: str
    warnings: tuple[str, ...]


def update(
    model: Model,
    target: Target,
    stages: Sequence[Stage],
    criteria: Criteria | None = None,
    weights: Weights | None = None,
    n_modes: int = 40,
    tolerance: float = 1e-3,
    progress: Callable[[Iteration], None] = lambda _: None,
) -> Updated:
    """Minimise ΔzᵀWΔz + pᵀW_p p over the parameters, equations (2)–(4).

    Each iteration pairs the modes anew (clusters are turned onto the test again), linearises
    the residuals and takes the bounded step of (GᵀWG + W_p)Δp = GᵀWΔz₀; a step that does not
    lower the objective is halved. A test mode without a partner costs what a pair at the limits
    of the criteria would, so gaining a pair is always a gain; losing a pair at the MAC limit
    does not stop a step that brings the other pairs closer.

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
    problem = _Problem(model, target, criteria, weights, n_modes)
    p = np.array(model.deck_point)
    state = before = problem.evaluate(p, stages[0].residuals)
    if not before.correlation.pairs:
        raise InputError(
            "no test mode pairs with the model within the MAC limit "
            f"{criteria.mac_min:g} and the frequency tolerance "
            f"{criteria.frequency_tolerance:g}; loosen them or check the alignment"
        )
    solves, stopped = 1, "no stage"
    history: list[Iteration] = []

    def note(stage: int, s: State) -> None:
        history.append(problem.entry(len(history), stage, s))
        progress(history[-1])

    note(0, state)
    for number, stage in enumerate(stages):
        state = replace(state, objective=problem.objective(state.correlation, stage.residuals))
        stopped = f"{stage.max_iterations} iterations"
        for _ in range(stage.max_iterations):
            step = problem.step(state, stage)
            trial, used = problem.descend(state, step, stage)
            solves += used
            if trial is None:
                stopped = "no step lowers the objective further"
                break
            moved = float(np.max(np.abs(trial.factors / state.factors - 1.0)))
            state = trial
            note(number, state)
            if moved < tolerance:
                stopped = f"factors moved less than {tolerance:g}"
                break
    active = sorted({k for s in stages for k in s.parameters})
    error, doubtful = problem.standard_error(state, active, stages[-1].residuals)
    warnings = (*doubtful, *_lost_pairs(before, state), *_unfinished(stopped, len(history) - 1))
    lower, upper = _bounds(model)
    at_bound = np.isclose(state.factors, lower, rtol=1e-6) | np.isclose(
        state.factors, upper, rtol=1e-6
    )
    return Updated(
        frozen(state.factors),
        frozen(error),
        frozen(at_bound),
        before,
        state,
        tuple(history),
        solves,
        stopped,
        warnings,
    )


def _lost_pairs(before: State, after: State) -> tuple[str, ...]:
    lost = sorted(
        {q.test + 1 for q in before.correlation.pairs}
        - {q.test + 1 for q in after.correlation.pairs}
    )
    if not lost:
        return ()
    modes = f"mode{'s' if len(lost) > 1 else ''} {', '.join(map(str, lost))}"
    return (f"test {modes} paired with the model as given, not with the updated one",)


def _unfinished(stopped: str, iterations: int) -> tuple[str, ...]:
    if stopped.endswith("iterations"):
        return (f"the update had not settled after {stopped}; allow more (max_iterations)",)
    if not iterations:
        return ("no step of the parameters brings the model closer to the test; nothing changed",)
    return ()


def _bounds(model: Model) -> tuple[Floats, Floats]:
    return (
        np.array([q.lower for q in model.parameters]),
        np.array([q.upper for q in model.parameters]),
    )


@dataclass(frozen=True, eq=False)
class _Problem:
    model: Model
    target: Target
    criteria: Criteria
    weights: Weights
    n_modes: int

    def evaluate(self, p: Floats, residuals: str) -> State:
        solution = solve(self.model, n_modes=self.n_modes, p=p)
        hz = np.sqrt(np.maximum(solution.eigenvalues, 0.0)) / (2.0 * np.pi)
        found = correlate(
            hz,
            np.asarray(self.target.sensors @ solution.vectors),
            self.target.frequencies_hz,
            self.target.shapes,
            self.criteria,
            solution.rigid_body_modes,
        )
        return State(frozen(p), solution, found, self.objective(found, residuals))

    def used(self, c: Correlation) -> list[Pair]:
        allowed = self.target.modes
        return [q for q in c.pairs if allowed is None or q.test in allowed]

    def objective(self, c: Correlation, residuals: str) -> float:
        count = len(self.target.frequencies_hz if self.target.modes is None else self.target.modes)
        return self._cost(self.used(c), count, residuals)

    def _cost(self, pairs: Sequence[Pair], count: int, residuals: str) -> float:
        """Equation (2) over pairs, with what is due for each of `count` that has none."""
        lam = np.array([(q.analysis_hz / q.test_hz) ** 2 - 1.0 for q in pairs])
        off = np.array([1.0 - q.mac for q in pairs])
        w, missing = self.weights, count - len(pairs)
        frequency = np.sum((lam / (2.0 * w.frequency)) ** 2)
        frequency += missing * (self.criteria.frequency_tolerance / w.frequency) ** 2
        shape = np.sum(off) / w.shape**2 + missing * (1.0 - self.criteria.mac_min) / w.shape**2
        parts = {"frequencies": (frequency,), "shapes": (shape,), "both": (frequency, shape)}
        return float(sum(parts[residuals]))

    def linearise(self, state: State, parameters: Sequence[int], residuals: str) -> Residuals:
        pairs = self.used(state.correlation)
        T = self._turned(state.correlation, pairs)
        values, slopes, shapes = sensitivities(
            self.model,
            state.factors,
            state.solution,
            T,
            tuple(parameters),
            self.target.sensors if residuals != "frequencies" else None,
        )
        parts = []
        if residuals != "shapes":
            parts.append(eigenvalue_residuals(pairs, values, slopes, self.weights.frequency))
        if residuals != "frequencies" and shapes is not None:
            test = self._test_shapes(state.correlation)[:, [q.test for q in pairs]]
            analysis = np.asarray(self.target.sensors @ (state.solution.vectors @ T))
            parts.append(shape_residuals(analysis, shapes, test, self.weights.shape))
        return Residuals(
            np.concatenate([r.values for r in parts]), np.vstack([r.gradient for r in parts])
        )

    def _test_shapes(self, c: Correlation) -> Floats:
        """Real test shapes as the pairs see them: turned where the test is the side to turn."""
        shapes = realised(self.target.shapes)
        if self.criteria.rotate != "test":
            return shapes
        size = np.maximum(np.linalg.norm(shapes, axis=0), np.finfo(float).tiny)
        return np.asarray((shapes / size) @ c.transformation)

    def _turned(self, c: Correlation, pairs: Sequence[Pair]) -> Floats:
        n = c.mac.shape[1]
        T = c.transformation if self.criteria.rotate == "analysis" else np.eye(n)
        return np.asarray(T[:, [q.analysis for q in pairs]])

    def step(self, state: State, stage: Stage) -> Floats:
        lin = self.linearise(state, stage.parameters, stage.residuals)
        free = list(stage.parameters)
        lower, upper = _bounds(self.model)
        prior = np.sqrt(
            self.weights.regularisation * np.array([self.model.parameters[k].weight for k in free])
        )
        p = np.asarray(state.factors)[free]
        step = lsq_linear(
            np.vstack([lin.gradient, np.diag(prior)]),
            np.concatenate([-lin.values, np.zeros(len(free))]),
            bounds=(
                np.maximum(lower[free] - p, -0.5 * p) - 1e-12,
                np.minimum(upper[free] - p, p) + 1e-12,
            ),
        ).x
        full = np.zeros(len(self.model.parameters))
        full[free] = step
        return full

    def descend(self, state: State, step: Floats, stage: Stage) -> tuple[State | None, int]:
        lower, upper = _bounds(self.model)
        for halving in range(5):
            p = np.clip(state.factors + step / 2**halving, lower, upper)
            trial = self.evaluate(p, stage.residuals)
            if trial.objective < state.objective or self._closer(trial, state, stage.residuals):
                return trial, halving + 1
        return None, 5

    def _closer(self, trial: State, state: State, residuals: str) -> bool:
        """Whether most of the pairs are still pairs, and together closer than before."""
        old = {q.test: q for q in self.used(state.correlation)}
        new = {q.test: q for q in self.used(trial.correlation)}
        common = sorted(old.keys() & new.keys())
        if len(common) < _KEPT * len(old):
            return False
        cost = [self._cost([s[k] for k in common], len(common), residuals) for s in (new, old)]
        return cost[0] < (1.0 - _LEAST_GAIN) * cost[1]

    def standard_error(
        self, state: State, active: Sequence[int], residuals: str
    ) -> tuple[Floats, tuple[str, ...]]:
        error = np.full(len(self.model.parameters), np.nan)
        if not self.used(state.correlation):
            return error, ()
        lin = self.linearise(state, active, residuals)
        _, s, vt = np.linalg.svd(lin.gradient, full_matrices=False)
        kinds = 2 if residuals == "both" else 1
        data = kinds * len(self.used(state.correlation))
        scatter = float(np.sum(lin.values**2)) / max(data - len(active), 1)
        sound = s > _UNIDENTIFIABLE * s[0] if s.size and s[0] > 0.0 else np.zeros(len(s), bool)
        said = vt[sound] ** 2 / s[sound, None] ** 2
        error[list(active)] = np.sqrt(np.sum(said, axis=0) * scatter)
        lost = np.vstack([vt[~sound], np.zeros((0, len(active)))])
        names = [self.model.parameters[k].name for k in active]
        doubtful = []
        for direction in lost:
            part = [names[i] for i in np.flatnonzero(np.abs(direction) > 0.1)]
            error[[active[i] for i in np.flatnonzero(np.abs(direction) > 0.1)]] = np.nan
            doubtful.append(
                f"the test does not determine {' and '.join(part)}: "
                + ("a common change leaves" if len(part) > 1 else "a change leaves")
                + " every residual the same; fix one of them"
            )
        return error, tuple(doubtful)

    def entry(self, iteration: int, stage: int, s: State) -> Iteration:
        deviations = np.full(len(self.target.frequencies_hz), np.nan)
        for q in s.correlation.pairs:
            deviations[q.test] = q.deviation_percent
        return Iteration(iteration, stage, s.objective, s.factors, frozen(deviations))
