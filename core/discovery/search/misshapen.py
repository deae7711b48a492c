"""What was found against a structure of another shape than drawn."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.map_fit import evaluate
from ..model_error.beside_fields import with_drift
from ..model_error.diffuse_error import at
from ..model_error.diffuse_fit import Judged, everything, judged, seen
from ..model_error.geometry_error import Deviation, Misshapen, Movable, misshapen, with_deviation
from ..model_error.geometry_shapes import Shape, shapes_of
from ..model_error.model_error_numbers import MODEL_ERROR
from .completeness import Completeness, nothing_found
from .found import Found
from .model_selection import scored, worth_telling
from .moves import Searcher
from .own_basis import Ground
from .refit_own_basis import Modal, modal
from .search_numbers import SEARCH


def beside_geometry(
    ground: Ground, searcher: Searcher, found: Found, kept: int, whole: Completeness
) -> tuple[int, Completeness]:
    """Return how many of what was found are told where a structure may be of another shape.

    None where that is likelier; else what was found has to be as far ahead of it as of anything
    elsewhere, and a shape is told that what is found leaves room for.
    """
    if ground.structure.moved is None:
        return kept, whole
    best = scored(searcher, found.levels[kept]).score
    if _worth_trying(kept, whole, best):
        shape = likeliest(ground, modal(ground, searcher.problem, found.levels[0]))
        if shape and _worth_telling(shape, whole.alone):
            kept, whole = _beside(shape, kept, whole, best)
    if kept and whole.shape is None and not whole.explains:
        shape = likeliest(ground, modal(ground, searcher.problem, found.levels[kept]))
        if shape and _worth_telling(shape, whole.best):
            whole = replace(whole, shape=shape)
    return kept, whole


def _worth_trying(kept: int, whole: Completeness, best: float) -> bool:
    """Whether the known parameters leave what a shape could be, and no effect is beyond that."""
    alone = whole.alone
    if kept:
        return best < alone.evidence + MODEL_ERROR.drift_gain or not whole.explains
    drifts = alone.evidence - alone.bare > MODEL_ERROR.seen
    return not whole.lacks_nothing and (drifts or alone.diffuse.error > MODEL_ERROR.usual)


def _worth_telling(shape: Misshapen, without: Judged) -> bool:
    """Whether a shape gains a share of every mode, and more than smooth fields do."""
    beyond_fields = shape.score - without.evidence > SEARCH.suspect
    return beyond_fields and shape.score - without.bare > worth_telling(without, shape.error)


def _beside(
    shape: Misshapen, kept: int, whole: Completeness, best: float
) -> tuple[int, Completeness]:
    """Weigh a shape against what was found, or else against supports that reach further in."""
    if not kept:
        ahead = np.inf if whole.reach is None else shape.score - whole.reach.score
        told = shape if ahead > -SEARCH.suspect else None
        reach = whole.reach if ahead < SEARCH.suspect else None
        return 0, replace(whole, shape=told, reach=reach)
    ahead = best - shape.score
    if ahead < 0.0:
        return 0, replace(nothing_found(whole.deck, whole.alone), shape=shape)
    told = shape if ahead < SEARCH.suspect else None
    return kept, replace(whole, ahead=min(whole.ahead, ahead), shape=told)


def likeliest(ground: Ground, m: Modal) -> Misshapen | None:
    """Return the shape beside which a hypothesis is likeliest, None where none can be.

    All are tried on the modes that may match, the best again on all modes, and what its family
    amounts to in any direction.
    """
    structure = ground.structure
    plain = judged(m.problem, m.state, everything(m.problem))
    few, every = (
        _Look(m, plain, Movable(structure, V, ground.compliance))
        for V in (m.vectors[:, : m.problem.columns], m.vectors)
    )
    shapes = shapes_of(structure.model.geometry.xyz)
    tried = few.at(shapes)
    if not tried:
        return None
    again = every.at((tried[0].deviation.shape, *few.between(tried)))
    best = again[0] if again else tried[0]
    j = best.judged
    full = with_drift(j.problem, j.fit, m.known, m.smooth)
    return misshapen(best.deviation, full, len(shapes))


@dataclass(frozen=True, eq=False)
class _Tried:
    """A shape that was fitted."""

    deviation: Deviation
    judged: Judged


@dataclass(frozen=True, eq=False)
class _Look:
    """A hypothesis on its modes, as it is `plain`, beside which shapes are looked at."""

    m: Modal
    plain: Judged
    movable: Movable

    def at(self, shapes: Iterable[Shape]) -> list[_Tried]:
        """Return shapes as they are fitted, the likeliest first; those that are nothing left out.

        Each from the best of several amplitudes.
        """
        out = []
        for shape in shapes:
            d = self.movable.deviation(shape)
            p = with_deviation(self.m.problem, d)
            starts = [s for a in MODEL_ERROR.shape_starts for s in self._start(p, a)]
            if starts:
                _, first = max(starts, key=lambda start: start[0])
                out.append(_Tried(d, judged(p, first, everything(p), self.plain.diffuse)))
        return sorted(out, key=lambda t: -t.judged.evidence)

    def _start(self, p: Problem, amplitude: float) -> Iterator[tuple[float, Fit]]:
        """Give how likely an amplitude is, nothing else moved; nothing where a mass is negative."""
        plain = self.plain
        with suppress(np.linalg.LinAlgError):
            x = np.insert(plain.fit.nuisance, -1, np.log1p(amplitude * MODEL_ERROR.shape_unit))
            f = evaluate(p, x, plain.fit.suspects)
            d = at(seen(p, f), plain.diffuse.error, plain.diffuse.noise)
            yield d.log - 0.5 * amplitude**2, f

    def between(self, tried: Sequence[_Tried]) -> Iterator[Shape]:
        """Give what the best shape and the others of its family amount to together."""
        family = tried[0].deviation.shape.family
        first, *others = (t for t in tried if t.deviation.shape.family == family)
        if not others:
            return
        p, x = first.judged.problem, first.judged.fit.nuisance
        for t in others:
            p, x = with_deviation(p, t.deviation), np.insert(x, -1, 0.0)
        both = judged(p, evaluate(p, x, self.plain.fit.suspects), everything(p), self.plain.diffuse)
        shapes = [t.deviation.shape.by for t in (first, *others)]
        by = np.tensordot(np.expm1(both.fit.nuisance[-1 - len(shapes) : -1]), shapes, 1)
        yield replace(first.deviation.shape, by=by / np.linalg.norm(by, axis=1).max())
