"""Is there a better place, by what the claim is weighed by.

The search goes by a robust misfit at known parameters that have already taken up a part of what is
missing, and moves a suspect to its neighbours alone. A wrong place with other parameters may be the
best there is nearby, while elsewhere, with another size, the test is far likelier by the error of
the model. So what is to be claimed is looked for anew with that measure: every suspect in turn, of
many the one that is missed least, is taken out, every place of every kind and size is tried beside
the others, and the best is moved to the next places and shapes for as long as this makes the test
likelier.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..effects.candidates import Suspect
from ..effects.element_patches import area_of, gives
from ..likelihood.hypothesis import Fit
from ..likelihood.map_fit import evaluate
from .coarse_scan import look
from .found import objective_of
from .model_selection import Scored, needed, ranked, says_else
from .moves import Searcher
from .patch_reshaping import options_beside, promising
from .search_numbers import SEARCH


def looked_again(searcher: Searcher, first: Scored, alone: float) -> tuple[Searcher, list[Scored]]:
    """Return all that was tried instead of a hypothesis, itself among it, the likeliest first.

    What comes next elsewhere is moved as far as the best, if it may get ahead; what comes next of
    other kinds if it gains nearly as much over the known parameters alone, whose score is `alone`:
    between the places of a scan a tuned one gains far less. The searcher that comes with it knows
    the shapes that were tried.
    """
    tried = [first]
    for q in searcher.doubtful(first.fit, len(first.fit.suspects)):
        tried = ranked(searcher, _elsewhere(searcher, first.fit, q), tried)
        tried = ranked(searcher, _other_kinds(searcher, first.fit, q), tried)
    searcher, moved = _moved(searcher, tried[0], tried)
    tried = ranked(searcher, (), [*tried, *moved])
    best = tried[0]
    others = [s for s in tried if says_else(searcher, best.fit, s.fit)]
    apart = [s for s in others if _kinds(searcher, s.fit) != _kinds(searcher, best.fit)]
    near = needed(best.judged) if best.judged else 0.0
    for field, within in ((others, near), (apart, SEARCH.nearly * (best.score - alone))):
        if field and best.score - field[0].score < within:
            searcher, moved = _moved(searcher, field[0], tried)
            tried += moved
    return searcher, ranked(searcher, (), tried)


def _kinds(searcher: Searcher, f: Fit) -> list[str]:
    return sorted(searcher.problem.catalogue[s.kind].kind.name for s in f.suspects)


def _elsewhere(searcher: Searcher, state: Fit, q: int) -> list[Fit]:
    """Return fits with another suspect anywhere in place of one, if they gain nearly as much."""
    without = evaluate(searcher.problem, state.nuisance, state.others(q))
    branches = searcher.branches(without, SEARCH.look_each, soft=False)
    tried = [
        searcher.fitted(without, (*without.suspects, s), SEARCH.steps_new, soften=True)
        for _, s in branches[: SEARCH.look_fitted]
    ]
    far = SEARCH.nearly * (without.objective - state.objective)
    close = [f for f in tried if f.objective - state.objective < far]
    return sorted(close, key=objective_of)[: SEARCH.look_judged]


def _other_kinds(searcher: Searcher, state: Fit, q: int) -> list[Fit]:
    """Return fits with effects of another nature near a suspect in its place, the best of each.

    However well they fit: a beam's joint may be a softer beam, a heavy patch a soft one.
    """
    s = state.suspects[q]
    own = searcher.problem.catalogue[s.kind]
    without = evaluate(searcher.problem, state.nuisance, state.others(q))
    small, here = searcher.local(without)
    found: list[tuple[float, Suspect]] = []
    for kind, c in enumerate(searcher.problem.catalogue):
        away = np.linalg.norm(c.xyz - own.xyz[s.row], axis=1)
        rows = np.flatnonzero(away < SEARCH.near * searcher.size)
        alike = c.kind is own.kind or c.kind.joins(own.kind)
        if alike or c.kind.late or not len(rows):
            continue
        seen = look(small, here, kind, rows)
        best = int(seen.cost.argmin())
        new = Suspect(kind, int(seen.rows[best]), tuple(seen.theta[best]))
        found.append((float(seen.cost[best]), new))
    nearest = sorted(found, key=lambda f: f[0])[: SEARCH.look_judged]
    return [
        searcher.fitted(without, (*without.suspects, new), SEARCH.steps_new, soften=True)
        for _, new in nearest
    ]


def _moved(
    searcher: Searcher, best: Scored, known: Sequence[Scored]
) -> tuple[Searcher, list[Scored]]:
    """Return the hypotheses that come of one whose suspects move to the next places and shapes.

    Each once. Where they move is told by the evidence alone; a patch that gives pays besides for
    the choice of shapes that there was.
    """
    out: list[Scored] = []
    seen = {_shape(searcher, s.fit) for s in known}
    paid = dict[int, float]()
    for _ in range(SEARCH.rounds):
        before = best.score
        for q in range(len(best.fit.suspects)):
            c = searcher.problem.catalogue[best.fit.suspects[q].kind]
            searcher, fits = _beside(searcher, best, q)
            fits = [f for f in fits if _shape(searcher, f) not in seen]
            seen |= {_shape(searcher, f) for f in fits}
            first, *_ = both = ranked(searcher, fits, [best])
            new = [s for s in both if s is not best]
            now = paid | {q: float(np.log1p(len(fits)))} if gives(c) else paid
            out += (replace(s, score=s.score - sum(now.values())) for s in new)
            best, paid = first, paid if first is best else now
        if best.score < before + SEARCH.likelier:
            break
    return searcher, out


def _shape(searcher: Searcher, f: Fit) -> str:
    """Return what tells hypotheses apart, magnitudes aside: kinds, places and shapes."""
    catalogue = searcher.problem.catalogue
    return repr([(s.kind, catalogue[s.kind].where[s.row]) for s in f.suspects])


def _beside(searcher: Searcher, best: Scored, q: int) -> tuple[Searcher, list[Fit]]:
    """Return fits with a suspect at the next places and of the next shapes.

    None where there is no next place: what lies on a footprint lies where it fits best. The basis
    of the search is too stiff for a patch that gives, the more so the larger it is: what shape it
    has is told by bases of their own alone.
    """
    state, s = best.fit, best.fit.suspects[q]
    c = searcher.problem.catalogue[s.kind]
    near = [Suspect(s.kind, int(r), s.theta) for r in searcher.around(s.kind, s.row) if r != s.row]
    if not near and not gives(c):
        return searcher, []
    searcher, options = options_beside(searcher, s)
    if gives(c) and best.judged:
        now = best.judged.fit
        moved = (_as_much(searcher, now.suspects[q], o) for o in options)
        tried = [evaluate(searcher.problem, now.nuisance, state.instead(q, o)) for o in moved]
        return searcher, tried
    options = promising(searcher, state, q, [*options, *near], SEARCH.look_sizes)
    tried = [
        searcher.fitted(state, state.instead(q, option), SEARCH.steps_new)
        for option in options[: SEARCH.look_beside]
    ]
    return searcher, sorted(tried, key=objective_of)[: SEARCH.look_beside_judged]


def _as_much(searcher: Searcher, suspect: Suspect, other: Suspect) -> Suspect:
    """Return a patch of another shape that gives as much: the larger it is the less anywhere."""
    had, has = (
        area_of(c.structure, c.patches[s.row])
        for s in (suspect, other)
        if gives(c := searcher.problem.catalogue[s.kind])
    )
    return other.moved(had / has * np.array(suspect.theta))
