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
from .poles.significance import significance
from .poles.start_values import start_from
from .poles.variable_projection import fit_shapes, refine
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
    its band is refined with it. A pole that the other roots draw away is held, a started one with
    the damping that explains most. Returns the bands, and what is to be said.

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
    bands = list(fits)
    for hz in refuse:
        found = _nearest(hz, [_hz(b, b.core) for b in bands])
        if found is None:
            within = 100 * IDENTIFICATION.by_hand
            raise InputError(f"there is no mode to refuse within {within:g} % of {hz:g} Hz")
        n, k = found
        root = np.arange(len(bands[n].core)) == np.flatnonzero(bands[n].core)[k]
        b = bands[n]
        bands[n] = replace(b, core=b.core & ~root, background=b.background | root)
    drawn = {hz: _drawn(hz, bands, proposals) for hz in take}
    said = [_held(hz, to, bands, proposals) for hz, to in drawn.items() if to is not None]
    return tuple(bands), tuple(said)


def _nearest_root(
    hz: float, bands: list[BandFit], proposals: tuple[Proposal, ...]
) -> tuple[int, Candidate | int | None]:
    """Band of a frequency; its root of the background, or stable pole, or neither."""
    aside = [_hz(b, b.background) for b in bands]
    stable = [unused(b, p) for b, p in zip(bands, proposals, strict=True)]
    roots = [np.append(a, s) for a, s in zip(aside, stable, strict=True)]
    n, k = _nearest(hz, roots) or (_band_of(hz, bands), -1)
    if 0 <= k < len(aside[n]):
        return n, int(np.flatnonzero(bands[n].background)[k])
    return n, proposals[n].firm[k - len(aside[n])] if k >= 0 else None


def _drawn(hz: float, bands: list[BandFit], proposals: tuple[Proposal, ...]) -> float | None:
    """Take a root; where the other roots draw it away leave it, and return where they do."""
    n, root = _nearest_root(hz, bands, proposals)
    b = bands[n]
    if isinstance(root, int):
        one = np.arange(len(b.core)) == root
        bands[n] = replace(b, core=b.core | one, background=b.background & ~one)
        return None
    grown = with_pole(b, root or _started(hz, b))
    ends = float(_hz(grown, grown.core)[-1])
    if not near(ends, hz):
        return ends
    bands[n] = grown
    return None


def _held(hz: float, ends: float, bands: list[BandFit], proposals: tuple[Proposal, ...]) -> str:
    """Take a pole where it is, the others staying where they are; return what is to be said."""
    n, root = _nearest_root(hz, bands, proposals)
    b, drawn = (
        bands[n],
        f"beside the other roots of its band the functions draw it to {ends:.2f} Hz",
    )
    if isinstance(root, Candidate):
        bands[n] = with_pole(b, root, held=True)
        return f"the pole taken at {hz:g} Hz is held where the stabilisation chart has it: {drawn}"
    tried = [with_pole(b, _started(hz, b, x), held=True) for x in IDENTIFICATION.dampings]
    value = [float(significance(t.data, t.frequencies_hz, t.fit)[-1]) for t in tried]
    if max(value) < IDENTIFICATION.held:
        raise InputError(f"no root can be taken at {hz:g} Hz: {drawn}")
    bands[n] = tried[int(np.argmax(value))]
    return f"the pole taken at {hz:g} Hz is held there, its damping is a guess: {drawn}"


def with_pole(b: BandFit, candidate: Candidate, held: bool = False) -> BandFit:
    """Return a band with one more mode, its last; its poles are held or all refined."""
    new = start_from(b.data, (candidate,))
    poles = np.append(b.fit.poles, new.poles)
    part = np.column_stack([b.fit.participation, new.participation])
    core, background = np.append(b.core, True), np.append(b.background, False)
    fit = (fit_shapes if held else refine)(b.data, poles, part)
    return replace(b, fit=fit, core=core, background=background)


def _hz(b: BandFit, chosen: Bools) -> Floats:
    return np.asarray(np.abs(b.fit.poles[chosen]) / (2.0 * np.pi))


def near(a: float, b: float) -> bool:
    """Tell whether two frequencies are one, as read off a chart."""
    return abs(a - b) <= IDENTIFICATION.by_hand * min(a, b)


def unused(b: BandFit, proposed: Proposal) -> Floats:
    """Frequencies of the stable poles of a band, infinite where one is a root that the fit holds.

    A root of the fit is one of them, the others near it are not.
    """
    free = b.fit.poles
    hz = np.array([abs(c.pole) for c in proposed.firm]) / (2.0 * np.pi)
    for k in np.flatnonzero((hz >= b.band.low) & (hz <= b.band.high)):
        pole = proposed.firm[k].pole
        gap = np.abs(free - pole) / np.minimum(np.abs(free.real), abs(pole.real))
        if len(gap) and gap.min() < POLES.candidate_same:
            free, hz[k] = np.delete(free, int(np.argmin(gap))), np.inf
    return np.asarray(np.where((hz < b.band.low) | (hz > b.band.high), np.inf, hz))


def _nearest(hz: float, by_band: list[Floats]) -> tuple[int, int] | None:
    """Band and place of the frequency next to `hz`; None where none is near."""
    gaps = [(abs(float(f) - hz), n, k) for n, own in enumerate(by_band) for k, f in enumerate(own)]
    gap, n, k = min(gaps, default=(np.inf, 0, 0))
    return (n, k) if gap <= IDENTIFICATION.by_hand * hz else None


def _band_of(hz: float, bands: Sequence[BandFit]) -> int:
    return next(n for n, b in enumerate(bands) if hz <= b.band.high or n == len(bands) - 1)


def _started(hz: float, b: BandFit, times: float = 1.0) -> Candidate:
    """Return a pole at `hz`, damped so many times as the modes of its band typically are.

    Its participation is the strongest direction of the functions at that line.
    """
    poles = b.fit.poles[b.core]
    ratio = np.median(-poles.real / np.abs(poles)) if len(poles) else IDENTIFICATION.damping
    ratio = min(times * float(ratio), POLES.damping_most)
    line = unstacked(b.data.y)[..., int(np.argmin(np.abs(b.frequencies_hz - hz)))]
    participation = np.linalg.svd(line)[2][0]
    pole = 2.0 * np.pi * hz * (-ratio + 1j * np.sqrt(1.0 - ratio**2))
    return Candidate(complex(pole), participation, 0)
