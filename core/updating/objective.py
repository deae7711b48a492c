"""What an update minimises, equation (2) of the source paper, and its linearisation."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, frozen
from ..correlation.criteria import Criteria
from ..correlation.mac import realised
from ..correlation.mode_pairing import Correlation, correlate
from ..reduction.damped_poles import Damped
from ..reduction.eigenpair_derivatives import Spectral
from ..reduction.full_or_reduced import Order
from .residuals import DampedPairs, Linearisation, Residual, Seen, Slopes, Target, Weights


@dataclass(frozen=True, eq=False)
class State:
    """The model at one parameter point, correlated; `seen` holds the pairs that count."""

    factors: Floats
    solution: Spectral
    correlation: Correlation
    seen: Seen
    objective: float


@dataclass(frozen=True, eq=False)
class Objective:
    """ΔzᵀWΔz of a test, with what is due for test modes that have no partner."""

    target: Target
    criteria: Criteria
    weights: Weights

    def at(self, order: Order, p: Floats, residuals: Sequence[Residual]) -> State:
        """Solve and correlate at the factors `p`."""
        solution = order.solve(p)
        shapes = np.asarray(order.sensors @ solution.vectors)
        found = correlate(
            np.sqrt(np.maximum(solution.eigenvalues, 0.0)) / (2.0 * np.pi),
            shapes,
            self.target.frequencies_hz,
            self.target.shapes,
            self.criteria,
            solution.rigid_body_modes,
        )
        allowed = self.target.modes
        pairs = tuple(q for q in found.pairs if allowed is None or q.test in allowed)
        T = self._turned(found, [q.analysis for q in pairs])
        test = self._test_shapes(found)[:, [q.test for q in pairs]]
        quotients = solution.eigenvalues @ T**2 / np.sum(T**2, axis=0)
        ratios, taken = self.target.damping, [q.test for q in pairs]
        damped = DampedPairs(
            Damped(order, frozen(p), solution),
            T,
            None if ratios is None else ratios[taken],
            self.target.responses,
        )
        seen = Seen(
            order.model,
            frozen(p),
            pairs,
            quotients,
            shapes @ T,
            test,
            self.target.beside,
            damped,
        )
        return State(seen.factors, solution, found, seen, self.value(seen, residuals))

    def value(self, seen: Seen, residuals: Sequence[Residual]) -> float:
        """Equation (2) without W_p."""
        every = range(len(self.target.frequencies_hz))
        due = set(self.target.modes or every) - {q.test for q in seen.pairs}
        return self._cost(seen, float(self.weights.of(due).sum()), residuals)

    def kept(
        self, trial: State, state: State, residuals: Sequence[Residual]
    ) -> tuple[int, int, float, float]:
        """Return how many pairs both have, how many the second, and what those of both cost."""
        old = {q.test: k for k, q in enumerate(state.seen.pairs)}
        new = {q.test: k for k, q in enumerate(trial.seen.pairs)}
        common = sorted(old.keys() & new.keys())
        now, then = (
            self._cost(s.seen.take([at[k] for k in common]), 0.0, residuals)
            for s, at in ((trial, new), (state, old))
        )
        return len(common), len(old), now, then

    def linearise(
        self, order: Order, state: State, active: Sequence[int], residuals: Sequence[Residual]
    ) -> Linearisation:
        """Return the weighted residuals of the pairs and their derivatives, of all kinds in one."""
        return stacked(self.linearised(order, state, active, residuals))

    def linearised(
        self, order: Order, state: State, active: Sequence[int], residuals: Sequence[Residual]
    ) -> list[Linearisation]:
        """Return the same of each kind."""
        T = self._turned(state.correlation, [q.analysis for q in state.seen.pairs])
        found = order.sensitivities(
            state.factors, state.solution, T, active, any(r.needs_shapes for r in residuals)
        )
        slopes = Slopes(tuple(active), found.slopes, found.shapes)
        return [r.linearised(state.seen, slopes, self.sigma(r, state.seen)) for r in residuals]

    def sigma(self, residual: Residual, seen: Seen) -> Floats | float:
        """Return the standard deviation of a residual, of each pair where the test has its own."""
        stated, modes = self.weights.sigma(residual), [q.test for q in seen.pairs]
        if residual.error is None:
            return stated
        own = residual.error(self.target)
        whole = stated if own is None else np.hypot(stated, own[modes])
        return np.asarray(whole / np.sqrt(self.weights.of(modes)))

    def _cost(self, seen: Seen, missing: float, residuals: Sequence[Residual]) -> float:
        """Equation (2) over pairs, with what is due for `missing` modes that have none."""
        total = 0.0
        for r in residuals:
            total += float(np.sum(r.squared(seen) / self.sigma(r, seen) ** 2))
            total += missing * r.unpaired(self.criteria) / self.weights.sigma(r) ** 2
        return total

    def _test_shapes(self, c: Correlation) -> Floats:
        """Real test shapes as the pairs see them: turned where the test is the side to turn."""
        shapes = realised(self.target.shapes)
        if self.criteria.rotate != "test":
            return shapes
        size = np.maximum(np.linalg.norm(shapes, axis=0), np.finfo(float).tiny)
        return np.asarray((shapes / size) @ c.transformation)

    def _turned(self, c: Correlation, modes: list[int]) -> Floats:
        T = c.transformation if self.criteria.rotate == "analysis" else np.eye(c.mac.shape[1])
        return np.asarray(T[:, modes])


def stacked(parts: Sequence[Linearisation]) -> Linearisation:
    """Return residuals one below the other."""
    return Linearisation(
        np.concatenate([r.values for r in parts]), np.vstack([r.gradient for r in parts])
    )
