"""Functions that contradict the others of their point: wrong in sign or size, or exchanged.

And those of a reference that are of two sizes, its gain having changed during the survey.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from ...arrays import Bools, Floats, Ints, Numbers
from .driving_points import positive_share
from .faults import Fault, listed
from .neighbours import Neighbours
from .participation import followed
from .survey_data import Survey, left_out, told
from .survey_numbers import SURVEY

_IN = {"wrong_sign": "sign", "wrong_gain": "size"}


@dataclass(frozen=True, eq=False)
class _Change:
    """What may have happened to the functions of one output: order and factors of its inputs."""

    order: Ints
    factors: Floats

    @property
    def touched(self) -> Ints:
        return np.flatnonzero((self.order != np.arange(len(self.order))) | (self.factors != 1.0))

    @property
    def kind(self) -> str:
        if (self.factors == 1.0).all():
            return "swapped_references"
        return "wrong_sign" if self.factors.min() < 0.0 else "wrong_gain"

    def of(self, functions: Numbers, input_weight: Floats) -> Numbers:
        """Undo it, functions (..., n_input, n_line) in the weighting of a survey."""
        factor = self.factors * input_weight / input_weight[self.order]
        return np.asarray(functions[..., self.order, :] * factor[:, None])


def contradictions_mended(survey: Survey, points: Floats, neighbours: Neighbours | None) -> Survey:
    """Turn or exchange the functions that contradict the others, leave out those of wrong size.

    At a resonance the functions of every output go as its participation. Where those of one output
    follow it far better with one of them turned or multiplied, or with two exchanged, that is what
    happened. Many that are wrong alike hide each other: what is found is mended, and the rest
    judged again. Two references do not say which of them is wrong: the driving point and the
    neighbours may. Where nothing does, both functions are left out.

    Parameters
    ----------
    survey : Survey
    points : (n_input, n_output) float
        From `driving_points`.
    neighbours : Neighbours, optional
    """
    judged = np.flatnonzero(survey.measured.all(axis=1))
    mended = survey
    known: list[tuple[int, _Change]] = []
    unknown = {kind: np.zeros(survey.measured.shape, bool) for kind in _IN}
    wrong = np.zeros(survey.measured.shape, bool)
    settled: set[int] = set()
    while survey.values.shape[1] > 1 and len(judged) >= SURVEY.signs_outputs:
        found = [(o, c) for o, c in _contradicting(mended, judged) if o not in settled]
        if not found:
            break
        values = mended.values.copy()
        for o, rivals in found:
            likely = _believed(survey, o, rivals, points, neighbours)
            if len(likely) == 1:
                values[o] = likely[0].of(values[o], survey.input_weight)
                known.append((o, likely[0]))
            else:
                kind = "wrong_gain" if any(c.kind == "wrong_gain" for c in likely) else "wrong_sign"
                unknown[kind][o, np.unique(np.concatenate([c.touched for c in likely]))] = True
        mended = replace(mended, values=values)
        settled |= {o for o, _ in found}
        wrong = np.any([*unknown.values()], axis=0)
        judged = judged[~wrong[judged].any(axis=1)]
    for o, change in known:
        if change.kind == "wrong_gain":
            wrong[o, change.touched] = True
    return left_out(told(mended, *_named(survey, known), *_doubtful(survey, unknown)), wrong)


def _contradicting(survey: Survey, rows: Ints) -> list[tuple[int, list[_Change]]]:
    """Find outputs that follow the participation far better after a change, and those changes.

    A gain may take any value: it has to be better whichever peak is left out.
    """
    seen = followed(survey, rows)
    if seen is None:
        return []
    n_input, weight = len(seen.participation), survey.input_weight
    changes = [[c] * len(rows) for c in _changes(n_input)]
    changes += [_gains(seen.factors(k), k, n_input) for k in range(n_input)]
    now = seen.left(seen.functions)
    after = np.empty((len(changes), len(rows)))
    for k, of_output in enumerate(changes):
        changed = [c.of(h, weight) for c, h in zip(of_output, seen.functions, strict=True)]
        better = seen.left(np.stack(changed)) / np.maximum(now, 1e-300)
        gain = k >= len(changes) - n_input
        after[k] = better.max(axis=1) if gain else better[:, 0]
    best = after.min(axis=0)
    contradicting = []
    for n in np.flatnonzero(best < SURVEY.signs_better):
        rivals = np.flatnonzero(after[:, n] <= SURVEY.signs_rival * best[n])
        contradicting.append((int(rows[n]), [changes[k][n] for k in rivals]))
    return contradicting


def _changes(n_input: int) -> list[_Change]:
    """Each function turned, each two exchanged."""
    same, plus = np.arange(n_input), np.ones(n_input)
    found = [_Change(same, np.where(same == k, -1.0, 1.0)) for k in range(n_input)]
    for a, b in combinations(range(n_input), 2):
        order = same.copy()
        order[[a, b]] = b, a
        found.append(_Change(order, plus))
    return found


def _gains(factor: Floats, k: int, n_input: int) -> list[_Change]:
    """Multiply function `k` of each output, where by more than measurements err."""
    same = np.arange(n_input)
    factor = np.where(factor > 0.0, factor, 1.0)
    factor = np.where(np.abs(np.log(factor)) > np.log(SURVEY.gain_least), factor, 1.0)
    return [_Change(same, np.where(same == k, f, 1.0)) for f in factor]


def _believed(
    survey: Survey,
    o: int,
    rivals: list[_Change],
    points: Floats,
    neighbours: Neighbours | None,
) -> list[_Change]:
    """Keep the changes that the driving point and then the neighbours do not speak against."""
    if len(rivals) == 1:
        return rivals
    changed = [c.of(survey.values[o], survey.input_weight) for c in rivals]
    driven = np.flatnonzero(np.isfinite(points).all(axis=1) & (points[:, o] != 0.0))
    for i in driven:
        share = [positive_share(np.sign(points[i, o]) * x[i]) for x in changed]
        sound = [c for c, s in zip(rivals, share, strict=True) if s > SURVEY.gives]
        if 0 < len(sound) < len(rivals):
            return sound
    if neighbours is not None:
        left = [neighbours.unlike(survey, o, x) for x in changed]
        sound = [c for c, e in zip(rivals, left, strict=True) if e < SURVEY.neighbour_left]
        return sound or rivals
    return rivals


def _named(survey: Survey, known: list[tuple[int, _Change]]) -> list[Fault]:
    faults = []
    turned = sorted((o, int(c.touched[0])) for o, c in known if c.kind == "wrong_sign")
    if turned:
        names = [survey.function(*place) for place in turned]
        sentence = (
            f"{listed(names)}: of the wrong sign, as the other functions of that point say; turned"
        )
        faults.append(Fault("wrong_sign", tuple(names), sentence, "turned"))
    exchanged = [(o, tuple(c.touched)) for o, c in known if c.kind == "swapped_references"]
    for pair in dict.fromkeys(pair for _, pair in exchanged):
        rows = sorted(o for o, p in exchanged if p == pair)
        a, b = (survey.inputs.labels[i] for i in pair)
        at = listed([survey.outputs.labels[o] for o in rows])
        names = [survey.function(o, i) for o in rows for i in pair]
        sentence = (
            f"{a} and {b}: their functions at {at} stand under each other's name, as the "
            "other points say; exchanged"
        )
        faults.append(Fault("swapped_references", tuple(names), sentence, "exchanged"))
    scaled = sorted((o, int(c.touched[0]), 1.0 / c.factors.prod())
                    for o, c in known if c.kind == "wrong_gain")  # fmt: skip
    if scaled:
        names = [survey.function(o, i) for o, i, _ in scaled]
        sizes = [f"{n} (about {g:.3g} times)" for n, (*_, g) in zip(names, scaled, strict=True)]
        sentence = (
            f"{listed(sizes)}: too large or too small, as the other functions of that point say (a "
            "wrong unit, range or calibration?); left out"
        )
        faults.append(Fault("wrong_gain", tuple(names), sentence, "left out"))
    return faults


def _doubtful(survey: Survey, unknown: dict[str, Bools]) -> list[Fault]:
    faults = []
    for kind, functions in unknown.items():
        names = tuple(survey.function(o, i) for o, i in zip(*np.nonzero(functions), strict=True))
        if names:
            sentence = (
                f"{listed(names)}: contradict each other in {_IN[kind]}, and nothing tells which "
                "is wrong; left out"
            )
            faults.append(Fault(kind, names, sentence, "left out"))
    return faults


@dataclass(frozen=True, eq=False)
class _Step:
    """Outputs whose functions of an input are large, or small, and how far these are apart, ln."""

    large: Ints
    small: Ints
    gap: float
    apart: float

    @property
    def few(self) -> tuple[Ints, float]:
        """Return the smaller set and what brings it to the size of the other, ln."""
        if len(self.large) <= len(self.small):
            return self.large, -self.apart
        return self.small, self.apart


def gain_steps_mended(survey: Survey) -> Survey:
    """Bring the functions of a reference that are of two sizes to that of the more frequent one.

    The sizes are those that the functions of the other references expect at each point; two of
    these at least, for of two references either may have changed. In order sizes scatter, but leave
    no gap with many on either side; where references are exchanged at many points they scatter in
    one set, and no factor makes all functions agree.
    """
    rows = np.flatnonzero(survey.measured.all(axis=1))
    n_input = survey.values.shape[1]
    seen = followed(survey, rows) if n_input > 2 else None
    if seen is None:
        return survey
    steps = {k: _step(seen.factors(k)) for k in range(n_input)}
    k = max(steps, key=lambda i: steps[i].gap)
    step, mended, now = steps[k], survey, seen.unlike
    if step.gap == 0.0:
        return survey
    for _ in range(SURVEY.gain_step_rounds):
        few, by = step.few
        times = np.ones(len(rows))
        times[few] = np.exp(by)
        values = survey.values.copy()
        values[rows, k] *= times[:, None]
        mended = replace(survey, values=values)
        seen = followed(mended, rows)
        step = _step(seen.factors(k) * times) if seen is not None else step
        if seen is None or step.gap == 0.0:
            return survey
    if seen.unlike > SURVEY.gain_step_left * now:
        return survey
    names = tuple(survey.function(int(o), k) for o in rows[np.sort(few)])
    sentence = (
        f"{listed(names)}: about {np.exp(-by):.2g} times the size of the other functions of "
        f"{survey.inputs.labels[k]}, as the other references say (its gain changed during the "
        "survey); brought to one size, nothing tells which is right"
    )
    return told(mended, Fault("wrong_gain", names, sentence, "scaled"))


def _step(factor: Floats) -> _Step:
    """Return the widest gap between sizes with enough functions of one size on either side."""
    least = SURVEY.gain_step_least
    known = np.flatnonzero(factor > 0.0)
    known = known[np.argsort(factor[known])]
    size = -np.log(factor[known])
    gap = -np.diff(size)[least - 1 : len(size) - least]
    if len(gap) and gap.max() > np.log(SURVEY.gain_step):
        split = least + int(np.argmax(gap))
        large, small = size[:split], size[split:]
        few = min(large, small, key=len)
        if np.median(np.abs(few - np.median(few))) < SURVEY.gain_step_scatter:
            apart = float(np.median(large) - np.median(small))
            return _Step(known[:split], known[split:], float(gap.max()), apart)
    return _Step(known, known[:0], 0.0, 0.0)
