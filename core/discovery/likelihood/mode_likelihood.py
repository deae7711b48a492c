"""The test as evidence: frequencies and shapes with honest noise, and how well a model fits."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from ...arrays import Bools, Floats, Ints
from ...correlation.mode_errors import ModeErrors
from ...numerics.lapack import lower_solved
from .likelihood_numbers import LIKELIHOOD


@dataclass(frozen=True)
class Noise:
    """Standard deviations of what a right model would still miss.

    Parameters
    ----------
    frequency : float or (n_test,) float
        Of ln f: test scatter and what discretisation leaves after the moduli took their part.
    shape : float or (n_test,) float
        Of one sensor's reading, relative to the rms of the shape.
    independent : float
        Number of sensors that count as independent: errors of a model are smooth over the
        structure, so that many sensors repeat what few say.
    robust : float
        Misfit of one mode beyond which more of it counts less and less (a mode may be wrong).
    mixing : float
        Relative size of the small changes of K that no model has right. Modes whose eigenvalues
        differ by no more than this turn freely within their subspace.
    """

    frequency: float | Floats
    shape: float | Floats
    independent: float = LIKELIHOOD.independent
    robust: float = LIKELIHOOD.robust
    mixing: float = LIKELIHOOD.mixing

    def of(self, modes: Ints | Bools) -> Noise:
        """Return the noise of some modes."""
        f, s = (
            v if np.ndim(v) == 0 else np.asarray(v)[modes] for v in (self.frequency, self.shape)
        )
        return replace(self, frequency=f, shape=s)


def noise_of(errors: ModeErrors | None, level: float, weights: Floats | None = None) -> Noise:
    """Return the noise of a test: what its errors are, and what a model always leaves.

    `level` is that of a sound sensor besides the standard errors, over the rms of the shape;
    `weights` (n_test,) divide the variances.
    """
    f: float | Floats = LIKELIHOOD.frequency
    s: float | Floats = float(np.hypot(level, LIKELIHOOD.placed))
    if errors is not None:
        f, s = np.hypot(f, errors.frequency), np.hypot(s, errors.length)
    if weights is not None:
        f, s = f / np.sqrt(weights), s / np.sqrt(weights)
    return Noise(f, s)


@dataclass(frozen=True, eq=False)
class Evidence:
    """Test modes at the sensors.

    Parameters
    ----------
    frequencies_hz : (n_test,) float
    shapes : (n_sensor, n_test) float
        Real, each of unit length over the sensors that count.
    noise : Noise
    scatter : (n_test,) float or float
        Standard errors of ln f that the test itself knows of.
    reading : float
        Standard deviation of a reading over the rms of its shape, at least: what the test states.
    """

    frequencies_hz: Floats
    shapes: Floats
    noise: Noise
    scatter: float | Floats = 0.0
    reading: float = 0.0

    def take(self, modes: Ints | Bools, sensors: Ints | Bools) -> Evidence:
        """Return part of the evidence, shapes of unit length again."""
        part = self.shapes[sensors][:, modes]
        length = np.maximum(np.linalg.norm(part, axis=0), np.finfo(float).tiny)
        scatter = np.broadcast_to(self.scatter, self.frequencies_hz.shape)[modes]
        return Evidence(
            self.frequencies_hz[modes], part / length, self.noise.of(modes), scatter, self.reading
        )


def targets(e: Evidence) -> Floats:
    """Eigenvalues of the test modes, (n_test,)."""
    return np.asarray((2.0 * np.pi * e.frequencies_hz) ** 2)


def joint_macs(eigenvalues: Floats, cross: Floats, gram: Floats, size: float) -> Floats:
    """MAC of test shapes with analysis modes, close modes counted as a subspace.

    The analysis shapes are made orthonormal at the sensors as far as they mix (Gram-Schmidt with
    the Gram matrix times `mixing`); then the shares of all modes that mix with one add up: for
    modes apart this is their MAC, for a repeated eigenvalue that of the test shape with the
    subspace; never less than the MAC.

    Parameters
    ----------
    eigenvalues : (..., n) float
    cross : (..., n_test, n) float
        Test shapes (unit length) times analysis shapes at the sensors.
    gram : (..., n, n) float
        Analysis shapes times analysis shapes at the sensors.
    size : float
        See `mixing`.

    Returns
    -------
    (..., n_test, n) float, 0 to 1
    """
    n = gram.shape[-1]
    diagonal = np.einsum("...ii->...i", gram)
    seen = diagonal > LIKELIHOOD.unseen * diagonal.max(axis=-1, keepdims=True)
    scale = np.where(seen, 1.0 / np.sqrt(np.where(seen, diagonal, 1.0)), 0.0)
    W = mixing(eigenvalues, size)
    G = scale[..., :, None] * scale[..., None, :]
    G *= gram
    G *= W
    G[..., np.arange(n), np.arange(n)] = 1.0 + LIKELIHOOD.ridge
    own = cross * scale[..., None, :]
    c = lower_solved(np.linalg.cholesky(G), np.swapaxes(own, -1, -2))
    return np.asarray(np.minimum(np.maximum(np.matmul(np.swapaxes(c**2, -1, -2), W), own**2), 1.0))


def mode_costs(e: Evidence, eigenvalues: Floats, cross: Floats, gram: Floats) -> Floats:
    """Misfit of every test mode with every analysis mode, (..., n_test, n); see `mode_squares`."""
    return robust(mode_squares(e, eigenvalues, cross, gram), e.noise.robust)


def mode_squares(e: Evidence, eigenvalues: Floats, cross: Floats, gram: Floats) -> Floats:
    """Square d of what parts every test mode from every analysis mode, (..., n_test, n).

    (ln f_a/f_t)²/σ_f² + n_ind (1 − MAC)/σ_s², with `joint_macs`.
    """
    omega2 = targets(e)
    floor = LIKELIHOOD.least_eigenvalue * omega2.min()
    off = 0.5 * (np.log(np.maximum(eigenvalues, floor))[..., None, :] - np.log(omega2)[:, None])
    n = e.noise
    macs = joint_macs(np.where(eigenvalues > floor, eigenvalues, 0.0), cross, gram, n.mixing)
    f, s = np.asarray(n.frequency)[..., None], np.asarray(n.shape)[..., None]
    return np.asarray((off / f) ** 2 + n.independent * (1.0 - macs) / s**2)


def robust(d: Floats, most: float) -> Floats:
    """Return misfits c ln(1 + d/c) of squares d, which count less and less from c, `most`, on."""
    return np.asarray(most * np.log1p(d / most))


def mixing(eigenvalues: Floats, size: float) -> Floats:
    """How much of mode l a mode k may hold that a slightly different model would not, (..., n, n).

    A relative change ε of the stiffness mixes two modes by ε λ / (λ_k − λ_l). Over changes of the
    size `size` the share of l that says nothing against k is 1 / (1 + (gap / size)²): all of it for
    a repeated eigenvalue (..., n), nothing for modes far apart. Symmetric, ones on the diagonal.
    """
    log = np.log(np.maximum(eigenvalues, np.finfo(float).tiny))
    gap = log[..., :, None] - log[..., None, :]
    return np.asarray(1.0 / (1.0 + (gap / size) ** 2))


def matched(costs: Floats) -> tuple[float, Ints]:
    """Return the smallest sum of `costs` (n_test, n) over one-to-one matches, and the match."""
    rows, columns = linear_sum_assignment(costs)
    return float(costs[rows, columns].sum()), columns


def least_sums(d: Floats, most: float) -> Floats:
    """Return the smallest sums of misfits over one-to-one matches, (n,); see `robust`.

    Of squares d (n, n_test, m): which is least of them is the least misfit.
    """
    own = d.argmin(axis=-1)
    least = np.take_along_axis(d, own[..., None], axis=-1)[..., 0]
    out = robust(least, most).sum(axis=-1)
    shared = np.any(np.diff(np.sort(own, axis=-1), axis=-1) == 0, axis=-1)
    out[shared] = [matched(x)[0] for x in robust(d[shared], most)]
    return np.asarray(out)
