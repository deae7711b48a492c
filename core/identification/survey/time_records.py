"""Time records that functions were made of: clipped, or hit twice."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ...arrays import Floats
from ...noun import Noun
from .faults import Fault, listed
from .survey_numbers import SURVEY


@dataclass(frozen=True, eq=False)
class TimeRecord(Noun):
    """What one channel recorded.

    Parameters
    ----------
    name : str
        Point and direction, such as ``40:Z``.
    times : (n_sample,) float
        s.
    values : (n_sample,) float
    is_force : bool
    """

    name: str
    times: Floats
    values: Floats
    is_force: bool


def faults_of_records(records: Iterable[TimeRecord]) -> tuple[Fault, ...]:
    """Name the records that are cut off at one value, and the hammer blows that are two."""
    cut, hits = [], []
    for record in records:
        if is_clipped(record.values):
            cut.append(record.name)
        after = second_blow(record.times, record.values) if record.is_force else 0.0
        if after > 0.0:
            hits.append((record.name, 1e3 * after))
    faults = []
    if cut:
        sentence = f"time records of {listed(cut)}: cut off at one value (an overload)"
        faults.append(Fault("overload", tuple(cut), sentence))
    if hits:
        said = listed([f"{name} ({after:.3g} ms after)" for name, after in hits])
        sentence = f"force records of {said}: a second blow behind the first"
        faults.append(Fault("double_hit", tuple(name for name, _ in hits), sentence))
    return tuple(faults)


def is_clipped(values: Floats) -> bool:
    """Tell a record that stays at its largest or smallest value for some samples in a row.

    It comes there by more than the steps that its values have: slow records of few bits stay, too.
    """
    span = float(np.ptp(values)) if len(values) else 0.0
    if span == 0.0:
        return False
    steps = np.abs(np.diff(values))
    least = SURVEY.flat_steps * steps[steps > SURVEY.flat * span].min()
    for x in (values, -values):
        flat = (x >= x.max() - SURVEY.flat * span) & (np.abs(x) > SURVEY.flat_off_zero * span)
        first, end = np.flatnonzero(np.diff(np.concatenate([[0], flat, [0]]))).reshape(-1, 2).T
        rises = np.where(first > 0, x[first] - x[first - 1], np.inf)
        if ((end - first >= SURVEY.flat_samples) & (rises > least)).any():
            return True
    return False


def second_blow(times: Floats, force: Floats) -> float:
    """Return how long after the first a second blow follows [s], 0 where none does.

    A force that is no single pulse, as that of a shaker or of many blows, has none.
    """
    size = np.abs(force - np.median(force))
    top = int(np.argmax(size)) if len(size) else 0
    if not len(size) or size[top] == 0.0:
        return 0.0
    above = size >= SURVEY.blow_second * size[top]
    ends = np.flatnonzero(~above)
    first = ends[ends < top].max(initial=-1) + 1
    last = ends[ends > top].min(initial=len(size)) - 1
    width = last - first + 1
    away = np.abs(np.arange(len(size)) - top) > SURVEY.blow_widths * width
    near = np.abs(times - times[top]) <= SURVEY.blow_reach
    others = np.flatnonzero(above & away)
    if not len(others) or not near[others].all():
        return 0.0
    pulse = float(np.sum(size[~away] ** 2)) / float(np.sum(size**2))
    other = others[int(np.argmax(size[others]))]
    return float(abs(times[other] - times[top])) if pulse > SURVEY.blow_share else 0.0
