"""From evidence to verdict."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from ..arrays import Bools, Floats
from ..correlation import realised
from ..errors import TrueupError
from .basis import Basis, build_basis
from .beam import Found
from .bench import Bench
from .candidates import Candidates
from .compliance import Compliance, Flexibility, SharedFlexibility
from .evidence import Evidence, noise_of
from .findings import Discovery
from .fitting import evaluate, fit
from .hearing import hearing, with_responses
from .judge import (
    Judgement,
    contenders,
    cost,
    held_out,
    judge,
    noise_scale,
    with_rival,
)
from .kinds import KINDS
from .kinds.scale import Scale
from .laws import ReleaseLaw
from .merging import merged
from .mesh_error import lumping, with_consistent_bars
from .paths import searched
from .polish import polished
from .problem import Fit, Prior, Problem
from .request import Request as Request
from .search import Searcher
from .shaping import reshaped
from .structure import thinned
from .telling import told
from .telling_dampers import with_damper
from .weighing_dampers import weighed

_MESH = (1.0, -1.0, 1.05)
"""Spread and bounds of the error of the mesh, see `mesh_error`."""
_RITZ = 110
_BAND, _MORE = 1.15, 4
"""How far above the test's band a mode may lie and match, and so many modes more."""
_CONTESTED, _RIVALS = 30.0, 2
"""Rivals less than this (twice the log of a likelihood ratio) behind, and so many of them, are
fitted as carefully as the best."""
_ALONG_AXES = {"ground_spring", "tuned_absorber"}
"""Kinds with one direction at a point, looked at only where something moves that way."""


def discover(request: Request, progress: Callable[[str], None] = lambda _: None) -> Discovery:
    """Find what the model lacks or what is wrong in the test.

    Sensors are checked against each other first; then known parameters and missing effects of
    every kind and place compete for the rest of the misfit. A part of the modes and sensors is
    kept out of the search.

    Parameters
    ----------
    request : Request
    progress : callable
        Told what happens, a few words at a time.
    """
    progress("checking the sensors against each other")
    bench = Bench(request.placed, request.structure.model)
    solution, n = request.solution, len(bench.survey.node)
    hz = bench.survey.frequencies_hz
    modes_out = held_out(len(hz), 4, 6) if len(hz) >= 10 else np.zeros(len(hz), bool)
    sensors_out = held_out(n, 5, 10) if n >= 30 else np.zeros(n, bool)
    motion = np.asarray(request.structure.model.expansion @ solution.vectors)
    first = bench.judged(motion, solution.eigenvalues)
    progress("making the catalogue of effects")
    ground = _ground(request, ~modes_out)
    progress("fitting the known parameters")
    trial = _Trial(request, ground, first.doubtful, first.noise, modes_out, sensors_out)
    tested = bench.judged_by(trial.problem, trial.null)
    if np.any(tested.doubtful != first.doubtful):
        trial = _Trial(request, ground, tested.doubtful, tested.noise, modes_out, sensors_out)
    searcher, found, verdict = _searched(trial, progress)
    if verdict.accepted:
        last = bench.judged_by(searcher.problem, _best(searcher, found, verdict))
        if np.any(last.accused & ~trial.aside):
            progress("searching again without sensors that the completed model accuses")
            aside = trial.aside | last.doubtful
            trial = _Trial(request, ground, aside, last.noise, modes_out, sensors_out)
            searcher, found, verdict = _searched(trial, progress)
            last = bench.judged_by(searcher.problem, _best(searcher, found, verdict))
        tested = last
    out = modes_out, sensors_out
    said = told(request, searcher, found, verdict, trial.zero, tested, out)
    progress("weighing dashpots by the measured damping")
    best = _best(searcher, found, verdict)
    said = with_damper(request, weighed(trial.request, searcher.problem, best), said)
    return with_responses(searcher.problem, found.levels[0].log_p, best, said)


class _Trial:
    """A search without the sensors that are set aside."""

    def __init__(
        self,
        request: Request,
        ground: _Ground,
        aside: Bools,
        noise: float,
        modes_out: Bools,
        sensors_out: Bools,
    ) -> None:
        self.ground, self.aside = ground, aside
        self.request = replace(request, placed=request.placed.take(~aside))
        self.sensors = ~sensors_out[~aside]
        self.problem, self.null, self.zero = _prepared(
            self.request, ground, noise, ~modes_out, self.sensors
        )


def _best(searcher: Searcher, found: Found, verdict: Judgement) -> Fit:
    best = found.levels[verdict.accepted]
    return evaluate(searcher.problem, best.log_p, best.suspects)


