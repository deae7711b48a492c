"""Does a richer hypothesis earn its place, and what else could it be."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Bools, Floats
from ..effects.candidates import Candidates, Suspect, apart
from ..effects.effect_numbers import EFFECTS
from ..equipment.bodies import grown
from ..likelihood.frf_evidence import misfit_of_responses
from ..likelihood.hypothesis import Fit, unmatched
from ..likelihood.map_fit import evaluate, mode_misfits, solve
from ..model_error.adequacy import adequacy, as_many_astray
from ..model_error.diffuse_fit import Judged
from ..model_error.model_error_numbers import MODEL_ERROR
from .found import Found, noise_scale
from .moves import Searcher
from .search_numbers import SEARCH


def price(searcher: Searcher, suspect: Suspect) -> float:
    """Return what a suspect must lower the objective by: twice ln(choices) and a margin."""
    return 2.0 * float(np.log(choices(searcher, suspect))) + SEARCH.margin


def choices(searcher: Searcher, suspect: Suspect) -> int:
    """Return the number of places of a kind times what it may be tuned to, times that of kinds."""
    catalogue = searcher.problem.catalogue
    kind = catalogue[suspect.kind].kind
    number = sum(
        len(rows) * c.tunings
        for c, rows in zip(catalogue, searcher.coarse, strict=True)
        if c.kind == kind
    )
    return max(number, 2) * len({c.kind for c in catalogue})


def side_by_side(searcher: Searcher, f: Fit) -> list[tuple[int, int]]:
    """Return numbers of suspects that may be one effect: each with the first beside it before."""
    catalogue = searcher.problem.catalogue
    found = dict[int, int]()
    for i, s in enumerate(f.suspects):
        for j, t in enumerate(f.suspects[:i]):
            a, b = catalogue[s.kind], catalogue[t.kind]
            apart = float(np.linalg.norm(a.xyz[s.row] - b.xyz[t.row]))
            if a.law.acts_on == b.law.acts_on and apart < SEARCH.beside * searcher.size:
                found.setdefault(i, j)
    return [(j, i) for i, j in found.items()]


def chosen(searcher: Searcher, found: Found) -> int:
    """Return the number of suspects that earn their place, see `kept`, or that may yet.

    Modes and sensors that were held out from the search count as well as those that it fitted:
    an effect that does not foretell them loses what it gained. Where the known parameters alone are
    not adequate, one suspect is worth a closer look.
    """
    levels = [scored(searcher, f) for f in found.levels]
    least = 0 if leaves_as_right_models(levels[0].judged) else 1
    return min(max(kept(searcher, levels), least), len(levels) - 1)


def stands(alone: Judged, best: Judged) -> bool:
    """Whether what is left, modes and error, is usual enough for what was found to be claimed.

    The larger a part of the error of the known parameters `alone` it is, the more usual it has to
    be: two causes that look alike take away much of the error, the right one nearly all of it. Of
    modes that the known parameters do not explain at all their error says nothing.
    """
    before, after = (np.count_nonzero(j.diffuse.astray) for j in (alone, best))
    left = best.diffuse.error / alone.diffuse.error
    least = SEARCH.usual_left * left if before <= after else 0.0
    return bool(adequacy_of(best) > MODEL_ERROR.claimed and by_such_a_test(best) > least)


def says_else(searcher: Searcher, best: Fit, f: Fit) -> bool:
    """Whether a hypothesis lacks an effect of the best one: another place, another nature."""
    return bool(_unmatched(searcher, best, f)[0])


@dataclass(frozen=True, eq=False)
class Scored:
    """A hypothesis, what the diffuse error makes of it, its evidence less its choices."""

    fit: Fit
    judged: Judged | None
    score: float


def scored(searcher: Searcher, f: Fit, best: Scored | None = None) -> Scored:
    """Return a hypothesis with its evidence, less ln of the number of choices it had.

    Of bodies of equipment that is known. Where the `best` is so far ahead that it does not matter,
    smooth fields are not tried.
    """
    paid = sum(float(np.log(choices(searcher, s))) for s in f.suspects)
    bodies = (grown(searcher.problem.catalogue[s.kind], s.row) for s in f.suspects)
    paid += sum(body.paid for body in bodies if body)
    least = -np.inf
    if best and best.judged:
        least = best.score - needed(best.judged) + paid
    judged = searcher.judged(searcher.problem, f, least)
    if judged is None:
        return Scored(f, None, -np.inf)
    heard = 0.5 * misfit_of_responses(searcher.problem, f)
    return Scored(f, judged, judged.evidence - paid - heard)


def ranked(searcher: Searcher, fits: Iterable[Fit], known: Sequence[Scored] = ()) -> list[Scored]:
    """Return what is `known` and more hypotheses, the likeliest first."""
    out = list(known)
    for f in fits:
        out.append(scored(searcher, f, max(out, key=lambda s: s.score, default=None)))
    return sorted(out, key=lambda s: -s.score)


def needed(judged: Judged) -> float:
    """Return the gain, ln of a likelihood, that an effect needs beside the error that is left.

    Over the known parameters alone, and over any other effect. An error of the model has a
    likeliest place as well, and what that gains is a share of what every mode says: `claimed` a
    mode is more than it, whatever the error that is left; where right models leave as much half of
    the time, 1 is. Less than right models leave is a fit of so few modes, and no proof.
    """
    a_mode = SEARCH.claimed ** max(1.0 - 2.0 * by_such_a_test(judged), 0.0)
    return float(max(SEARCH.suspect, a_mode * len(judged.diffuse.each)))


def kept(searcher: Searcher, levels: Sequence[Scored]) -> int:
    """Return the number of the richest hypothesis that is told beside the poorer ones.

    0 where it gains less over the first than `worth_telling`, or leaves more than that does.
    """
    best = 0
    for k, level in enumerate(levels[1:], start=1):
        if told_beside(searcher, level, levels[best], levels[0]):
            best = k
    alone, judged = levels[0].judged, levels[best].judged
    if alone and judged and best:
        least = worth_telling(alone, judged.diffuse.error)
        if levels[best].score - levels[0].score < least or _leaves_more(judged, alone):
            return 0
    return best


def _leaves_more(judged: Judged, alone: Judged) -> bool:
    """Whether a hypothesis leaves more error, and no fewer modes that nothing explains.

    More by less than the noise of readings falls is not more: where hardly a mode pairs, shapes
    that are none of the model's are noise, and once they pair they bear its error.
    """
    now, before = judged.diffuse, alone.diffuse
    more = now.error * now.noise > before.error * before.noise and now.error > before.error
    return bool(more and np.count_nonzero(now.astray) >= np.count_nonzero(before.astray))


def clear_gain(alone: Judged, error: float) -> float:
    """Return the gain over the known parameters `alone` below which nothing is clear.

    An error of the model has a likeliest place too, and where more than a small part of it is
    left, the `error`, what gains less a mode was never right.
    """
    small = error < SEARCH.small_part * alone.diffuse.error
    return 0.0 if small else SEARCH.each_mode * len(alone.diffuse.each)


def worth_telling(alone: Judged, error: float) -> float:
    """Return the gain below which nothing is told of, not in doubt either.

    What nearly gains enough is in doubt: "nothing" and "clear" are never neighbours.
    """
    return max(clear_gain(alone, error) - SEARCH.suspect, 0.0)


def earned(richer: Scored, poorer: Scored) -> bool:
    """Whether a richer hypothesis is likelier than a poorer one by what each effect more needs.

    What an effect more explains of an error that right models leave half of the time is most
    likely such an error: there it needs `claimed` a mode.
    """
    gain = _gain_each(richer, poorer)
    if richer.judged is None or poorer.judged is None or not poorer.fit.suspects:
        return gain > SEARCH.suspect
    if by_such_a_test(poorer.judged) > 0.5:
        return gain > SEARCH.claimed * len(richer.judged.diffuse.each)
    return gain > needed(richer.judged)


def told_beside(searcher: Searcher, richer: Scored, poorer: Scored, alone: Scored) -> bool:
    """Whether a richer hypothesis earns its place and is no rest of what the poorer one has.

    An effect of another shape than those of the catalogue leaves a share of what it gains over the
    known parameters `alone`, which one more of its nature beside it takes up: that one has to gain
    more than such a share, and `claimed` a mode.
    """
    if not earned(richer, poorer):
        return False
    if len(side_by_side(searcher, richer.fit)) <= len(side_by_side(searcher, poorer.fit)):
        return True
    rest = SEARCH.rest * (poorer.score - alone.score)
    least = SEARCH.claimed * len(richer.judged.diffuse.each) if richer.judged else np.inf
    return _gain_each(richer, poorer) > max(rest, least)


def without_one(searcher: Searcher, f: Fit) -> list[Fit]:
    """Return a hypothesis without one of its suspects, each in turn, nothing else moved."""
    each = range(len(f.suspects))
    return [evaluate(searcher.problem, f.nuisance, f.others(q)) for q in each]


def without_one_to_spare(searcher: Searcher, f: Fit, null: Fit) -> Fit | None:
    """Return a hypothesis less the suspect that it misses least, None where that earns its place.

    None either where it is all that is left.
    """
    if len(f.suspects) < 2:
        return None
    richer = scored(searcher, f)
    poorer = ranked(searcher, without_one(searcher, f), [richer])
    first = next(s for s in poorer if s is not richer)
    kept = told_beside(searcher, richer, first, scored(searcher, null))
    return None if kept else first.fit


def _gain_each(richer: Scored, poorer: Scored) -> float:
    """Return the gain of a richer hypothesis over a poorer one for each suspect more."""
    more = len(richer.fit.suspects) - len(poorer.fit.suspects)
    return (richer.score - poorer.score) / max(more, 1)


def by_such_a_test(judged: Judged) -> float:
    """Return the probability that a right model leaves an error as large, by a test like this."""
    return adequacy(judged.diffuse.error, judged.diffuse.noise)


def adequacy_of(judged: Judged) -> float:
    """Return the same of an error as large and of as many modes that nothing explains."""
    return by_such_a_test(judged) * _as_many_astray(judged)


def _as_many_astray(judged: Judged) -> float:
    """Return the probability that a right model leaves as many modes that nothing explains."""
    astray = judged.diffuse.astray
    return as_many_astray(int(np.count_nonzero(astray)), len(astray))


def complete(searcher: Searcher, f: Fit) -> bool:
    """Whether a hypothesis leaves no error that could be told from scatter."""
    judged = searcher.judged(searcher.problem, f)
    return judged is not None and judged.diffuse.complete


def usual(searcher: Searcher, f: Fit) -> bool:
    """Whether a hypothesis leaves no more error than right models usually do."""
    judged = searcher.judged(searcher.problem, f)
    return judged is not None and judged.diffuse.error <= MODEL_ERROR.usual


def matched(searcher: Searcher, f: Fit) -> bool:
    """Whether every test mode is one of a hypothesis'."""
    judged = searcher.judged(searcher.problem, f)
    return judged is not None and not judged.diffuse.astray.any()


