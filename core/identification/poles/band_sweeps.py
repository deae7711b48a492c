"""All bands together: each fitted with what the modes of the others contribute taken away."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Bools, Floats, Numbers
from ..survey.modal_synthesis import modal_response
from ..survey.mode_indicator import Band
from ..survey.survey_data import Survey
from .aligned_functions import aligned, distinct
from .moments import BandData, band_data
from .pole_candidates import Proposal
from .pole_numbers import POLES
from .pole_selection import prune, select
from .pole_splitting import modes_of, strength
from .soundness import satellites, survey_error
from .start_values import start_from
from .variable_projection import Fit, fit_shapes, refine


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
        With the modes beyond the band taken away, brought to one set of poles if need be.
    measured : BandData
        The same as measured, to judge errors by.
    fit : Fit
    core : (n_mode,) bool
        The modes that this band answers for.
    background : (n_mode,) bool
        Roots beside or beneath the modes, see `modes_of`.
    """

    band: Band
    frequencies_hz: Floats
    data: BandData
    measured: BandData
    fit: Fit
    core: Numbers
    background: Numbers


def fit_range(
    survey: Survey, bands: tuple[Band, ...], proposals: tuple[Proposal, ...]
) -> tuple[BandFit, ...]:
    """Fit all bands, each with the contributions of the modes of all others removed.

    Unless the stable poles leave far more than noise, the survey is first believed to hold one
    set of poles and noise. Where that leaves more than noise in the end, or not only because roots
    that scatter of the poles makes explain it, modes are searched for anew in the knowledge of the
    error, see `BandData`, and with functions brought to one set of poles where each output having
    its own explains that error.
    """
    of_outputs, of_inputs = survey.measured.shape
    none = Roots(*(np.empty(s, complex) for s in (0, (of_inputs, 0), (of_outputs, 0))))

    def proposed(n: int, data: BandData, f: Floats, start: Fit) -> Fit:
        start = start_from(data, proposals[n].firm)
        return refine(data, start.poles, start.participation)

    found = _Found([none] * len(bands), [none] * len(bands))
    for _ in _sweep(survey, bands, found, 0.0, proposed):
        pass
    error = _error(survey, bands, found)
    if error < POLES.error_surely:
        fits = _searched(survey, bands, proposals, found.copy(), 0.0)
        left = survey_error(_singly(b) for b in fits)
        if left < POLES.error_none:
            return fits
        error = max(error, left)
        del fits
    if of_inputs == 1:
        return _searched(survey, bands, proposals, found, error)
    of_one_set, found, error = _of_one_set_of_poles(survey, bands, found, error)
    fits = _searched(of_one_set, bands, proposals, found, error)
    return fits if of_one_set is survey else tuple(_as_measured(b, survey, fits) for b in fits)


def _error(survey: Survey, bands: tuple[Band, ...], found: _Found) -> float:
    """Refine all bands; return what is left over beyond noise."""

    def refined(n: int, data: BandData, f: Floats, start: Fit) -> Fit:
        return refine(data, start.poles, start.participation)

    swept = _sweep(survey, bands, found, 0.0, refined)
    return survey_error((b.measured, b.frequencies_hz, b.fit) for b in swept)


def _of_one_set_of_poles(
    survey: Survey, bands: tuple[Band, ...], found: _Found, error: float
) -> tuple[Survey, _Found, float]:
    """Bring the functions to one set of poles, where poles of each output explain the error.

    They are fitted to the same functions, so what they leave is less than the error that remains:
    the geometric mean with that before is taken for it.
    """
    best, least = (survey, found, error), POLES.align_better * error
    then = found
    for _ in range(POLES.align_times):
        roots = _joined(then.owned)
        fit = Fit(roots.poles, roots.participation, roots.shapes, np.inf)
        one = _take(roots, distinct(roots.poles, roots.participation, strength(fit)))
        own = [_take(r, np.isin(r.poles, one.poles)) for r in then.owned]
        then = _Found(own, list(then.beside))
        functions = survey.frequencies_hz, survey.values, survey.measured
        values = aligned(*functions, one.poles, one.participation, one.shapes)
        brought = replace(survey, values=values)
        left = _error(brought, bands, then)
        if left < least:
            remains = float(np.sqrt(error * max(left, POLES.error_none)))
            best, least = (brought, then.copy(), remains), left
    return best


