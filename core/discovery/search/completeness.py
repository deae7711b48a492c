"""What is found against what a model that lacks nothing would leave.

The hypotheses of a search, the known parameters alone among them, are fitted alike by the diffuse
error of a model, smooth fields beside them. A suspect counts where the test is likelier with it by
more than it could have been anywhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Floats
from ...errors import CheckError
from ..model_error.adequacy import adequacy
from ..model_error.diffuse_fit import Judged
from .beam_search import Found
from .model_selection import Judgement, contenders, cost, needed, scored
from .moves import Searcher
from .search_numbers import SEARCH


@dataclass(frozen=True, eq=False)
class Completeness:
    """How well the known parameters alone explain a test, and how well what was found does.

    Parameters
    ----------
    deck, alone, best : Judged
        The deck as it is; the known parameters alone; the hypothesis that is accepted.
    gain : float
        ln of how much likelier the test is by the best, its choices paid for.
    last : float
        The same beside one or more suspects fewer.
    ahead : float
        ln of how much likelier it is than its nearest rival elsewhere.
    hz : (n_test,) float
        Of the test modes.
    """

    deck: Judged
    alone: Judged
    best: Judged
    gain: float
    last: float
    ahead: float
    hz: Floats

    @property
    def moved(self) -> float:
        """Return ln of how much likelier the test is with the known parameters moved."""
        return self.alone.plain - self.deck.evidence

    @property
    def clear(self) -> bool:
        """Whether what was found explains more than an error of the model would seem to.

        What moves modes at an end of the band alone may be an error of those.
        """
        error = self.best.diffuse.error
        gained = self.best.diffuse.each - self.alone.diffuse.each
        order = np.argsort(self.hz)
        inner = float(np.sum(gained[order[SEARCH.ends : -SEARCH.ends]]))
        return bool(
            self.gain > needed(error)
            and self.ahead > SEARCH.ahead
            and inner > SEARCH.inner * float(np.sum(gained))
            and len(self.unexplained) <= SEARCH.strays * len(gained)
        )

    @property
    def adequacy(self) -> float:
        """Probability that a right model would leave an error as large as the best."""
        return adequacy(self.best.diffuse.error)

    @property
    def unexplained(self) -> tuple[int, ...]:
        """Test modes that are more likely none of the model's than one that it has, as rows."""
        return tuple(int(k) for k in np.flatnonzero(self.best.diffuse.stray > 0.5))


def completeness(
    searcher: Searcher,
    found: Found,
    verdict: Judgement,
    deck: Judged,
) -> tuple[Found, int, Completeness]:
    """Return the best of what was found, the number of its suspects, and how well it explains.

    The levels up to the accepted one compete, then what is found with the nearest rivals. `deck`
    is how likely the test is by the deck as it is.
    """
    levels = [scored(searcher, f) for f in found.levels[: verdict.accepted + 1]]
    kept = 0
    for k, level in enumerate(levels[1:], start=1):
        least = needed(level.judged.diffuse.error) if kept and level.judged else SEARCH.suspect
        if level.score - levels[kept].score > least:
            kept = k
    tried = sorted(
        contenders(searcher, found, kept), key=lambda f: cost(searcher, f, verdict.scale)
    )
    tried = [f for f in tried if len(f.suspects) == kept][: SEARCH.rivals_judged if kept else 0]
    others = (scored(searcher, f) for f in tried)
    field = sorted([levels[kept], *others], key=lambda s: -s.score)
    best, alone = field[0], levels[0]
    ahead = best.score - field[1].score if len(field) > 1 else np.inf
    if best is not levels[kept]:
        rest = tuple(f for f in found.rivals[kept] if f is not best.fit)
        rivals = (*found.rivals[:kept], (levels[kept].fit, *rest), *found.rivals[kept + 1 :])
        found = Found((*found.levels[:kept], best.fit, *found.levels[kept + 1 :]), rivals)
    if best.judged is None or alone.judged is None:
        raise CheckError("the deck with its known parameters fitted does not solve")
    fewer = max((level.score for level in levels[:kept]), default=best.score)
    gain, last = best.score - alone.score, best.score - fewer
    hz = searcher.problem.whole.frequencies_hz
    return found, kept, Completeness(deck, alone.judged, best.judged, gain, last, float(ahead), hz)