def adequate(searcher: Searcher, f: Fit) -> bool:
    """Whether a hypothesis leaves an error as right models do, and hardly a mode unexplained."""
    return leaves_as_right_models(searcher.judged(searcher.problem, f))


def leaves_as_right_models(judged: Judged | None) -> bool:
    """Whether an error as large, and as many modes astray, are no rarity in any test."""
    if judged is None:
        return False
    rare = min(adequacy(judged.diffuse.error), _as_many_astray(judged))
    return rare > MODEL_ERROR.adequate


def hopeless(searcher: Searcher, previous: Fit, best: Fit) -> bool:
    """Whether one more suspect gains next to nothing of its price before it is moved about."""
    return _worth(searcher, previous, best) < SEARCH.hopeless


def _worth(searcher: Searcher, previous: Fit, best: Fit) -> float:
    """Return what one more suspect gains in the fit, over its price."""
    return (previous.objective - best.objective) / max(price(searcher, s) for s in best.suspects)


def enough(searcher: Searcher, previous: Fit, best: Fit) -> bool:
    """Whether one more suspect neither pays well nor earns its place, which ends the search.

    By the error of the model one may earn it that hardly fits better: modes that are far off count
    alike, however far. What pays well may beside another one; not what an adequate one leaves.
    """
    if _worth(searcher, previous, best) > SEARCH.pays and not adequate(searcher, previous):
        return False
    before = scored(searcher, previous)
    return not earned(scored(searcher, best, before), before)


