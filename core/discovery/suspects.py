"""Which nodes contradict all the others, and how noisy the others are."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..arrays import Bools, Floats, Ints
from .survey import Prediction, Span, Survey, predict

LEVELS = 0.008 * 1.4 ** np.arange(10)
"""Noise of a sound sensor over the rms of its shape that is thought possible."""
_WIDTHS = 0.03 * 2.0 ** np.arange(5)
_EVERY = range(len(LEVELS))
_TRUSTED = 0.85
"""Share of the nodes, the best predicted ones, by which the noise is judged."""
SUSPICIOUS = 4.0
_MOST, _ALWAYS = 0.25, 4


def suspects(survey: Survey, span: Span) -> Bools:
    """Set nodes aside one by one, the worst first, the noise judged again each time.

    A few are set aside in any case: a fault that the others' predictions share in hides itself.
    """
    near = span.along_only()
    count = (survey.slots >= 0).sum(axis=1)
    masked = np.zeros(len(count), bool)
    level, width = level_of(survey, near, masked)
    always = min(_ALWAYS, len(count) // 8)
    for number in range(max(always, int(_MOST * len(count)))):
        off = distance(predict(survey, near, float(LEVELS[level]), width, masked), count)
        off = off / max(1.0, float(np.median(off[~masked])))
        off[masked] = 0.0
        worst = int(np.argmax(off))
        if off[worst] < SUSPICIOUS and number >= always:
            break
        masked[worst] = True
        level, width = level_of(survey, near, masked, range(max(0, level - 1), level + 1))
    return masked


def distance(said: Prediction, count: Ints) -> Floats:
    """Squared distance of each node from its prediction a degree of freedom, (n_node,)."""
    k = said.rows
    S = said.covariance[..., :k, :k].copy()
    S[..., np.arange(k), np.arange(k)] += said.noise
    off = said.reading - said.mean[..., :k]
    square = np.einsum("nmk,nmk->nm", off, np.linalg.solve(S, off[..., None])[..., 0])
    return np.asarray(np.minimum(square / count[:, None], 30.0).mean(axis=1))


def level_of(
    survey: Survey, span: Span, masked: Bools, among: Iterable[int] = _EVERY
) -> tuple[int, Floats]:
    """Noise, by its number in `LEVELS`, and width of every mode that make the nodes likeliest.

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
                survey, span, float(LEVELS[number]), np.full(modes, float(width)), masked
            )
            one = np.diagonal(said.covariance, axis1=2, axis2=3) + said.noise
            off = said.reading - said.mean
            log = np.where(there, off**2 / one + np.log(one), 0.0).sum(axis=2)
            each[w] = -np.sort(log[~masked], axis=0)[:keep].sum(axis=0)
        total = float(each.max(axis=0).sum())
        if total > best:
            best, at, widths = total, number, _WIDTHS[each.argmax(axis=0)]
    return at, widths
