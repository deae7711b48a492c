"""A modal plant of a model, or of modes alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Numbers
from ..data.modes import Modes
from ..data.parametric_model import Model
from ..eigen.eigen_numbers import EIGEN
from ..eigen.normal_modes import solve
from ..errors import InputError
from .channels import Channel, refuse_fixed
from .modal_plant import ModalPlant
from .statespace_numbers import STATESPACE
from .truncation import receptance_at, relative_error, residual_modes


@dataclass(frozen=True, eq=False)
class ModalBasis:
    """Modes of modal mass 1 at the channels, before damping is known; deck units.

    Parameters
    ----------
    frequencies_hz : (n,) float
        Of rigid-body modes 0.
    drive : (n, n_input) float
    sense : (n_output, n) float
    residual : int
        The last so many are residual modes.
    band_hz : float or None
    difference : (n_output, n_input) float or None
        Of the undamped receptance of the whole model to that of all these modes, at `band_hz`.
    vectors : (n_free, n) float or None
        Of a model.
    damping : (n,) float or None
        Of modes alone: their ratios, NaN where unknown.
    notes : tuple of str
    """

    frequencies_hz: Floats
    drive: Floats
    sense: Floats
    residual: int = 0
    band_hz: float | None = None
    difference: Floats | None = None
    vectors: Floats | None = field(default=None, repr=False)
    damping: Floats | None = None
    notes: tuple[str, ...] = ()

    def plant(
        self, damping: Floats, inputs: Sequence[Channel], outputs: Sequence[Channel]
    ) -> ModalPlant:
        """Return the plant with these damping ratios, in deck units."""
        made = ModalPlant(
            self.frequencies_hz,
            damping,
            self.drive,
            self.sense,
            tuple(inputs),
            tuple(outputs),
            self.residual,
            self.band_hz,
            si=False,
        )
        if self.difference is None or self.band_hz is None:
            return made
        lines = np.linspace(0.0, self.band_hz, STATESPACE.lines + 1)[1:]
        of_motion = made.receptances(lines)
        return made.with_error(relative_error(self.difference, of_motion))


def basis_of_model(
    model: Model,
    inputs: Sequence[Channel],
    outputs: Sequence[Channel],
    rows_in: Floats,
    rows_out: Floats | sp.spmatrix,
    *,
    fmax: float | None = None,
    n_modes: int | None = None,
    residual: bool = True,
    rigid: bool = True,
) -> ModalBasis:
    """Return the modes of a model up to one and a half times the band, and residual modes.

    Parameters
    ----------
    model : Model
    inputs, outputs : sequence of Channel
    rows_in, rows_out : (n, n_dof)
        What reads them of displacements on all dofs of the model.
    fmax : float, optional
        Upper end of the band, Hz.
    n_modes : int, optional
        How many modes, rigid-body ones included; without `fmax` the band follows from them.
    residual, rigid : bool
        Whether residual modes are added and rigid-body modes kept.

    Raises
    ------
    InputError
        A channel where nothing moves; an input on which a free body would run away where
        rigid-body modes are refused and nothing is left.
    CheckError
        The eigensolution does not meet its check.
    """
    enough = None if fmax is None else STATESPACE.beyond * fmax
    count = n_modes if n_modes or fmax else STATESPACE.modes
    forces = np.asarray(model.expansion.T @ rows_in.T)
    read = sp.csr_matrix(rows_out) @ model.expansion
    refuse_fixed(inputs, forces.T, "nothing moves there")
    refuse_fixed(outputs, np.asarray(abs(read).sum(axis=1)), "nothing moves there")
    kept = solve(model, count, enough, keep_factor=residual)
    zero = kept.rigid_body_modes
    hz = np.where(np.arange(len(kept.eigenvalues)) < zero, 0.0, kept.frequencies_hz)
    if fmax is None and len(hz) > zero:
        fmax = float(hz[-1] / STATESPACE.beyond)
    K, M = model.K(), model.M()
    vectors, added = kept.vectors, 0
    if residual:
        more, others = residual_modes(K, M, kept, forces)
        hz = np.concatenate([hz, np.sqrt(more) / (2.0 * np.pi)])
        vectors, added = np.hstack([vectors, others]), len(more)
    drive, sense = vectors.T @ forces, np.asarray(read @ vectors)
    difference, short = None, []
    top = kept.frequencies_hz.max(initial=0.0)
    if fmax is not None and len(kept.eigenvalues) in (n_modes, EIGEN.most) and top < fmax:
        short = [
            f"the {len(kept.eigenvalues)} modes end at {top:.4g} Hz: from there to the {fmax:g} Hz "
            "of the band resonances may be missing; ask for more modes, or for a narrower band"
        ]
    elif fmax is not None:
        own = sense @ (drive / ((2.0 * np.pi) ** 2 * (hz**2 - fmax**2))[:, None])
        difference = receptance_at(K, M, forces, read, fmax) - own
    stay = slice(None) if rigid else slice(zero, None)
    if not len(hz[stay]):
        raise InputError("no mode is left: there are rigid-body modes only in the band")
    left_out = [f"{zero} rigid-body modes are left out as asked for"] if zero and not rigid else []
    return ModalBasis(
        hz[stay], drive[stay], sense[:, stay], added, fmax, difference, vectors[:, stay],
        notes=(*kept.warnings, *left_out, *short),
    )  # fmt: skip


def basis_of_modes(
    modes: Modes,
    inputs: Sequence[Channel],
    outputs: Sequence[Channel],
    rows_in: Numbers,
    rows_out: Numbers,
    *,
    fmax: float | None = None,
    n_modes: int | None = None,
    rigid: bool = True,
) -> ModalBasis:
    """Return modes that are known without their model; what they leave out is not known.

    Raises
    ------
    InputError
        Complex modes, modes without a generalised mass, a channel where no mode moves.
    """
    who = modes.source or "the source"
    if modes.is_complex:
        raise InputError(f"the modes of {who} are complex; give normal modes")
    mass = modes.generalized_mass
    if not np.all(mass > 0.0):
        k = int(np.flatnonzero(~(mass > 0.0))[0])
        raise InputError(
            f"mode {k + 1} of {who} has no generalised mass, so that nobody knows what forces do; "
            "give modes with their mass, or the deck"
        )
    hz = modes.frequencies_hz
    rest = STATESPACE.resting * np.abs(hz).max(initial=0.0)
    if np.any(hz < -rest):
        k = int(np.flatnonzero(hz < -rest)[0])
        raise InputError(f"mode {k + 1} of {who} has {hz[k]:g} Hz: the model is unstable")
    free = hz <= rest
    hz = np.where(free, 0.0, hz)
    stay = np.ones(len(hz), bool) if fmax is None else hz <= STATESPACE.beyond * fmax
    stay[n_modes or len(hz) :] = False
    if not rigid:
        stay &= ~free
    if not stay.any():
        raise InputError(f"no mode of {who} is left to make a plant of")
    shapes = (modes.shapes / np.sqrt(mass))[:, stay]
    drive, sense = np.asarray(rows_in @ shapes).T, np.asarray(rows_out @ shapes)
    seen = STATESPACE.still * np.abs(shapes).max(initial=0.0)
    refuse_fixed(inputs, drive.T, "no mode moves there", seen)
    refuse_fixed(outputs, sense, "no mode moves there", seen)
    note = (
        "of modes alone nobody knows what was left out: the band is good to about "
        f"{hz[stay].max() / STATESPACE.beyond:.4g} Hz, antiresonances less"
    )
    notes = [note]
    if np.any(modes.frequencies_hz[free & stay] > 0.0):
        top = modes.frequencies_hz[free & stay].max()
        notes.append(f"modes up to {top:.3g} Hz are taken to be rigid-body motions")
    known = np.where(free, np.nan, modes.damping)[stay]
    return ModalBasis(hz[stay], drive, sense, band_hz=fmax, damping=known, notes=tuple(notes))
