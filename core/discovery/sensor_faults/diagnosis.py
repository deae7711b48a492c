"""What may be wrong in the test: each node against what all the others say.

A sensor that reads the opposite, a multiple, another sensor's values or along another axis stands
out against its prediction (see `survey`) in every mode, no matter which effect the model misses.
All that a node may be competes in one list, the model being wrong there included; the chance of a
fault that is told is the share of its evidence.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from ..arrays import Bools, Floats
from .alternatives import Alternative
from .faults import Fault
from .survey import Span, Survey
from .suspects import suspects
from .swaps import Swap
from .turning import maps_of, rotation
from .weighing import Weighed, weigh

_FEWEST, _FEWEST_MODES = 8, 3
"""Nodes and modes below which nodes cannot judge each other."""
_NAMED, _DOUBTFUL = 0.6, 0.05
_ODDS = float(np.log(_NAMED / (1.0 - _NAMED)))
_KNOWN = 0.97
"""Chance that what is wrong with a faulty sensor is in the list."""


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

    @property
    def accused(self) -> Bools:
        """Sensors that a fault is told of, (n_sensor,)."""
        out = np.zeros(len(self.doubtful), bool)
        for f in self.faults:
            out[list(f.sensors)] = True
        return out


def judge_sensors(survey: Survey, span: Span) -> Verdicts:
    """Find sensors that contradict all the others.

    Nodes that turn out to be sound help to predict the others again.

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
    weighed = weigh(survey, span, suspects(survey, span))
    while np.any(weighed.aside & (weighed.guilt <= _DOUBTFUL)):
        weighed = weigh(survey, span, weighed.guilt > _DOUBTFUL)
    doubtful = np.zeros(n, bool)
    doubtful[slots[weighed.aside][slots[weighed.aside] >= 0]] = True
    return Verdicts(faults_of(weighed), doubtful, weighed.sigma)


def faults_of(weighed: Weighed) -> tuple[Fault, ...]:
    """Return the faults that are likely enough."""
    out: list[Fault] = []
    used: set[int] = set()
    for s in weighed.swaps:
        if s.odds > _ODDS and not used & set(s.nodes):
            used |= set(s.nodes)
            out.append(_swapped(weighed, s))
    for i in weighed.alone:
        if i not in used:
            out += _likeliest(weighed, i)
    return tuple(out)


def _swapped(weighed: Weighed, s: Swap) -> Fault:
    i, j = s.nodes
    a, b = (weighed.survey.rows(k)[list(r)] for k, r in zip(s.nodes, s.rows, strict=True))
    n = len(a)
    exchange = s.sign * np.roll(np.eye(2 * n), n, axis=0)
    rivals = [t.odds for t in weighed.swaps if t is not s and {i, j} & set(t.nodes)]
    share = float(np.exp(s.odds - logsumexp([0.0, s.odds, *rivals])))
    rows = (*(int(r) for r in a), *(int(r) for r in b))
    return Fault("sensor_swap", rows, exchange, 1.0, 0.0, (), _KNOWN * share)


def _likeliest(weighed: Weighed, i: int) -> list[Fault]:
    """Return the likeliest kind of fault of a node, if it is likely enough."""
    share = weighed.shares(i)
    if sum(share.values()) < _NAMED:
        return []
    kind = max(share, key=lambda k: share[k])
    best = max((a for a in weighed.alone[i] if a.kind == kind), key=lambda a: a.log)
    return [_told(weighed.survey, i, best, _KNOWN * share[kind])]


def _told(survey: Survey, i: int, a: Alternative, confidence: float) -> Fault:
    rows = survey.rows(i)[list(a.rows)]
    reads: Floats | None = np.eye(len(rows)) * a.factor
    axis: tuple[float, ...] = ()
    if a.kind == "sensor_axis":
        vector = np.array(a.vector)
        axis = tuple(float(v) for v in vector / np.linalg.norm(vector))
        axes = survey.axis[rows]
        seen = maps_of(axes, rotation(vector)[None])[0][:, len(rows) :]
        reads = seen @ axes.T if np.allclose(seen @ axes.T @ axes, seen, atol=0.02) else None
    elif a.kind == "sensor_swap":
        reads = np.eye(2)[::-1]
    return Fault(
        a.kind, tuple(int(r) for r in rows), reads, a.factor, a.deviation, axis, confidence
    )
