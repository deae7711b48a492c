"""What is found against what a model that lacks nothing would leave.

The hypotheses of a search, the known parameters alone among them, are fitted alike by the diffuse
error of a model, smooth fields beside them. A suspect counts where the test is likelier with it by
more than it could have been anywhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np

from ...arrays import Floats
from ...errors import CheckError
from ..effects.element_patches import gives
from ..likelihood.hypothesis import Fit
from ..likelihood.map_fit import evaluate
from ..model_error.diffuse_fit import Judged
from ..model_error.geometry_error import Misshapen
from ..model_error.held_out import agreement, foretold
from ..model_error.model_error_numbers import MODEL_ERROR
from ..model_error.support_reach import Reach
from .credible_places import Place, alike, credible_places, middle
from .found import Found, objective_of
from .last_look import looked_again
from .model_selection import (
    Scored,
    adequacy_of,
    by_such_a_test,
    clear_gain,
    kept,
    needed,
    ranked,
    says_else,
    scored,
    side_by_side,
    stands,
    told_beside,
    without_one,
)
from .moves import Searcher
from .search_numbers import SEARCH


@dataclass(frozen=True, eq=False)
class Completeness:
    """How well the known parameters alone explain a test, and how well what was found does.

    Parameters
    ----------
    deck, alone, best, told : Judged
        The deck as it is; the known parameters alone; the hypothesis that is accepted; that in the
        middle of those as likely, whose places and magnitudes are told.
    gain : float
        ln of how much likelier the test is by the best, its choices paid for.
    last : float
        The same beside one or more suspects fewer.
    ahead : float
        ln of how much likelier it is than its nearest rival: another place, direction or nature.
    agree : float
        By how many standard deviations modes that they were not fitted to agree that the best
        foretells them better than the known parameters alone do.
    places : list of list of Place
        Where each suspect of the best may be.
    reach : Reach or None
        Supports that hold more than the deck says and explain the test as well or better.
    shape : Misshapen or None
        A shape other than drawn that does.
    """

    deck: Judged
    alone: Judged
    best: Judged
    told: Judged
    gain: float
    last: float
    ahead: float
    agree: float
    places: list[list[Place]]
    reach: Reach | None = None
    shape: Misshapen | None = None

    @property
    def moved(self) -> float:
        """Return ln of how much likelier the test is with the known parameters moved."""
        return self.alone.plain - self.deck.evidence

    @property
    def posterior(self) -> float:
        """Probability of the best among what was found and the known parameters alone."""
        alone = np.exp(-self.gain) if self.best is not self.alone else 0.0
        return float(1.0 / (1.0 + np.exp(-self.ahead) + alone))

    @property
    def deviations(self) -> Floats:
        """Standard deviations of the magnitudes that are told, suspect after suspect."""
        n = sum(len(s.theta) for s in self.told.fit.suspects)
        variance = np.diag(np.linalg.pinv(self.told.information))
        return np.asarray(np.sqrt(np.maximum(variance[len(variance) - n :], 0.0)))

    @property
    def clear(self) -> bool:
        """Whether what was found explains more than an error of the model would seem to.

        It has to gain enough, the more where it leaves more than a small part of the error (what is
        not there hardly lessens it), and to be ahead of what else was found, by less where a right
        model may leave as much: the odds are then those of a model that has no error. What the
        set-up may do has no such odds.
        """
        least = max(needed(self.best), clear_gain(self.alone, self.best.diffuse.error))
        ahead = MODEL_ERROR.seen if self.explains and self.reach is None else SEARCH.suspect
        return bool(self.gain > least and self.ahead > ahead)

    @property
    def true(self) -> bool:
        """See `stands`."""
        return stands(self.alone, self.best)

    @property
    def adequacy(self) -> float:
        """Probability that a right model leaves a misfit as large, by a test like this."""
        return adequacy_of(self.best)

    @property
    def explains(self) -> bool:
        """Whether the error is as right models leave it, and hardly a mode unexplained.

        Shapes that are off everywhere by more than sensors are bear no model out.
        """
        usual = by_such_a_test(self.best) > MODEL_ERROR.explained
        return usual and self.legible and self.adequacy > MODEL_ERROR.claimed

    @property
    def legible(self) -> bool:
        """Whether sensors read what the best explanation says within what sensors are off by."""
        return self.best.diffuse.noise < MODEL_ERROR.legible

    @property
    def in_fields(self) -> bool:
        """Whether smooth fields beside the best explanation gain enough to be spoken of."""
        return bool(self.best.drifts and self.best.evidence - self.best.bare > MODEL_ERROR.seen)

    @property
    def lacks_nothing(self) -> bool:
        """See `lacks_nothing`."""
        return lacks_nothing(self.deck, self.alone)

    @property
    def unexplained(self) -> tuple[int, ...]:
        """Test modes that are more likely none of the model's than one that it has, as rows."""
        return tuple(int(k) for k in np.flatnonzero(self.best.diffuse.astray))


