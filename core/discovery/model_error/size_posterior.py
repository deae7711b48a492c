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
    each = [len(s.theta) for s in found.state.suspects]
    first = len(found.information) - sum(each)
    for k, n in enumerate(each):
        own = first + sum(each[:k])
        deviation = float(np.sqrt(np.linalg.pinv(found.information)[own, own]))
        if n == 1 and deviation > MODEL_ERROR.told:
            found = _centred(found, k, own, deviation)
    return found


def _centred(found: Judged, number: int, own: int, deviation: float) -> Judged:
    """Return a hypothesis with one magnitude, a row of the information, in the middle."""
    known = dict(_profile(found, number, deviation))
    theta = np.array(sorted(known))
    log = np.array([known[t] for t in theta.tolist()])
    fine = np.linspace(theta[0], theta[-1], MODEL_ERROR.profile_fine)
    share = np.cumsum(np.exp(np.interp(fine, theta, log) - log.max()))
    return _put(found, number, own, np.interp(_QUANTILES, share / share[-1], fine))


def amid(found: Judged, others: Sequence[Judged]) -> Judged:
    """Return a hypothesis, first magnitudes in the middle of where several others have them.

    These have as many suspects, and are as likely as each other, whatever the test says.
    """
    each = [len(s.theta) for s in found.state.suspects]
    for k in range(len(each)):
        theta, deviation = np.transpose([_first(other, k) for other in others])
        ends = theta + np.outer([-1.0, 1.0], MODEL_ERROR.profile_depth * deviation)
        fine = np.linspace(ends.min(), ends.max(), MODEL_ERROR.profile_fine)
        share = ndtr((fine[:, None] - theta) / deviation).mean(axis=1)
        own = len(found.information) - sum(each[k:])
        found = _put(found, k, own, np.interp(_QUANTILES, share, fine))
    return found


def _first(found: Judged, number: int) -> tuple[float, float]:
    """Return the first magnitude of a suspect and its standard deviation."""
    suspects = found.state.suspects
    own = len(found.information) - sum(len(s.theta) for s in suspects[number:])
    return suspects[number].theta[0], float(np.sqrt(np.linalg.pinv(found.information)[own, own]))


def _put(found: Judged, number: int, own: int, quantiles: Floats) -> Judged:
    """Return a hypothesis with the first magnitude of a suspect, a row of the information, put."""
    low, middle, high = quantiles
    H = found.information.copy()
    H[own, own] += 1.0 / (0.5 * (high - low)) ** 2 - 1.0 / np.linalg.pinv(H)[own, own]
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
