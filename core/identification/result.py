"""What an identification gives."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Floats, Numbers
from ..data.dofs import Dofs
from ..data.frfs import Frfs
from ..data.modes import Modes
from ..noun import Noun
from .poles.pole_stabilisation import Chart
from .quality import correlation
from .rejected import Rejected
from .survey.faults import Fault
from .survey.modal_synthesis import derivative_order, modal_response
from .survey.mode_indicator import Band
from .survey.references import DrivingPoint, Reciprocity
from .survey.survey_numbers import SURVEY


@dataclass(frozen=True, eq=False)
class Indicator:
    """The complex mode indicator function of the survey.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    values : (n_line, n_value) float
        Singular values of the response matrix, largest first, in the units of the responses.
    """

    frequencies_hz: Floats
    values: Floats


@dataclass(frozen=True, eq=False)
class Background:
    """What the modes do not explain of one band.

    Parameters
    ----------
    band : Band
    residuals : (4, n_output, n_input) complex
        Factors of (jω)^(d−4), (jω)^(d−2), (jω)^d, (jω)^(d+2), d the derivative order of the
        quantity: the second and third are the mass and the stiffness line.
    poles : (n_root,) complex
        Roots beside or beneath the modes that the fit used, rad/s.
    shapes : (n_output, n_root) complex
    participation : (n_input, n_root) complex
    """

    band: Band
    residuals: Numbers
    poles: Numbers
    shapes: Numbers
    participation: Numbers


@dataclass(frozen=True, eq=False)
class Identification(Noun):
    """Modes of a test with their uncertainty and quality, by rising frequency.

    Parameters
    ----------
    modes : Modes
        Complex shapes, turned to their principal phase, largest component of magnitude 1.
        `generalized_mass` as in `real_modes`.
    real_modes : Modes
        Normalised real shapes, largest component 1; `generalized_mass` in the units of
        force over the response's acceleration where a driving point tells it, NaN elsewhere.
    frequency_std : (n_mode,) float
        Standard error of the frequency [Hz].
    damping_std : (n_mode,) float
        Standard error of the damping ratio.
    shape_std : (n_dof, n_mode) float
        Standard error of the real shapes, an error of their common scale left out.
    participation : (n_reference, n_mode) complex
        H = (jω)^d Σ ψ lᵀ/(jω − λ) + conj. with ψ the complex shapes.
    references : Dofs
        Where the structure was driven (or, for a roving hammer, observed).
    mpc : (n_mode,) float
        Modal phase collinearity, 0..1.
    mpd : (n_mode,) float
        Mean phase deviation [degrees].
    mode_indicator : (n_mode,) float
        1 − multivariate mode indicator at the frequency: 1 for a normal mode well excited.
    quality : (n_mode,) float
        Squared correlation of measured and synthesised functions around the mode, 0..1.
    significance : (n_mode,) float
        What the mode explains over what noise would; all are above 1.
    close_pair_possible : (n_mode,) bool
        Whether a second root may hide behind this one, unseen by the references.
    rigid_share : (n_mode,) float
        Share of each real shape in the rigid-body motions of the sensors; NaN unknown.
    remarks : tuple of str
        One per mode; empty for a mode without reproach.
    rejected : tuple of Rejected
        What was considered and is not among the modes.
    bands : tuple of Background
        Bands fitted, with their residual terms.
    chart : Chart
        Stabilisation diagram.
    cmif : Indicator
    measured : Frfs
        The functions, responses where the shapes are given, wrong signs mended.
    quantity : str
        Of the functions as given; fitted as accelerations.
    window_decay : float
        What an exponential window added to the decay rates of the functions, taken out of the
        modes [1/s].
    faults : tuple of Fault
        What is wrong with functions of the survey, and what was done about it.
    driving_points : tuple of DrivingPoint
    reciprocity : tuple of Reciprocity
        How far they hold.
    warnings : tuple of str
    """

    modes: Modes
    real_modes: Modes
    frequency_std: Floats
    damping_std: Floats
    shape_std: Floats
    participation: Numbers
    references: Dofs
    mpc: Floats
    mpd: Floats
    mode_indicator: Floats
    quality: Floats
    significance: Floats
    close_pair_possible: Numbers
    rigid_share: Floats
    remarks: tuple[str, ...]
    rejected: tuple[Rejected, ...]
    bands: tuple[Background, ...]
    chart: Chart
    cmif: Indicator
    measured: Frfs
    quantity: str
    window_decay: float
    faults: tuple[Fault, ...]
    driving_points: tuple[DrivingPoint, ...]
    reciprocity: tuple[Reciprocity, ...]
    warnings: tuple[str, ...]

    @property
    def suspension(self) -> Numbers:
        """Modes that move the whole body as one, (n_mode,) bool."""
        return np.asarray(self.rigid_share > SURVEY.rigid)

    @property
    def poles(self) -> Numbers:
        """Poles λ of the modes, (n_mode,) complex [rad/s]."""
        omega = 2.0 * np.pi * self.modes.frequencies_hz
        zeta = self.modes.damping
        return np.asarray(omega * (-zeta + 1j * np.sqrt(np.maximum(1.0 - zeta**2, 0.0))))

    def synthesised(self, frequencies_hz: Floats | None = None) -> Frfs:
        """Return the functions that modes and residual terms make, at any lines, as windowed.

        Parameters
        ----------
        frequencies_hz : (n_line,) float, optional
            Default: the measured lines. Outside the fitted range the nearest band's residual
            terms are continued.
        """
        f = self.cmif.frequencies_hz if frequencies_hz is None else np.asarray(frequencies_hz)
        values = synthesise(
            f, self.poles - self.window_decay, self.modes.shapes, self.participation, self.bands,
            self.quantity,
        )  # fmt: skip
        source = f"synthesised, {self.modes.source}"
        return Frfs(f, self.modes.dofs, self.references, values, self.quantity, source)

    @cached_property
    def frac(self) -> Floats:
        """Frequency response assurance of each function, (n_dof, n_reference); NaN unmeasured.

        |Σ H* Ĥ|² / (Σ|H|² Σ|Ĥ|²) of measured and synthesised accelerations over the lines fitted.

        References
        ----------
        Heylen, Lammens (1996), FRAC: a consistent way of comparing frequency response functions,
        Proceedings of the Conference on Identification in Engineering Systems, Swansea.
        """
        own, made = self.measured.as_acceleration, self.synthesised().as_acceleration
        pairs = zip(own.values, made.values, strict=True)
        return np.array(
            [
                [
                    np.nan if np.isnan(h[0]) else correlation(h, fit)
                    for h, fit in zip(*row, strict=True)
                ]
                for row in pairs
            ]
        ).reshape(self.measured.values.shape[:2])


def synthesise(
    f: Floats,
    poles: Numbers,
    shapes: Numbers,
    participation: Numbers,
    bands: tuple[Background, ...],
    quantity: str,
) -> Numbers:
    """Functions of modes and, band by band, of residual terms; see `Identification`."""
    values = modal_response(f, poles, shapes, participation, quantity)
    inner = np.array([b.band.high for b in bands[:-1]])
    number = np.searchsorted(inner, f, side="left")
    for n, b in enumerate(bands):
        here = np.flatnonzero(number == n)
        if len(here):
            values[:, :, here] += background_response(f[here], b, quantity)
    return values


def background_response(f: Floats, b: Background, quantity: str = "acceleration") -> Numbers:
    """Functions of the residual terms and background roots of a band."""
    terms = residual_terms(f, quantity)
    values = np.tensordot(b.residuals.transpose(1, 2, 0), terms, axes=1)
    if len(b.poles):
        values = values + modal_response(f, b.poles, b.shapes, b.participation, quantity)
    return np.asarray(values)


def residual_terms(f: Floats, quantity: str = "acceleration") -> Numbers:
    """Lines of the four residual terms, (4, n_line) complex."""
    s = 2j * np.pi * np.asarray(f, dtype=float)
    d = derivative_order(quantity)
    return np.stack([s ** (d - 4), s ** (d - 2), s**d, s ** (d + 2)])