def _unmatched(
    searcher: Searcher,
    best: Fit,
    f: Fit,
    by_nature: bool = True,
) -> tuple[list[int], list[Suspect]]:
    """Numbers of the suspects of the best that a rival does not have, and what it has instead.

    A mass that is spread out and one that is not, at one place, say the same `by_nature`, and so
    does what acts in one direction and more: an edge that turns and one that moves besides. So do
    twins on either side of a place.
    """
    catalogue = searcher.problem.catalogue
    near = SEARCH.same_effect_apart * SEARCH.apart * searcher.size

    def same(s: Suspect, t: Suspect) -> bool:
        a, b = catalogue[s.kind], catalogue[t.kind]
        alike = a.kind == b.kind or (by_nature and a.kind.joins(b.kind))
        along, other = _directions(a, s.row), _directions(b, t.row)
        alike = alike and (along == other or bool(along & other))
        return alike and apart(a, s.row, b, t.row) < near

    return unmatched(best, f, same)


def _directions(c: Candidates, row: int) -> set[int]:
    """Return along which components one of some candidates acts."""
    where = c.where[row]
    return {*where.get("components", ()), *where.get("free_components", ())}


def instead(
    searcher: Searcher, found: Found, accepted: int, number: int
) -> list[tuple[Suspect, float]]:
    """Return suspects of rivals that take the place of one of the accepted, with weights.

    Rivals within a likelihood ratio of exp(3) that differ in this suspect alone; the weight is
    relative to the accepted hypothesis.
    """
    best = found.levels[accepted]
    here = scored(searcher, best)
    out = []
    for f in (f for level in found.rivals for f in level):
        alone, others = _unmatched(searcher, best, f, by_nature=False)
        if alone == [number] and len(others) == 1:
            behind = max(here.score - scored(searcher, f, here).score, 0.0)
            if 2.0 * behind < SEARCH.credible:
                out.append((others[0], float(np.exp(-behind))))
    return out


