"""Sizes that make trial magnitudes sensible on any structure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Floats
from .effect_numbers import EFFECTS


@dataclass(frozen=True, eq=False)
class Scale:
    """What is large and small on this structure.

    Parameters
    ----------
    mass : float
        Of the whole structure.
    size : float
        Diagonal of its box.
    omega2 : float
        (rad/s)² in the middle of the measured band.
    band_hz : (float, float)
        Lowest and highest frequency that was measured.
    """

    mass: float
    size: float
    omega2: float
    band_hz: tuple[float, float]

    def masses(self, count: int = EFFECTS.trials) -> Floats:
        """Trial masses, ln, (count, 1)."""
        return np.asarray(np.log(self.mass * np.geomspace(*EFFECTS.mass_trials, count)))[:, None]

    def springs(self, count: int = EFFECTS.trials) -> Floats:
        """Trial stiffnesses, ln, (count, 1)."""
        stiffness = self.mass * self.omega2 * np.geomspace(*EFFECTS.spring_trials, count)
        return np.asarray(np.log(stiffness))[:, None]
