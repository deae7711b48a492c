"""Roots that the user takes for modes, or refuses to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Bools, Floats
from ..errors import InputError
from .identification_numbers import IDENTIFICATION
from .poles.band_sweeps import BandFit
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
) -> tuple[BandFit, ...]:
    """Move the roots nearest to the given frequencies [Hz] among the modes, or out of them.

    A root refused serves the fit as background. One to be taken is a root of the background or,
    where there is none, a stable pole; then its band is refined with it.

    Raises
    ------
    InputError
        No such root at a frequency, or a frequency outside of the `ranges` [Hz] that take part.
    """
    for hz, what in (*((f, "taken") for f in take), *((f, "refused") for f in refuse)):
        if not any(low <= hz <= high for low, high in ranges):
            raise InputError(
                f"no root can be {what} at {hz:g} Hz: only {named_ranges(ranges)} take part"
            )
    bands = list(fits)
    for hz in refuse:
        n, k = _nearest(hz, [_hz(b, b.core) for b in bands], "mode to refuse")
        root = np.arange(len(bands[n].core)) == np.flatnonzero(bands[n].core)[k]
        b = bands[n]
        bands[n] = replace(b, core=b.core & ~root, background=b.background | root)
    for hz in take:
        aside = [_hz(b, b.background) for b in bands]
        stable = [unused(b, p) for b, p in zip(bands, proposals, strict=True)]
        roots = [np.append(a, s) for a, s in zip(aside, stable, strict=True)]
        n, k = _nearest(hz, roots, "rejected root to take")
        b = bands[n]
        if k < len(aside[n]):
            root = np.arange(len(b.core)) == np.flatnonzero(b.background)[k]
            bands[n] = replace(b, core=b.core | root, background=b.background & ~root)
            continue
        candidate = proposals[n].firm[k - len(aside[n])]
        bands[n] = with_pole(b, candidate)
        ends = _hz(bands[n], bands[n].core)[-1]
        if not near(ends, hz):
            raise InputError(
                f"the pole at {abs(candidate.pole) / (2.0 * np.pi):.2f} Hz cannot be taken: beside "
                f"the other roots of its band the functions draw it to {ends:.2f} Hz"
            )
    return tuple(bands)


def with_pole(b: BandFit, candidate: Candidate) -> BandFit:
    """Return a band refined with one more mode, its last."""
    new = start_from(b.data, (candidate,))
    poles = np.append(b.fit.poles, new.poles)
    part = np.column_stack([b.fit.participation, new.participation])
    core, background = np.append(b.core, True), np.append(b.background, False)
    return replace(b, fit=refine(b.data, poles, part), core=core, background=background)


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


def _nearest(hz: float, by_band: list[Floats], what: str) -> tuple[int, int]:
    gaps: list[tuple[float, int, int]] = [
        (abs(float(f) - hz), n, k) for n, own in enumerate(by_band) for k, f in enumerate(own)
    ]
    gap, n, k = min(gaps, default=(np.inf, 0, 0))
    if gap > IDENTIFICATION.by_hand * hz:
        raise InputError(
            f"there is no {what} within {100 * IDENTIFICATION.by_hand:g} % of {hz:g} Hz"
        )
    return n, k
