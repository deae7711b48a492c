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

from ...arrays import Bools, Floats
from ..faults import AXIS, SWAP, Fault
from .fault_hypotheses import Alternative
from .fault_posterior import Weighed, weigh
from .leave_one_out import Span, Survey
from .misalignment import maps_of, rotation
from .outliers import suspects
from .sensor_numbers import SENSORS
from .swapped_channels import Swap

_ODDS = float(np.log(SENSORS.named / (1.0 - SENSORS.named)))


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
    if len(slots) < SENSORS.fewest or survey.shapes.shape[1] < SENSORS.fewest_modes:
        return Verdicts((), np.zeros(n, bool), SENSORS.noise)
    span = span.seen()
    weighed = weigh(survey, span, suspects(survey, span))
    while np.any(weighed.aside & (weighed.guilt <= SENSORS.doubtful)):
        weighed = weigh(survey, span, weighed.guilt > SENSORS.doubtful)
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
    return Fault(SWAP.name, rows, exchange, 1.0, 0.0, (), SENSORS.known * share)


def _likeliest(weighed: Weighed, i: int) -> list[Fault]:
    """Return the likeliest kind of fault of a node, if it is likely enough."""
    share = weighed.shares(i)
    if sum(share.values()) < SENSORS.named:
        return []
    kind = max(share, key=lambda k: share[k])
    best = max((a for a in weighed.alone[i] if a.kind == kind), key=lambda a: a.log)
    return [_told(weighed.survey, i, best, SENSORS.known * share[kind])]


def _told(survey: Survey, i: int, a: Alternative, confidence: float) -> Fault:
    rows = survey.rows(i)[list(a.rows)]
    reads: Floats | None = np.eye(len(rows)) * a.factor
    axis: tuple[float, ...] = ()
    if a.kind == AXIS.name:
        vector = np.array(a.vector)
        axis = tuple(float(v) for v in vector / np.linalg.norm(vector))
        axes = survey.axis[rows]
        seen = maps_of(axes, rotation(vector)[None])[0][:, len(rows) :]
        whole = np.allclose(seen @ axes.T @ axes, seen, atol=SENSORS.in_plane)
        reads = seen @ axes.T if whole else None
    elif a.kind == SWAP.name:
        reads = np.eye(2)[::-1]
    return Fault(
        a.kind, tuple(int(r) for r in rows), reads, a.factor, a.deviation, axis, confidence
    )
