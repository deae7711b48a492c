"""The test as evidence: frequencies and shapes with honest noise, and how well a model fits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..arrays import Bools, Floats, Ints


@dataclass(frozen=True)
class Noise:
    """Standard deviations of what a right model would still miss.

    Parameters
    ----------
    frequency : float
        Of ln f: test scatter and what discretisation leaves after the moduli took their part.
    shape : float
        Of one sensor's reading, relative to the rms of the shape.
    independent : float
        Number of sensors that count as independent: errors of a model are smooth over the
        structure, so that many sensors repeat what few say.
    robust : float
        Misfit of one mode beyond which more of it counts less and less (a mode may be wrong).
    """

    frequency: float = 0.004
    shape: float = 0.05
    independent: float = 12.0
    robust: float = 40.0


@dataclass(frozen=True, eq=False)
class Evidence:
    """Test modes at the sensors.

    Parameters
    ----------
    frequencies_hz : (n_test,) float
    shapes : (n_sensor, n_test) float
        Real, each of unit length over the sensors that count.
    sensors : (n_sensor, n_free) sparse or (n_sensor, r) float
    noise : Noise
    """

    frequencies_hz: Floats
    shapes: Floats
    noise: Noise

    def take(self, modes: Ints | Bools, sensors: Ints | Bools) -> Evidence:
        """Return part of the evidence, shapes of unit length again."""
        part = self.shapes[sensors][:, modes]
        length = np.maximum(np.linalg.norm(part, axis=0), np.finfo(float).tiny)
        return Evidence(self.frequencies_hz[modes], part / length, self.noise)


def mode_costs(e: Evidence, eigenvalues: Floats, cross: Floats, lengths: Floats) -> Floats:
    """Misfit of every test mode with every analysis mode.

    Parameters
    ----------
    e : Evidence
    eigenvalues : (..., n) float
    cross : (..., n_test, n) float
        Test shapes times analysis shapes at the sensors.
    lengths : (..., n) float
        Squared lengths of the analysis shapes at the sensors.

    Returns
    -------
    (..., n_test, n) float
        (ln f_a/f_t)²/σ_f² + n_ind (1 − MAC)/σ_s², robust: c ln(1 + d/c).
    """
    omega2 = (2.0 * np.pi * e.frequencies_hz) ** 2
    floor = 1e-6 * omega2.min()
    off = 0.5 * np.log(np.maximum(eigenvalues, floor)[..., None, :] / omega2[:, None])
    macs = cross**2 / np.maximum(lengths, np.finfo(float).tiny)[..., None, :]
    n = e.noise
    d = (off / n.frequency) ** 2 + n.independent * np.maximum(1.0 - macs, 0.0) / n.shape**2
    return np.asarray(n.robust * np.log1p(d / n.robust))


def matched(costs: Floats) -> tuple[float, Ints]:
    """Return the smallest total misfit over one-to-one matches and the match of each test mode.

    Parameters
    ----------
    costs : (n_test, n) float
    """
    rows, columns = linear_sum_assignment(costs)
    return float(costs[rows, columns].sum()), columns
