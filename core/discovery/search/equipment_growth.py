"""A mass grows into equipment where the test tells its offset or how it resists being turned.

A mass on a stand of 60 mm looks like a heavier one, one with an absorber beside it, or an absorber.
So each mass and absorber of a hypothesis that earned its place is tried as a rigid body on the
grids around, each as a foot of its own and with those beside it, and its mass, centre and extent
climb to where the test is likeliest by the error of the model: what a mass on no stand leaves is no
noise to weigh it by. The test has to be clearly likelier, less what the choice of a body cost.
Where the model is off by more than right ones are, the test does not tell a heavy mass from a less
heavy one that resists being turned; there a mass is a solid block of what the structure is made
of: equipment is rarely more compact.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..effects import point_mass, tuned_absorber
from ..effects.candidates import Candidates, Suspect, places_of
from ..equipment.bodies import Body, Equipment, ball, block, equipment, grown
from ..equipment.loose_body import body_of, loose, theta_of
from ..equipment.stands import Stand, stands
from ..likelihood.hypothesis import Fit
from ..likelihood.map_fit import evaluate, spread_of
from ..model_error.diffuse_fit import Judged, everything
from ..reduction.elements_and_supports import Structure
from .exact_scan import scan
from .model_selection import Scored, earned, scored
from .moves import Searcher
from .search_numbers import SEARCH

Place = tuple[Candidates, list[Stand]]
"""Masses whose prior holds there, and what equipment stands on, at all places alike."""


@dataclass(frozen=True, eq=False)
class _Replaced:
    """A hypothesis, and which of its suspects equipment takes the place of."""

    searcher: Searcher
    state: Fit
    number: int


def equipped(structure: Structure, searcher: Searcher, state: Fit) -> tuple[Searcher, Fit]:
    """Return a hypothesis whose masses have offset and inertia, and a searcher that knows them.

    What has both climbs on where that is likelier: it climbed beside other suspects.
    """
    for q, s in enumerate(state.suspects):
        c = searcher.problem.catalogue[s.kind]
        if c.kind is tuned_absorber.KIND or c.kind.joins(point_mass.KIND):
            better, now = _best(structure, _Replaced(searcher, state, q)), scored(searcher, state)
            if better and _instead(better[1], now, stood=grown(c, s.row) is not None):
                searcher, state = better[0], better[1].fit
    return searcher, state


def _instead(better: Scored, now: Scored, *, stood: bool) -> bool:
    """Whether a body takes the place of a mass that stood on its own, or of another body."""
    return better.score > now.score + SEARCH.likelier if stood else earned(better, now)


def as_blocks(
    structure: Structure,
    searcher: Searcher,
    state: Fit,
    density: float,
    mount: float | None = None,
) -> tuple[Searcher, Fit]:
    """Return a hypothesis whose masses at points are blocks, and a searcher that knows them.

    Fitted; as they are where they stand on a `mount` of a known ln f.
    """
    for q, s in enumerate(state.suspects):
        c = searcher.problem.catalogue[s.kind]
        own, _ = places_of(c, s.row)[0]
        feet = _feet(structure, c, s.row) if _at_point(own) else []
        if feet:
            body = block(float(np.exp(s.theta[0])), density)
            made = equipment(c, feet[0], [body], mount)
            kind = len(searcher.problem.catalogue)
            searcher = searcher.with_kind(kind, made)
            new = Suspect(kind, 0, tuple(made.like(s.theta[:1]).tolist()))
            suspects = state.instead(q, new)
            if mount is None:
                state = searcher.fitted(state, suspects, SEARCH.steps_moved)
            else:
                state = replace(state, suspects=suspects)
    return searcher, state


def _at_point(c: Candidates) -> bool:
    return c.kind is point_mass.KIND and bool(c.rows_each) and not isinstance(c, Equipment)


def _best(structure: Structure, r: _Replaced) -> tuple[Searcher, Scored] | None:
    """Return the best with equipment in place of a mass, and a searcher that knows it.

    None where none can stand there. Of those that have climbed once the likeliest climb on.
    """
    s = r.state.suspects[r.number]
    places = _places(structure, r.searcher, s)
    first = [(place, j) for place in places for j in [_climbed(r, place)] if j is not None]
    first.sort(key=lambda one: one[1].evidence, reverse=True)
    found = (_standing(r, *one) for one in first[: SEARCH.equipment_tried])
    return max(found, key=lambda one: one[1].score, default=None)


def _places(structure: Structure, searcher: Searcher, s: Suspect) -> list[Place]:
    """Return where equipment may stand in place of a mass: there, and on the grids next to it.

    In place of masses at places alike there and, where these are beside each other, one alone next
    to each: what turns about one axis more than about another moves as a pair does.
    """
    own = searcher.problem.catalogue[s.kind]
    rows = [(own, s.row)] if own.kind is point_mass.KIND and own.rows_each else []
    c = next(c for c in searcher.problem.catalogue if c.kind is point_mass.KIND and c.rows_each)
    between = np.array([len(w["grids"]) > 1 for w in c.where])
    spots = np.array([alone.xyz[row] for alone, row in places_of(own, s.row)])
    near = set[int]()
    if np.linalg.norm(np.ptp(spots, axis=0)) < SEARCH.beside * searcher.size:
        for spot in spots:
            away = np.where(between, np.inf, np.linalg.norm(c.xyz - spot, axis=1))
            near.update(np.argsort(away, kind="stable")[: SEARCH.equipment_places].tolist())
    rows += [(c, row) for row in sorted(near) if not (c is own and row == s.row)]
    return [(c, feet) for c, row in rows for feet in _feet(structure, c, row)]


def _feet(structure: Structure, c: Candidates, row: int) -> list[list[Stand]]:
    """Return what equipment in place of a suspect may stand on, each at all its places alike.

    None where one of them holds no equipment.
    """
    places = places_of(c, row)
    turns = np.eye(3)[None] if c.maps is None else c.maps
    both = zip(places, turns, strict=True)
    found = [stands(structure, own.where[i], turn) for (own, i), turn in both]
    return [list(feet) for feet in zip(*found, strict=False)]


def _start(r: _Replaced, place: Place) -> tuple[float, Body]:
    """Return ln of the mass and the body at a place that promise most, all else as it stands."""
    template, feet = place
    bodies = _upright(feet[0], r.searcher.size)
    made = equipment(template, feet, bodies)
    kind = len(r.searcher.problem.catalogue)
    wide = r.searcher.with_kind(kind, made)
    small, here = wide.without(r.state, r.number)
    sizes = np.array(SEARCH.equipment_sizes)
    trials = made.around(made.like(r.state.suspects[r.number].theta).tolist(), sizes)
    hopes = scan(small, here, kind, np.arange(len(made)), trials) + made.surprise(trials)
    row, size = np.unravel_index(hopes.argmin(), hopes.shape)
    return float(trials[size][0]), bodies[row]


def _climbed(r: _Replaced, place: Place) -> Judged | None:
    """Return a hypothesis whose mass at a place is a loose body, moved to where it is likeliest.

    None where no model with it solves.
    """
    mass, body = _start(r, place)
    size = r.searcher.size
    kind = len(r.searcher.problem.catalogue)
    wide = r.searcher.with_kind(kind, loose(*place, size))
    new = Suspect(kind, 0, theta_of(mass, body, size))
    state = evaluate(wide.problem, r.state.nuisance, r.state.instead(r.number, new))
    return wide.judged(wide.problem, state, np.inf)


def _standing(r: _Replaced, place: Place, best: Judged) -> tuple[Searcher, Scored]:
    """Return equipment at a place as the test is likeliest, climbed on from where it is.

    On the modes of a start a body is moved only so far: so again from there.
    """
    (template, feet), q, size = place, r.number, r.searcher.size
    kind = len(r.searcher.problem.catalogue)
    wide = r.searcher.with_kind(kind, loose(template, feet, size))
    for _ in range(SEARCH.turns):
        state = evaluate(wide.problem, best.fit.nuisance, best.fit.suspects)
        found = wide.judged(wide.problem, state, np.inf)
        if found is None or found.evidence < best.evidence + SEARCH.better:
            break
        best = found
    s = best.fit.suspects[q]
    made = equipment(template, feet, [body_of(s.theta, size)], paid=_paid(best, q))
    new = Suspect(kind, 0, tuple(made.like(s.theta[:1]).tolist()))
    wide = r.searcher.with_kind(kind, made)
    stood = evaluate(wide.problem, best.fit.nuisance, best.fit.instead(q, new))
    return wide, scored(wide, stood)


def _paid(best: Judged, q: int) -> float:
    """Return ln of what it cost the evidence that the body of a suspect had a choice."""
    spread = spread_of(best.problem, best.state, everything(best.problem))
    A = spread[:, None] * best.information * spread
    suspects = best.fit.suspects
    first = len(A) - sum(len(s.theta) for s in suspects[q:])
    body = np.arange(first + 1, first + len(suspects[q].theta))
    rest = np.delete(np.arange(len(A)), body)
    occam = np.linalg.slogdet(A)[1] - np.linalg.slogdet(A[np.ix_(rest, rest)])[1]
    return 0.5 * float(occam + np.sum(np.square(suspects[q].theta[1:])))


def _upright(s: Stand, size: float) -> list[Body]:
    """Return a body at a place, and those above and below a sheet."""
    heights = SEARCH.equipment_heights if s.sheet else ()
    off = [0.0, *(way * h * size for h in heights for way in (1.0, -1.0))]
    return [ball(h * s.axes[0], SEARCH.equipment_radius * size) for h in off]
