"""All that the nodes which were set aside may be, weighed against each other."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import expit, logsumexp

from ..arrays import Bools, Floats, Ints
from .alternatives import Alternative, Before, alternatives
from .readings import LOCAL, likelihood, local_shares, node_of
from .survey import Prediction, Span, Survey, predict
from .suspects import LEVELS, SUSPICIOUS, distance, level_of
from .swaps import Swap, swaps

_FAULTY = 0.5
"""Faulty nodes that are expected of a test."""
_IN_PROPORTION = 0.05
"""Share of nodes at which a model may be wrong by a factor of its own in all modes,"""
_BESIDE, _NEAR = 0.4, 0.15
"""and of those nearer than this part of the structure to another that is off its prediction."""
_SURE = 0.9
_NO_MODEL = {"sensor_polarity", "sensor_swap"}
"""What no error of a model looks like."""


@dataclass(frozen=True, eq=False)
class Weighed:
    """Alternatives of the nodes that were set aside.

    Parameters
    ----------
    survey : Survey
    aside : (n_node,) bool
    sigma : float
        Noise of a sound sensor over the rms of its shape.
    alone : dict of int to list of Alternative
        By node.
    swaps : list of Swap
        The likeliest first.
    """

    survey: Survey
    aside: Bools
    sigma: float
    alone: dict[int, list[Alternative]]
    swaps: list[Swap]

    def shares(self, i: int) -> dict[str, float]:
        """Return how likely each kind of fault of a node is but for swaps with others."""
        return _shares(self.alone[i])

    @property
    def guilt(self) -> Floats:
        """Chance that a node is faulty in one way or another, (n_node,)."""
        out = np.zeros(len(self.aside))
        for i in self.alone:
            odds = logsumexp([-np.inf, *(s.odds for s in self.swaps if i in s.nodes)])
            swapped = float(expit(odds))
            out[i] = swapped + (1.0 - swapped) * sum(self.shares(i).values())
        return out


def _shares(every: list[Alternative]) -> dict[str, float]:
    total = logsumexp([a.log for a in every])
    return {
        k: float(np.exp(logsumexp([a.log for a in every if a.kind == k]) - total))
        for k in {a.kind for a in every if a.faulty}
    }


def weigh(survey: Survey, span: Span, aside: Bools) -> Weighed:
    """Weigh what nodes may be that were set aside, all others taken as sound.

    Parameters
    ----------
    survey : Survey
    span : Span
        As `Span.seen`.
    aside : (n_node,) bool
    """
    level, width = level_of(survey, span.along_only(), aside)
    sigma = float(LEVELS[level])
    said = predict(survey, span, sigma, width, aside)
    count = (survey.slots >= 0).sum(axis=1)
    nodes = {i: node_of(said, i, int(count[i])) for i in range(len(aside))}
    sound = np.flatnonzero(~aside)
    likely = np.array([likelihood(nodes[i], nodes[i].identity[None])[0] for i in sound.tolist()])
    before = Before(
        _FAULTY / len(aside), local_shares(likely), _IN_PROPORTION, _proportion(said, sound)
    )
    doubted = np.flatnonzero(aside).tolist()
    alone = {i: alternatives(nodes[i], _axes(survey, i), before) for i in doubted}
    crossed = swaps(nodes, doubted, alone, before)
    off = _disturbed(survey, said, Weighed(survey, aside, sigma, alone, crossed))
    beside = _beside(survey, off)
    if beside.any():
        local = replace(
            before,
            in_proportion=_BESIDE,
            shares=(1.0 - _BESIDE) * before.shares + _BESIDE / len(LOCAL),
        )
        for i in np.flatnonzero(beside & aside).tolist():
            alone[i] = alternatives(nodes[i], _axes(survey, i), local)
        crossed = swaps(nodes, doubted, alone, before)
    return Weighed(survey, aside, sigma, alone, crossed)


def _disturbed(survey: Survey, said: Prediction, weighed: Weighed) -> Bools:
    """Nodes that are off their prediction by something that a model may have wrong, (n_node,)."""
    off = distance(said, (survey.slots >= 0).sum(axis=1))
    out = weighed.aside & (off > SUSPICIOUS * max(1.0, float(np.median(off[~weighed.aside]))))
    for i in weighed.alone:
        clear = sum(p for k, p in weighed.shares(i).items() if k in _NO_MODEL) > _SURE
        out[i] &= not clear and all(s.odds < 0.0 for s in weighed.swaps if i in s.nodes)
    return np.asarray(out)


def _beside(survey: Survey, off: Bools) -> Bools:
    """Nodes near to another that is off, (n_node,)."""
    xyz = survey.xyz[survey.slots[:, 0]]
    size = float(np.linalg.norm(np.ptp(xyz, axis=0)))
    apart = np.linalg.norm(xyz[:, None] - xyz[None, :], axis=2)
    np.fill_diagonal(apart, np.inf)
    return np.asarray((apart[:, off] < _NEAR * size).any(axis=1))


def _axes(survey: Survey, i: int) -> Floats | None:
    rows = survey.rows(i)
    if np.any(survey.component[rows] > 3) or len(rows) > 3:
        return None
    return np.asarray(survey.axis[rows])


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
