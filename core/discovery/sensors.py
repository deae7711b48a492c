"""What may be wrong in the test: each node against what all the others say.

A sensor that reads the opposite, a multiple, another sensor's values or along another axis stands
out against its prediction (see `survey`) in every mode, no matter which effect the model misses.
All that a node may be competes in one list, the model being wrong there included; the chance of a
fault that is told is the share of its evidence.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from ..arrays import Bools, Floats, Ints
from .alternatives import Alternative, Before, alternatives
from .readings import likelihood, local_shares, node_of
from .survey import Prediction, Span, Survey, predict
from .swaps import Swap, swaps
from .turning import maps_of, rotation

_FEWEST, _FEWEST_MODES = 8, 3
"""Nodes and modes below which nodes cannot judge each other."""
_LEVELS = 0.008 * 1.4 ** np.arange(10)
_WIDTHS = 0.03 * 2.0 ** np.arange(5)
_EVERY = range(len(_LEVELS))
_TRUSTED = 0.85
"""Share of the nodes, the best predicted ones, by which the noise is judged."""
_SUSPICIOUS = 4.0
_MOST, _ALWAYS = 0.25, 4
_FAULTY = 0.5
"""Faulty nodes that are expected of a test."""
_NAMED, _DOUBTFUL = 0.5, 0.05
_KNOWN = 0.97
"""Chance that what is wrong with a faulty sensor is in the list."""


@dataclass(frozen=True, eq=False)
class Fault:
    """A sensor that does not read what it should.

    Parameters
    ----------
    kind : str
        ``sensor_polarity``, ``sensor_gain``, ``sensor_swap``, ``sensor_axis`` or ``doubled``.
    sensors : tuple of int
        Rows concerned.
    reads : (n, n) float or None
        What these rows read of what they should; None where that cannot be undone.
    factor, deviation : float
        What is read over what should be, of a turned sensor the angle [deg]; its standard
        deviation.
    axis : tuple of float
        About which a sensor is turned, in the frame of the analysis.
    confidence : float
        Chance that this is what is wrong.
    """

    kind: str
    sensors: tuple[int, ...]
    reads: Floats | None
    factor: float
    deviation: float
    axis: tuple[float, ...]
    confidence: float


@dataclass(frozen=True, eq=False)
class Verdicts:
    """What is wrong in a test.

    Parameters
    ----------
    faults : tuple of Fault
    doubtful : (n_sensor,) bool
        Sensors that may be faulty: no evidence about the model.
    noise : float
        Standard deviation of a sound sensor over the rms of its shape.
    """

    faults: tuple[Fault, ...]
    doubtful: Bools
    noise: float


def judge_sensors(survey: Survey, span: Span) -> Verdicts:
    """Find sensors that contradict all the others.

    Parameters
    ----------
    survey : Survey
    span : Span
        Shapes of the best model there is.
    """
    slots, n = survey.slots, len(survey.node)
    if len(slots) < _FEWEST or survey.shapes.shape[1] < _FEWEST_MODES:
        return Verdicts((), np.zeros(n, bool), 0.03)
    span = span.seen()
    judged = _Judged(survey, span, _suspects(survey, span))
    while np.any(judged.aside & ~judged.possible):
        judged = _Judged(survey, span, judged.possible)
    doubtful = np.zeros(n, bool)
    for i in np.flatnonzero(judged.possible):
        doubtful[slots[i][slots[i] >= 0]] = True
    return Verdicts(judged.faults(), doubtful, judged.sigma)


def corrected(shapes: Floats, faults: Sequence[Fault]) -> Floats:
    """Return the shapes as sound sensors would have read them.

    What cannot be known of a sensor that is turned away stays as it is; see `lost`.
    """
    out = np.array(shapes)
    for f in faults:
        if f.reads is not None:
            rows = list(f.sensors)
            out[rows] = np.linalg.solve(f.reads, out[rows])
    return out


def lost(faults: Sequence[Fault], n: int) -> Bools:
    """Return the sensors whose right readings cannot be had from what they read, (n,)."""
    out = np.zeros(n, bool)
    for f in faults:
        if f.reads is None:
            out[list(f.sensors)] = True
    return out


def _suspects(survey: Survey, span: Span) -> Bools:
    """Set nodes aside one by one, the worst first, the noise judged again each time.

    A few are set aside in any case: a fault that the others' predictions share in hides itself.
    """
    near = span.along_only()
    count = (survey.slots >= 0).sum(axis=1)
    masked = np.zeros(len(count), bool)
    level, width = _level(survey, near, masked)
    always = min(_ALWAYS, len(count) // 8)
    for number in range(max(always, int(_MOST * len(count)))):
        off = _distance(predict(survey, near, float(_LEVELS[level]), width, masked), count)
        off = off / max(1.0, float(np.median(off[~masked])))
        off[masked] = 0.0
        worst = int(np.argmax(off))
        if off[worst] < _SUSPICIOUS and number >= always:
            break
        masked[worst] = True
        level, width = _level(survey, near, masked, range(max(0, level - 1), level + 1))
    return masked


def _distance(said: Prediction, count: Ints) -> Floats:
    """Squared distance of each node from its prediction a degree of freedom, (n_node,)."""
    k = said.rows
    S = said.covariance[..., :k, :k].copy()
    S[..., np.arange(k), np.arange(k)] += said.noise
    off = said.reading - said.mean[..., :k]
    square = np.einsum("nmk,nmk->nm", off, np.linalg.solve(S, off[..., None])[..., 0])
    return np.asarray(np.minimum(square / count[:, None], 30.0).mean(axis=1))


def _level(
    survey: Survey, span: Span, masked: Bools, among: Iterable[int] = _EVERY
) -> tuple[int, Floats]:
    """Noise, by its number in `_LEVELS`, and width of every mode that make the nodes likeliest.

    The worst predicted nodes of every mode do not count.
    """
    there = (survey.slots >= 0)[:, None, :]
    keep = max(1, int(_TRUSTED * np.count_nonzero(~masked)))
    modes = len(survey.frequencies_hz)
    best, at, widths = -np.inf, 0, np.full(modes, _WIDTHS[-1])
    for number in among:
        each = np.empty((len(_WIDTHS), modes))
        for w, width in enumerate(_WIDTHS):
            said = predict(
                survey, span, float(_LEVELS[number]), np.full(modes, float(width)), masked
            )
            one = np.diagonal(said.covariance, axis1=2, axis2=3) + said.noise
            off = said.reading - said.mean
            log = np.where(there, off**2 / one + np.log(one), 0.0).sum(axis=2)
            each[w] = -np.sort(log[~masked], axis=0)[:keep].sum(axis=0)
        total = float(each.max(axis=0).sum())
        if total > best:
            best, at, widths = total, number, _WIDTHS[each.argmax(axis=0)]
    return at, widths


class _Judged:
    """All alternatives of the nodes that were set aside, weighed."""

    def __init__(self, survey: Survey, span: Span, masked: Bools) -> None:
        self._survey = survey
        self.aside = masked
        level, width = _level(survey, span.along_only(), masked)
        self.sigma = float(_LEVELS[level])
        self._said = predict(survey, span, self.sigma, width, masked)
        self._count = (survey.slots >= 0).sum(axis=1)
        n = len(masked)
        sound = [i for i in range(n) if not masked[i]]
        nodes = {i: node_of(self._said, i, int(self._count[i])) for i in range(n)}
        likely = np.array([likelihood(nodes[i], nodes[i].identity[None])[0] for i in sound])
        self._before = Before(
            _FAULTY / n, local_shares(likely), _proportion(self._said, np.array(sound))
        )
        self._aside = [int(i) for i in np.flatnonzero(masked)]
        self._alone = {i: alternatives(nodes[i], self._axes(i), self._before) for i in self._aside}
        self._swaps = swaps(nodes, self._aside, self._alone, self._before)
        self.possible = np.zeros(n, bool)
        for i in self._aside:
            self.possible[i] = self._guilt(i) > _DOUBTFUL

    def _rows(self, i: int) -> Ints:
        return np.asarray(self._survey.slots[i][: self._count[i]])

    def _axes(self, i: int) -> Floats | None:
        rows = self._rows(i)
        if np.any(self._survey.component[rows] > 3) or len(rows) > 3:
            return None
        return np.asarray(self._survey.axis[rows])

    def _guilt(self, i: int) -> float:
        """Chance that a node is faulty in one way or another."""
        mine = [s.odds for s in self._swaps if i in s.nodes]
        total = logsumexp([a.log for a in self._alone[i]])
        bad = [a.log - total for a in self._alone[i] if a.faulty]
        return float(
            np.exp(logsumexp([*bad, *mine]) - np.logaddexp(0.0, logsumexp(mine or [-1e9])))
        )

    def faults(self) -> tuple[Fault, ...]:
        """Return what is more likely than not."""
        out: list[Fault] = []
        used: set[int] = set()
        for s in self._swaps:
            if s.odds > 0.0 and not used & set(s.nodes):
                used |= set(s.nodes)
                out.append(self._swap(s))
        for i in self._aside:
            if i not in used:
                out += self._single(i)
        return tuple(out)

    def _swap(self, s: Swap) -> Fault:
        i, j = s.nodes
        a, b = self._rows(i)[list(s.rows[0])], self._rows(j)[list(s.rows[1])]
        n = len(a)
        exchange = np.zeros((2 * n, 2 * n))
        exchange[np.arange(n), n + np.arange(n)] = exchange[n + np.arange(n), np.arange(n)] = 1.0
        rivals = [t.odds for t in self._swaps if t is not s and {i, j} & set(t.nodes)]
        share = float(np.exp(s.odds - logsumexp([0.0, s.odds, *rivals])))
        rows = (*(int(r) for r in a), *(int(r) for r in b))
        return Fault("sensor_swap", rows, exchange, 1.0, 0.0, (), _KNOWN * share)

    def _single(self, i: int) -> list[Fault]:
        """Return the likeliest kind of fault of a node, if it is faulty more likely than not."""
        every = self._alone[i]
        total = logsumexp([a.log for a in every])
        kinds = {a.kind for a in every if a.faulty}
        share = {
            k: float(np.exp(logsumexp([a.log for a in every if a.kind == k]) - total))
            for k in kinds
        }
        if sum(share.values()) < _NAMED:
            return []
        kind = max(share, key=lambda k: share[k])
        best = max((a for a in every if a.kind == kind), key=lambda a: a.log)
        return [self._told(i, best, _KNOWN * share[kind])]

    def _told(self, i: int, a: Alternative, confidence: float) -> Fault:
        rows = self._rows(i)[list(a.rows)]
        reads: Floats | None = np.eye(len(rows)) * a.factor
        axis: tuple[float, ...] = ()
        if a.kind == "sensor_axis":
            vector = np.array(a.vector)
            axis = tuple(float(v) for v in vector / np.linalg.norm(vector))
            axes = self._survey.axis[rows]
            seen = maps_of(axes, rotation(vector)[None])[0][:, len(rows) :]
            reads = seen @ axes.T if np.allclose(seen @ axes.T @ axes, seen, atol=0.02) else None
        elif a.kind == "sensor_swap":
            reads = np.eye(2)[::-1]
        return Fault(
            a.kind, tuple(int(r) for r in rows), reads, a.factor, a.deviation, axis, confidence
        )


def _proportion(said: Prediction, sound: Ints) -> float:
    """Scale of what the model has wrong in proportion at sound nodes, over the rms of a shape."""
    k = said.rows
    mean, read = said.mean[sound][..., :k], said.reading[sound]
    one = np.diagonal(said.covariance[sound][..., :k, :k], axis1=2, axis2=3) + said.noise[sound]
    square = np.sum(mean**2 / one, axis=1)
    gain = np.sum(mean * read / one, axis=1) / np.maximum(square, 1e-12)
    off = (gain - 1.0) * np.sqrt(np.mean(mean**2, axis=1))
    off = off[square > 1e-6]
    return 1.4826 * float(np.median(np.abs(off))) if off.size else 0.0
