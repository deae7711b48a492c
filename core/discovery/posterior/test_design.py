"""What to measure next: the sensors and modes that tell rival hypotheses apart."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Bools, Floats, Ints
from ...correlation.correlation_numbers import CORRELATION
from ...data.parametric_model import Model
from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.likelihood_numbers import LIKELIHOOD
from ..likelihood.map_fit import misfit, solve
from .posterior_numbers import POSTERIOR

_TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True, eq=False)
class _Forecast:
    """Modes that a hypothesis has: `hz` (n,), translations `motion` (n_row, n), unit rms."""

    hz: Floats
    motion: Floats
    match: Ints


Rivals = tuple[tuple[str, Fit], ...]
"""Other explanations in words, most likely first."""


def further_sensors(
    problem: Problem, model: Model, best: Fit, rivals: Rivals, modes: Ints, stray: Bools
) -> tuple[str, ...]:
    """Name the grids of a model and directions where the explanations differ most.

    At most three, apart from each other, by what all the rivals together gain; `modes` (n_test,)
    are the numbers of the test modes of the evidence. A mode that is `stray` (n_test,), which
    nothing explains, tells no explanations apart.
    """
    if not rivals or stray.all():
        return ()
    rows = np.flatnonzero(model.dofs.component <= 3)
    own = _forecast(problem, best, rows)
    a = own.motion[:, own.match]
    apart = np.stack([_differences(a, _forecast(problem, f, rows)) for _, f in rivals])
    apart[:, :, stray] = 0.0
    told = np.einsum("rdm->d", np.minimum(apart, 1.0) ** 2)
    out: list[str] = []
    chosen: list[Floats] = []
    g = model.geometry
    at = g.index_of(model.dofs.node[rows])
    for d in np.argsort(-told, kind="stable"):
        rival, mode = np.unravel_index(int(np.argmax(apart[:, d])), (len(apart), a.shape[1]))
        if apart[rival, d, mode] < POSTERIOR.tells or len(out) == POSTERIOR.sensors:
            break
        xyz = g.xyz[at[d]]
        if any(np.linalg.norm(xyz - c) < POSTERIOR.sensors_apart * g.size for c in chosen):
            continue
        chosen.append(xyz)
        axis = "XYZ"[int(model.dofs.component[rows[d]]) - 1]
        by = apart[rival, d, mode]
        much = f"{100.0 * by:.0f} % of its rms" if by < 1.0 else "more than its rms"
        out.append(
            f"a sensor at grid {int(model.dofs.node[rows[d]])} in direction {axis}: there mode "
            f"{int(modes[mode])} differs by {much} between the best explanation and "
            f"{rivals[rival][0]}"
        )
    return tuple(out)


def further_modes(problem: Problem, model: Model, best: Fit, rivals: Rivals) -> tuple[str, ...]:
    """Name the mode that was not measured whose frequency differs most between explanations."""
    if not rivals:
        return ()
    rows = np.flatnonzero(model.dofs.component <= 3)
    own = _forecast(problem, best, rows)
    top = POSTERIOR.band_above * float(problem.whole.frequencies_hz.max())
    within = np.flatnonzero((own.hz < top) & (own.hz > LIKELIHOOD.elastic * top))
    new = np.setdiff1d(within, own.match)
    name, f = rivals[0]
    other = _forecast(problem, f, rows)
    if not len(new) or not len(other.hz):
        return ()
    mac = (own.motion[:, new].T @ other.motion) ** 2 / float(len(rows)) ** 2
    twin = np.argmax(mac, axis=1)
    shift = np.abs(np.log(np.maximum(other.hz[twin], _TINY) / own.hz[new]))
    shift = np.where(mac.max(axis=1) > POSTERIOR.twin, shift, 0.0)
    k = int(np.argmax(shift))
    if shift[k] < POSTERIOR.shift:
        return ()
    return (
        f"the mode near {own.hz[new[k]]:.4g} Hz, which was not measured: the best explanation has "
        f"it at {own.hz[new[k]]:.4g} Hz, {name} at {other.hz[twin[k]]:.4g} Hz",
    )


def _forecast(problem: Problem, f: Fit, rows: Ints) -> _Forecast:
    values, vectors = solve(problem, f.nuisance, f.suspects)
    n = min(problem.columns, len(values))
    motion = problem.basis.motion[rows] @ vectors[: problem.basis.size, :n]
    length = np.sqrt(np.mean(motion**2, axis=0))
    motion = motion / np.maximum(length, _TINY)
    hz = np.sqrt(np.maximum(values[:n], 0.0)) / (2.0 * np.pi)
    return _Forecast(hz, motion, misfit(problem, values, vectors)[1])


def _differences(a: Floats, other: _Forecast) -> Floats:
    """Differences of the matched shapes, (n_row, n_test).

    Close modes of the other explanation are turned within their subspace to be as alike as they
    can be.
    """
    out = np.empty_like(a)
    for j, k in enumerate(other.match):
        close = np.abs(np.log(np.maximum(other.hz, _TINY) / other.hz[k])) < CORRELATION.cluster
        B = other.motion[:, close]
        turned = B @ np.linalg.lstsq(B, a[:, j], rcond=None)[0]
        length = np.sqrt(np.mean(turned**2))
        out[:, j] = np.abs(a[:, j] - turned / max(length, _TINY))
    return out
