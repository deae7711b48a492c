"""From frequency responses to modes, unattended."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Floats
from ..data.frfs import Frfs
from ..data.geometry import Geometry
from ..errors import InputError
from .by_hand import by_hand
from .collect_bands import assemble
from .identification_numbers import IDENTIFICATION
from .number_of_modes import fewer, more
from .poles.band_sweeps import fit_range
from .poles.complete_blocks import complete_blocks
from .poles.plscf import poles_by_order
from .poles.pole_candidates import propose
from .poles.pole_numbers import POLES
from .result import Identification
from .survey.check_survey import checked
from .survey.coherence import Coherence
from .survey.exponential_window import decay_rate
from .survey.mode_indicator import Band, cmif, peaks, split
from .survey.survey_data import Survey, prepare
from .survey.wanted_ranges import wanted_ranges


def identify(
    frfs: Frfs,
    *,
    fmin: float | None = None,
    fmax: float | None = None,
    max_order: int | None = None,
    geometry: Geometry | None = None,
    coherence: Coherence | None = None,
    take: Sequence[float] = (),
    refuse: Sequence[float] = (),
    exponential_window: float | str | None = None,
    bands: Sequence[tuple[float, float]] = (),
    modes: int | None = None,
) -> Identification:
    """Identify modes from frequency responses, close pairs included, without anybody's help.

    The range is split into bands at valleys of the mode indicator. In each band poles that
    stabilise over the orders of a poly-reference least-squares complex frequency model are
    clustered; they are refined by variable projection (poles and participation by nonlinear
    least squares on the output error, shapes and residual terms within), tested against the
    noise, and the residual is searched for roots still missing. Bands see each other's modes.

    Parameters
    ----------
    frfs : Frfs
        Any number of responses and references, combinations may be missing (NaN).
    fmin, fmax : float, optional
        Range to use [Hz]; default: all lines above 0 Hz.
    max_order : int, optional
        Highest order of the denominator polynomial; default: from the peaks in each band.
    geometry : Geometry, optional
        Tells driving points whose response and reference go by two node numbers, and points that
        contradict their neighbours.
    coherence : Coherence, optional
        Of these functions: where it is low is told.
    take, refuse : sequence of float
        Frequencies [Hz] of rejected roots that are modes, and of modes that are none.
    exponential_window : float or str, optional
        Whose damping is taken out of the modes, see `decay_rate`.
    bands : sequence of (low, high), optional
        Parts of the range to use [Hz]; what lies outside takes no part.
    modes : int, optional
        As many modes as there are: the best founded, rejected roots among them where need be.

    Returns
    -------
    Identification
        Poor modes are kept and carry a remark; what was left out or is unsure stands in
        `warnings`. No mode at all is a result, too.

    Raises
    ------
    InputError
        Functions that are no frequency responses, a frequency axis that does not rise, too few
        lines, functions that are all equal or of the opposite sign convention, no root where one is
        taken or refused, one both taken and refused,
        fewer roots than modes asked for, bands that are none, an exponential window that no record
        has.

    References
    ----------
    See `poles_by_order`, `refine`, `errors`.
    """
    if max_order is not None and max_order < 2:
        raise InputError(f"the model order {max_order} is too low; it must be 2 or more")
    if modes is not None and modes < 1:
        raise InputError(f"{modes} modes are asked for; ask for one or more")
    survey = checked(prepare(frfs, wanted_ranges(fmin, fmax, bands)), geometry, coherence)
    window = decay_rate(exponential_window, frfs.frequencies_hz)
    parts, lines = _parts(survey)
    proposals = tuple(propose(survey, b.first, b.last, _count(lines, b), max_order) for b in parts)
    fits = fit_range(survey, parts, proposals)
    if not any(fit.core.any() for fit in fits):
        _refuse_conjugated(survey)
    fits, taken = by_hand(fits, proposals, take, refuse, survey.ranges)
    survey = replace(survey, warnings=(*survey.warnings, *taken, *_bounded(survey, max_order)))
    unwanted = dict.fromkeys(refuse, "refused by hand")
    found = assemble(survey, fits, proposals, geometry, unwanted, window)
    if modes is None or len(found.modes) == modes:
        return found
    if len(found.modes) > modes:
        fits, others = fewer(fits, found, modes, take)
        return assemble(survey, fits, proposals, geometry, unwanted | others, window)
    fits, added = more(fits, proposals, modes, refuse)
    of = ", ".join(f"{hz:.2f}" for hz in added)
    said = f"{modes} modes are asked for: rejected roots ({of} Hz) are taken among them"
    forced = assemble(survey, fits, proposals, geometry, unwanted, window)
    return replace(forced, warnings=(*forced.warnings, said))


def _bounded(survey: Survey, max_order: int | None) -> tuple[str, ...]:
    """Say that a model order is out of reach."""
    most, n = POLES.columns_most // len(survey.inputs), len(survey.inputs)
    if max_order is None or max_order <= most:
        return ()
    return (f"the model order {max_order} is bounded at {most}, the most for {n} reference(s)",)


def _parts(survey: Survey) -> tuple[tuple[Band, ...], Floats]:
    """Split each range that is used into bands; return the frequencies of the peaks, too.

    Peaks are those of the most telling complete part: one of a mode would come again in further
    singular values where combinations are missing.
    """
    rows, columns = complete_blocks(survey.measured)[0]
    indicator = cmif(survey.values[np.ix_(rows, columns)])
    floor = float(np.sqrt(len(rows)) + np.sqrt(len(columns)))
    bands: list[Band] = []
    lines = []
    for own in (survey.lines(*ends) for ends in survey.ranges):
        f = survey.frequencies_hz[own]
        bands += split(f, indicator[own], floor)
        lines.append(f[peaks(indicator[own], floor)])
    return tuple(bands), np.concatenate(lines)


def _count(lines: Floats, band: Band) -> int:
    return int(np.count_nonzero((lines >= band.first) & (lines <= band.last)))


def _refuse_conjugated(survey: Survey) -> None:
    """Raise when the functions make sense only with the phase turned round."""
    complete = survey.measured.all(axis=1)
    if not complete.any():
        return
    values = survey.values[complete]
    count = []
    for v in (values, values.conj()):
        orders = range(IDENTIFICATION.orders[0], IDENTIFICATION.orders[1] + 1)
        top = poles_by_order(survey.frequencies_hz, v, orders)
        most = IDENTIFICATION.stable
        poles = [s.values for s in top]
        stable = [z[(z.real < 0) & (z.real > -most * abs(z))] for z in poles]
        count.append(sum(len(s) for s in stable[-IDENTIFICATION.orders_last :]))
    if count[1] > IDENTIFICATION.backwards * max(count[0], 2):
        raise InputError(
            f"the functions of {survey.source or 'the survey'} run backwards in phase (conjugated,"
            " the e^(-jωt) convention): conjugate them"
        )
