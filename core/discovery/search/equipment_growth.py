"""A mass grows into equipment where the test tells its offset or how it resists being turned.

A mass on a stand of 60 mm looks like a heavier one, or like one with an absorber beside it. So each
mass of a hypothesis that earned its place is tried with its centre off the structure, above it
first, and with radii of gyration, in steps that get smaller. The test has to be clearly likelier
with them by the error of the model: what a mass on no stand leaves is no noise to weigh them by.
Where the model is off by more than right ones are, the test does not tell a heavy mass from a less
heavy one that resists being turned; there a mass is a solid block of what the structure is made
of: equipment is rarely more compact.
"""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Floats
from ..effects import point_mass
from ..effects.candidates import Candidates, Suspect, places_of
from ..effects.equipment import Body, Equipment, Stand, block, equipment, stand, stands_off
from ..likelihood.hypothesis import Fit
from ..likelihood.map_fit import evaluate
from ..reduction.elements_and_supports import Structure
from .exact_scan import scan
from .model_selection import scored
from .moves import Searcher
from .search_numbers import SEARCH

Better = tuple[Searcher, Fit] | None


def equipped(structure: Structure, searcher: Searcher, state: Fit) -> tuple[Searcher, Fit]:
    """Return a hypothesis whose masses have offset and inertia, and a searcher that knows them."""
    for q, s in enumerate(state.suspects):
        c = searcher.problem.catalogue[s.kind]
        if c.kind.joins(point_mass.KIND) and not stands_off(c, s.row):
            better = _one(structure, searcher, state, q)
            gain = scored(*better).score - scored(searcher, state).score if better else 0.0
            if better and gain > SEARCH.suspect:
                searcher, state = better
    return searcher, state


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
        stands = _stands(structure, c, s.row) if _at_point(own) else []
        if stands:
            body = block(float(np.exp(s.theta[0])), density)
            made = equipment(c, stands, [body], mount)
            searcher, kind = _with(searcher, made), len(searcher.problem.catalogue)
            new = Suspect(kind, 0, tuple(made.like(s.theta[:1]).tolist()))
            suspects = (*state.suspects[:q], new, *state.suspects[q + 1 :])
            if mount is None:
                state = searcher.fitted(state, suspects, SEARCH.steps_moved)
            else:
                state = replace(state, suspects=suspects)
    return searcher, state


def _at_point(c: Candidates) -> bool:
    return c.kind is point_mass.KIND and bool(c.rows_each) and not isinstance(c, Equipment)


def _one(structure: Structure, searcher: Searcher, state: Fit, q: int) -> Better:
    """Return a hypothesis with equipment in place of one mass, None where that is not worth it."""
    if state.misfit <= SEARCH.equipment_gain:
        return None
    places = [(c, _stands(structure, c, row)) for c, row in _places(searcher, state.suspects[q])]
    looked: list[tuple[float, Candidates, list[Stand], Body]] = []
    for c, stands in places:
        if stands:
            bodies = _upright(stands[0], searcher.size)
            hopes = _looked(searcher, state, q, c, stands, bodies, state).score.min(axis=1)
            looked.append((float(hopes.min()), c, stands, bodies[int(hopes.argmin())]))
    looked.sort(key=lambda place: place[0])
    best: Better = None
    for _, c, stands, body in looked[: SEARCH.equipment_tried]:
        wide, fit = _grown(searcher, state, q, c, stands, body)
        now = state if best is None else best[1]
        if fit.objective < now.objective - SEARCH.equipment_gain:
            best = (wide, fit)
    return best


def _places(searcher: Searcher, s: Suspect) -> list[tuple[Candidates, int]]:
    """Return where equipment may stand in place of a mass: there, and on the grids nearest to it.

    Places alike stay where they are.
    """
    own = searcher.problem.catalogue[s.kind]
    here = [(own, s.row)] if own.kind is point_mass.KIND and own.rows_each else []
    if own.single is not None:
        return here
    c = next(c for c in searcher.problem.catalogue if c.kind is point_mass.KIND and c.rows_each)
    away = np.linalg.norm(c.xyz - own.xyz[s.row], axis=1)
    away[[len(w["grids"]) > 1 for w in c.where]] = np.inf
    near = np.argsort(away, kind="stable")[: SEARCH.equipment_places]
    return here + [(c, int(row)) for row in near if not (c is own and row == s.row)]


def _stands(structure: Structure, c: Candidates, row: int) -> list[Stand]:
    """Return the places of a suspect, none where one of them holds no equipment."""
    places = places_of(c, row)
    turns = np.eye(3)[None] if c.maps is None else c.maps
    both = zip(places, turns, strict=True)
    found = [stand(structure, own.where[i], turn) for (own, i), turn in both]
    kept = [s for s in found if s is not None]
    return kept if len(kept) == len(found) else []


