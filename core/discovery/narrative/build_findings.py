"""From the hypotheses that are left to what a person is told."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...arrays import Bools, Floats
from ..effects.candidates import Candidates, Suspect, places_of
from ..findings import Alternative, Discovery, Finding, MovedParameter, Where
from ..likelihood.elimination import InDeck
from ..likelihood.hypothesis import Fit
from ..likelihood.likelihood_numbers import LIKELIHOOD
from ..likelihood.request import Request
from ..model_error.model_error_numbers import MODEL_ERROR
from ..posterior.test_design import further_modes, further_sensors
from ..search.completeness import Completeness
from ..search.credible_places import Place, between
from ..search.found import Found, noise_scale, objective_of
from ..search.model_selection import (
    explained,
    instead,
    says_else,
    scored,
    times,
)
from ..search.moves import Searcher
from ..sensor_faults.diagnosis import Verdicts
from .held_places import held_said, is_held
from .model_error_words import left_over, looks_like
from .narrative_numbers import NARRATIVE
from .open_frame import frame_needed, images
from .sensor_findings import accusations, remarks
from .sentences import alternative, effects_said, magnitude_of, sentence_of, spot_of


def build_discovery(
    request: Request,
    searcher: Searcher,
    found: Found,
    accepted: int,
    whole: Completeness,
    known: InDeck,
    tested: Verdicts,
    held_out: tuple[Bools, Bools],
) -> Discovery:
    """Say what the search amounts to: verdict, findings, alternatives, what would decide.

    `whole` is how well it explains the test beside the error of a model, `known` what the known
    parameters are then; `held_out` are the test modes and the sensors that were kept out of the
    search.
    """
    outcome = _Outcome(request, searcher, found, accepted, whole)
    best = outcome.best
    own = np.split(whole.deviations, np.cumsum([len(s.theta) for s in best.suspects])[:-1])
    suspects = [(k, p) for k, s in enumerate(best.suspects) for p in range(len(outcome.places(s)))]
    held = [outcome.region(best.suspects[k], p) for k, p in suspects if outcome.held(k)]
    findings = [_finding(outcome, k, p, own[k]) for k, p in suspects if not outcome.held(k)]
    nodes = request.placed.observation.sensors.node
    adequate = whole.explains
    tested = _told_of_sensors(whole, tested, bool(suspects))
    accused = accusations(request.placed.observation, tested)
    word = "no_gap"
    spots = [np.asarray(f.where.xyz) for f in findings]
    placed, geometry = request.placed, request.structure.model.geometry
    decide = frame_needed(placed.alignment, geometry, spots) if suspects else ()
    clear = whole.clear and bool(findings) and not (decide or held)
    clear = clear and not any(map(_says_nothing, findings))
    clear = clear and not (_gains_little(whole) and any(map(_hardly_told, findings)))
    few = _few_modes(whole, len(findings))
    clear, decide = clear and not few, (*few, *decide)
    proposal = clear and not whole.true
    if clear and whole.true:
        word = "effect"
    elif suspects:
        word = "undecided"
        decide = (*decide, *_would_decide(outcome, held_out[0]))
    elif not adequate:
        word = "undecided"
    elif accused:
        word = "test_fault"
    elif whole.shape is not None:
        word = "undecided"
    elif whole.moved > MODEL_ERROR.seen:
        word = "parameters_only"
    elif not whole.lacks_nothing:
        word = "undecided"
    sure = whole.posterior * _share(word, bool(suspects), whole)
    told = whole.shape is not None or whole.reach is not None or whole.unexplained
    in_fields = word == "parameters_only" and whole.in_fields
    looks = not adequate or in_fields or (word == "undecided" and (bool(told) or not decide))
    if looks:
        decide = (*left_over(whole, request.numbers), *decide)
    decide = (*held_said(held), *decide)
    return Discovery(
        word,
        (*(replace(f, confidence=sure) for f in findings), *accused),
        _alternatives(outcome, sure / (1.0 - sure)),
        _moved(known),
        noise_scale(searcher.problem, outcome.best),
        2.0 * whole.gain,
        sure,
        whole.agree,
        tuple(int(i) for i in request.numbers[held_out[0]]),
        tuple(int(nodes[i]) for i in np.flatnonzero(held_out[1])),
        tested.faults,
        decide,
        remarks(request.placed.observation, tested),
        error=whole.best.diffuse.error,
        error_alone=whole.alone.diffuse.error,
        gain=whole.gain,
        adequacy=whole.adequacy,
        unexplained=tuple(int(request.numbers[k]) for k in whole.unexplained),
        proposal=proposal,
        mesh=known.mesh,
        looks_like=looks_like(whole) if looks else "",
    )


def _says_nothing(f: Finding) -> bool:
    """Whether a finding is a factor that may as well be 1."""
    return (
        "factor" in f.magnitude and f.interval is not None and f.interval[0] < 1.0 < f.interval[1]
    )


def _hardly_told(f: Finding) -> bool:
    """Whether the test hardly tells how large what was found is."""
    return f.interval is not None and f.interval[1] > NARRATIVE.hardly * f.interval[0]


def _gains_little(whole: Completeness) -> bool:
    """Whether what was found gains little a mode."""
    return whole.gain < NARRATIVE.little * len(whole.best.diffuse.each)


def _few_modes(whole: Completeness, places: int) -> tuple[str, ...]:
    """Say that effects at so many places are more than the modes that they explain can tell."""
    modes = _explained(whole)
    if places * NARRATIVE.modes_each <= modes:
        return ()
    return (
        f"further modes: each effect has a place and a size, for which "
        f"{NARRATIVE.modes_each} modes are asked; there are {modes} for {places}",
    )


def _told_of_sensors(whole: Completeness, tested: Verdicts, suspects: bool) -> Verdicts:
    """Return what is told of the sensors: less where the model is in doubt.

    Shapes that no model explains accuse nobody.
    """
    if _explained(whole) < NARRATIVE.modes_each:
        return replace(tested, faults=())
    return tested if whole.explains and (whole.clear or not suspects) else tested.beyond_doubt


def _explained(whole: Completeness) -> int:
    """Return the number of modes searched that the best of what was found explains."""
    return int(np.count_nonzero(~whole.best.diffuse.astray))


@dataclass(frozen=True, eq=False)
class _Outcome:
    """What was asked, what was found, and what it amounts to."""

    request: Request
    searcher: Searcher
    found: Found
    accepted: int
    whole: Completeness

    @property
    def best(self) -> Fit:
        """The hypothesis that is accepted."""
        return self.found.levels[self.accepted]

    @cached_property
    def rivals(self) -> list[Fit]:
        """Of what says something else the best of every combination of kinds, likeliest first."""
        best = self.kinds(self.best)
        seen: dict[tuple[str, ...], Fit] = {}
        for f in sorted((f for level in self.found.rivals for f in level), key=objective_of):
            if self.kinds(f) != best or says_else(self.searcher, self.best, f):
                seen.setdefault(self.kinds(f), f)
        return sorted(seen.values(), key=self.behind)

    def named(self, f: Fit) -> list[tuple[Candidates, int]]:
        """Return candidates and row of every place of a hypothesis, by the names of their kinds."""
        every = (place for s in f.suspects for place in self.places(s))
        return sorted(every, key=lambda place: place[0].kind.name)

    def kinds(self, f: Fit) -> tuple[str, ...]:
        """Return the kinds of a hypothesis, one for each place."""
        return tuple(c.kind.name for c, _ in self.named(f))

    def regions(self, f: Fit) -> tuple[str, ...]:
        """Say where the effects of a hypothesis are, one for each of its `kinds`."""
        geometry = self.request.structure.model.geometry
        return tuple(spot_of(geometry, c, row) for c, row in self.named(f))

    def behind(self, f: Fit) -> float:
        """Return by how much a hypothesis is less likely than the best, ln, choices paid for."""
        best = scored(self.searcher, self.best)
        return best.score - scored(self.searcher, f, best).score

    def times_less_likely(self, f: Fit) -> float:
        """Return how many times, by the error of the model, choices paid for; at least once."""
        return times(2.0 * max(self.behind(f), 0.0))

    def of(self, s: Suspect) -> Candidates:
        """Return the candidates that a suspect is one of."""
        return self.searcher.problem.catalogue[s.kind]

    def places(self, s: Suspect) -> list[tuple[Candidates, int]]:
        """Return candidates and row of every place of a suspect, several of twins."""
        return places_of(self.of(s), s.row)

    def held(self, number: int) -> bool:
        """Whether a suspect says no more than that the test is held at its place."""
        s = self.best.suspects[number]
        return is_held(self.of(s), s, self.request.mass)

    def region(self, s: Suspect, place: int = 0) -> str:
        """Say where a suspect is, or one of its places."""
        c, row = self.places(s)[place]
        return spot_of(self.request.structure.model.geometry, c, row)


def _finding(o: _Outcome, number: int, place: int, deviation: Floats) -> Finding:
    """Tell one suspect at one of its places.

    A factor is as many deviations off 1 as the likelihood without it says (its signed root).
    """
    best, masses = o.best, o.request.masses
    s = best.suspects[number]
    (c, row), spot, sizes = o.places(s)[place], o.region(s, place), np.exp(s.theta)
    places = o.whole.places[number]
    error = [m.place_error for m in c.kind.magnitudes[: len(s.theta)]]
    spread = np.hypot(deviation, error)
    if "factor" in (m.word for m in c.kind.magnitudes):
        off = min(np.sqrt(2.0 * max(o.whole.last, 1.0)), NARRATIVE.off_one)
        spread = np.minimum(spread, np.abs(s.theta) / off)
    spread = np.hypot(spread, between(places))
    half = LIKELIHOOD.interval * spread[:, None]
    intervals = sizes[:, None] * np.exp(half * np.array([-1.0, 1.0]))
    magnitude = magnitude_of(c, row, sizes, intervals, masses)
    first = intervals[0] * (masses.card if c.kind.magnitudes[0].is_mass else 1.0)
    interval = (float(first[0]), float(first[1]))
    rows = explained(o.searcher, best, number)
    modes = [int(o.request.numbers[j]) for j in rows if j not in o.whole.unexplained]
    where = Where.of(c.where[row], c.xyz[row], region=spot)
    many = len(o.places(s))
    text = sentence_of(c.kind, magnitude, spot, interval, modes, masses, many)
    credible = _credible(o, number, place, places)
    return Finding("model", c.kind.name, where, magnitude, interval, credible, 0.0, text)


def _credible(o: _Outcome, number: int, place: int, places: Sequence[Place]) -> tuple[Where, ...]:
    """Places, and effects of other kinds, that explain the data about as well as one finding.

    By every position of the test that is as good.
    """
    others = instead(o.searcher, o.found, o.accepted, number)
    every = [*((p.suspect, p.weight) for p in places), *others]
    at = [(w, *o.places(s)[min(place, len(o.places(s)) - 1)]) for s, w in every]
    alignment = o.request.placed.alignment
    at += [(w, c, _nearest(c, x)) for w, c, row in at for x in images(alignment, c.xyz[row])]
    total = sum(w for w, _, _ in at)
    return tuple(
        Where.of(c.where[row], c.xyz[row], weight=w / total, kind=c.kind.name) for w, c, row in at
    )


def _nearest(c: Candidates, xyz: Floats) -> int:
    return int(np.argmin(np.linalg.norm(c.xyz - xyz, axis=1)))


def _share(word: str, findings: bool, whole: Completeness) -> float:
    """Return the share of frozen cases in which what is told so was right.

    The posterior compares hypotheses of the catalogue. That one of them is true is less than
    sure, the less so where the best one is not clear, leaves more than right models do, or gains
    little a mode.
    """
    if not findings:
        return NARRATIVE.nothing
    if word == "effect":
        return NARRATIVE.claimed_by_little if _gains_little(whole) else NARRATIVE.claimed
    return NARRATIVE.doubted


def _moved(known: InDeck) -> tuple[MovedParameter, ...]:
    """Known parameters as the completed deck takes them."""
    factor = np.exp(np.where(known.clear, known.alone, known.together))
    return tuple(
        MovedParameter(k, float(f), float(f * d), bool(c), float(np.exp(together)))
        for k, (f, d, c, together) in enumerate(
            zip(factor, known.deviation, known.clear, known.together, strict=True)
        )
    )


def _alternatives(o: _Outcome, most: float) -> tuple[Alternative, ...]:
    """Best rival of every combination of kinds, and the known parameters alone.

    One of the kinds that were found counts where it says something else: another place. None is
    said to be more than `most` times less likely: as much as the confidence in the best leaves.
    """
    out = []
    for f in o.rivals:
        xyz = [c.xyz[row] for c, row in o.named(f)]
        regions = o.regions(f)
        said = effects_said(o.kinds(f), regions)
        out.append(alternative(o.kinds(f), xyz, o.times_less_likely(f), said, regions, most=most))
    if o.accepted:
        ratio = o.times_less_likely(o.found.levels[0])
        out.append(alternative((), (), ratio, "the known parameters alone", most=most))
    return tuple(sorted(out, key=lambda a: a.times_less_likely))[: NARRATIVE.alternatives]


def _would_decide(o: _Outcome, held: Bools) -> tuple[str, ...]:
    """Say which sensors and modes tell the best hypotheses apart."""
    simpler = o.found.levels[: o.accepted][-1:]
    other = [f for f in o.rivals if says_else(o.searcher, o.best, f)]
    rivals = sorted((*other, *simpler), key=o.behind)
    near = [f for f in rivals if o.behind(f) < NARRATIVE.rival] or rivals[:1]
    told_apart = tuple((_in_words(o, f), f) for f in near[: NARRATIVE.rivals])
    p, model = o.searcher.problem, o.request.structure.model
    stray = np.isin(np.flatnonzero(~held), o.whole.unexplained)
    return (
        *further_sensors(p, model, o.best, told_apart, o.request.numbers[~held], stray),
        *further_modes(p, model, o.best, told_apart),
    )


def _in_words(o: _Outcome, f: Fit) -> str:
    return effects_said(o.kinds(f), o.regions(f)) or "the known parameters alone"
