"""References whose gain changed during the survey: their functions are of two sizes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Floats, Ints
from .faults import Fault, listed
from .participation import followed
from .survey_data import Survey, told
from .survey_numbers import SURVEY


@dataclass(frozen=True, eq=False)
class _Step:
    """Outputs whose functions of an input are large, or small, and how far these are apart, ln."""

    large: Ints
    small: Ints
    gap: float
    apart: float

    @property
    def few(self) -> tuple[Ints, float]:
        """Return the smaller set and what brings it to the size of the other, ln."""
        if len(self.large) <= len(self.small):
            return self.large, -self.apart
        return self.small, self.apart


def gain_steps_mended(survey: Survey) -> Survey:
    """Bring the functions of a reference that are of two sizes to that of the more frequent one.

    The sizes are those that the functions of the other references expect at each point; two of
    these at least, for of two references either may have changed. In order sizes scatter, but leave
    no gap with many on either side; where references are exchanged at many points they scatter in
    one set, and no factor makes all functions agree.
    """
    rows = np.flatnonzero(survey.measured.all(axis=1))
    n_input = survey.values.shape[1]
    seen = followed(survey, rows) if n_input > 2 else None
    if seen is None:
        return survey
    steps = {k: _step(seen.factors(k)) for k in range(n_input)}
    k = max(steps, key=lambda i: steps[i].gap)
    step, mended, now = steps[k], survey, seen.unlike
    if step.gap == 0.0:
        return survey
    for _ in range(SURVEY.gain_step_rounds):
        few, by = step.few
        times = np.ones(len(rows))
        times[few] = np.exp(by)
        values = survey.values.copy()
        values[rows, k] *= times[:, None]
        mended = replace(survey, values=values)
        seen = followed(mended, rows)
        step = _step(seen.factors(k) * times) if seen is not None else step
        if seen is None or step.gap == 0.0:
            return survey
    if seen.unlike > SURVEY.gain_step_left * now:
        return survey
    names = tuple(survey.function(int(o), k) for o in rows[np.sort(few)])
    sentence = (
        f"{listed(names)}: about {np.exp(-by):.2g} times the size of the other functions of "
        f"{survey.inputs.labels[k]}, as the other references say (its gain changed during the "
        "survey); brought to one size, nothing tells which is right"
    )
    return told(mended, Fault("wrong_gain", names, sentence, "scaled"))


def _step(factor: Floats) -> _Step:
    """Return the widest gap between sizes with enough functions of one size on either side."""
    least = SURVEY.gain_step_least
    known = np.flatnonzero(factor > 0.0)
    known = known[np.argsort(factor[known])]
    size = -np.log(factor[known])
    gap = -np.diff(size)[least - 1 : len(size) - least]
    if len(gap) and gap.max() > np.log(SURVEY.gain_step):
        split = least + int(np.argmax(gap))
        large, small = size[:split], size[split:]
        few = min(large, small, key=len)
        if np.median(np.abs(few - np.median(few))) < SURVEY.gain_step_scatter:
            apart = float(np.median(large) - np.median(small))
            return _Step(known[:split], known[split:], float(gap.max()), apart)
    return _Step(known, known[:0], 0.0, 0.0)
