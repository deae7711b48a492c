"""What is found against what a model that lacks nothing would leave.

The hypotheses of a search, the known parameters alone among them, are fitted alike by the diffuse
error of a model, smooth fields beside them. A suspect counts where the test is likelier with it by
more than it could have been anywhere.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...arrays import Floats
from ..likelihood.hypothesis import Fit
from ..model_error.adequacy import adequacy
from ..model_error.diffuse_fit import Judged
from .beam_search import Found
from .model_selection import choices
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
    hz : (n_test,) float
        Of the test modes.
    """

    deck: Judged
    alone: Judged
    best: Judged
    gain: float
    hz: Floats

    @property
    def moved(self) -> float:
        """Return ln of how much likelier the test is with the known parameters moved."""
        return self.alone.plain - self.deck.evidence

    @property
    def clear(self) -> bool:
        """Whether what was found explains more than an error of the model would seem to.

        The larger the error that is left, the more of it the likeliest place of the likeliest kind
        takes up; what moves modes at an end of the band alone may be an error of those.
        """
        error = self.best.diffuse.error
        gained = self.best.diffuse.each - self.alone.diffuse.each
        order = np.argsort(self.hz)
        inner = float(np.sum(gained[order[SEARCH.ends : -SEARCH.ends]]))
        return bool(
            self.gain > SEARCH.claimed * (1.0 + error / SEARCH.imitated)
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
    searcher: Searcher, found: Found, accepted: int, deck: Judged, judge: Callable[[Fit], Judged]
) -> tuple[int, Completeness]:
    """Return how many suspects of those `accepted` earn their places, and how well they explain.

    `deck` is how likely the test is by the deck as it is; ``judge(fit)`` says that of hypotheses.
    """
    judged = [judge(f) for f in found.levels[: accepted + 1]]
    scores = [
        j.evidence - sum(float(np.log(choices(searcher, s))) for s in f.suspects)
        for j, f in zip(judged, found.levels, strict=False)
    ]
    best = max(range(len(scores)), key=lambda k: scores[k] - SEARCH.suspect * k)
    gain = scores[best] - scores[0]
    hz = searcher.problem.whole.frequencies_hz
    return best, Completeness(deck, judged[0], judged[best], gain, hz)
