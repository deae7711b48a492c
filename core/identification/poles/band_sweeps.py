"""All bands together: each fitted with what the modes of the others contribute taken away."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Floats, Numbers
from ..survey.modal_synthesis import modal_response
from ..survey.mode_indicator import Band
from ..survey.survey_data import Survey
from .moments import BandData, band_data
from .pole_candidates import Proposal
from .pole_numbers import POLES
from .pole_selection import prune, select
from .pole_splitting import plausible
from .significance import significance
from .start_values import start_from
from .variable_projection import Fit, fit_shapes


@dataclass(frozen=True, eq=False)
class Roots:
    """Modes of the whole range, by rising frequency, in the weighting of the survey.

    Parameters
    ----------
    poles : (n_mode,) complex
    participation : (n_input, n_mode) complex
    shapes : (n_output, n_mode) complex
    """

    poles: Numbers
    participation: Numbers
    shapes: Numbers

    @property
    def hz(self) -> Floats:
        """Undamped natural frequencies."""
        return np.asarray(np.abs(self.poles) / (2.0 * np.pi))


@dataclass(frozen=True, eq=False)
class BandFit:
    """A band explained by its modes.

    Parameters
    ----------
    band : Band
    frequencies_hz : (n_line,) float
    data : BandData
        With the modes beyond the band taken away.
    fit : Fit
    significance : (n_mode,) float
    core : (n_mode,) bool
        The modes that this band answers for.
    background : (n_mode,) bool
        Roots beside or beneath the modes, see `plausible`.
    """

    band: Band
    frequencies_hz: Floats
    data: BandData
    fit: Fit
    significance: Floats
    core: Numbers
    background: Numbers


def fit_range(
    survey: Survey, bands: tuple[Band, ...], proposals: tuple[Proposal, ...]
) -> tuple[BandFit, ...]:
    """Fit all bands, first each for itself, then with the contributions of all others removed."""
    owned: list[Roots] = []
    beside: list[Roots] = []
    for band, proposed in zip(bands, proposals, strict=True):
        f, data = _data(survey, band, None)
        fit = prune(data, f, start_from(data, proposed.firm))
        owned.append(_core(f, fit, band))
        beside.append(_background(f, fit))
    owned = _without_doubles(owned)
    for n, (band, proposed) in enumerate(zip(bands, proposals, strict=True)):
        near, far = _near_and_far(_joined(owned), band)
        f, data = _data(survey, band, far)
        near = _joined([near, beside[n]])
        start = Fit(near.poles, near.participation, near.shapes, np.inf)
        fit = select(data, f, start, proposed.more, band.low, band.high)
        owned[n] = _core(f, fit, band)
        beside[n] = _background(f, fit)
        owned = _without_doubles(owned)
    for sweep in range(POLES.final_sweeps):
        done = []
        for n, band in enumerate(bands):
            near, far = _near_and_far(_joined(owned), band)
            f, data = _data(survey, band, far)
            near = _joined([near, beside[n]])
            fit = prune(data, f, fit_shapes(data, near.poles, near.participation))
            owned[n] = _core(f, fit, band)
            owned = _without_doubles(owned)
            beside[n] = _background(f, fit)
            if sweep == POLES.final_sweeps - 1:
                value = significance(data, f, fit)
                mine = np.isin(fit.poles, owned[n].poles)
                aside = ~plausible(f, fit)
                done.append(BandFit(band, f, data, fit, value, mine, aside))
    return tuple(done)


def _data(survey: Survey, band: Band, far: Roots | None) -> tuple[Floats, BandData]:
    lines = survey.lines(band.first, band.last)
    f = survey.frequencies_hz[lines]
    values = survey.values[:, :, lines]
    if far is not None and len(far.poles):
        values = values - modal_response(
            f, far.poles, far.shapes, far.participation, survey.quantity
        )
    return f, band_data(f, values, survey.measured, survey.order)


def _roots(fit: Fit) -> Roots:
    return Roots(fit.poles, fit.participation, fit.shapes)


def _core(f: Floats, fit: Fit, band: Band) -> Roots:
    """Modes of a fit that belong to the core of its band."""
    hz = np.abs(fit.poles) / (2.0 * np.pi)
    reach = np.abs(fit.poles.real) / (2.0 * np.pi) * POLES.same
    inside = (hz >= band.low - reach) & (hz <= band.high + reach)
    return _take(_roots(fit), inside & plausible(f, fit))


def _background(f: Floats, fit: Fit) -> Roots:
    return _take(_roots(fit), ~plausible(f, fit))


def _joined(owned: list[Roots]) -> Roots:
    poles = np.concatenate([r.poles for r in owned])
    order = np.argsort(np.abs(poles), kind="stable")
    return Roots(
        poles[order],
        np.concatenate([r.participation for r in owned], axis=1)[:, order],
        np.concatenate([r.shapes for r in owned], axis=1)[:, order],
    )


def _without_doubles(owned: list[Roots]) -> list[Roots]:
    """Drop from a band the roots at its edges that the band below found as well."""
    cleaned = owned[:1]
    for roots in owned[1:]:
        below = cleaned[-1]
        keep = np.ones(len(roots.poles), bool)
        for pole in below.poles:
            gap = np.abs(roots.poles - pole)
            if len(gap) and gap.min() < POLES.same * abs(pole.real):
                keep[int(np.argmin(gap))] = False
        cleaned.append(
            Roots(roots.poles[keep], roots.participation[:, keep], roots.shapes[:, keep])
        )
    return cleaned


def _near_and_far(roots: Roots, band: Band) -> tuple[Roots, Roots]:
    near = (roots.hz >= band.first) & (roots.hz <= band.last)
    return _take(roots, near), _take(roots, ~near)


def _take(roots: Roots, keep: Numbers) -> Roots:
    return Roots(roots.poles[keep], roots.participation[:, keep], roots.shapes[:, keep])
