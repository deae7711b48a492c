"""The participation that the functions of every output follow at resonances, and how well."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Floats, Ints, Numbers
from .survey_data import Survey, few_at_a_time, noise_levels
from .survey_numbers import SURVEY


@dataclass(frozen=True, eq=False)
class Followed:
    """Functions of outputs at the lines where one mode rules, and the direction they follow there.

    Parameters
    ----------
    functions : (n_output, n_input, n_clear) complex
        Less the mean of the lines on either side, which leaves a peak its own mode; peaks made
        equal.
    noise : (n_output, n_input, n_clear) float
        Of the functions, as lines beside each other tell it.
    participation : (n_input, n_clear) complex
    peak : (n_clear,) int
        To which each line belongs.
    """

    functions: Numbers
    noise: Floats
    participation: Numbers
    peak: Ints

    def left(self, functions: Numbers) -> Floats:
        """Share of each output's functions that does not follow, (n_output, 1 + n_peak).

        At all peaks first, then at all but one each time.
        """
        power = np.sum(np.abs(functions) ** 2, axis=1)
        amplitude = np.einsum("oin,in->on", functions, self.participation.conj())
        member = (self.peak[:, None] == np.unique(self.peak)).astype(float)
        total, along = power @ member, np.abs(amplitude) ** 2 @ member
        without = np.eye(member.shape[1] + 1)[1:]
        total, along = (x.sum(axis=1, keepdims=True) - x @ without for x in (total, along))
        return np.asarray(1.0 - along / np.maximum(total, 1e-300))

    @property
    def unlike(self) -> float:
        """Sum over the outputs of the shares that do not follow."""
        return float(np.sum(self.left(self.functions)[:, 0]))

    def factors(self, k: int) -> Floats:
        """Real factor that makes function `k` of each output follow as the output's others do.

        Lines count by the part that the others have there, which makes the noise of what is
        expected even; NaN where that or the function itself does not stand well above its noise.
        """
        part = self.participation
        others = np.arange(len(part)) != k
        known = np.sqrt(np.sum(np.abs(part[others]) ** 2, axis=0))
        ratio = part[others].conj() * part[k] / np.maximum(known, 1e-300)
        expected = np.einsum("oin,in->on", self.functions[:, others], ratio)
        blur = np.einsum("oin,in->o", self.noise[:, others] ** 2, np.abs(ratio) ** 2)
        own = self.functions[:, k] * known
        total, least = np.sum(np.abs(own) ** 2, axis=1), SURVEY.gain_clear**2
        clear = np.sum(np.abs(expected) ** 2, axis=1) > least * blur
        clear &= total > least * np.sum((self.noise[:, k] * known) ** 2, axis=1)
        factor = np.sum((own.conj() * expected).real, axis=1) / np.maximum(total, 1e-300)
        return np.where(clear, factor, np.nan)


def followed(survey: Survey, rows: Ints) -> Followed | None:
    """Find what the functions of outputs `rows` follow at resonances.

    The participation at a line is the direction that leaves the least of the functions of all
    outputs, magnitudes and not squares summed, so that outputs which are wrong draw it aside
    little. None where peaks are few: what a mode does at its node looks like a fault at one peak,
    not at several.

    References
    ----------
    Lerman, Maunu (2018), Fast, robust and non-convex subspace recovery, Information and
    Inference 7, 277-336.
    """
    from scipy.signal import find_peaks

    raw = survey.values[rows]
    size = np.linalg.norm(raw, axis=(1, 2))
    raw = raw / np.maximum(size, np.median(size))[:, None, None]
    level = np.sqrt(np.sum(np.abs(raw) ** 2, axis=(0, 1)))
    decibel = 20.0 * np.log10(np.maximum(level, 1e-300))
    tops, _ = find_peaks(decibel, prominence=SURVEY.signs_prominence_db)
    if len(tops) < SURVEY.signs_peaks:
        return None
    reach = np.arange(-SURVEY.signs_lines, SURVEY.signs_lines + 1)
    about = [np.unique(np.clip(t + reach, 0, len(level) - 1)) for t in tops]
    near = np.unique(np.concatenate(about))
    functions, whole = _less_beside(raw, survey, tops, level, near)
    weight = 1.0 / np.maximum(whole, 1e-300)
    about = [np.searchsorted(near, lines) for lines in about]
    for _ in range(SURVEY.signs_rounds):
        gram = np.einsum("o,oin,ojn->nij", weight, functions, functions.conj(), optimize=True)
        square, directions = np.linalg.eigh(gram)
        lines, scale, peak = _ruled(np.sqrt(np.maximum(square[:, ::-1], 0.0)), about)
        if not len(lines):
            return None
        own, part = functions[..., lines] * scale, directions[lines, :, -1].T
        away = np.maximum(_not_along(own, part), SURVEY.signs_follow)
        weight = 1.0 / np.maximum(np.linalg.norm(own, axis=(1, 2)) * np.sqrt(away), 1e-300)
    noise = noise_levels(raw)[:, :, None] * np.sqrt(1.0 + 2.0 * 0.5**2) * scale
    return Followed(own, noise, part, peak)


def _less_beside(
    functions: Numbers, survey: Survey, tops: Ints, level: Floats, near: Ints
) -> tuple[Numbers, Floats]:
    """Take off the mean of the lines a few typical half-power bandwidths to either side.

    Returned are the functions at the lines `near`, and the norm over all lines, (n_output,).
    """
    from scipy.signal import peak_widths

    width = float(np.median(peak_widths(level**2, tops, rel_height=0.5)[0]))
    reach = max(round(SURVEY.signs_beside * width), SURVEY.signs_lines + 1)
    result = np.empty((*functions.shape[:2], len(near)), functions.dtype)
    whole = np.empty(len(functions))
    for some in few_at_a_time(functions):
        left = np.zeros_like(functions[some])
        for lines in (survey.lines(*ends) for ends in survey.ranges):
            own, kept = functions[some][..., lines], left[..., lines]
            if own.shape[2] > 2 * reach:
                beside = own[..., : -2 * reach] + own[..., 2 * reach :]
                kept[..., reach:-reach] = own[..., reach:-reach] - 0.5 * beside
        result[some], whole[some] = left[..., near], np.linalg.norm(left, axis=(1, 2))
    return result, whole


def _not_along(functions: Numbers, part: Numbers) -> Floats:
    total = np.sum(np.abs(functions) ** 2, axis=(1, 2))
    along = np.sum(np.abs(np.einsum("oin,in->on", functions, part.conj())) ** 2, axis=1)
    return np.asarray(1.0 - along / np.maximum(total, 1e-300))


def _ruled(size: Floats, about: Sequence[Ints]) -> tuple[Ints, Floats, Ints]:
    """Return lines at which one mode rules, weights that make peaks equal, the peak of each line.

    Parameters
    ----------
    size : (n_line, n_value) float
        Singular values.
    about : sequence of (k,) int
        The lines about each peak.
    """
    clear = size[:, 0] > SURVEY.signs_clear * np.sum(size[:, 1:2], axis=1)
    kept = [lines[clear[lines]] for lines in about if clear[lines].any()]
    if len(kept) < SURVEY.signs_peaks:
        return np.empty(0, np.int64), np.empty(0), np.empty(0, np.int64)
    weight = [np.full(len(k), 1.0 / np.linalg.norm(size[k, 0])) for k in kept]
    peak = np.repeat(np.arange(len(kept)), [len(k) for k in kept])
    return np.concatenate(kept), np.concatenate(weight), peak
