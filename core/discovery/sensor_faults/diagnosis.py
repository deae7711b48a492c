"""What may be wrong in the test: each node against what all the others say.

A sensor that reads the opposite, a multiple, another sensor's values or along another axis stands
out against its prediction (see `survey`) in every mode, no matter which effect the model misses.
All that a node may be competes in one list, the model being wrong there included; the chance of a
fault that is told is the share of its evidence.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.special import logsumexp

from ...arrays import Bools, Floats
from ...correlation.comparison import Placed
from ...correlation.mac import realised
from ...data.dofs import Dofs
from ...data.parametric_model import Model
from ...sensors.sensor_map import observe
from ..faults import AXIS, FAULTS, SWAP, Fault, accused
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
        return accused(self.faults, len(self.doubtful))

    @property
    def beyond_doubt(self) -> Verdicts:
        """The same without the faults that an error of the model may look like."""
        return replace(self, faults=tuple(f for f in self.faults if not FAULTS[f.kind].like_model))


def judge_sensors(survey: Survey, span: Span) -> Verdicts:
    """Find sensors that contradict all the others, by the shapes of the best model there is.

    Nodes that turn out to be sound help to predict the others again.
    """
    slots, n = survey.slots, len(survey.node)
    if len(slots) < SENSORS.fewest or survey.shapes.shape[1] < SENSORS.fewest_modes:
        return Verdicts((), np.zeros(n, bool), SENSORS.noise)
    span = span.seen()
    weighed = weigh(survey, span, *suspects(survey, span))
    while np.any(weighed.aside & (weighed.guilt <= SENSORS.doubtful)):
        weighed = weigh(survey, span, weighed.guilt > SENSORS.doubtful, weighed.level)
    doubtful = np.zeros(n, bool)
    doubtful[slots[weighed.aside][slots[weighed.aside] >= 0]] = True
    return Verdicts(faults_of(weighed), doubtful, weighed.sigma)


def faults_of(weighed: Weighed) -> tuple[Fault, ...]:
    """Return the faults that are likely enough.

    Many sensors that read as if turned are a structure that leans or is out of round there. Of
    three or more that are mixed up two do not read each other's values, whatever one gains by it:
    which of them is where is not told.
    """
    out: list[Fault] = []
    used: set[int] = set()
    likely = [s for s in weighed.swaps if s.odds > _ODDS]
    for s in likely:
        if not used & set(s.nodes):
            more = {i for t in likely if set(s.nodes) & set(t.nodes) for i in t.nodes}
            mutual = s.worse > SENSORS.mutual or len(more) == len(s.nodes)
            used |= set(s.nodes) if mutual else more
            out += [_swapped(weighed, s)] if mutual else []
    for i in weighed.alone:
        if i not in used:
            out += _likeliest(weighed, i)
    turned = sum(f.kind == AXIS.name for f in out)
    return tuple(f for f in out if f.kind != AXIS.name or turned <= SENSORS.turned_most)


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
    """Return the likeliest kind of fault of a node, if it is likely enough.

    Where an error of the model may look like it, that there is a fault at all has to be surer.
    What hardly moves in any mode moves the other way where the model is wrong nearby: of a turn
    that is what moves across its axis.
    """
    share = weighed.shares(i)
    if sum(share.values()) < SENSORS.named:
        return []
    kind = max(share, key=lambda k: share[k])
    unsure = share[kind] < SENSORS.named or sum(share.values()) < SENSORS.sure
    if FAULTS[kind].like_model and unsure:
        return []
    best = max((a for a in weighed.alone[i] if a.kind == kind), key=lambda a: a.log)
    if np.abs(_readings_changed(weighed.survey, i, best)).max() < SENSORS.moves:
        return []
    return [_told(weighed.survey, i, best, SENSORS.known * share[kind])]


def _readings_changed(survey: Survey, i: int, a: Alternative) -> Floats:
    """Return the readings that a fault changes: of a turn those across its axis, (n, n_mode)."""
    rows = survey.rows(i)[list(a.rows)]
    read: Floats = survey.unit()[rows]
    if a.kind != AXIS.name:
        return read
    axis = np.array(a.vector) / np.linalg.norm(a.vector)
    motion = survey.axis[rows].T @ read
    return np.asarray(motion - np.outer(axis, axis @ motion))


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
    own = tuple(int(r) for r in rows)
    return Fault(a.kind, own, reads, a.factor, a.deviation, axis, confidence)


class Bench:
    """A test laid onto a model, with what its nodes would read in every direction.

    Parameters
    ----------
    placed : Placed
    model : Model
        The deck's.
    """

    def __init__(self, placed: Placed, model: Model) -> None:
        self.survey = survey_of(placed)
        self._along = placed.observation.matrix
        self._around = _every_direction(placed, model)

    def judged(self, motion: Floats, eigenvalues: Floats) -> Verdicts:
        """Judge by shapes on all analysis dofs, (n_dof, n)."""
        hz = np.sqrt(np.maximum(eigenvalues, 0.0)) / (2.0 * np.pi)
        around = np.asarray(self._around @ motion).reshape(-1, 3, motion.shape[1])
        return judge_sensors(self.survey, Span(np.asarray(self._along @ motion), around, hz))


def survey_of(placed: Placed) -> Survey:
    """Return the readings of a test on a model, complex shapes turned to real ones."""
    seen = placed.observation
    return Survey(
        realised(placed.test.shapes),
        placed.test.frequencies_hz,
        seen.sensors.node,
        seen.sensors.component,
        seen.sensors.axis,
        seen.xyz,
        None if placed.errors is None else placed.errors.shape,
    )


def _every_direction(placed: Placed, model: Model) -> sp.csr_matrix:
    """Map of sensors along all three axes at each node, (3 n_node, n_dof)."""
    _, first = np.unique(placed.observation.sensors.node, return_index=True)
    nodes = placed.observation.sensors.node[np.sort(first)]
    n = len(nodes)
    along = Dofs(np.repeat(nodes, 3), np.tile([1, 2, 3], n), np.tile(np.eye(3), (n, 1)))
    at = observe(model.geometry, model.dofs, placed.test_geometry, along, motion=model.expansion)
    return at.matrix