def nothing_found(deck: Judged, alone: Judged) -> Completeness:
    """Return how well the known parameters alone explain a test, nothing beside them."""
    return Completeness(deck, alone, alone, alone, 0.0, 0.0, np.inf, 0.0, [])


def lacks_nothing(deck: Judged, alone: Judged) -> bool:
    """Whether what the deck leaves is usual for a good model before a good test.

    And neither the known parameters `alone` nor smooth fields are clearly likelier. The stiffness
    of shells is off as the square of element over wave, as their lumped mass is: a part of what
    lumping does to their frequencies is no gap. Beams have no such excuse. A test that scatters
    by more than such a model errs does not show that nothing is missing.
    """
    clearly = alone.evidence - deck.evidence > MODEL_ERROR.seen
    most = np.hypot(MODEL_ERROR.usual, SEARCH.nothing * deck.lumped)
    shows = np.median(deck.problem.evidence.scatter) <= most
    return bool(shows and not clearly and deck.diffuse.error <= most)


def completeness(
    searcher: Searcher,
    found: Found,
    accepted: int,
    deck: Judged,
) -> tuple[Searcher, Found, int, Completeness]:
    """Return the best of what was found, the number of its suspects, and how well it explains.

    The searcher that comes with it knows the places that were tried on the way.

    The levels up to the accepted one compete, one suspect where it is about as likely as the known
    parameters alone, or where these leave more than right models do; of each the likeliest, the
    richer one less a suspect among them, and, where the richer one does not earn its place over
    these, its rivals and what another look finds. What is not clear is none in a deck that lacks
    nothing. `deck` is how likely the test is by the deck as it is.
    """
    levels = [scored(searcher, found.levels[0])]
    alone = levels[0].judged
    if alone is None:
        raise CheckError("the deck with its known parameters fitted does not solve")
    enough = alone.diffuse.error <= MODEL_ERROR.usual or lacks_nothing(deck, alone)
    near = levels[0].score - SEARCH.suspect
    as_likely = any(scored(searcher, f).score > near for f in found.levels[1:2])
    most = min(max(accepted, int(as_likely or not enough)), len(found.levels) - 1)
    fields: list[list[Scored]] = [[] for _ in range(most + 1)]
    poorer: list[Fit] = []
    for k in range(most, 0, -1):
        richer = fields[k + 1][:1] if k < most else []
        tried = ranked(searcher, (found.levels[k], *poorer), richer)
        tried = [s for s in tried if s not in richer]
        clear = bool(richer) and told_beside(searcher, richer[0], tried[0], levels[0])
        if not clear or side_by_side(searcher, richer[0].fit):
            tried = ranked(searcher, _nearest(found, k), tried)
            first = tried[0]
            if _unsettled(first):
                searcher, again = looked_again(searcher, first, levels[0].score)
                tried += (s for s in again if s is not first)
                found = found.with_rivals(s.fit for s in again if s is not first)
        found = found.with_rivals(poorer)
        fields[k] = _plainest_first(searcher, _from_there(searcher, tried))
        found = found.with_rivals(s.fit for s in fields[k] if s not in tried)
        found = _led(found, fields[k][0].fit)
        poorer = without_one(searcher, fields[k][0].fit) if k > 1 else []
    levels += [field[0] for field in fields[1:]]
    number = kept(searcher, levels)
    best, told, places = _centred(searcher, levels[number], fields[number])
    found = _led(found, told.fit)
    rivals = [s for s in fields[number] if says_else(searcher, told.fit, s.fit)]
    ahead = float(best.score - max((s.score for s in rivals), default=-np.inf))
    assert best.judged is not None
    assert told.judged is not None
    fewer = max((level.score for level in levels[:number]), default=best.score)
    gain, last = best.score - levels[0].score, best.score - fewer
    agree = agreement(foretold(best.judged), foretold(alone)) if number else 0.0
    judged = best.judged, told.judged
    whole = Completeness(deck, alone, *judged, gain, last, ahead, agree, places)
    if not whole.clear and whole.lacks_nothing:
        return searcher, found, 0, nothing_found(deck, alone)
    return searcher, found, number, whole


