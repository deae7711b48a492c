"""What an update minimises, equation (2) of the source paper, and its linearisation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.optimize import lsq_linear

from .arrays import Floats, Numbers, frozen
from .correlate import Correlation, Criteria, Pair, correlate
from .correlation import realised
from .orders import Order
from .parameter import Parameter
from .residuals import Residuals, Weights, eigenvalue_residuals, shape_residuals
from .sensitivity import Spectral

_UNIDENTIFIABLE = 1e-4
_UNSURE = 0.5
_LEAST_GAIN = 1e-3
_KEPT = 0.75
"""Share of the pairs that a step must keep to be judged by those alone."""


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
    frequency_std, shape_std : (n_test,) float, optional
        Standard errors of the test's frequencies, relative, and lengths of those of its shapes,
        over the shapes'; they add to the standard deviations of the weights.
    """

    frequencies_hz: Floats
    shapes: Numbers
    sensors: sp.csr_matrix
    modes: tuple[int, ...] | None = None
    frequency_std: Floats | None = None
    shape_std: Floats | None = None


@dataclass(frozen=True, eq=False)
class State:
    """The model at one parameter point, correlated."""

    factors: Floats
    solution: Spectral
    correlation: Correlation
    objective: float


@dataclass(frozen=True, eq=False)
class Objective:
    """ΔzᵀWΔz + pᵀW_p p of a test, with what is due for test modes that have no partner."""

    parameters: tuple[Parameter, ...]
    target: Target
    criteria: Criteria
    weights: Weights

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """Lowest and highest factors, each (n_parameter,)."""
        return (
            np.array([q.lower for q in self.parameters]),
            np.array([q.upper for q in self.parameters]),
        )

    def at(self, order: Order, p: Floats, residuals: str) -> State:
        """Solve and correlate at the factors `p`."""
        solution = order.solve(p)
        found = correlate(
            np.sqrt(np.maximum(solution.eigenvalues, 0.0)) / (2.0 * np.pi),
            np.asarray(order.sensors @ solution.vectors),
            self.target.frequencies_hz,
            self.target.shapes,
            self.criteria,
            solution.rigid_body_modes,
        )
        return State(frozen(p), solution, found, self.value(found, residuals))

    def used(self, c: Correlation) -> list[Pair]:
        """Pairs that count."""
        allowed = self.target.modes
        return [q for q in c.pairs if allowed is None or q.test in allowed]

    def value(self, c: Correlation, residuals: str) -> float:
        """Equation (2) without W_p, at a correlation."""
        count = len(self.target.frequencies_hz if self.target.modes is None else self.target.modes)
        return self._cost(self.used(c), count, residuals)

    def closer(self, trial: State, state: State, residuals: str) -> bool:
        """Whether a step is one: by all test modes, or by most of the pairs, which are kept.

        Where shapes alone count, a pair that is lost is what the step did.
        """
        if trial.objective < state.objective:
            return True
        if residuals == "shapes":
            return False
        old = {q.test: q for q in self.used(state.correlation)}
        new = {q.test: q for q in self.used(trial.correlation)}
        common = sorted(old.keys() & new.keys())
        if len(common) < _KEPT * len(old):
            return False
        cost = [self._cost([s[k] for k in common], len(common), residuals) for s in (new, old)]
        return cost[0] < (1.0 - _LEAST_GAIN) * cost[1]

    def step(self, order: Order, state: State, active: Sequence[int], residuals: str) -> Floats:
        """Return the bounded step of equations (3) and (4), (n_parameter,)."""
        lin = self.linearise(order, state, active, residuals)
        free = list(active)
        lower, upper = self.bounds
        prior = np.sqrt(
            self.weights.regularisation * np.array([self.parameters[k].weight for k in free])
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
        full = np.zeros(len(self.parameters))
        full[free] = step
        return full

    def linearise(
        self, order: Order, state: State, active: Sequence[int], residuals: str
    ) -> Residuals:
        """Return the weighted residuals of the pairs and their derivatives."""
        pairs = self.used(state.correlation)
        T = self._turned(state.correlation, pairs)
        with_shapes = residuals != "frequencies"
        values, slopes, shapes = order.sensitivities(state.factors, state.solution, T, active,
                                                     with_shapes)  # fmt: skip
        parts = []
        if residuals != "shapes":
            parts.append(eigenvalue_residuals(pairs, values, slopes, self.sigmas(pairs)[0]))
        if shapes is not None:
            test = self._test_shapes(state.correlation)[:, [q.test for q in pairs]]
            analysis = np.asarray(order.sensors @ (state.solution.vectors @ T))
            parts.append(shape_residuals(analysis, shapes, test, self.sigmas(pairs)[1]))
        return Residuals(
            np.concatenate([r.values for r in parts]), np.vstack([r.gradient for r in parts])
        )

    def standard_error(
        self, order: Order, state: State, active: Sequence[int], residuals: str
    ) -> tuple[Floats, tuple[str, ...]]:
        """Return the standard errors of the factors, NaN where the test says nothing, and that."""
        error = np.full(len(self.parameters), np.nan)
        if not self.used(state.correlation):
            return error, ()
        lin = self.linearise(order, state, active, residuals)
        _, s, vt = np.linalg.svd(lin.gradient, full_matrices=False)
        kinds = 2 if residuals == "both" else 1
        data = kinds * len(self.used(state.correlation))
        scatter = float(np.sum(lin.values**2)) / max(data - len(active), 1)
        sound = s > _UNIDENTIFIABLE * s[0] if s.size and s[0] > 0.0 else np.zeros(len(s), bool)
        said = vt[sound] ** 2 / s[sound, None] ** 2
        error[list(active)] = np.sqrt(np.sum(said, axis=0) * scatter)
        factors = np.asarray(state.factors)
        unsure = np.flatnonzero(error > _UNSURE * factors)
        lost = np.vstack([vt[~sound], np.zeros((0, len(active)))])
        names = [self.parameters[k].name for k in active]
        doubtful = []
        for direction in lost:
            part = [names[i] for i in np.flatnonzero(np.abs(direction) > 0.1)]
            error[[active[i] for i in np.flatnonzero(np.abs(direction) > 0.1)]] = np.nan
            doubtful.append(
                f"the test does not determine {' and '.join(part)}: "
                + ("a common change leaves" if len(part) > 1 else "a change leaves")
                + " every residual the same; fix one of them"
            )
        for k in unsure[np.isfinite(error[unsure])]:
            doubtful.append(
                f"the test hardly determines {self.parameters[k].name}: its factor "
                f"{factors[k]:.3g} has a standard error of {error[k]:.2g}"
            )
        return error, tuple(doubtful)

    def sigmas(self, pairs: Sequence[Pair]) -> tuple[Floats, Floats]:
        """Return standard deviations of the residuals of each pair: the weights' and the test's."""
        test = [q.test for q in pairs]
        w, t = self.weights, self.target
        none = np.zeros(len(self.target.frequencies_hz))
        return (
            np.hypot(w.frequency, (none if t.frequency_std is None else t.frequency_std)[test]),
            np.hypot(w.shape, (none if t.shape_std is None else t.shape_std)[test]),
        )

    def _cost(self, pairs: Sequence[Pair], count: int, residuals: str) -> float:
        """Equation (2) over pairs, with what is due for each of `count` that has none."""
        lam = np.array([(q.analysis_hz / q.test_hz) ** 2 - 1.0 for q in pairs])
        off = np.array([1.0 - q.mac for q in pairs])
        w, missing = self.weights, count - len(pairs)
        sigma_f, sigma_s = self.sigmas(pairs)
        frequency = np.sum((lam / (2.0 * sigma_f)) ** 2)
        frequency += missing * (self.criteria.frequency_tolerance / w.frequency) ** 2
        shape = np.sum(off / sigma_s**2) + missing * (1.0 - self.criteria.mac_min) / w.shape**2
        parts = {"frequencies": (frequency,), "shapes": (shape,), "both": (frequency, shape)}
        return float(sum(parts[residuals]))

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
