"""All that the nodes which were set aside may be, weighed against each other."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import expit, logsumexp

from ...arrays import Bools, Floats
from ..faults import FAULTS
from .fault_hypotheses import Alternative, Before, alternatives
from .leave_one_out import Prediction, Span, Survey, predict
from .node_likelihood import LOCAL, Node, likelihood, local_shares, node_of
from .outliers import LEVELS, distance, level_of
from .sensor_numbers import SENSORS
from .swapped_channels import Swap, swaps


@dataclass(frozen=True, eq=False)
class Weighed:
    """Alternatives of the nodes that were set aside.

    Parameters
    ----------
    survey : Survey
    aside : (n_node,) bool
    level : int
        Number of the noise of a sound sensor in `LEVELS`.
    alone : dict of int to list of Alternative
        By node.
    swaps : list of Swap
        The likeliest first.
    """

    survey: Survey
    aside: Bools
    level: int
    alone: dict[int, list[Alternative]]
    swaps: list[Swap]

    @property
    def sigma(self) -> float:
        """Noise of a sound sensor over the rms of its shape."""
        return float(LEVELS[self.level])

    def shares(self, i: int) -> dict[str, float]:
        """Return how likely each kind of fault of a node is but for swaps with others."""
        every = self.alone[i]
        total = logsumexp([a.log for a in every])
        return {
            k: float(np.exp(logsumexp([a.log for a in every if a.kind == k]) - total))
            for k in {a.kind for a in every if a.faulty}
        }

    @property
    def guilt(self) -> Floats:
        """Chance that a node is faulty in one way or another, (n_node,)."""
        out = np.zeros(len(self.aside))
        for i in self.alone:
            odds = logsumexp([-np.inf, *(s.odds for s in self.swaps if i in s.nodes)])
            swapped = float(expit(odds))
            out[i] = swapped + (1.0 - swapped) * sum(self.shares(i).values())
        return out


def weigh(survey: Survey, span: Span, aside: Bools, level: int) -> Weighed:
    """Weigh what nodes may be that were set `aside` (n_node,), all others taken as sound.

    The noise is about that of the number `level`.
    """
    level, width = level_of(survey, span.along_only(), aside, (level,))
    sigma = float(LEVELS[level])
    said = predict(survey, span, sigma, width, aside)
    count = (survey.slots >= 0).sum(axis=1)
    nodes = {i: node_of(said, i, int(count[i])) for i in range(len(aside))}
    sound = np.flatnonzero(~aside)
    likely = np.array([likelihood(nodes[i], nodes[i].identity[None])[0] for i in sound.tolist()])
    off = _in_proportion(said)
    usual = SENSORS.mad * float(np.median(np.abs(off[sound])))
    anywhere = np.array([[SENSORS.in_proportion, 0.0, max(usual, SENSORS.proportion)]])
    before = Before(SENSORS.faulty / len(aside), local_shares(likely), usual, anywhere)
    doubted = np.flatnonzero(aside).tolist()
    alone = {i: alternatives(nodes[i], _axes(survey, i), before) for i in doubted}
    crossed = _swaps(nodes, alone, before)
    disturbed = _disturbed(survey, said, Weighed(survey, aside, level, alone, crossed))
    near = _near(survey) & disturbed
    for i in np.flatnonzero(near.any(axis=1) & aside).tolist():
        alone[i] = alternatives(nodes[i], _axes(survey, i), _beside(before, off[near[i]]))
    if near[aside].any():
        crossed = _swaps(nodes, alone, before)
    return Weighed(survey, aside, level, alone, crossed)


def _swaps(
    nodes: dict[int, Node], alone: dict[int, list[Alternative]], before: Before
) -> list[Swap]:
    """Return the possible swaps among nodes that are not clearly sound."""
    among = [i for i, every in alone.items() if _unsound(every) > SENSORS.cleared]
    return swaps(nodes, among, alone, before)


def _unsound(every: list[Alternative]) -> float:
    log = np.array([a.log for a in every])
    sound = np.array([a.kind == "sound" for a in every])
    return float(np.exp(logsumexp(log[~sound]) - logsumexp(log)))


def _disturbed(survey: Survey, said: Prediction, weighed: Weighed) -> Bools:
    """Nodes that are off their prediction by something that a model may have wrong, (n_node,)."""
    off = distance(said, (survey.slots >= 0).sum(axis=1))
    usual = max(1.0, float(np.median(off[~weighed.aside])))
    out = weighed.aside & (off > SENSORS.suspicious * usual)
    for i in weighed.alone:
        sure = (p for k, p in weighed.shares(i).items() if not FAULTS[k].like_model)
        clear = sum(sure) > SENSORS.sure
        out[i] &= not clear and all(s.odds < 0.0 for s in weighed.swaps if i in s.nodes)
    return np.asarray(out)


def _near(survey: Survey) -> Bools:
    """Which nodes are near to each other, (n_node, n_node)."""
    xyz = survey.xyz[survey.slots[:, 0]]
    size = float(np.linalg.norm(np.ptp(xyz, axis=0)))
    apart = np.linalg.norm(xyz[:, None] - xyz[None, :], axis=2)
    np.fill_diagonal(apart, np.inf)
    return np.asarray(apart < SENSORS.near * size)


def _beside(before: Before, off: Floats) -> Before:
    """Assume more of a node near to others that are off in proportion by `off`."""
    spread = np.hypot(SENSORS.unlike * off, before.in_proportion[0, 2])
    alike = np.column_stack([np.full(len(off), SENSORS.beside / len(off)), off, spread])
    return replace(
        before,
        in_proportion=np.vstack([before.in_proportion, alike]),
        shares=(1.0 - SENSORS.beside) * before.shares + SENSORS.beside / len(LOCAL),
    )


def _axes(survey: Survey, i: int) -> Floats | None:
    rows = survey.rows(i)
    if np.any(survey.component[rows] > 3) or len(rows) > 3:
        return None
    return np.asarray(survey.axis[rows])


def _in_proportion(said: Prediction) -> Floats:
    """Error of every node in proportion to its prediction, over the rms of a shape, (n_node,)."""
    k = said.rows
    mean = said.mean[..., :k]
    one = np.diagonal(said.covariance[..., :k, :k], axis1=2, axis2=3) + said.noise
    square = np.maximum(np.sum(mean**2 / one, axis=(1, 2)), SENSORS.least_variance)
    gain = np.sum(mean * said.reading / one, axis=(1, 2)) / square
    return np.asarray((gain - 1.0) * np.sqrt(np.mean(mean**2, axis=(1, 2))))
