"""From fitted bands to the result."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from ..arrays import Floats, Numbers
from ..data.frfs import Frfs
from ..data.geometry import Geometry
from ..data.modes import Modes
from .identification_numbers import IDENTIFICATION
from .mode_table import ModeTable, collect, physical
from .peaks_without_mode import of_peaks
from .poles.band_sweeps import BandFit
from .poles.moments import unstacked
from .poles.pole_candidates import Proposal
from .poles.pole_stabilisation import Chart
from .quality import correlation, multivariate_indicator, phase_collinearity, phase_deviation
from .rejected import rejected
from .remarks import Judged, of_leakage, of_modes, of_own_poles, of_window, pair_possible
from .result import Background, Identification, Indicator, background_response, residual_terms
from .survey.driving_points import driving_points, reciprocity_of_modes, scale
from .survey.modal_synthesis import derivative_order, modal_response
from .survey.mode_indicator import cmif
from .survey.references import checked_references
from .survey.survey_data import Survey
from .survey.suspension import rigid_share
from .uncertainty.standard_errors import frequency_and_damping_errors


def assemble(
    survey: Survey,
    fits: tuple[BandFit, ...],
    proposals: tuple[Proposal, ...],
    geometry: Geometry | None = None,
    unwanted: Mapping[float, str] = MappingProxyType({}),
    window: float = 0.0,
) -> Identification:
    """Bring the modes of all bands into physical units, judge them, find their scale.

    Parameters
    ----------
    survey : Survey
    fits : tuple of BandFit
    proposals : tuple of Proposal
        Of each band.
    geometry : Geometry, optional
        For driving points under two numbers.
    unwanted : mapping of float to str
        Why the user does not want modes, by their frequency [Hz].
    window : float
        What an exponential window added to all decay rates [1/s].
    """
    t = collect(fits)
    p = physical(survey, t)
    points = driving_points(survey.outputs, survey.inputs, geometry)
    poles = t.poles + window
    f_std, z_std = frequency_and_damping_errors(poles, t.pole_covariance)
    scaling = scale(t.poles, p.shapes, p.participation, points, survey.inputs)
    driving, reciprocity = checked_references(survey, points, t.poles, p.shapes, p.participation)
    backgrounds, quality = _backgrounds(survey, fits, t)
    sure = np.where(p.known, p.shapes, 0.0)
    mpc = phase_collinearity(sure)
    warnings = [*survey.warnings, *(scaling.warnings if len(t.hz) else ())]
    pair = pair_possible(t, warnings)
    warnings += of_own_poles(fits)
    warnings += of_leakage(t.hz, t.blurred)
    if not len(t.hz):
        warnings.append("no mode stands out of the noise")
    damping = -poles.real / np.abs(poles)
    warnings += of_window(poles, damping, z_std, window)

    hz = np.abs(poles) / (2.0 * np.pi)

    indicator = _indicator_at(survey, t.hz)
    mass = scaling.modal_mass / p.real_size**2
    reciprocal = reciprocity_of_modes(p.shapes, p.participation, points)
    judged = Judged(quality, mpc, indicator, mass, reciprocal)

    def modes(shapes: Numbers, size: Floats) -> Modes:
        known = damping, scaling.modal_mass / size**2
        return Modes(
            hz, shapes / size, survey.outputs, *known, survey.source, doubted=judged.doubted
        )

    measured = _measured(survey)
    indicators = cmif(np.where(survey.measured[:, :, None], measured.values, 0.0))
    warnings += of_peaks(survey, fits, indicators[:, 0], np.array([*t.hz, *unwanted]))
    return Identification(
        modes=modes(p.shapes, p.size),
        real_modes=modes(p.real, p.real_size),
        frequency_std=f_std,
        damping_std=z_std,
        shape_std=p.std,
        participation=p.participation * p.size,
        references=survey.inputs,
        mpc=mpc,
        mpd=phase_deviation(sure),
        mode_indicator=indicator,
        quality=quality,
        significance=t.significance,
        close_pair_possible=pair,
        rigid_share=rigid_share(p.real, survey.outputs, geometry),
        remarks=of_modes(survey, t, p, judged),
        bands=backgrounds,
        rejected=rejected(fits, proposals, unwanted),
        measured=measured,
        chart=_joined_chart(fits, tuple(p.chart for p in proposals)),
        cmif=Indicator(survey.frequencies_hz, indicators),
        quantity=survey.quantity,
        window_decay=window,
        faults=survey.faults,
        driving_points=driving,
        reciprocity=reciprocity,
        warnings=tuple(warnings),
    )


def _measured(survey: Survey) -> Frfs:
    """Functions of the quantity and in the units of the file."""
    values = survey.physical
    if order := derivative_order(survey.quantity) - derivative_order("acceleration"):
        values *= (2j * np.pi * survey.frequencies_hz) ** order
    values[~survey.measured] = np.nan
    places = survey.frequencies_hz, survey.outputs, survey.inputs
    return Frfs(*places, values, survey.quantity, survey.source)


def _indicator_at(survey: Survey, hz: Floats) -> Floats:
    """Multivariate mode indicator at the modes, 1 at a normal mode well excited."""
    mif = multivariate_indicator(survey.values)
    near = [int(np.argmin(np.abs(survey.frequencies_hz - x))) for x in hz]
    return 1.0 - np.array([mif[max(k - 2, 0) : k + 3].min() for k in near])


def _backgrounds(
    survey: Survey, fits: tuple[BandFit, ...], t: ModeTable
) -> tuple[tuple[Background, ...], Floats]:
    """Residual terms of each band at the final modes, and how well each mode is synthesised."""
    found, hz = [], t.hz
    quality = np.zeros(len(hz))
    out, inp = survey.output_weight[:, None], survey.input_weight[:, None]
    for b in fits:
        lines = survey.lines(b.band.first, b.band.last)
        f = survey.frequencies_hz[lines]
        measured = survey.values[:, :, lines]
        modal = modal_response(f, t.poles, t.shapes, t.participation)
        aside = b.background
        roots = b.fit.poles[aside], b.fit.shapes[:, aside], b.fit.participation[:, aside]
        left = measured - modal
        if aside.any():
            left = left - modal_response(f, *roots)
        terms = residual_terms(f)
        size = np.linalg.norm(terms, axis=1)
        judged = measured
        if b.measured is not b.data:  # functions brought to one set of poles
            judged = measured + unstacked(b.data.y - b.measured.y)
        residuals = left @ np.linalg.pinv(terms / size[:, None]) / size
        weighted = Background(b.band, residuals.transpose(2, 0, 1), *roots)
        synthesised = modal + background_response(f, weighted)
        for k in np.flatnonzero((hz >= b.band.low) & (hz <= b.band.high)):
            least = IDENTIFICATION.near_lines * float(np.median(np.diff(f)))
            half = max(2.0 * abs(t.poles[k].real) / np.pi, least)
            near = np.abs(f - hz[k]) <= half
            used = survey.measured
            quality[k] = correlation(judged[:, :, near][used], synthesised[:, :, near][used])
        found.append(
            Background(
                b.band,
                weighted.residuals / out / inp.T,
                roots[0],
                roots[1] / out,
                roots[2] / inp,
            )
        )
    return tuple(found), quality


def _joined_chart(fits: tuple[BandFit, ...], charts: tuple[Chart, ...]) -> Chart:
    order, hz, damping, level = [], [], [], []
    for fit, c in zip(fits, charts, strict=True):
        here = (c.frequency_hz >= fit.band.low) & (c.frequency_hz <= fit.band.high)
        order.append(c.order[here])
        hz.append(c.frequency_hz[here])
        damping.append(c.damping[here])
        level.append(c.level[here])
    return Chart(*(np.concatenate(x) for x in (order, hz, damping, level)))