def _searched(trial: _Trial, progress: Callable[[str], None]) -> tuple[Searcher, Found, Judgement]:
    """Search on sensors taken as sound, and weigh."""
    request, problem, sensors = trial.request, trial.problem, trial.sensors
    made = trial.ground.catalogue
    searcher = _searcher(trial)
    if request.responses is not None:
        searcher = replace(searcher, problem=hearing(request, searcher.problem, trial.null.log_p))
    found = searched(searcher, progress)
    searcher, found = _reshaped(searcher, found)
    made = list(searcher.problem.catalogue)
    progress("weighing the best hypotheses on bases of their own")
    found, verdict = _weighed(request, searcher, made, found, sensors)
    best = found.levels[verdict.accepted]
    one = merged(searcher, best)
    if one is not best:
        with suppress(TrueupError):
            as_many = found.levels[len(one.suspects)]
            one = min(
                (_polished(request, searcher, made, f, sensors) for f in (one, as_many)),
                key=lambda f: f.objective,
            )
            levels = (*found.levels[: verdict.accepted], one)
            scale = max(verdict.scale, noise_scale(problem, one))
            found, verdict = replace(found, levels=levels), replace(verdict, scale=scale)
    return searcher, found, verdict


def _hz(eigenvalues: Floats) -> Floats:
    return np.asarray(np.sqrt(np.maximum(eigenvalues, 0.0)) / (2.0 * np.pi))


@dataclass(frozen=True, eq=False)
class _Ground:
    """What does not depend on the sensors.

    The basis, the error of the mesh on it, how many modes may match, what loads do to the deck as
    it is, and every effect that may be missing.
    """

    basis: Basis
    mesh: Floats
    columns: int
    compliance: Compliance
    catalogue: list[Candidates]


def _ground(request: Request, modes: Bools) -> _Ground:
    top = float(request.placed.test.frequencies_hz.max())
    targets = _below(request.solution.eigenvalues, top)
    basis = build_basis(request.structure.model, request.solution, targets)
    basis = with_consistent_bars(request.structure, basis)
    return _Ground(
        basis,
        lumping(request.structure, basis.vectors),
        targets + _MORE,
        Compliance(request.structure.model, request.solution),
        _catalogue(request, request.placed.test.frequencies_hz[modes]),
    )


def _below(eigenvalues: Floats, top: float) -> int:
    """Return the number of modes that may match one up to `top` [Hz]."""
    return int(np.count_nonzero(_hz(eigenvalues) < _BAND * top))


def _prepared(
    request: Request, ground: _Ground, noise: float, modes: Any, sensors: Any
) -> tuple[Problem, Fit, Fit]:
    """Return the problem without suspects, its best fit, and the fit with nothing moved."""
    model, hz = request.structure.model, request.placed.test.frequencies_hz
    placed = request.placed
    shapes = np.asarray(placed.weighted(realised(placed.test.shapes)))
    unit = shapes / np.maximum(np.linalg.norm(shapes, axis=0), np.finfo(float).tiny)
    whole = Evidence(hz, unit, noise_of(placed.errors, noise))
    e = whole.take(modes, sensors)
    basis = ground.basis
    observed = np.asarray(placed.weighted(placed.observation.matrix @ basis.motion))
    prior = Prior(
        np.append(request.spread, _MESH[0]),
        np.append(np.log([q.lower for q in model.parameters]), _MESH[1]),
        np.append(np.log([q.upper for q in model.parameters]), _MESH[2]),
    )
    problem = Problem(
        e,
        whole,
        basis,
        observed[sensors],
        observed,
        ground.mesh,
        (),
        (),
        prior,
        min(basis.size, _RITZ),
        ground.columns,
    )
    n = len(prior.spread)
    zero = fit(problem, np.zeros(n), (), (n - 1,), 10)
    null = fit(problem, np.zeros(n), (), tuple(range(n)), 30)
    columns = _below(null.eigenvalues, float(hz.max())) + _MORE
    return replace(problem, columns=columns), null, zero


def _catalogue(request: Request, hz: Floats) -> list[Candidates]:
    """Return every kind of effect at every place."""
    scale = Scale(
        request.mass,
        request.structure.model.geometry.size,
        float((2.0 * np.pi * np.median(hz)) ** 2),
        (float(hz.min()), float(hz.max())),
    )
    return [c for make in KINDS.values() for c in make(request.structure, scale)]


def _reshaped(searcher: Searcher, found: Found) -> tuple[Searcher, Found]:
    """Give the patches of the hypotheses that earned their place better shapes."""
    verdict = judge(searcher, found)
    levels = list(found.levels)
    for k in range(1, verdict.accepted + 1):
        searcher, levels[k] = reshaped(searcher, levels[k], verdict.scale)
    return searcher, Found(tuple(levels), found.rivals)


