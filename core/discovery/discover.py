"""From evidence to verdict."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..arrays import Floats
from ..comparison import Placed
from ..correlation import realised
from ..eigen import Eigensolution
from ..errors import TrueupError
from .basis import Flexibility, build_basis
from .candidates import Candidates, Suspect
from .evidence import Evidence, Noise
from .findings import Alternative, Discovery, Finding, MovedParameter
from .fitting import Fit, Prior, Problem, evaluate, fit
from .judge import (
    Judgement,
    burden,
    credible_places,
    deviations,
    enough,
    held_out,
    judge,
    summary,
    times,
)
from .kinds import KINDS
from .kinds.scale import Scale
from .mesh_error import lumping
from .places import region
from .polish import polished
from .search import Effort, Found, Searcher
from .sensors import Fault, find_faults
from .structure import Structure, thinned
from .wording import magnitude_of, sentence_of, test_sentence

_MESH = (1.0, -1.0, 1.05)
"""Spread and bounds of the error of the mesh, see `mesh_error`."""
_SIGNIFICANT = 3.0
_SURE = 0.6
_RITZ = 110
_UNEXPLAINED = 8.0


@dataclass(frozen=True, eq=False)
class Request:
    """What discovery is asked.

    Parameters
    ----------
    structure : Structure
        Its model carries the known parameters that may be off.
    spread : (n_parameter,) float
        Standard deviation of ln p of each.
    solution : Eigensolution
        Of the deck as it is, its factor kept, with modes to well above the test's.
    placed : Placed
        The test on the model.
    mass : float
        Of the structure, deck units.
    """

    structure: Structure
    spread: Floats
    solution: Eigensolution
    placed: Placed
    mass: float
    effort: Effort = field(default_factory=Effort)


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
    shapes = realised(request.placed.test.shapes)
    hz = request.placed.test.frequencies_hz
    analysis = np.asarray(
        request.placed.observation.matrix
        @ (request.structure.model.expansion @ request.solution.vectors)
    )
    analysis_hz = np.sqrt(np.maximum(request.solution.eigenvalues, 0.0)) / (2.0 * np.pi)
    faults, noise = find_faults(shapes, hz, analysis, analysis_hz)
    sound = corrected(shapes, faults)
    modes_out = held_out(len(hz), 4, 6) if len(hz) >= 10 else np.zeros(len(hz), bool)
    sensors_out = held_out(len(sound), 5, 10) if len(sound) >= 30 else np.zeros(len(sound), bool)
    progress("fitting the known parameters")
    problem, null, zero = _prepared(request, sound, noise, ~modes_out, ~sensors_out)
    null_shapes = _mode_shapes(request, problem, null)
    again, noise = find_faults(
        shapes, hz, null_shapes[0], np.sqrt(np.maximum(null_shapes[1], 0.0)) / (2.0 * np.pi)
    )
    merged = _merged(faults, again)
    if {(f.kind, f.sensors) for f in merged} != {(f.kind, f.sensors) for f in faults}:
        faults, sound = merged, corrected(shapes, merged)
        problem, null, zero = _prepared(request, sound, noise, ~modes_out, ~sensors_out)
    progress("making the catalogue of effects")
    made = _catalogue(request, problem)
    searcher = _searcher(request, problem, null, made)
    found = searcher.run(enough(searcher), progress)
    progress("weighing the best hypotheses on bases of their own")
    found, verdict = _weighed(request, searcher, made, found, ~sensors_out)
    return _told(request, searcher, found, verdict, zero, faults, (modes_out, sensors_out))


def corrected(shapes: Floats, faults: tuple[Fault, ...]) -> Floats:
    """Return the shapes as sound sensors would have read them."""
    out = np.array(shapes, dtype=float)
    for f in faults:
        rows = list(f.sensors)
        if f.kind == "sensor_swap":
            out[rows] = out[rows[::-1]]
        else:
            out[rows] /= f.factor
    return out


def _merged(first: tuple[Fault, ...], second: tuple[Fault, ...]) -> tuple[Fault, ...]:
    """Faults of both passes; where both speak of a sensor the second, better founded, counts."""
    spoken = {i for f in second for i in f.sensors}
    return (*second, *(f for f in first if not spoken & set(f.sensors)))


def _prepared(
    request: Request, shapes: Floats, noise: float, modes: Any, sensors: Any
) -> tuple[Problem, Fit, Fit]:
    """Return the problem without suspects, its best fit, and the fit with nothing moved."""
    model, hz = request.structure.model, request.placed.test.frequencies_hz
    sigma = Noise(shape=float(np.hypot(noise, 0.04)))
    unit = shapes / np.maximum(np.linalg.norm(shapes, axis=0), np.finfo(float).tiny)
    e = Evidence(hz, unit, sigma).take(modes, sensors)
    below = np.sqrt(np.maximum(request.solution.eigenvalues, 0.0)) < 2.0 * np.pi * 1.15 * hz.max()
    targets = int(below.sum())
    basis = build_basis(model, request.solution, targets)
    observed = np.asarray(request.placed.observation.matrix @ basis.motion)[sensors]
    prior = Prior(
        np.append(request.spread, _MESH[0]),
        np.append(np.log([q.lower for q in model.parameters]), _MESH[1]),
        np.append(np.log([q.upper for q in model.parameters]), _MESH[2]),
    )
    mesh = lumping(request.structure, basis.vectors)
    problem = Problem(e, basis, observed, mesh, (), (), prior, min(basis.size, _RITZ), targets + 4)
    n = len(prior.spread)
    zero = fit(problem, np.zeros(n), (), (n - 1,), 10)
    null = fit(problem, np.zeros(n), (), tuple(range(n)), 30)
    return problem, null, zero


def _mode_shapes(request: Request, problem: Problem, state: Fit) -> tuple[Floats, Floats]:
    everywhere = np.asarray(request.placed.observation.matrix @ problem.basis.motion)
    return everywhere @ state.vectors, state.eigenvalues


def _catalogue(request: Request, problem: Problem) -> list[Candidates]:
    """Return every kind of effect at every place."""
    hz = problem.evidence.frequencies_hz
    scale = Scale(
        request.mass,
        request.structure.model.geometry.size,
        float((2.0 * np.pi * np.median(hz)) ** 2),
    )
    return [c for make in KINDS.values() for c in make(request.structure, scale)]


def _weighed(
    request: Request, searcher: Searcher, made: list[Candidates], found: Found, sensors: Any
) -> tuple[Found, Judgement]:
    """Fit the chosen hypothesis and the one with a suspect less on their own bases, judge again.

    A hypothesis whose completed model does not solve (a release larger than what is there) stays
    as the search left it.
    """
    model = request.structure.model
    observation = (request.placed.observation.matrix @ model.expansion).tocsr()[sensors]
    top = float(request.placed.test.frequencies_hz.max()) * 1.25
    hz = np.sqrt(np.maximum(request.solution.eigenvalues, 0.0)) / (2.0 * np.pi)
    modes = int(np.count_nonzero(hz < top)) + 8
    levels = list(found.levels)
    done: set[int] = set()
    verdict = judge(searcher, found)
    while verdict.accepted and {verdict.accepted, verdict.accepted - 1} - done:
        for k in {verdict.accepted, verdict.accepted - 1} - done:
            with suppress(TrueupError):
                levels[k] = polished(
                    request.structure, made, observation, searcher.problem, levels[k], modes
                )
            done.add(k)
        kept = Found(tuple(levels[: verdict.accepted + 1]), found.rivals[: verdict.accepted + 1])
        verdict, found = judge(searcher, kept), kept
    return found, verdict


def _searcher(request: Request, problem: Problem, null: Fit, made: list[Candidates]) -> Searcher:
    """Put the catalogue on the leading vectors of the fitted state."""
    model = request.structure.model
    size = model.geometry.size
    small = problem.turned(null.vectors)
    small = replace(small, modes=min(80, small.basis.size))
    missing = tuple(
        Flexibility(model, request.solution, small.basis, c.root, c.rows_each)
        if c.needs_flexibility
        else None
        for c in made
    )
    factors = tuple(c.factors(small.basis) for c in made)
    small = replace(small, catalogue=tuple(made), factors=factors, missing=missing, turn=None)
    coarse = tuple(_coarse(c, f, small, size) for c, f in zip(made, factors, strict=True))
    active = tuple(range(len(problem.prior.spread)))
    return Searcher(small, coarse, active, null.log_p, size, request.effort)


def _coarse(c: Candidates, factors: Any, problem: Problem, size: float) -> Any:
    """Rows that the first scan looks at: spread over the structure, where anything moves."""
    rows = np.arange(len(c))
    if c.kind == "ground_spring":
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


def _told(
    request: Request,
    searcher: Searcher,
    found: Found,
    verdict: Judgement,
    zero: Fit,
    faults: tuple[Fault, ...],
    out: tuple[Any, Any],
) -> Discovery:
    best = found.levels[verdict.accepted]
    n_active = len(best.active)
    spread = deviations(best, verdict.scale)
    alternatives = _alternatives(request, searcher, found, verdict)
    findings = [
        _finding(request, searcher, best, k, verdict, float(spread[n_active + k]), alternatives)
        for k in range(len(best.suspects))
    ]
    nodes = request.placed.observation.sensors.node
    xyz = request.placed.observation.xyz
    named = {
        (f.kind, tuple(int(nodes[i]) for i in f.sensors)): _fault(f, nodes, xyz)
        for f in faults
        if f.kind != "doubled"
    }
    told = list(named.values())
    moved = _moved(request, searcher, best, spread)
    null = found.levels[0]
    gained = (zero.objective - null.objective) / verdict.scale
    matters = gained > 2.0 * np.log(len(null.log_p)) + 8.0
    warnings = tuple(
        f"sensor {int(nodes[f.sensors[0]])} reads twice what all the others say, as if two "
        "measurements of it had been added up; its values were halved for the search"
        for f in faults
        if f.kind == "doubled"
    )
    word = "no_gap"
    decide: tuple[str, ...] = ()
    if findings and verdict.posterior >= _SURE:
        word = "effect"
    elif findings:
        word, decide = "undecided", _would_decide(request, searcher, found, verdict)
    elif verdict.scale > _UNEXPLAINED:
        word = "undecided"
        decide = (
            f"the best explanation leaves {verdict.scale:.0f} times the misfit of a right model; "
            "further sensors or modes, or an effect that the catalogue does not have",
        )
    elif told:
        word = "test_fault"
    elif matters:
        word = "parameters_only"
    return Discovery(
        word,
        (*findings, *told),
        alternatives,
        moved,
        verdict.scale,
        summary(found.levels),
        verdict.evidence,
        tuple(int(i) + 1 for i in np.flatnonzero(out[0])),
        tuple(int(nodes[i]) for i in np.flatnonzero(out[1])),
        tuple((f.kind, tuple(int(nodes[i]) for i in f.sensors), f.factor) for f in faults),
        decide,
        warnings,
    )


def _finding(
    request: Request,
    searcher: Searcher,
    best: Fit,
    number: int,
    verdict: Judgement,
    deviation: float,
    alternatives: tuple[Alternative, ...],
) -> Finding:
    s = best.suspects[number]
    c = searcher.problem.catalogue[s.kind]
    geometry = request.structure.model.geometry
    size = float(np.exp(s.theta))
    low, high = (float(np.exp(s.theta + d * 1.96 * deviation)) for d in (-1.0, 1.0))
    places = credible_places(searcher, best, number, verdict.scale)
    where = {**c.where[s.row], "xyz": c.xyz[s.row].tolist()}
    where["region"] = region(geometry, c.xyz[s.row])
    magnitude = magnitude_of(c, s.row, size)
    next_best = alternatives[0] if alternatives else None
    return Finding(
        "model",
        c.kind,
        where,
        magnitude,
        (low, high),
        tuple({**c.where[r], "xyz": c.xyz[r].tolist(), "weight": w} for r, w in places),
        verdict.posterior,
        sentence_of(c.kind, magnitude, where["region"], (low, high), next_best),
        {"xyz": c.xyz[s.row].tolist(), "radius": _radius(c, s)},
    )


def _radius(c: Candidates, s: Suspect) -> float:
    return float(c.extra["patches"][s.row].radius) if "patches" in c.extra else 0.0


def _fault(f: Fault, nodes: Any, xyz: Floats) -> Finding:
    sensors = [int(nodes[i]) for i in f.sensors]
    magnitude = {"factor": f.factor} if f.kind == "sensor_gain" else {}
    where = {
        "sensors": sensors,
        "xyz": xyz[f.sensors[0]].tolist(),
        "region": f"sensor{'s' if len(sensors) > 1 else ''} {' and '.join(map(str, sensors))}",
    }
    sure = 1.0 - 1.0 / (1.0 + f.gain_in_fit)
    interval = None
    if magnitude:
        interval = (f.factor - 1.96 * f.deviation, f.factor + 1.96 * f.deviation)
    return Finding(
        "test",
        f.kind,
        where,
        magnitude,
        interval,
        (),
        sure,
        test_sentence(f.kind, sensors, f.factor),
    )


def _moved(
    request: Request, searcher: Searcher, best: Fit, spread: Floats
) -> tuple[MovedParameter, ...]:
    """Known parameters as the completed deck takes them.

    In the deck there is no trend for the error of the mesh: moduli, thicknesses and inertias
    have to absorb it, so they are fitted once more without it, the effects as found.
    """
    n = len(request.structure.model.parameters)
    start = np.array(best.log_p)
    start[-1] = 0.0
    flat = fit(searcher.problem, start, best.suspects, tuple(range(n)), 20)
    return tuple(
        MovedParameter(
            k,
            float(np.exp(flat.log_p[k])),
            float(np.exp(flat.log_p[k])) * float(spread[best.active.index(k)]),
            abs(float(best.log_p[k])) > _SIGNIFICANT * float(spread[best.active.index(k)]),
        )
        for k in range(n)
    )


def _alternatives(
    request: Request, searcher: Searcher, found: Found, verdict: Judgement
) -> tuple[Alternative, ...]:
    """Best rival of every combination of kinds, and the known parameters alone."""
    catalogue = searcher.problem.catalogue
    best = found.levels[verdict.accepted]

    def cost(f: Fit) -> float:
        return f.objective / verdict.scale + burden(searcher, f)

    seen: dict[tuple[str, ...], Fit] = {}
    here = tuple(sorted(catalogue[s.kind].kind for s in best.suspects))
    for f in sorted((f for level in found.rivals for f in level), key=cost):
        seen.setdefault(tuple(sorted(catalogue[s.kind].kind for s in f.suspects)), f)
    out = []
    for kinds, f in seen.items():
        if kinds == here:
            continue
        places = tuple(tuple(float(v) for v in catalogue[s.kind].xyz[s.row]) for s in f.suspects)
        ratio = times(cost(f) - cost(best))
        words = " and ".join(k.replace("_", " ") for k in kinds)
        spot = region(request.structure.model.geometry, np.array(places[0]))
        out.append(
            Alternative(kinds, places, ratio, f"{words} {spot}: {ratio:.3g} times less likely")
        )
    if verdict.accepted:
        ratio = times(cost(found.levels[0]) - cost(best))
        out.append(
            Alternative((), (), ratio, f"the known parameters alone: {ratio:.3g} times less likely")
        )
    return tuple(sorted(out, key=lambda a: a.times_less_likely))[:8]


def _would_decide(
    request: Request, searcher: Searcher, found: Found, verdict: Judgement
) -> tuple[str, ...]:
    """Say which place, measured, tells the two best hypotheses apart."""
    best = found.levels[verdict.accepted]
    rivals = sorted(
        (f for level in found.rivals for f in level if len(f.suspects) == len(best.suspects)),
        key=lambda f: f.objective,
    )
    if not rivals:
        return ()
    p = searcher.problem
    a = evaluate(p, best.log_p, best.suspects)
    b = evaluate(p, rivals[0].log_p, rivals[0].suspects)
    model = request.structure.model
    rows = np.flatnonzero(model.dofs.component <= 3)
    motion, r = p.basis.motion[rows], p.basis.size
    A, B = motion @ a.vectors[:r, a.match], motion @ b.vectors[:r, b.match]
    A, B = A / np.linalg.norm(A, axis=0), B / np.linalg.norm(B, axis=0)
    sign = np.where(np.sum(A * B, axis=0) < 0.0, -1.0, 1.0)
    apart = np.abs(A - B * sign)
    row, mode = np.unravel_index(int(np.argmax(apart)), apart.shape)
    grid = int(model.dofs.node[rows[row]])
    axis = "XYZ"[int(model.dofs.component[rows[row]]) - 1]
    return (
        f"a sensor at grid {grid} in direction {axis}: there mode {int(mode) + 1} differs most "
        "between the two best explanations",
    )
