"""Functions that contradict the others of their point: of the wrong sign, or exchanged."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from scipy.signal import find_peaks

from ...arrays import Floats, Ints, Numbers
from .driving_points import positive_share
from .faults import Fault, listed
from .neighbours import Neighbours
from .survey_data import Survey, left_out, told
from .survey_numbers import SURVEY


@dataclass(frozen=True, eq=False)
class _Change:
    """What may have happened to the functions of one output: order and sign of its inputs."""

    order: Ints
    signs: Floats

    @property
    def touched(self) -> Ints:
        return np.flatnonzero((self.order != np.arange(len(self.order))) | (self.signs < 0.0))

    def of(self, functions: Numbers, input_weight: Floats) -> Numbers:
        """Undo it, functions (..., n_input, n_line) in the weighting of a survey."""
        factor = self.signs * input_weight / input_weight[self.order]
        return np.asarray(functions[..., self.order, :] * factor[:, None])


def contradictions_mended(survey: Survey, points: Floats, neighbours: Neighbours | None) -> Survey:
    """Turn or exchange the functions that contradict the others, and name them.

    At a resonance the functions of every output go as its participation, which is the first right
    singular vector of all functions at the line. Where those of one output follow it
    far better with one of them turned, or with two exchanged, that is what happened. Two
    references do not say which of them is turned: the driving point and the neighbours may. Where
    nothing does, both functions are left out.

    Parameters
    ----------
    survey : Survey
    points : (n_input, n_output) float
        From `driving_points`.
    neighbours : Neighbours, optional
    """
    complete = np.flatnonzero(survey.measured.all(axis=1))
    if survey.values.shape[1] < 2 or len(complete) < SURVEY.signs_outputs:
        return survey
    changes = _changes(survey.values.shape[1])
    values = survey.values.copy()
    known: dict[tuple[int, ...], list[int]] = {}
    unknown = np.zeros(survey.measured.shape, bool)
    for o, rivals in _contradicting(survey, complete, changes):
        likely = _believed(survey, o, [changes[k] for k in rivals], points, neighbours)
        if len(likely) == 1:
            values[o] = likely[0].of(values[o], survey.input_weight)
            exchange = likely[0].signs.min() > 0.0
            known.setdefault((int(exchange), *likely[0].touched.tolist()), []).append(o)
        else:
            unknown[o, np.unique(np.concatenate([c.touched for c in likely]))] = True
    mended = told(replace(survey, values=values), *_named(survey, known))
    if not unknown.any():
        return mended
    doubtful = [survey.function(o, i) for o, i in zip(*np.nonzero(unknown), strict=True)]
    sentence = (
        f"{listed(doubtful)}: contradict each other in sign, and nothing tells which is wrong; "
        "left out"
    )
    return told(
        left_out(mended, unknown), Fault("wrong_sign", tuple(doubtful), sentence, "left out")
    )


def _changes(n_input: int) -> list[_Change]:
    """As it is, each function turned, each two exchanged."""
    same, plus = np.arange(n_input), np.ones(n_input)
    found = [_Change(same, plus)]
    found += [_Change(same, np.where(same == k, -1.0, 1.0)) for k in range(n_input)]
    for a, b in combinations(range(n_input), 2):
        order = same.copy()
        order[[a, b]] = b, a
        found.append(_Change(order, plus))
    return found


def _contradicting(
    survey: Survey, complete: Ints, changes: Sequence[_Change]
) -> list[tuple[int, list[int]]]:
    """Find outputs that follow the participation far better after a change, and those changes."""
    own = survey.values[complete]
    _, size, vh = np.linalg.svd(own.transpose(2, 0, 1), full_matrices=False)
    lines, weight = _ruled(size)
    if not len(lines):
        return []
    own, part = own[..., lines] * weight, vh[lines, 0].conj().T
    left = np.empty((len(changes), len(complete)))
    for k, change in enumerate(changes):
        changed = change.of(own, survey.input_weight)
        total = np.sum(np.abs(changed) ** 2, axis=(1, 2))
        along = np.sum(np.abs(np.einsum("oin,in->on", changed, part)) ** 2, axis=1)
        left[k] = 1.0 - along / np.maximum(total, 1e-300)
    best = left[1:].min(axis=0)
    found = []
    for n in np.flatnonzero(best < SURVEY.signs_better * left[0]):
        rivals = np.flatnonzero(left[:, n] <= SURVEY.signs_rival * best[n])
        found.append((int(complete[n]), rivals.tolist()))
    return found


def _ruled(size: Floats) -> tuple[Ints, Floats]:
    """Return the lines about peaks at which one mode rules, and weights that make peaks equal.

    None where the peaks are few: what a mode does at its node looks like a fault at one peak, not
    at several.

    Parameters
    ----------
    size : (n_line, n_value) float
        Singular values.
    """
    clear = size[:, 0] > SURVEY.signs_clear * np.sum(size[:, 1:2], axis=1)
    decibel = 20.0 * np.log10(np.maximum(size[:, 0], 1e-300))
    tops, _ = find_peaks(decibel, prominence=SURVEY.signs_prominence_db)
    reach = np.arange(-SURVEY.signs_lines, SURVEY.signs_lines + 1)
    about = [np.clip(t + reach, 0, len(size) - 1) for t in tops]
    kept = [np.unique(lines[clear[lines]]) for lines in about if clear[lines].any()]
    if len(kept) < SURVEY.signs_peaks:
        return np.empty(0, np.int64), np.empty(0)
    weight = [np.full(len(k), 1.0 / np.linalg.norm(size[k, 0])) for k in kept]
    return np.concatenate(kept), np.concatenate(weight)


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


def _named(survey: Survey, known: dict[tuple[int, ...], list[int]]) -> list[Fault]:
    faults = []
    turned = [(o, c[0]) for (exchange, *c), rows in known.items() if not exchange for o in rows]
    if turned:
        names = [survey.function(o, i) for o, i in sorted(turned)]
        sentence = (
            f"{listed(names)}: of the wrong sign, as the other functions of that point say; turned"
        )
        faults.append(Fault("wrong_sign", tuple(names), sentence, "turned"))
    for (exchange, *pair), rows in known.items():
        if exchange:
            a, b = (survey.inputs.labels[i] for i in pair)
            at = listed([survey.outputs.labels[o] for o in rows])
            names = [survey.function(o, i) for o in rows for i in pair]
            sentence = (
                f"{a} and {b}: their functions at {at} stand under each other's name, as the "
                "other points say; exchanged"
            )
            faults.append(Fault("swapped_references", tuple(names), sentence, "exchanged"))
    return faults
