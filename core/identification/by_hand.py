"""Roots that the user takes for modes, or refuses to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Bools, Floats
from ..errors import InputError
from .identification_numbers import IDENTIFICATION
from .poles.band_sweeps import BandFit
from .poles.moments import unstacked
from .poles.pole_candidates import Proposal
from .poles.pole_numbers import POLES
from .poles.pole_stabilisation import Candidate
from .poles.start_values import start_from
from .poles.variable_projection import refine
from .survey.wanted_ranges import named_ranges


def by_hand(
    fits: tuple[BandFit, ...],
    proposals: tuple[Proposal, ...],
    take: Sequence[float],
    refuse: Sequence[float],
    ranges: Sequence[tuple[float, float]] = ((0.0, np.inf),),
) -> tuple[tuple[BandFit, ...], tuple[str, ...]]:
    """Move the roots nearest to the given frequencies [Hz] among the modes, or out of them.

    A root refused serves the fit as background. One to be taken is a root of the background or,
    where there is none, a stable pole, or a pole of typical damping that is started there; then
    its band is refined with it. Returns the bands, and what is to be said.

    Raises
    ------
    InputError
        No such root at a frequency, a frequency outside of the `ranges` [Hz] that take part, or
        one that is both taken and refused.
    """
    both = sorted(set(take) & set(refuse))
    if both:
        raise InputError(f"the root at {both[0]:g} Hz is both taken and refused: leave one out")
    for hz, what in (*((f, "taken") for f in take), *((f, "refused") for f in refuse)):
        if not any(low <= hz <= high for low, high in ranges):
            raise InputError(
                f"no root can be {what} at {hz:g} Hz: only {named_ranges(ranges)} take part"
            )
    bands, said = list(fits), list[str]()
    for hz in refuse:
        found = _nearest(hz, [_hz(b, b.core) for b in bands])
        if found is None:
            within = 100 * IDENTIFICATION.by_hand
            raise InputError(f"there is no mode to refuse within {within:g} % of {hz:g} Hz")
        n, k = found
        root = np.arange(len(bands[n].core)) == np.flatnonzero(bands[n].core)[k]
        b = bands[n]
        bands[n] = replace(b, core=b.core & ~root, background=b.background | root)
    for hz in take:
        said += _take(hz, bands, proposals)
    return tuple(bands), tuple(said)


def _take(hz: float, bands: list[BandFit], proposals: tuple[Proposal, ...]) -> list[str]:
    aside = [_hz(b, b.background) for b in bands]
    stable = [unused(b, p) for b, p in zip(bands, proposals, strict=True)]
    roots = [np.append(a, s) for a, s in zip(aside, stable, strict=True)]
    n, k = _nearest(hz, roots) or (_band_of(hz, bands), -1)
    b = bands[n]
    if 0 <= k < len(aside[n]):
        root = np.arange(len(b.core)) == np.flatnonzero(b.background)[k]
        bands[n] = replace(b, core=b.core | root, background=b.background & ~root)
        return []
    candidate = proposals[n].firm[k - len(aside[n])] if k >= 0 else _started(hz, b)
    bands[n] = with_pole(b, candidate)
    ends = float(_hz(bands[n], bands[n].core)[-1])
    if near(ends, hz):
        return []
    drawn = f"beside the other roots of its band the functions draw it to {ends:.2f} Hz"
    if k < 0:
        raise InputError(f"no root can be taken at {hz:g} Hz: {drawn}")
    bands[n] = with_pole(b, candidate, held=True)
    return [f"the pole taken at {hz:g} Hz is held where the stabilisation chart has it: {drawn}"]


def with_pole(b: BandFit, candidate: Candidate, held: bool = False) -> BandFit:
    """Return a band refined with one more mode, its last, whose pole is held or moves as well."""
    new = start_from(b.data, (candidate,))
    poles = np.append(b.fit.poles, new.poles)
    part = np.column_stack([b.fit.participation, new.participation])
    core, background = np.append(b.core, True), np.append(b.background, False)
    free = np.append(np.ones(len(b.core), bool), not held)
    fit = refine(b.data, poles, part, free)
    return replace(b, fit=fit, core=core, background=background)


def _hz(b: BandFit, chosen: Bools) -> Floats:
    return np.asarray(np.abs(b.fit.poles[chosen]) / (2.0 * np.pi))


def near(a: float, b: float) -> bool:
    """Tell whether two frequencies are one, as read off a chart."""
    return abs(a - b) <= IDENTIFICATION.by_hand * min(a, b)


def unused(b: BandFit, proposed: Proposal) -> Floats:
    """Frequencies of the stable poles of a band, infinite where the fit holds the root."""
    poles = np.array([c.pole for c in proposed.firm], complex)
    gap = np.abs(poles[:, None] - b.fit.poles)
    width = np.minimum(np.abs(poles.real)[:, None], np.abs(b.fit.poles.real))
    held = (gap < POLES.candidate_same * width).any(axis=1)
    hz = np.abs(poles) / (2.0 * np.pi)
    outside = (hz < b.band.low) | (hz > b.band.high)
    return np.asarray(np.where(held | outside, np.inf, hz))


def _nearest(hz: float, by_band: list[Floats]) -> tuple[int, int] | None:
    """Band and place of the frequency next to `hz`; None where none is near."""
    gaps = [(abs(float(f) - hz), n, k) for n, own in enumerate(by_band) for k, f in enumerate(own)]
    gap, n, k = min(gaps, default=(np.inf, 0, 0))
    return (n, k) if gap <= IDENTIFICATION.by_hand * hz else None


def _band_of(hz: float, bands: Sequence[BandFit]) -> int:
    return next(n for n, b in enumerate(bands) if hz <= b.band.high or n == len(bands) - 1)


def _started(hz: float, b: BandFit) -> Candidate:
    """Return a pole at `hz`, damped as the modes of its band typically are.

    Its participation is the strongest direction of the functions at that line.
    """
    poles = b.fit.poles[b.core]
    ratio = np.median(-poles.real / np.abs(poles)) if len(poles) else IDENTIFICATION.damping
    line = unstacked(b.data.y)[..., int(np.argmin(np.abs(b.frequencies_hz - hz)))]
    participation = np.linalg.svd(line)[2][0]
    pole = 2.0 * np.pi * hz * (-ratio + 1j * np.sqrt(1.0 - ratio**2))
    return Candidate(complex(pole), participation, 0)