def _grown(
    searcher: Searcher, state: Fit, q: int, template: Candidates, stands: list[Stand], body: Body
) -> tuple[Searcher, Fit]:
    """Return a hypothesis with the best body in place of one mass, from a body on.

    Where the first step is no good it is given up: no better than the first body.
    """
    best: tuple[Searcher, Fit] | None = None
    look = _looked(searcher, state, q, template, stands, [body], state)
    least = max(state.objective, _fitted(look, state, q, state)[2].objective)
    for step in SEARCH.equipment_steps:
        for _ in range(SEARCH.equipment_rounds):
            tried = _around(body, step * searcher.size, stands[0].axes)
            now = state if best is None else best[1]
            look = _looked(searcher, state, q, template, stands, tried, now)
            k, wide, fit = _fitted(look, state, q, now)
            if best is not None and fit.objective > best[1].objective - SEARCH.better:
                break
            body, best = tried[k], (wide, fit)
            if fit.objective > least - SEARCH.hopeless * SEARCH.equipment_gain:
                return best
    assert best is not None
    return best


@dataclass(frozen=True, eq=False)
class _Look:
    """Bodies in place of one mass: the search that knows them, what each size promises."""

    searcher: Searcher
    trials: Floats
    score: Floats


def _looked(
    searcher: Searcher,
    state: Fit,
    q: int,
    template: Candidates,
    stands: list[Stand],
    bodies: list[Body],
    now: Fit,
) -> _Look:
    """Look at bodies in place of one mass with all else as it stands in the best fit so far."""
    others = state.suspects[:q] + state.suspects[q + 1 :]
    made = equipment(template, stands, bodies)
    wide, kind = _with(searcher, made), len(searcher.problem.catalogue)
    small, here = wide.local(evaluate(wide.problem, now.nuisance, others))
    trials = made.around(
        made.like(now.suspects[q].theta).tolist(), np.array(SEARCH.equipment_sizes)
    )
    score = scan(small, here, kind, np.arange(len(made)), trials) + made.surprise(trials)
    return _Look(wide, trials, score)


def _fitted(look: _Look, state: Fit, q: int, now: Fit) -> tuple[int, Searcher, Fit]:
    """Return which of the bodies fits best in place of one mass, the search and the fit with it.

    Those that promise most are fitted, from a lighter mass as well: which test mode is which may
    hang on it.
    """
    wide, trials, score = look.searcher, look.trials, look.score
    kind, near, fits = len(wide.problem.catalogue) - 1, wide.local(state)[0], []
    for row in np.argsort(score.min(axis=1), kind="stable")[: SEARCH.equipment_tried].tolist():
        for theta in (trials[score[row].argmin()], trials[0]):
            new = Suspect(kind, row, tuple(theta.tolist()))
            suspects = (*state.suspects[:q], new, *state.suspects[q + 1 :])
            fits.append((row, wide.fitted(now, suspects, SEARCH.steps_instead, near)))
    row, fit = min(fits, key=lambda f: f[1].objective)
    return row, wide, fit


def _upright(s: Stand, size: float) -> list[Body]:
    """Return a body at a place, and those above and below a sheet, by steps of two sizes."""
    radius = SEARCH.equipment_steps[-1] * size
    steps = SEARCH.equipment_steps[:2] if s.sheet else ()
    heights = [0.0, *(way * h * size for h in steps for way in (1.0, -1.0))]
    return [_body(h * s.axes[0], radius) for h in heights]


def _body(offset: Floats, radius: float) -> Body:
    x, y, z = (float(v) for v in offset)
    return Body((x, y, z), radius)


def _around(body: Body, step: float, axes: Floats) -> list[Body]:
    """Return a body, and those whose centre, along `axes` (3, 3), or radius differs by a step."""
    moves: Floats = step * np.vstack([axes, -axes])
    off = np.array(body.offset)
    out = [body, *(_body(off + m, body.radius) for m in moves)]
    radii = (body.radius + step, body.radius - step)
    return out + [replace(body, radius=r) for r in radii if r > 0.0]


def _with(searcher: Searcher, made: Candidates) -> Searcher:
    """Return the search with further candidates."""
    p = searcher.problem
    problem = replace(
        p,
        catalogue=(*p.catalogue, made),
        factors=(*p.factors, made.factors(p.basis)),
        missing=(*p.missing, None) if p.missing else (),
    )
    return replace(searcher, problem=problem, coarse=(*searcher.coarse, np.zeros(0, np.int64)))
