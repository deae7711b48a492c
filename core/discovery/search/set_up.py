"""What the set-up of a test does that no effect of the list is: its clamps reach further in."""

from dataclasses import replace

import numpy as np

from ..effects.candidates import Suspect
from ..likelihood.hypothesis import Fit
from ..likelihood.map_fit import fit
from ..model_error.support_reach import Reach, Reaches
from .completeness import Completeness, nothing_found
from .found import Found
from .model_selection import scored
from .moves import Searcher
from .search_numbers import SEARCH


def beside_reach(
    searcher: Searcher, found: Found, kept: int, whole: Completeness, reaches: Reaches | None
) -> tuple[int, Completeness]:
    """Return how many of what was found are told where clamps may reach further in.

    None where that is likelier: patches and springs beside a support imitate it. Else what was
    found has to be as far ahead of it as of anything elsewhere.
    """
    reach = _best_reach(searcher, found.levels[0], reaches)
    if reach is None or reach.score - whole.alone.evidence < SEARCH.suspect:
        return kept, whole
    if not kept:
        return 0, replace(whole, reach=reach)
    ahead = scored(searcher, found.levels[kept]).score - reach.score
    if ahead < 0.0:
        return 0, replace(nothing_found(whole.deck, whole.alone), reach=reach)
    told = reach if ahead < SEARCH.suspect else None
    return kept, replace(whole, ahead=min(whole.ahead, ahead), reach=told)


def _best_reach(searcher: Searcher, null: Fit, reaches: Reaches | None) -> Reach | None:
    """Return the likeliest reach beside the known parameters, None where there is none."""
    if reaches is None:
        return None
    p = searcher.problem
    p = replace(p, catalogue=(reaches,), factors=(reaches.factors(p.basis),), missing=())
    tried = []
    for row in range(len(reaches)):
        start = Suspect(0, row, tuple(reaches.typical))
        f = fit(p, null.nuisance, (start,), searcher.active, SEARCH.steps)
        judged = searcher.judged(p, f)
        if judged is not None:
            ((theta,),) = (s.theta for s in judged.fit.suspects)
            near, far = reaches.far[row : row + 2]
            held = float(far - (far - near) * np.exp(-theta))
            tried.append(Reach(held, judged.evidence - float(np.log(len(reaches)))))
    return max(tried, key=lambda r: r.score, default=None)