def _unsettled(best: Scored) -> bool:
    """Whether another look at a hypothesis may change what is said.

    Not at several suspects that leave more error than a right model does.
    """
    adequate = best.judged is not None and by_such_a_test(best.judged) > MODEL_ERROR.adequate
    return adequate or len(best.fit.suspects) < 2


def _centred(
    searcher: Searcher, best: Scored, tried: Sequence[Scored]
) -> tuple[Scored, Scored, list[list[Place]]]:
    """Return a hypothesis, that in the middle of where and how large it may be, and the places.

    What is found does not hang on which of places that are as likely happens to be the best: what
    is at points is put in the middle of them. Of patches that give the places are those that were
    `tried`, the larger one is the less it gives: the one that does the middling is told.
    """
    kinds = [searcher.problem.catalogue[s.kind] for s in best.fit.suspects]
    every: list[list[Place]] = [[] for _ in kinds]
    for q, c in enumerate(kinds):
        if gives(c):
            continue
        places = credible_places(searcher, best.fit, q)
        for _ in range(SEARCH.turns if c.kind.at_points else 0):
            s = places[middle(c, places)].suspect
            if s.row == best.fit.suspects[q].row:
                break
            moved = searcher.fitted(best.fit, best.fit.instead(q, s), SEARCH.steps_new)
            new = scored(searcher, moved)
            if 2.0 * (best.score - new.score) > SEARCH.credible:
                break
            best = new
            places = credible_places(searcher, best.fit, q)
        every[q] = places
    told = best
    for q, c in enumerate(kinds):
        if gives(c):
            others = (s for s in tried if s is not told)
            near, every[q] = alike((told, *others), told, q)
            told = near[middle(c, every[q])]
    return best, told, every


def _from_there(searcher: Searcher, tried: Sequence[Scored]) -> list[Scored]:
    """Return hypotheses, the likeliest rivals fitted from where the best has the parameters too.

    By the error of a model the likelihood has several maxima: which of them a hypothesis climbs to
    hangs on where its search left the known parameters. Of rivals that say the same one.
    """
    out = ranked(searcher, (), tried)
    best = None
    while best is not out[0]:
        best, others = out[0], list[Scored]()
        for s in out[1:]:
            if all(says_else(searcher, o.fit, s.fit) for o in (best, *others)) and s.judged:
                others.append(s)
        for s in others[: SEARCH.look_judged]:
            assert best.judged is not None
            assert s.judged is not None
            there = best.judged.fit.nuisance, s.judged.fit.suspects
            new = scored(searcher, evaluate(searcher.problem, *there), best)
            if new.score > s.score + SEARCH.likelier:
                out[out.index(s)] = new
        out = ranked(searcher, (), out)
    return out


def _plainest_first(searcher: Searcher, tried: Sequence[Scored]) -> list[Scored]:
    """Return hypotheses, the likeliest first, or what says the same with fewer places.

    A mass between two grids is about as likely as half of it at each.
    """
    best = tried[0]

    def same(s: Scored) -> bool:
        near = best.score - s.score < SEARCH.suspect
        return near and not any(
            says_else(searcher, *fits) for fits in permutations((best.fit, s.fit))
        )

    def places(s: Scored) -> int:
        return sum(searcher.problem.catalogue[t.kind].many(t.row) for t in s.fit.suspects)

    first = min(filter(same, tried), key=places)
    return [first, *(s for s in tried if s is not first)]


def _nearest(found: Found, k: int) -> list[Fit]:
    """Return those with so many suspects that come nearest to the best.

    However much less these gain: beside an error of the model what fits worse may be likelier.
    """
    return sorted(found.rivals[k], key=objective_of)[: SEARCH.rivals]


def _led(found: Found, best: Fit) -> Found:
    """Return what was found led by one of the rivals of as many suspects."""
    k = len(best.suspects)
    rest = tuple(f for f in (found.levels[k], *found.rivals[k]) if f is not best)
    rivals = (*found.rivals[:k], rest, *found.rivals[k + 1 :])
    return Found(found.with_level(best).levels, rivals)
