"""Measured frequency responses as evidence: what hypotheses make of them, and how well it fits.

Hypotheses are fitted to modes, so every line of the responses is new to them. What the modes did
not say already is in the sizes: modal masses, modes that nobody identified, antiresonances. So a
hypothesis is compared with its modes turned onto the measured ones, at the measured frequencies
and ratios (how far off its own are has been counted), by log magnitudes, and what it leaves
counts as often as there are independent lines.

References
----------
Heylen, Lammens (1996), FRAC: a consistent way of comparing frequency response functions,
Proceedings of the International Conference on Identification in Engineering Systems, 48-57;
Allemang (2003), The modal assurance criterion, Sound and Vibration 37, 14-23.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats, Ints, Numbers
from ...data.frfs import Frfs
from ..reduction.residual_flexibility import Compliance
from .likelihood_numbers import LIKELIHOOD


@dataclass(frozen=True, eq=False)
class Responses:
    """Measured responses laid onto a model.

    Parameters
    ----------
    frfs : Frfs
        Displacement, velocity or acceleration in the deck's length unit per force of the test.
    observed, driven : (n_response, n_dof), (n_reference, n_dof) sparse
        What the responses and the references read of the model's motion, basic axes.
    """

    frfs: Frfs
    observed: sp.csr_matrix
    driven: sp.csr_matrix

    def at(self, nodes: Ints) -> Responses:
        """Return the responses at some nodes of the test."""
        rows = np.flatnonzero(np.isin(self.frfs.responses.node, nodes))
        return replace(self, frfs=self.frfs.at(rows), observed=self.observed[rows])


@dataclass(frozen=True, eq=False)
class State:
    """A hypothesis as far as responses need it.

    Parameters
    ----------
    omega : (n_mode,) float
        rad/s.
    ratios : (n_mode,) float
    motion : (n_dof, n_mode) float
        Shapes of unit modal mass.
    """

    omega: Floats
    ratios: Floats
    motion: Floats


def ratios_of(measured: Floats, match: Ints, count: int) -> Floats:
    """Return ratios of all modes: as measured where matched, else the geometric mean, (count,)."""
    known = np.isfinite(measured) & (measured > 0.0)
    usual = float(np.exp(np.mean(np.log(measured[known])))) if known.any() else LIKELIHOOD.ratio
    out = np.full(count, usual)
    out[match[known]] = measured[known]
    return out


def synthesised(
    r: Responses, s: State, rest: Floats, lines: Ints | None = None, rows: Ints | None = None
) -> Numbers:
    """Return the responses of a hypothesis, (n_response, n_reference, n_line) complex.

    `rest` (n_response, n_reference) is the static flexibility that its modes lack; `lines` and
    `rows` say which lines and responses are wanted, default all.
    """
    lines = np.arange(len(r.frfs.frequencies_hz)) if lines is None else lines
    rows = np.arange(len(r.frfs.responses)) if rows is None else rows
    jw = 2j * np.pi * r.frfs.frequencies_hz[lines]
    a, b = np.asarray(r.observed[rows] @ s.motion), np.asarray(r.driven @ s.motion)
    gain = 1.0 / (jw**2 + 2.0 * s.ratios[:, None] * s.omega[:, None] * jw + (s.omega**2)[:, None])
    residues = (a[:, None, :] * b[None]).reshape(-1, len(s.omega))
    H = (residues @ gain).reshape(len(a), len(b), len(jw)) + rest[rows][:, :, None]
    return np.asarray(H * jw**r.frfs.order)


def frac(measured: Numbers, model: Numbers) -> Floats:
    """Frequency response assurance of functions (..., n_line), over finite lines, 0 to 1."""
    good = np.isfinite(measured)
    a, b = np.where(good, measured, 0.0), np.where(good, model, 0.0)
    cross = np.abs(np.sum(a * b.conj(), axis=-1)) ** 2
    scale = np.sum(np.abs(a) ** 2, axis=-1) * np.sum(np.abs(b) ** 2, axis=-1)
    return np.asarray(np.divide(cross, scale, out=np.zeros_like(cross), where=scale > 0.0))


def log_ratios(measured: Numbers, model: Numbers) -> Floats:
    """Log ratios of magnitudes (..., n_line), one common factor taken out, far ones cut.

    NaN where nothing was measured.
    """
    good = np.isfinite(measured) & (np.abs(measured) > 0.0) & (np.abs(model) > 0.0)
    e = np.log(np.where(good, np.abs(model), 1.0) / np.where(good, np.abs(measured), 1.0))
    e = np.where(good, e, np.nan)
    far = np.log(LIKELIHOOD.far)
    return np.asarray(np.clip(e - np.nanmedian(e), -far, far)) if good.any() else e


def independent_lines(e: Floats) -> float:
    """Return how many of the lines are independent, from how errors go along with one another.

    The number of lines over 1 + 2 Σ ρ_k, the autocorrelation summed up to its first zero
    (Geyer 1992, Statistical Science 7, 473-483: initial positive sequence), averaged over the
    functions, `e` (..., n_line).
    """
    n = e.shape[-1]
    rows = np.nan_to_num(e.reshape(-1, n))
    rows = rows - rows.mean(axis=1, keepdims=True)
    spectrum = np.abs(np.fft.rfft(rows, 2 * n, axis=1)) ** 2
    rho = np.fft.irfft(spectrum.mean(axis=0), 2 * n)[:n]
    if not rho[0] > 0.0:
        return float(n)
    rho = rho / rho[0]
    negative = np.flatnonzero(rho < 0.0)
    last = int(negative[0]) if len(negative) else n
    return float(np.clip(n / (1.0 + 2.0 * rho[1:last].sum()), 1.0, n))


@dataclass(frozen=True, eq=False)
class Heard:
    """What the responses say of hypotheses.

    Parameters
    ----------
    responses : Responses
    ratios : (n_test,) float
        Of the measured modes.
    rest : (n_response, n_reference) float
        Static flexibility that the basis lacks.
    lines, rows : (n,) int
        Lines and responses that hypotheses are compared on: spread evenly.
    independent : float
        Number of independent lines.
    """

    responses: Responses
    ratios: Floats
    rest: Floats
    lines: Ints
    rows: Ints
    independent: float

    def misfit(self, s: State) -> float:
        """Return −2 ln of the likelihood up to a constant: n ln of the mean squared log ratio.

        The variance is unknown and the functions of one structure repeat each other, so only
        the independent lines count.
        """
        return self.independent * float(np.log(self.rms(s) ** 2 + LIKELIHOOD.least_error**2))

    def rms(self, s: State) -> float:
        """Return the rms log ratio of magnitudes."""
        model = synthesised(self.responses, s, self.rest, self.lines, self.rows)
        measured = self.responses.frfs.values[self.rows][:, :, self.lines]
        return float(np.sqrt(np.nanmean(log_ratios(measured, model) ** 2)))


def heard(
    responses: Responses, hz: Floats, ratios: Floats, rest: Floats, reference: State
) -> Heard:
    """Choose lines and count the independent ones by what one hypothesis leaves.

    `hz` and `ratios` (n_test,) are those of the measured modes; `reference` is a hypothesis that
    fits about as well as others will.
    """
    f = responses.frfs.frequencies_hz
    low, high = LIKELIHOOD.band_below * hz.min(), LIKELIHOOD.band_above * hz.max()
    inside = np.flatnonzero((f > low) & (f < high))
    inside = inside if len(inside) else np.arange(len(f))
    lines = inside[np.unique(np.linspace(0, len(inside) - 1, LIKELIHOOD.lines).astype(int))]
    n = len(responses.frfs.responses)
    rows = np.unique(np.linspace(0, n - 1, LIKELIHOOD.functions).astype(int))
    model = synthesised(responses, reference, rest, inside, rows)
    e = log_ratios(responses.frfs.values[rows][:, :, inside], model)
    return Heard(responses, ratios, rest, lines, rows, independent_lines(e))


def lacking(
    observed: sp.csr_matrix, driven: sp.csr_matrix, compliance: Compliance, basis: Floats
) -> Floats:
    """Return the static flexibility between responses and references that a basis lacks.

    Shapes: `observed` (n_response, n_free), `driven` (n_reference, n_free), `basis` (n_free, r).
    """
    exact = observed @ compliance.responses(driven.T.toarray())
    inner = compliance.on(basis)
    return np.asarray(exact - np.asarray(observed @ basis) @ inner @ np.asarray(driven @ basis).T)
