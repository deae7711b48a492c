"""As many modes as the user says there are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Bools, Floats, Ints
from ..errors import InputError
from .by_hand import near, unused, with_pole
from .poles.band_sweeps import BandFit
from .poles.pole_candidates import Proposal
from .poles.pole_splitting import plausible
from .poles.significance import significance
from .result import Identification


def fewer(
    fits: tuple[BandFit, ...], found: Identification, number: int, take: Sequence[float]
) -> tuple[tuple[BandFit, ...], dict[float, str]]:
    """Keep the best founded modes; say of each other one, by its frequency [Hz], why it is none.

    Modes taken by hand stand first, then those without reproach, then the others; among alike
    the standard error of the shape decides, over the shape.
    """
    hz, shapes = found.modes.frequencies_hz, found.real_modes.shapes
    error = np.linalg.norm(found.shape_std, axis=0) / np.linalg.norm(shapes, axis=0)
    by_hand = np.array([any(near(f, t) for t in take) for f in hz], bool)
    poor = np.array([bool(r) for r in found.remarks], bool)
    worst = np.lexsort((error, poor, ~by_hand))[number:]
    kept = list(fits)
    for omega in found.poles.imag[worst]:  # which no window has moved
        gaps = [np.where(b.core, np.abs(b.fit.poles.imag - omega), np.inf) for b in kept]
        n = int(np.argmin([g.min(initial=np.inf) for g in gaps]))
        b, root = kept[n], np.arange(len(gaps[n])) == np.argmin(gaps[n])
        kept[n] = replace(b, core=b.core & ~root, background=b.background | root)
    reason = f"not among the {number} best founded modes, as many as are asked for"
    return tuple(kept), dict.fromkeys(hz[worst].tolist(), reason)


def more(
    fits: tuple[BandFit, ...],
    proposals: tuple[Proposal, ...],
    number: int,
    refuse: Sequence[float],
) -> tuple[tuple[BandFit, ...], tuple[float, ...]]:
    """Take the best founded of the rejected roots besides; return their frequencies [Hz], too.

    Roots that serve the fit as background come first, by what they explain over noise, then
    stable poles that no fit kept, by the number of orders at which they were found.

    Raises
    ------
    InputError
        There are not as many.
    """
    missing = number - sum(int(np.count_nonzero(b.core)) for b in fits)
    bands: list[BandFit] = list(fits)
    spare = [
        (float(what), n, int(k))
        for n, b in enumerate(bands)
        for k, what in zip(*_spare(b, refuse), strict=True)
    ]
    taken = [(n, k) for _, n, k in sorted(spare, reverse=True)[:missing]]
    for n, k in taken:
        b, root = bands[n], np.arange(len(bands[n].core)) == k
        bands[n] = replace(b, core=b.core | root, background=b.background & ~root)
    left = [
        (c, n, float(hz))
        for n, (b, p) in enumerate(zip(bands, proposals, strict=True))
        for c, hz in zip(p.firm, unused(b, p), strict=True)
        if np.isfinite(hz) and not any(near(hz, r) for r in refuse)
    ]
    for c, n, hz in sorted(left, key=lambda x: -x[0].length):
        if len(taken) < missing:
            grown = with_pole(bands[n], c)
            if near(float(_hz(grown)[-1]), hz):
                bands[n] = grown
                taken.append((n, len(grown.core) - 1))
    if len(taken) < missing:
        raise InputError(
            f"{number} modes are asked for; the functions hold {number - missing + len(taken)} "
            "roots that can be one, rejected ones included"
        )
    return tuple(bands), tuple(sorted(float(_hz(bands[n])[k]) for n, k in taken))


def _spare(b: BandFit, refuse: Sequence[float]) -> tuple[Ints, Floats]:
    """Rejected roots of a band that are no wider than modes, and what each explains over noise."""
    hz = _hz(b)
    wanted: Bools = ~np.array([any(near(f, r) for r in refuse) for f in hz], bool)
    wanted &= b.background & plausible(b.frequencies_hz, b.fit)
    wanted &= (hz >= b.band.low) & (hz <= b.band.high)
    rows = np.flatnonzero(wanted)
    return rows, significance(b.data, b.frequencies_hz, b.fit)[rows]


def _hz(b: BandFit) -> Floats:
    return np.asarray(np.abs(b.fit.poles) / (2.0 * np.pi))
