"""What was considered and is not among the modes, with the reason."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Numbers
from .by_hand import near, unused
from .poles.band_sweeps import BandFit
from .poles.pole_candidates import Proposal
from .poles.pole_numbers import POLES
from .poles.pole_splitting import plausible, tones
from .poles.shared_noise import is_shared_noise
from .poles.soundness import left_over
from .quality import phase_collinearity


@dataclass(frozen=True)
class Rejected:
    """A root that is no mode.

    Parameters
    ----------
    frequency_hz : float
    damping_ratio : float
    reason : str
    """

    frequency_hz: float
    damping_ratio: float
    reason: str


def rejected(
    fits: tuple[BandFit, ...], proposals: tuple[Proposal, ...], unwanted: Mapping[float, str]
) -> tuple[Rejected, ...]:
    """Roots beside or beneath the modes of the fits, and stable poles that no fit kept.

    By rising frequency. `unwanted` says of modes by their frequency [Hz] why the user has none.
    """
    modes = np.concatenate([b.fit.poles[b.core] for b in fits])
    found: list[Rejected] = []
    for b, proposed in zip(fits, proposals, strict=True):
        hz = np.abs(b.fit.poles) / (2.0 * np.pi)
        aside = b.background & (hz >= b.band.low) & (hz <= b.band.high)
        reasons = _of_background(b, unwanted)
        found += [_named(b.fit.poles[k], reasons[k]) for k in np.flatnonzero(aside)]
        spare = np.isfinite(unused(b, proposed))
        poles = [proposed.firm[k].pole for k in np.flatnonzero(spare)]
        found += [_named(pole, _of_candidate(pole, modes)) for pole in poles]
    return tuple(sorted(found, key=lambda r: r.frequency_hz))


def _named(pole: complex, reason: str) -> Rejected:
    return Rejected(float(abs(pole) / (2.0 * np.pi)), float(-pole.real / abs(pole)), reason)


def _of_background(b: BandFit, unwanted: Mapping[float, str]) -> list[str]:
    hz = np.abs(b.fit.poles) / (2.0 * np.pi)
    by_user = [next((why for f, why in unwanted.items() if near(f, x)), "") for x in hz]
    tone = tones(b.frequencies_hz, b.fit)
    wide = ~plausible(b.frequencies_hz, b.fit)
    left = left_over(b.data, b.frequencies_hz, b.fit)
    mpc = phase_collinearity(b.fit.shapes)
    shared = is_shared_noise(b.data, b.frequencies_hz, b.fit)
    return [
        by_user[k]
        if by_user[k]
        else "noise that all points share, one shape all over the band; serves as background"
        if shared[k]
        else "a tone, in one line only, which is no resonance"
        if tone[k]
        else "too wide for a mode of its band: serves the fit as background"
        if wide[k]
        else f"no more than the errors of the survey make: {100 * left[k]:.0f} % of its energy is "
        f"left over around it, phase collinearity {mpc[k]:.2f}; serves the fit as background"
        for k in range(len(wide))
    ]


def _of_candidate(pole: complex, modes: Numbers) -> str:
    width = np.minimum(np.abs(modes.real), abs(pole.real))
    gap = np.abs(modes.imag - pole.imag) / width
    if len(gap) and gap.min() < POLES.one_resonance:
        hz = np.abs(modes[int(np.argmin(gap))]) / (2.0 * np.pi)
        return f"no second direction beside the resonance at {hz:.2f} Hz"
    return "explains no more than what is left over around it"