def _as_measured(b: BandFit, survey: Survey, fits: tuple[BandFit, ...]) -> BandFit:
    modes = [_take(_roots(x.fit), x.core) for x in fits]
    _, far = _near_and_far(_joined(modes), b.band)
    return replace(b, measured=_data(survey, b.band, far, b.data.error)[1])


def _singly(b: BandFit) -> tuple[BandData, Floats, Fit]:
    """Fit a band with no more roots to a resonance than it surely has directions."""
    fit = b.fit
    while (doubles := satellites(b.data, b.frequencies_hz, fit, strength(fit), strict=True)).any():
        fit = refine(b.data, fit.poles[~doubles], fit.participation[:, ~doubles])
    return b.data, b.frequencies_hz, fit


@dataclass(frozen=True, eq=False)
class _Found:
    """Modes that each band answers for, and roots beside or beneath them; sweeps renew them."""

    owned: list[Roots]
    beside: list[Roots]

    def copy(self) -> _Found:
        return _Found(list(self.owned), list(self.beside))


def _searched(
    survey: Survey,
    bands: tuple[Band, ...],
    proposals: tuple[Proposal, ...],
    found: _Found,
    error: float,
) -> tuple[BandFit, ...]:
    """Search all bands for modes, then settle them against each other."""

    def selected(n: int, data: BandData, f: Floats, start: Fit) -> Fit:
        return select(data, f, start, proposals[n].more, bands[n].low, bands[n].high)

    def pruned(n: int, data: BandData, f: Floats, start: Fit) -> Fit:
        return prune(data, f, fit_shapes(data, start.poles, start.participation))

    for fitted in (selected, *[pruned] * (POLES.final_sweeps - 1)):
        for _ in _sweep(survey, bands, found, error, fitted):
            pass
    return tuple(_sweep(survey, bands, found, error, pruned))


def _sweep(
    survey: Survey,
    bands: tuple[Band, ...],
    found: _Found,
    error: float,
    fitted: Callable[[int, BandData, Floats, Fit], Fit],
) -> Iterator[BandFit]:
    """Fit one band after the other; only who asks for all of them holds the data of all."""
    for n, band in enumerate(bands):
        near, far = _near_and_far(_joined(found.owned), band)
        f, data = _data(survey, band, far, error)
        near = _joined([near, found.beside[n]])
        fit = fitted(n, data, f, Fit(near.poles, near.participation, near.shapes, np.inf))
        modes = modes_of(data, f, fit)
        found.owned[n] = _core(fit, band, modes)
        found.beside[n] = _take(_roots(fit), ~modes)
        found.owned[:] = _without_doubles(found.owned)
        mine = np.isin(fit.poles, found.owned[n].poles)
        yield BandFit(band, f, data, data, fit, mine, ~modes)


def _data(survey: Survey, band: Band, far: Roots, error: float) -> tuple[Floats, BandData]:
    lines = survey.lines(band.first, band.last)
    f = survey.frequencies_hz[lines]
    values = survey.values[:, :, lines]
    if len(far.poles):
        values = values - modal_response(f, far.poles, far.shapes, far.participation)
    return f, band_data(f, values, survey.measured, error)


def _roots(fit: Fit) -> Roots:
    return Roots(fit.poles, fit.participation, fit.shapes)


def _core(fit: Fit, band: Band, modes: Bools) -> Roots:
    """Modes of a fit that belong to the core of its band."""
    hz = np.abs(fit.poles) / (2.0 * np.pi)
    reach = np.abs(fit.poles.real) / (2.0 * np.pi) * POLES.same
    inside = (hz >= band.low - reach) & (hz <= band.high + reach)
    return _take(_roots(fit), inside & modes)


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
