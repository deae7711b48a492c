"""Simple explanations first; kinds that imitate others where these leave much.

A mass on a spring has one magnitude more than a mass or a spring and can imitate either until all
that is missing stands where it should; a spring may join any two places. So the search runs
without such kinds first. Then one of them is put beside every level of what was found; from the
best of these the search goes on with the others, and the likelier of the two outcomes counts.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ..likelihood.hypothesis import Fit
from ..reduction.elements_and_supports import Structure
from .beam_search import grown
from .equipment_growth import equipped
from .found import Found, objective_of
from .model_selection import (
    adequate,
    chosen,
    complete,
    hopeless,
    matched,
    ranked,
    scored,
    usual,
)
from .moves import Searcher
from .search_numbers import SEARCH


def searched(
    searcher: Searcher,
    progress: Callable[[str], None] = lambda _: None,
    explained: Callable[[Searcher, Fit], bool] = lambda s, f: usual(s, f),
) -> Found:
    """Search with all kinds but the late ones, and with these where much is left.

    ``explained(searcher, best)`` says where not. A tuned one is not looked for where an adequate
    explanation of every mode was found: it would imitate what that leaves. Where not even one
    suspect pays, late kinds are tried beside the best one as well: two that hide each other hardly
    pay alone.
    """
    kinds = [c.kind.late for c in searcher.problem.catalogue]
    simple = _with(searcher, [not late for late in kinds])

    def explains(f: Fit) -> bool:
        """Whether a hypothesis leaves nothing, or masses on footprints what right models do."""
        laws = [searcher.problem.catalogue[s.kind].law for s in f.suspects]
        masses = bool(laws) and all(law.acts_on == "M" for law in laws)
        laid = masses and adequate(simple, f) and explained(searcher, f)
        return laid or complete(simple, f)

    found = grown(simple, progress, explains=explains)
    best = chosen(searcher, found)
    if not any(kinds) or explained(searcher, found.levels[best]):
        return found
    stands = bool(best) and adequate(searcher, found.levels[best])
    if (stands and matched(searcher, found.levels[best])) or complete(searcher, found.levels[-1]):
        tuned = (c.tunings > 1 for c in searcher.problem.catalogue)
        kinds = [late and not t for late, t in zip(kinds, tuned, strict=True)]
    progress("looking for absorbers and for springs between two places")
    alone = _with(searcher, kinds)
    first = best - 1 if stands else 0
    simpler = (*found.levels[1:], None)
    beside = [
        f for k in range(first, best + 1) for f in _beside(alone, found.levels[k], simpler[k])
    ]
    if not best:
        beside += [f for level in found.levels[1:2] for f in _beside(alone, level, few=1)]
    best_so_far = scored(searcher, found.levels[best])
    top = next(iter(ranked(searcher, beside)), best_so_far)
    if top.score <= best_so_far.score:
        return found.with_rivals(f for f in beside if len(f.suspects) <= best)
    levels = [*found.levels[: len(top.fit.suspects)], top.fit]
    return _likelier(searcher, found, grown(simple, progress, levels))


def _likelier(searcher: Searcher, *ways: Found) -> Found:
    """Return the likelier of two outcomes with the hypotheses of the other among its rivals."""
    other, found = sorted(ways, key=lambda way: _evidence(searcher, way))
    levels = len(found.rivals)
    others = (f for level in other.rivals[:levels] for f in level)
    return found.with_rivals((*other.levels[1:levels], *others))


def on_stands(
    structure: Structure,
    searcher: Searcher,
    found: Found,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[Searcher, Found]:
    """Put masses on stands; where one does, search on from it.

    What was found beside a mass on no stand made up for its stand. Not where little is left.
    """
    searcher, new = _stood(structure, searcher, found)
    pairs = enumerate(zip(new.levels, found.levels, strict=True))
    first = next((k for k, (f, old) in pairs if f is not old), None)
    if first is None or usual(searcher, new.levels[chosen(searcher, new)]):
        return searcher, new
    progress("searching on beside equipment on its stand")
    simple = _with(searcher, [not c.kind.late for c in searcher.problem.catalogue])
    other = grown(simple, progress, new.levels[: first + 1])
    searcher, other = _stood(structure, searcher, other, new.levels)
    return searcher, _likelier(searcher, new, other)


def _stood(
    structure: Structure, searcher: Searcher, found: Found, done: Sequence[Fit] = ()
) -> tuple[Searcher, Found]:
    """Put masses on stands in what is chosen, with a suspect less, and with one more if likelier.

    Not in what is `done`.
    """
    number, levels = chosen(searcher, found), list(found.levels)
    for k in range(max(number - 1, 1), min(number + 2, len(levels))):
        ahead = scored(searcher, levels[k]).score - scored(searcher, levels[number]).score
        if (k <= number or ahead > 0.0) and levels[k] not in done:
            searcher, levels[k] = equipped(structure, searcher, levels[k])
    return searcher, Found(tuple(levels), found.rivals)


def _evidence(searcher: Searcher, found: Found) -> float:
    """Return ln of the evidence for what is chosen of an outcome, by the error of the model."""
    return scored(searcher, found.levels[chosen(searcher, found)]).score


def _with(searcher: Searcher, kinds: list[bool]) -> Searcher:
    """Return a searcher that looks for some kinds alone."""
    none = np.zeros(0, np.int64)
    coarse = tuple(
        rows if wanted else none for rows, wanted in zip(searcher.coarse, kinds, strict=True)
    )
    return replace(searcher, coarse=coarse)


def _beside(
    searcher: Searcher, state: Fit, simpler: Fit | None = None, few: int = SEARCH.late_moved
) -> list[Fit]:
    """Return the best fit of a state with one more suspect of each kind.

    Of the best `few`, each moved to better neighbours: the first scan sees but few of the links,
    and one that is right but for its ends gains no more there than others. None of a kind that
    gains next to nothing, none moved that gains far less than a `simpler` one beside the state.
    """
    worth = SEARCH.late_worth * (state.objective - simpler.objective if simpler else 0.0)
    fits: dict[int, list[Fit]] = {}
    for _, branch in searcher.branches(state, SEARCH.late_tried):
        new = searcher.fitted(state, (*state.suspects, branch), SEARCH.steps_new, soften=True)
        if not hopeless(searcher, state, new):
            fits.setdefault(branch.kind, []).append(new)
    first = [sorted(own, key=objective_of)[:few] for own in fits.values()]
    moved = (
        [searcher.refined(f) if state.objective - f.objective > worth else f for f in own]
        for own in first
    )
    return [min(own, key=objective_of) for own in moved]
