"""Configurations of one structure as one problem: every test, one set of parameters."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
from scipy.optimize import lsq_linear

from ..arrays import Floats, Ints, frozen
from ..correlation.criteria import Criteria
from ..correlation.mode_pairing import Correlation
from ..data.parameter import Parameter
from ..data.parametric_model import Model
from ..eigen.normal_modes import Eigensolution
from ..errors import InputError
from ..noun import Noun
from ..reduction.full_or_reduced import FullOrder, Order, ReducedOrder, reduce_around
from .identifiability import Identifiability, identifiability, unsure
from .objective import Objective, State, stacked
from .residuals import Linearisation, Residual, Target, Weights
from .scatter import Kind, Scatter, left_over, scatter_of
from .updating_numbers import UPDATING

Orders = Sequence[Order]
"""Every configuration, in full or reduced."""


@dataclass(frozen=True, eq=False)
class Configuration(Noun):
    """A structure in one state, and its test: with or without an attachment, filled or empty.

    Parameters
    ----------
    model : Model
        Parameters are those of other configurations that have the same names.
    target : Target
    criteria : Criteria
    weights : Weights
        Those of the test; the regularisation of the first configuration counts.
    n_modes : int
        Analysis modes per eigensolution.
    name : str
        For messages; empty where there is one configuration.
    """

    model: Model
    target: Target
    criteria: Criteria = field(default_factory=Criteria)
    weights: Weights = field(default_factory=Weights)
    n_modes: int = UPDATING.modes
    name: str = ""


@dataclass(frozen=True, eq=False)
class Point:
    """All configurations at one parameter point; the objective is the sum of theirs."""

    factors: Floats
    states: tuple[State, ...]
    objective: float

    @property
    def solution(self) -> Eigensolution:
        """Of the first configuration, where it was solved in full."""
        found = self.states[0].solution
        assert isinstance(found, Eigensolution)
        return found

    @property
    def correlation(self) -> Correlation:
        """Of the first configuration."""
        return self.states[0].correlation

    def of(self, k: int) -> Self:
        """Return one configuration alone."""
        s = self.states[k]
        return replace(self, factors=s.factors, states=(s,), objective=s.objective)

    def without_factors(self) -> Self:
        """Return the same without the factorised matrices of full solutions."""
        return replace(self, states=tuple(map(_without_factor, self.states)))


@dataclass(frozen=True, eq=False)
class Part:
    """A configuration with its place in the problem: `own` (n_own,) are its parameters there."""

    name: str
    objective: Objective
    full: FullOrder
    own: Ints

    def moving(self, active: Sequence[int]) -> tuple[list[int], list[int]]:
        """Return which of its own parameters are active, and their positions among those."""
        at = {int(k): n for n, k in enumerate(self.own)}
        both = [(at[k], column) for column, k in enumerate(active) if k in at]
        return [n for n, _ in both], [column for _, column in both]


@dataclass(frozen=True, eq=False)
class Problem:
    """Equation (2) summed over configurations, and its linearisation stacked."""

    parameters: tuple[Parameter, ...]
    parts: tuple[Part, ...]

    @classmethod
    def of(cls, configurations: Sequence[Configuration]) -> Self:
        """Bring configurations together by the names of their parameters.

        What a parameter's prior costs is shared among the configurations that have it.

        Raises
        ------
        InputError
            A parameter that two configurations know by different values.
        """
        known: dict[str, Parameter] = {}
        where: dict[str, str] = {}
        for c in configurations:
            for q in c.model.parameters:
                _require_same(known.setdefault(q.name, q), q, where.setdefault(q.name, c.name), c)
        shared = Counter(q.name for c in configurations for q in c.model.parameters)
        at = {name: k for k, name in enumerate(known)}
        parts = []
        for c in configurations:
            own = c.model.parameters
            split = tuple(replace(q, weight=q.weight / shared[q.name]) for q in own)
            model = replace(c.model, parameters=split)
            parts.append(
                Part(
                    c.name,
                    Objective(c.target, c.criteria, c.weights),
                    FullOrder(model, c.target.sensors, c.n_modes, c.target.forces),
                    np.array([at[q.name] for q in own], np.int64),
                )
            )
        return cls(tuple(known.values()), tuple(parts))

    @property
    def deck_point(self) -> Floats:
        """The parameter values of the decks as they are: ones, (n_parameter,)."""
        return frozen(np.ones(len(self.parameters)))

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """Lowest and highest factors, each (n_parameter,)."""
        return (
            np.array([q.lower for q in self.parameters]),
            np.array([q.upper for q in self.parameters]),
        )

    @property
    def full(self) -> Orders:
        """Every configuration in full."""
        return [part.full for part in self.parts]

    def around(
        self, point: Point, active: Sequence[int], sketch: int | None = None
    ) -> list[ReducedOrder]:
        """Reduce every configuration around a point where it was solved in full."""
        return [
            reduce_around(part.full, s.factors, _in_full(s), part.moving(active)[0], sketch)
            for part, s in zip(self.parts, point.states, strict=True)
        ]

    def widened(self, orders: Sequence[ReducedOrder], point: Point) -> list[ReducedOrder]:
        """Take the modes of a point where every configuration was solved in full into the bases."""
        return [
            order.with_modes(part.full, _in_full(s))
            for part, order, s in zip(self.parts, orders, point.states, strict=True)
        ]

    def corrected(self, orders: Sequence[ReducedOrder], p: Floats) -> list[ReducedOrder]:
        """Take what the modes at the factors `p` lack into the bases."""
        return [
            order.corrected(part.full, p[part.own])
            for part, order in zip(self.parts, orders, strict=True)
        ]

    def nearly(self, orders: Sequence[ReducedOrder], p: Floats) -> Orders:
        """Return every configuration in full, its modes at the factors `p` nearly known."""
        return [
            replace(part.full, near=order.near(p[part.own]))
            for part, order in zip(self.parts, orders, strict=True)
        ]

    def at(self, orders: Orders, p: Floats, residuals: Sequence[Residual]) -> Point:
        """Solve and correlate at the factors `p` (n_parameter,)."""
        states = tuple(
            part.objective.at(order, p[part.own], residuals)
            for part, order in zip(self.parts, orders, strict=True)
        )
        return Point(frozen(p), states, sum(s.objective for s in states))

    def valued(self, point: Point, residuals: Sequence[Residual]) -> Point:
        """Return a point as other residuals see it."""
        states = tuple(
            replace(s, objective=part.objective.value(s.seen, residuals))
            for part, s in zip(self.parts, point.states, strict=True)
        )
        return replace(point, states=states, objective=sum(s.objective for s in states))

    def require_pairs(self, point: Point) -> None:
        """Refuse a configuration of which nothing pairs.

        Raises
        ------
        InputError
            Which, and what to do.
        """
        for part, s in zip(self.parts, point.states, strict=True):
            where = f"configuration '{part.name}': " * bool(part.name)
            if s.correlation.pairs and not s.seen.pairs:
                raise InputError(
                    f"{where}none of the test modes that take part pairs with the model"
                )
            if not s.correlation.pairs:
                criteria = part.objective.criteria
                raise InputError(
                    f"{where}no test mode pairs with the model within the MAC limit "
                    f"{criteria.mac_min:g} and the frequency tolerance "
                    f"{criteria.frequency_tolerance:g}; loosen them or check the alignment"
                )

    def closer(self, trial: Point, point: Point, residuals: Sequence[Residual]) -> bool:
        """Whether a step is one: by all test modes, or by most of the pairs, which are kept.

        Where nothing counts but what pairs are told by, a pair that is lost is what the step did.
        """
        if trial.objective < point.objective:
            return True
        if all(r.tells_pairs for r in residuals):
            return False
        of = zip(self.parts, trial.states, point.states, strict=True)
        kept = np.array([part.objective.kept(new, old, residuals) for part, new, old in of])
        common, before, now, then = kept.sum(axis=0)
        if common < UPDATING.kept * before:
            return False
        return bool(now < (1.0 - UPDATING.least_gain) * then)

    def step(
        self, orders: Orders, point: Point, active: Sequence[int], residuals: Sequence[Residual]
    ) -> Floats:
        """Return the bounded step of equations (3) and (4), (n_parameter,).

        Beside W_p a step is damped by what residuals scatter (Levenberg 1944, Quarterly of Applied
        Mathematics 2, 164), as if each factor were known roughly to stay where it is: what the
        tests determine moves as it would, what they do not hardly moves, and where residuals
        vanish nothing holds it. With a prior that is what holds it.
        """
        lin = self.linearise(orders, point, active, residuals)
        free = list(active)
        lower, upper = self.bounds
        weight = np.array([self.parameters[k].weight for k in free])
        prior = np.sqrt(self.parts[0].objective.weights.regularisation * weight)
        prior = np.hypot(prior, UPDATING.unseen * np.linalg.norm(lin.gradient))
        p = np.asarray(point.factors)[free]
        if not any(r.believes_sigmas for r in residuals):
            data = sum(r.data(s.seen) for r in residuals for s in point.states)
            left = left_over(lin.values, lin.gradient, data)
            prior = np.hypot(prior, np.sqrt(left) / (UPDATING.damped * p))
        down, up = UPDATING.step
        least = np.maximum(lower[free] - p, -down * p) - UPDATING.slack
        most = np.minimum(upper[free] - p, up * p) + UPDATING.slack
        G = np.vstack([lin.gradient, np.diag(prior)])
        full = np.zeros(len(self.parameters))
        due = np.concatenate([-lin.values, np.zeros(len(free))])
        full[free] = lsq_linear(G, due, bounds=(least, most)).x
        return full

    def linearise(
        self, orders: Orders, point: Point, active: Sequence[int], residuals: Sequence[Residual]
    ) -> Linearisation:
        """Return the weighted residuals of all configurations and their derivatives, stacked."""
        return stacked(self._linearised(orders, point, active, residuals))

    def _linearised(
        self, orders: Orders, point: Point, active: Sequence[int], residuals: Sequence[Residual]
    ) -> list[Linearisation]:
        """Return the same of each kind."""
        kinds: list[list[Linearisation]] = [[] for _ in residuals]
        for part, order, s in zip(self.parts, orders, point.states, strict=True):
            own, columns = part.moving(active)
            every = part.objective.linearised(order, s, own, residuals)
            for kind, lin in zip(kinds, every, strict=True):
                gradient = np.zeros((len(lin.values), len(active)))
                gradient[:, columns] = lin.gradient
                kind.append(Linearisation(lin.values, gradient))
        return [stacked(kind) for kind in kinds]

    def identified(
        self, orders: Orders, point: Point, active: Sequence[int], residuals: Sequence[Residual]
    ) -> Identifiability | None:
        """Return what the tests say of the `active` parameters here; None where nothing pairs."""
        if not any(s.seen.pairs for s in point.states):
            return None
        scatter = self.scatter(orders, point, active, residuals)
        factors = np.asarray(point.factors)[list(active)]
        return identifiability(scatter.gradient, scatter.variance, unsure(factors))

    def scatter(
        self, orders: Orders, point: Point, active: Sequence[int], residuals: Sequence[Residual]
    ) -> Scatter:
        """Return how far residuals scatter beside `active` parameters: by what is left of them.

        With a prior their standard deviations are believed.
        """
        every = self._linearised(orders, point, active, residuals)
        kinds = [
            Kind(lin.values, lin.gradient, sum(r.data(s.seen) for s in point.states), r.stated)
            for r, lin in zip(residuals, every, strict=True)
        ]
        return scatter_of(kinds, any(r.believes_sigmas for r in residuals))

    @property
    def tests(self) -> tuple[int, ...]:
        """Number of test modes of each configuration."""
        return tuple(len(part.objective.target.frequencies_hz) for part in self.parts)

    def deviations(self, point: Point) -> Floats:
        """Return the deviation of each test mode, %, one configuration after the other."""
        return frozen(np.concatenate([*self._deviations(point)]))

    def _deviations(self, point: Point) -> Iterator[Floats]:
        for count, s in zip(self.tests, point.states, strict=True):
            off = np.full(count, np.nan)
            for q in s.correlation.pairs:
                off[q.test] = q.deviation_percent
            yield off

    def lost(self, before: Point, after: Point) -> tuple[str, ...]:
        """Say which test modes paired before and do not after."""
        told = []
        for part, old, new in zip(self.parts, before.states, after.states, strict=True):
            of, left = ({q.test + 1 for q in s.correlation.pairs} for s in (old, new))
            if lost := sorted(of - left):
                modes = f"mode{'s' if len(lost) > 1 else ''} {', '.join(map(str, lost))}"
                whose = f" of '{part.name}'" if part.name else ""
                told.append(
                    f"test {modes}{whose} paired with the model as given, not with the updated one"
                )
        return tuple(told)

    def farther(
        self, before: Point, after: Point, residuals: Sequence[Residual]
    ) -> tuple[str, ...]:
        """Say where pairs were lost step by step so that the end is no closer than the start."""
        begin, end = (self.valued(p, residuals) for p in (before, after))
        if not self.lost(before, after) or self.closer(end, begin, residuals):
            return ()
        return (
            "the updated model is farther from the test than the given one, for the pairs it "
            "lost on the way; move fewer parameters, or those the model is most wrong in first",
        )


def _without_factor(state: State) -> State:
    found, damped = _in_full(state), state.seen.damped
    bare = replace(found, factor=None, count_factor=None, kept=None)
    if damped is not None:
        damped = replace(damped, model=replace(damped.model, solution=bare))
    return replace(state, solution=bare, seen=replace(state.seen, damped=damped))


def _in_full(state: State) -> Eigensolution:
    assert isinstance(state.solution, Eigensolution)
    return state.solution


def _require_same(known: Parameter, other: Parameter, first: str, c: Configuration) -> None:
    """Refuse a parameter whose values are others than in the configuration that had it first."""
    values = dict(zip(known.handle, known.deck_values, strict=True))
    for handle, value in zip(other.handle, other.deck_values, strict=True):
        before = values.get(handle, value)
        if not np.isclose(before, value, rtol=UPDATING.same_value, atol=0.0):
            raise InputError(
                f"parameter '{known.name}': {handle} is {before:g} in configuration '{first}' and "
                f"{value:g} in '{c.name}'; one parameter moves one property: make the values "
                "equal, or name a parameter of each configuration"
            )
