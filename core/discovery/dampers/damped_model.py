"""What a model does with a dashpot of any size: the quadratic eigenproblem on its undamped modes.

A heavy dashpot nearly holds its place: damped frequencies, real parts of shapes and how damping is
shared out among close modes are then far from first order. Poles and shapes of the model with the
dashpot are compared with those of the test as they are; nothing of the test is taken as undamped.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Floats, Ints, Numbers
from ...correlation.mac import mac
from ..likelihood.complex_modes import complex_modes, ratios
from ..likelihood.likelihood_numbers import LIKELIHOOD
from ..likelihood.mode_likelihood import Evidence, matched, mixing
from .damper_numbers import DAMPERS


@dataclass(frozen=True, eq=False)
class Damped:
    """Modes of a model with dashpots, those that match the modes of a test.

    Parameters
    ----------
    misfit : float
        Of frequencies and shapes.
    poles : (n_test,) complex
        rad/s.
    shapes : (n, n_test) float
        Real parts at principal phase, unit length, on the undamped modes.
    undamped : (n, n_test) float
        The same modes without the dashpots: orthonormal, each turned only within close modes.
    omega : (n_test,) float
        Their frequencies [rad/s].
    """

    misfit: float
    poles: Numbers
    shapes: Floats
    undamped: Floats
    omega: Floats

    @property
    def ratios(self) -> Floats:
        """Damping ratios, (n_test,)."""
        return ratios(self.poles)

    @property
    def stretched(self) -> Floats:
        """By how much the dashpots multiply each frequency, (n_test,)."""
        return np.asarray(np.abs(self.poles) / self.omega)

    @property
    def moved(self) -> Ints:
        """Test modes whose frequency or real shape the dashpots move, numbers from 0.

        To a search for missing stiffness and mass that looks like something else.
        """
        turned = np.linalg.norm(self.shapes - self.undamped, axis=0)
        still = (np.abs(self.stretched - 1.0) < LIKELIHOOD.frequency) & (turned < DAMPERS.turned)
        return np.flatnonzero(~still)


def damped(e: Evidence, shapes: Numbers, omega: Floats, sensors: Floats, D: Floats) -> Damped:
    """Match the modes of a model with dashpots D (n, n), unit modal masses, to those of a test.

    `shapes` (n_sensor, n_test), complex or real, are the test's as measured; `omega` (n,) [rad/s]
    and `sensors` (n_sensor, n) are the undamped modes of the model, unit modal masses. A mode that
    does not swing any more counts as critically damped.
    """
    poles, Q = complex_modes(omega, D)
    still = ~np.isfinite(poles)
    poles = np.where(still, -omega, poles)
    Q = np.where(still, np.eye(len(omega)), Q)
    seen = sensors @ Q
    Q = Q * np.exp(-0.5j * np.angle(np.sum(seen**2, axis=0)))
    like = mac(shapes, sensors @ (Q if np.iscomplexobj(shapes) else Q.real))
    least = LIKELIHOOD.elastic * omega.max()
    off = np.log(np.maximum(np.abs(poles), least) / (2.0 * np.pi * e.frequencies_hz[:, None]))
    n = e.noise
    f, s = np.asarray(n.frequency)[..., None], np.asarray(n.shape)[..., None]
    d = (off / f) ** 2 + n.independent * (1.0 - like) / s**2
    misfit, match = matched(n.robust * np.log1p(d / n.robust))
    real = np.asarray(Q[:, match].real)
    real = real / np.linalg.norm(real, axis=0)
    near = np.sqrt(mixing(np.maximum(omega**2, least**2), LIKELIHOOD.mixing)[:, match])
    U, _, Vt = np.linalg.svd(near * real, full_matrices=False)
    return Damped(misfit, poles[match], real, np.asarray(U @ Vt), omega[match])
