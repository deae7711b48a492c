"""Which nodes contradict all the others, and how noisy the others are."""

from collections.abc import Iterable

import numpy as np

from ...arrays import Bools, Floats, Ints
from .leave_one_out import Prediction, Span, Survey, predict
from .sensor_numbers import SENSORS

LEVELS = SENSORS.noise_least * SENSORS.noise_step ** np.arange(SENSORS.noise_levels)
"""Noise of a sound sensor over the rms of its shape that is thought possible."""
_SPREAD = range(1, len(LEVELS), SENSORS.noise_strides)
_WIDTHS = np.array(SENSORS.widths)


def suspects(survey: Survey, span: Span) -> tuple[Bools, int]:
    """Set nodes aside one by one, the worst first, the noise judged again each time.

    A few are set aside in any case: a fault that the others' predictions share in hides itself.
    Return which, and the number of the noise in `LEVELS`.
    """
    near = span.along_only()
    count = (survey.slots >= 0).sum(axis=1)
    masked = np.zeros(len(count), bool)
    level, width = level_of(survey, near, masked)
    always = min(SENSORS.aside_always, len(count) // SENSORS.aside_always_of)
    for number in range(max(always, int(SENSORS.aside_most * len(count)))):
        off = distance(predict(survey, near, float(LEVELS[level]), width, masked), count)
        off = off / max(1.0, float(np.median(off[~masked])))
        off[masked] = 0.0
        worst = int(np.argmax(off))
        if off[worst] < SENSORS.suspicious and number >= always:
            break
        masked[worst] = True
        level = _lowered(survey, near, masked, level, width)
    return masked, level


def distance(said: Prediction, count: Ints) -> Floats:
    """Squared distance of each node from its prediction a degree of freedom, (n_node,)."""
    k = said.rows
    S = said.covariance[..., :k, :k].copy()
    S[..., np.arange(k), np.arange(k)] += said.noise
    off = said.reading - said.mean[..., :k]
    square = np.einsum("nmk,nmk->nm", off, np.linalg.solve(S, off[..., None])[..., 0])
    return np.asarray(np.minimum(square / count[:, None], SENSORS.distance_most).mean(axis=1))


def level_of(
    survey: Survey, span: Span, masked: Bools, first: Iterable[int] = _SPREAD
) -> tuple[int, Floats]:
    """Noise, by its number in `LEVELS`, and width of every mode that make the nodes likeliest.

    Looked for at the `first` levels, then beside the best until none is likelier.
    """
    likely = {n: _likeliest(survey, span, masked, n) for n in first}
    while True:
        best = max(likely, key=lambda n: likely[n][0])
        beside = {best - 1, best + 1} & set(range(len(LEVELS))) - likely.keys()
        if not beside:
            return best, likely[best][1]
        likely |= {n: _likeliest(survey, span, masked, n) for n in sorted(beside)}


def _lowered(survey: Survey, span: Span, masked: Bools, level: int, width: Floats) -> int:
    """Return the level or the next lower one, whichever makes the nodes likelier."""
    if not level:
        return level
    here, lower = (
        float(_likelihood(survey, span, masked, n, width).sum()) for n in (level, level - 1)
    )
    return level - (lower > here)


def _likeliest(survey: Survey, span: Span, masked: Bools, level: int) -> tuple[float, Floats]:
    """Log likelihood at the best width of every mode, and these widths."""
    modes = len(survey.frequencies_hz)
    each = np.array(
        [_likelihood(survey, span, masked, level, np.full(modes, float(w))) for w in _WIDTHS]
    )
    return float(each.max(axis=0).sum()), _WIDTHS[each.argmax(axis=0)]


def _likelihood(survey: Survey, span: Span, masked: Bools, level: int, width: Floats) -> Floats:
    """Log likelihood of each mode at the nodes, the worst predicted ones left out, (n_mode,)."""
    said = predict(survey, span, float(LEVELS[level]), width, masked)
    keep = max(1, int(SENSORS.trusted * np.count_nonzero(~masked)))
    one = np.diagonal(said.covariance, axis1=2, axis2=3) + said.noise
    off = said.reading - said.mean
    there = (survey.slots >= 0)[:, None, :]
    log = np.where(there, off**2 / one + np.log(one), 0.0).sum(axis=2)
    return np.asarray(-np.sort(log[~masked], axis=0)[:keep].sum(axis=0))
