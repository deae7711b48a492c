"""Figures in the words of the one who reads them: masses in kilograms, modes in ranges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

_RUNS = 4
"""More stretches of modes than these are not listed."""


@dataclass(frozen=True)
class MassUnit:
    """What masses are counted in.

    Parameters
    ----------
    card : float
        Of a mass as cards have it, in one unit of the mass matrix: 1/WTMASS.
    kilograms : float or None
        In one unit of the mass matrix; None where the deck's units are not known.
    """

    card: float = 1.0
    kilograms: float | None = None

    def said(self, mass: float) -> str:
        """Return a mass of cards in kilograms where they are known."""
        if self.kilograms is None:
            return f"{mass:.3g} (deck units)"
        return f"{mass / self.card * self.kilograms:.3g} kg"


def mode_ranges(modes: Sequence[int]) -> str:
    """Return ``mode 7``, ``modes 3 and 7 to 12``: what follows each other is joined.

    Modes all over the test are counted: ``9 modes``.
    """
    runs: list[list[int]] = []
    for m in sorted(modes):
        if runs and m == runs[-1][-1] + 1:
            runs[-1].append(m)
        else:
            runs.append([m])
    if len(runs) > _RUNS:
        return f"{len(modes)} modes"
    words = []
    for run in runs:
        words += [f"{run[0]} to {run[-1]}"] if len(run) > 2 else [str(m) for m in run]
    said = words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
    return f"mode{'s' if len(modes) > 1 else ''} {said}"
