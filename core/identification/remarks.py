"""What is to be said of each mode, and of all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats, Numbers
from ..errors import InputError
from .identification_numbers import IDENTIFICATION
from .mode_table import ModeTable, Physical
from .poles.band_sweeps import BandFit
from .survey.survey_data import Survey
from .survey.survey_numbers import SURVEY


def pair_possible(t: ModeTable, warnings: list[str]) -> Numbers:
    """Flag the modes behind which the references cannot see a second root; say why."""
    n = len(t.poles)
    if not n:
        return np.zeros(0, bool)
    part = t.participation / np.linalg.norm(t.participation, axis=0)
    singular = np.linalg.svd(part, compute_uv=False)
    if len(t.participation) == 1:
        warnings.append(
            "one reference cannot tell two roots at the same frequency apart: a close pair may "
            "hide behind any of the modes"
        )
        return np.ones(n, bool)
    if n > 1 and len(singular) > 1 and singular[1] < IDENTIFICATION.input_rank * singular[0]:
        warnings.append(
            "all references excite the same combination of modes, as one reference would: a "
            "close pair may hide behind any of the modes"
        )
        return np.ones(n, bool)
    return np.zeros(n, bool)


def of_leakage(hz: Floats, blurred: Numbers) -> list[str]:
    """Name the modes whose damping a window may have raised."""
    if not blurred.any():
        return []
    which = ", ".join(f"{f:.2f}" for f in hz[blurred][: SURVEY.named])
    which += ", ..." if np.count_nonzero(blurred) > SURVEY.named else ""
    return [
        f"{np.count_nonzero(blurred)} mode(s) ({which} Hz) are narrow for the lines and leave a "
        "residual that is not noise (leakage): their damping may be too high, as its standard "
        "error says"
    ]


def of_own_poles(fits: tuple[BandFit, ...]) -> list[str]:
    """Say that functions were brought to one set of poles."""
    if all(b.measured is b.data for b in fits):
        return []
    return [
        "the frequencies of the modes differ from response to response (mass of a roving sensor, "
        "temperature, force): the functions were brought to their means before shapes were fitted"
    ]


def of_window(poles: Numbers, damping: Floats, std: Floats, decay: float) -> list[str]:
    """Say what was taken out for an exponential window.

    Raises
    ------
    InputError
        The window damps more than what was measured.
    """
    if decay == 0.0 or not len(poles):
        return []
    below = damping < -SURVEY.window_sure * std
    if below.any():
        k = int(np.argmin(damping / std))
        hz, share = np.abs(poles[k]) / (2.0 * np.pi), decay / np.abs(poles[k])
        raise InputError(
            f"an exponential window of {1.0 / decay:.4g} s makes {100.0 * share:.3g} % of damping "
            f"at {hz:.2f} Hz, where all in all {100.0 * (damping[k] + share):.3g} % was measured: "
            "it was not the window of these functions"
        )
    return [
        f"the damping that an exponential window of {1.0 / decay:.4g} s adds is taken out of the "
        "modes, not out of the roots rejected and the stabilisation chart"
    ]


@dataclass(frozen=True, eq=False)
class Judged:
    """What modes are judged by, (n_mode,) each; `reciprocity` from `reciprocity_of_modes`."""

    quality: Floats
    mpc: Floats
    indicator: Floats
    mass: Floats
    reciprocity: Floats

    @property
    def doubted(self) -> Bools:
        """Which may be no modes: no resonance of all responses, or a shape with no one phase."""
        complex_shape = self.mpc < IDENTIFICATION.poor_mpc
        return np.asarray(complex_shape | (self.indicator < IDENTIFICATION.poor_indicator))


def of_modes(survey: Survey, t: ModeTable, p: Physical, judged: Judged) -> tuple[str, ...]:
    """Say what makes each mode a poor one; empty for a mode without reproach."""
    texts = []
    again = _seen_alike(t)
    for k, hz in enumerate(t.hz):
        found = _of_figures(judged, k)
        if again[k]:
            others = ", ".join(f"{f:.2f}" for f in t.hz[again[k]])
            found.append(
                f"the references see it as they do {others} Hz, at other responses: perhaps one "
                "resonance whose frequency differs from response to response"
            )
        found += _of_shape(p, k, survey.outputs.labels)
        if survey.coherence is not None:
            coherence = survey.coherence[int(np.argmin(np.abs(survey.frequencies_hz - hz)))]
            if coherence < SURVEY.coherent:
                found.append(f"low coherence at its resonance ({coherence:.2f})")
        width = abs(t.poles[k].real) / np.pi
        if any(abs(hz - edge) < width for ends in survey.ranges for edge in ends):
            found.append("at the edge of the measured range")
        texts.append("; ".join(found))
    return tuple(texts)


def _of_figures(value: Judged, k: int) -> list[str]:
    """Say which figures of a mode are poor."""
    known = value.mass[np.isfinite(value.mass)]
    mass = value.mass / (np.median(known) if len(known) else 1.0)
    told = (
        (value.quality[k] < IDENTIFICATION.poor_quality,
         f"synthesised and measured functions agree to {value.quality[k]:.2f} only"),
        (value.mpc[k] < IDENTIFICATION.poor_mpc,
         f"complex shape (phase collinearity {value.mpc[k]:.2f})"),
        (value.indicator[k] < IDENTIFICATION.poor_indicator,
         f"no clear resonance of all responses (mode indicator {value.indicator[k]:.2f})"),
        (value.reciprocity[k] < IDENTIFICATION.poor_reciprocity,
         "not reciprocal: at the driving points its shape and what the references see of it agree "
         f"to {value.reciprocity[k]:.2f} only"),
        (mass[k] > IDENTIFICATION.heavy, f"implausible modal mass ({mass[k]:.0f} times the usual)"),
    )  # fmt: skip
    return [text for poor, text in told if poor]


def _of_shape(p: Physical, k: int, labels: Sequence[str]) -> list[str]:
    """Say what of a shape is not known."""
    found = []
    sure, std, shape = p.known[:, k], p.std[:, k], p.real[:, k] / p.real_size[k]
    if np.any(std[~sure] > SURVEY.known * np.abs(shape[sure]).max(initial=0.0)):
        where = [labels[o] for o in np.flatnonzero(~sure)[: SURVEY.named]]
        found.append(f"its shape is hardly known at {', '.join(where)}")
    spread = np.sqrt(np.mean(std[sure] ** 2) / np.mean(shape[sure] ** 2))
    if spread > IDENTIFICATION.weak:
        found.append(f"uncertain shape ({100 * spread:.0f} %)")
    return found


def _seen_alike(t: ModeTable) -> list[list[int]]:
    """Modes near each one that have its participation, but shapes of other responses.

    A structure has no two such modes: where it is driven, participation is the shape. A single
    reference sees all modes alike; there it is told where most modes have such a one.
    """
    part, shapes = (x / np.linalg.norm(x, axis=0) for x in (t.participation, t.shapes))
    alike = np.abs(part.conj().T @ part) ** 2 > IDENTIFICATION.one_participation
    apart = (np.abs(shapes).T @ np.abs(shapes)) ** 2 < IDENTIFICATION.other_responses
    near = np.abs(t.hz - t.hz[:, None]) < IDENTIFICATION.beside * t.hz
    found = alike & apart & near
    twice = np.count_nonzero(found.any(axis=1))
    if len(part) == 1 and twice < IDENTIFICATION.most * len(found):
        return [[] for _ in found]
    return [np.flatnonzero(row).tolist() for row in found]