def explained(searcher: Searcher, best: Fit, number: int) -> tuple[int, ...]:
    """Return which test modes one of the suspects explains, as rows of the whole test.

    Those whose misfit rises clearly where the suspect is taken away and nothing else moves.
    """
    p = searcher.problem.entire()
    left, kept = (
        mode_misfits(p, *solve(p, best.nuisance, suspects))
        for suspects in (best.others(number), best.suspects)
    )
    gained = (left - kept) / noise_scale(searcher.problem, best)
    clear = (gained > SEARCH.explains) & (gained > SEARCH.explains_share * gained.max())
    return tuple(int(j) for j in np.flatnonzero(clear))


def held_out(start: int, every: int, enough: int, key: Floats) -> Bools:
    """Return a mask of what is kept out of the search: of `enough`, every so many from `start`.

    In the order of a `key` (n,) that the test itself gives, not of a file, numbers or axes.
    """
    order = np.argsort(key, kind="stable")
    mask = np.zeros(len(order), bool)
    mask[order[start::every]] = len(order) >= enough
    return mask


def times(value: float) -> float:
    """Return a likelihood ratio from twice its log, as far as odds are said."""
    most = EFFECTS.odds_most
    return float(np.clip(np.exp(np.clip(0.5 * value, -most, most)), 1.0 / most, most))