def _weighed(
    request: Request, searcher: Searcher, made: list[Candidates], found: Found, sensors: Any
) -> tuple[Found, Judgement]:
    """Fit the chosen hypothesis and the one with a suspect less on their own bases, judge again.

    A hypothesis whose completed model does not solve (a release larger than what is there) stays
    as the search left it.
    """
    levels = list(found.levels)
    done: set[int] = set()
    verdict = judge(searcher, found)
    while wanted := {verdict.accepted, max(verdict.accepted - 1, 0)} - done:
        for k in wanted:
            with suppress(TrueupError):
                levels[k] = _polished(request, searcher, made, levels[k], sensors)
            done.add(k)
        kept = Found(tuple(levels[: verdict.accepted + 1]), found.rivals[: verdict.accepted + 1])
        verdict, found = judge(searcher, kept), kept
    return _contested(request, searcher, made, found, verdict, sensors)


def _contested(
    request: Request,
    searcher: Searcher,
    made: list[Candidates],
    found: Found,
    verdict: Judgement,
    sensors: Any,
) -> tuple[Found, Judgement]:
    """Fit the nearest rivals on bases of their own too, and let the best of all win."""
    best = cost(searcher, found.levels[verdict.accepted], verdict.scale)

    def behind(f: Fit) -> float:
        return cost(searcher, f, verdict.scale) - best

    near = sorted(
        (f for f in contenders(searcher, found, verdict.accepted) if behind(f) < _CONTESTED),
        key=behind,
    )[:_RIVALS]
    for rival in near if verdict.accepted else ():
        with suppress(TrueupError):
            found = with_rival(
                searcher, found, rival, _polished(request, searcher, made, rival, sensors)
            )
    return found, judge(searcher, found)


def _polished(
    request: Request, searcher: Searcher, made: list[Candidates], state: Fit, sensors: Any
) -> Fit:
    """Fit a hypothesis on a basis of its own."""
    model = request.structure.model
    placed = request.placed
    observation = sp.csr_matrix(placed.weighted(placed.observation.matrix @ model.expansion))
    return polished(request.structure, made, observation, sensors, searcher.problem, state)


def _searcher(trial: _Trial) -> Searcher:
    """Put the catalogue on the leading vectors of the fitted state."""
    request, problem, null = trial.request, trial.problem, trial.null
    made, compliance = trial.ground.catalogue, trial.ground.compliance
    size = request.structure.model.geometry.size
    small = problem.turned(null.vectors)
    small = replace(small, modes=min(80, small.basis.size))
    vectors = small.basis.vectors
    inverse = compliance.on(vectors)
    missing = tuple(_missing(c, compliance, vectors, inverse) for c in made)
    factors = tuple(c.factors(small.basis) for c in made)
    small = replace(small, catalogue=tuple(made), factors=factors, missing=missing, turn=None)
    coarse = tuple(_coarse(c, f, small, size) for c, f in zip(made, factors, strict=True))
    active = tuple(range(len(problem.prior.spread)))
    return Searcher(small, coarse, active, null.log_p, size, request.effort)


def _missing(c: Candidates, compliance: Compliance, vectors: Floats, inverse: Floats) -> Any:
    """Return the flexibility that a basis lacks for candidates, None where it does not matter."""
    if not c.needs_flexibility:
        return None
    if isinstance(c.law, ReleaseLaw):
        loads = c.extra.get("loads", c.root)
        turns = c.extra.get("turns", sp.identity(c.root.shape[0], format="csr"))
        return SharedFlexibility(compliance, vectors, inverse, loads, turns, c.rows_each)
    return Flexibility(compliance, vectors, inverse, c.root, c.rows_each)


def _coarse(c: Candidates, factors: Any, problem: Problem, size: float) -> Any:
    """Rows that the first scan looks at: spread over the structure, where anything moves."""
    rows = np.arange(len(c))
    if c.kind in _ALONG_AXES:
        moves = np.sum(factors[rows][:, 0, : problem.columns] ** 2, axis=1)
        live = np.flatnonzero(moves > 0.02 * moves.max())
        parts = []
        component = np.array([w["components"][0] for w in c.where])
        for k in (1, 2, 3):
            own = live[component[live] == k]
            if len(own):
                parts.append(own[thinned(c.xyz[own], size / 13.0)])
        return np.concatenate(parts) if parts else rows[:0]
    if "patches" in c.extra:
        first = np.flatnonzero([p.first for p in c.extra["patches"]])
        return first[thinned(c.xyz[first], size / 18.0)] if c.kind == "point_mass" else first
    if c.kind == "point_mass":
        return thinned(c.xyz, size / 18.0)
    return rows
