"""The middle of what the magnitude of an effect may be, where the test hardly tells it.

A joint or a support that gives much does what one does that gives a hundred times as much: the
likelihood is flat on that side, and where it is highest says little. So the evidence is found at
magnitudes on either side, all else following, and the median of what is likely is told.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from scipy.special import ndtr

from ...arrays import Floats
from ..effects.candidates import Suspect
from ..effects.effect_numbers import EFFECTS
from ..likelihood.map_fit import evaluate
from .diffuse_fit import Judged, everything, judged
from .model_error_numbers import MODEL_ERROR

_QUANTILES = ndtr([-1.0, 0.0, 1.0])


def centred(found: Judged) -> Judged:
    """Return a hypothesis with each magnitude that is hardly told in the middle of its posterior.

    Its deviation stands in the information. Magnitudes that come in pairs stay.
    """
    for k, s in enumerate(found.state.suspects):
        deviation = float(np.sqrt(_variance(found, k)))
        if len(s.theta) == 1 and deviation > MODEL_ERROR.told:
            found = _centred(found, k, deviation)
    return found


def _centred(found: Judged, number: int, deviation: float) -> Judged:
    """Return a hypothesis with one magnitude in the middle."""
    known = dict(_profile(found, number, deviation))
    theta = np.array(sorted(known))
    log = np.array([known[t] for t in theta.tolist()])
    fine = np.linspace(theta[0], theta[-1], MODEL_ERROR.profile_fine)
    share = np.cumsum(np.exp(np.interp(fine, theta, log) - log.max()))
    return _put(found, number, np.interp(_QUANTILES, share / share[-1], fine))


def amid(found: Judged, others: Sequence[Judged]) -> Judged:
    """Return a hypothesis, first magnitudes in the middle of where several others have them.

    These have as many suspects, and are as likely as each other, whatever the test says.
    """
    for k in range(len(found.state.suspects)):
        theta = np.array([other.state.suspects[k].theta[0] for other in others])
        deviation = np.sqrt([_variance(other, k) for other in others])
        ends = theta + np.outer([-1.0, 1.0], MODEL_ERROR.profile_depth * deviation)
        fine = np.linspace(ends.min(), ends.max(), MODEL_ERROR.profile_fine)
        share = ndtr((fine[:, None] - theta) / deviation).mean(axis=1)
        found = _put(found, k, np.interp(_QUANTILES, share, fine))
    return found


def _row(found: Judged, number: int) -> int:
    """Return the row of the information that is the first magnitude of a suspect's."""
    return len(found.information) - sum(len(s.theta) for s in found.state.suspects[number:])


def _variance(found: Judged, number: int) -> float:
    """Return the variance of the first magnitude of a suspect."""
    own = _row(found, number)
    return float(np.linalg.pinv(found.information)[own, own])


def _put(found: Judged, number: int, quantiles: Floats) -> Judged:
    """Return a hypothesis with the first magnitude of a suspect at the middle of quantiles."""
    low, middle, high = quantiles
    H, own = found.information.copy(), _row(found, number)
    H[own, own] += 1.0 / (0.5 * (high - low)) ** 2 - 1.0 / _variance(found, number)
    fit, state = (
        replace(f, suspects=_at(f.suspects, number, middle)) for f in (found.fit, found.state)
    )
    return replace(found, fit=fit, state=state, information=H)


def _profile(found: Judged, number: int, deviation: float) -> Iterator[tuple[float, float]]:
    """Yield magnitudes θ and ln of how likely each is, up to a constant."""
    s = found.state.suspects[number]
    (middle,), c = s.theta, found.problem.catalogue[s.kind]
    least, largest, wider = MODEL_ERROR.profile
    most = _log(found, number, middle)
    yield middle, most
    for side in (-1.0, 1.0):
        step, theta, log = side * np.clip(deviation, least, largest), middle, most
        while log > most - MODEL_ERROR.profile_depth:
            before, theta = theta, float(c.within(np.array([theta + step]))[0])
            if theta == before:
                break
            log, step = _log(found, number, theta), wider * step
            most = max(most, log)
            yield theta, log


def _log(found: Judged, number: int, theta: float) -> float:
    """Return ln of the posterior of one magnitude, all else integrated out."""
    kind, at = found.state.suspects[number].kind, np.array([theta])
    prior = found.problem.catalogue[kind]
    held = replace(prior, typical=at, spread=np.array([EFFECTS.held]))
    catalogue = tuple(held if k == kind else c for k, c in enumerate(found.problem.catalogue))
    problem = replace(found.problem, catalogue=catalogue)
    start = evaluate(problem, found.state.nuisance, _at(found.state.suspects, number, theta))
    there = judged(problem, start, everything(problem), found.diffuse)
    return there.evidence - 0.5 * float(prior.surprise(at))


def _at(suspects: tuple[Suspect, ...], number: int, theta: float) -> tuple[Suspect, ...]:
    """Return suspects, one of which has another first magnitude."""
    own = suspects[number]
    moved = own.moved(np.append(theta, own.theta[1:]))
    return (*suspects[:number], moved, *suspects[number + 1 :])
