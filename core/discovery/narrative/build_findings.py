"""From the hypotheses that are left to what a person is told."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...arrays import Bools, Floats
from ...registration.alignment import Alignment
from ..effects.candidates import Suspect
from ..findings import Alternative, Discovery, Finding, MovedParameter, Where
from ..likelihood.hypothesis import Fit
from ..likelihood.request import Request
from ..posterior.credible_places import Place, between, credible_places
from ..posterior.test_design import further_modes, further_sensors
from ..search.beam_search import Found
from ..search.model_selection import (
    Judgement,
    contenders,
    cost,
    deviations,
    explained,
    instead,
    times,
)
from ..search.moves import Searcher
from ..sensor_faults.diagnosis import Verdicts
from .narrative_numbers import NARRATIVE
from .sensor_findings import accusations, remarks
from .sentences import alternative, magnitude_of, region, sentence_of


def build_discovery(
    request: Request,
    searcher: Searcher,
    found: Found,
    verdict: Judgement,
    zero: Fit,
    tested: Verdicts,
    held_out: tuple[Bools, Bools],
) -> Discovery:
    """Say what the search amounts to: verdict, findings, alternatives, what would decide.

    `held_out` are the test modes and the sensors that were kept out of the search.
    """
    best = found.levels[verdict.accepted]
    spread = deviations(best, verdict.scale)
    ends = np.cumsum([len(best.active), *(len(s.theta) for s in best.suspects)])
    own = np.split(spread, ends[:-1])[1:]
    alternatives = _alternatives(request, searcher, found, verdict)
    findings = [
        _finding(request, searcher, found, k, verdict, deviation, alternatives)
        for k, deviation in enumerate(own)
    ]
    nodes = request.placed.observation.sensors.node
    accused = accusations(request.placed.observation, tested)
    moved = _moved(best, spread)
    null = found.levels[0]
    gained = (zero.objective - null.objective) / verdict.scale
    matters = gained > 2.0 * np.log(len(null.nuisance)) + NARRATIVE.matters
    word = "no_gap"
    decide = frame_needed(request.placed.alignment) if findings else ()
    sure = verdict.posterior >= NARRATIVE.sure and verdict.foretold > NARRATIVE.contradicted
    if findings and sure and not decide:
        word = "effect"
    elif findings:
        word = "undecided"
        decide = (*decide, *_would_decide(request, searcher, found, verdict, held_out[0]))
    elif verdict.scale > NARRATIVE.unexplained:
        word = "undecided"
        decide = (
            f"the best explanation leaves {verdict.scale:.0f} times the misfit of a right model; "
            "further sensors or modes, or an effect that the catalogue does not have",
        )
    elif accused:
        word = "test_fault"
    elif matters:
        word = "parameters_only"
    return Discovery(
        word,
        (*findings, *accused),
        alternatives,
        moved,
        verdict.scale,
        verdict.evidence,
        verdict.posterior,
        verdict.foretold,
        tuple(int(i) for i in request.numbers[held_out[0]]),
        tuple(int(nodes[i]) for i in np.flatnonzero(held_out[1])),
        tested.faults,
        decide,
        remarks(request.placed.observation, tested),
    )


def frame_needed(alignment: Alignment) -> tuple[str, ...]:
    """Say that a place means nothing where the test may stand on the model in several ways."""
    if alignment.decided:
        return ()
    return (
        f"how the test lies on the model: {alignment.ambiguity}; with the test in the frame of "
        "the deck the place is known, now it is known but for such a turn or slide",
    )


def _finding(
    request: Request,
    searcher: Searcher,
    found: Found,
    number: int,
    verdict: Judgement,
    deviation: Floats,
    alternatives: tuple[Alternative, ...],
) -> Finding:
    best = found.levels[verdict.accepted]
    s = best.suspects[number]
    c = searcher.problem.catalogue[s.kind]
    geometry = request.structure.model.geometry
    sizes = np.exp(s.theta)
    places = credible_places(searcher, best, number, verdict.scale)
    error = [m.place_error for m in c.kind.magnitudes]
    spread = np.hypot(np.hypot(deviation, error), between(places))
    half = NARRATIVE.interval * spread[:, None]
    intervals = sizes[:, None] * np.exp(half * np.array([-1.0, 1.0]))
    spot = region(geometry, c.xyz[s.row])
    magnitude = magnitude_of(c, s.row, sizes, intervals, request.masses)
    first = intervals[0] * (request.masses.card if c.kind.magnitudes[0].is_mass else 1.0)
    interval = (float(first[0]), float(first[1]))
    modes = [int(request.numbers[j]) for j in explained(searcher, best, number, verdict.scale)]
    next_best = alternatives[0] if alternatives else None
    return Finding(
        "model",
        c.kind.name,
        Where.of(c.where[s.row], c.xyz[s.row], region=spot),
        magnitude,
        interval,
        _credible(searcher, found, verdict, number, places),
        _confidence(verdict),
        sentence_of(c.kind, magnitude, spot, interval, modes, request.masses, next_best),
    )


def _credible(
    searcher: Searcher, found: Found, verdict: Judgement, number: int, places: Sequence[Place]
) -> tuple[Where, ...]:
    """Places, and effects of other kinds, that explain the data about as well as one finding."""
    catalogue = searcher.problem.catalogue
    own = [(p.suspect.kind, p.suspect.row, p.weight) for p in places]
    others = [(s.kind, s.row, w) for s, w in instead(searcher, found, verdict, number)]
    total = sum(w for _, _, w in (*own, *others))
    return tuple(
        Where.of(c.where[row], c.xyz[row], weight=w / total, kind=c.kind.name)
        for kind, row, w in (*own, *others)
        for c in [catalogue[kind]]
    )


def _confidence(verdict: Judgement) -> float:
    """Chance that a finding is right.

    The posterior compares hypotheses of the catalogue. That one of them is true is less than
    sure, the less so the more misfit even the best one leaves.
    """
    left = 1.0 + NARRATIVE.left_over * (verdict.scale - 1.0)
    return verdict.posterior * NARRATIVE.in_catalogue / left


def _moved(best: Fit, spread: Floats) -> tuple[MovedParameter, ...]:
    """Known parameters as the completed deck takes them."""
    values = best.log_p if best.in_deck is None else best.in_deck
    return tuple(
        MovedParameter(
            k,
            float(np.exp(value)),
            float(np.exp(value)) * float(spread[best.active.index(k)]),
            abs(float(value)) > NARRATIVE.significant * float(spread[best.active.index(k)]),
        )
        for k, value in enumerate(values)
    )


def _alternatives(
    request: Request, searcher: Searcher, found: Found, verdict: Judgement
) -> tuple[Alternative, ...]:
    """Best rival of every combination of kinds, and the known parameters alone.

    One of the kinds that were found counts where it says something else: another place.
    """
    catalogue = searcher.problem.catalogue
    best = found.levels[verdict.accepted]

    def behind(f: Fit) -> float:
        return cost(searcher, f, verdict.scale) - cost(searcher, best, verdict.scale)

    def named(f: Fit) -> list[Suspect]:
        return sorted(f.suspects, key=lambda s: catalogue[s.kind].kind.name)

    def kinds_of(f: Fit) -> tuple[str, ...]:
        return tuple(catalogue[s.kind].kind.name for s in named(f))

    other = contenders(searcher, found, verdict.accepted)
    seen: dict[tuple[str, ...], Fit] = {}
    for f in sorted((f for level in found.rivals for f in level), key=behind):
        if kinds_of(f) != kinds_of(best) or any(f is g for g in other):
            seen.setdefault(kinds_of(f), f)
    out = []
    for kinds, f in seen.items():
        xyz = [catalogue[s.kind].xyz[s.row] for s in named(f)]
        regions = tuple(region(request.structure.model.geometry, x) for x in xyz)
        said = " and ".join(
            f"{k.replace('_', ' ')} {r}" for k, r in zip(kinds, regions, strict=True)
        )
        out.append(alternative(kinds, xyz, times(behind(f)), said, regions))
    if verdict.accepted:
        out.append(
            alternative((), (), times(behind(found.levels[0])), "the known parameters alone")
        )
    return tuple(sorted(out, key=lambda a: a.times_less_likely))[: NARRATIVE.alternatives]


def _would_decide(
    request: Request, searcher: Searcher, found: Found, verdict: Judgement, held: Bools
) -> tuple[str, ...]:
    """Say which sensors and modes tell the best hypotheses apart."""
    best = found.levels[verdict.accepted]
    simpler = found.levels[: verdict.accepted][-1:]
    rivals = sorted(
        (*contenders(searcher, found, verdict.accepted), *simpler),
        key=lambda f: cost(searcher, f, verdict.scale),
    )
    here, scale, most = cost(searcher, best, verdict.scale), verdict.scale, NARRATIVE.rivals
    near = [f for f in rivals if cost(searcher, f, scale) - here < NARRATIVE.rival] or rivals[:1]
    told_apart = tuple((_in_words(request, searcher, f), f) for f in near[:most])
    p, model = searcher.problem, request.structure.model
    return (
        *further_sensors(p, model, best, told_apart, request.numbers[~held]),
        *further_modes(p, model, best, told_apart),
    )


def _in_words(request: Request, searcher: Searcher, f: Fit) -> str:
    if not f.suspects:
        return "the known parameters alone"
    last = f.suspects[-1]
    c = searcher.problem.catalogue[last.kind]
    spot = region(request.structure.model.geometry, c.xyz[last.row])
    return f"{'' if len(f.suspects) < 2 else 'one with '}{c.kind.words} {spot}"
