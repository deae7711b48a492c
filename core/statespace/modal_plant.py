"""A structure as a linear system: modal coordinates, forces in, motions out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Floats, Numbers, hold, require_finite
from ..data.dofs import Dofs
from ..data.frfs import QUANTITIES, Frfs
from ..errors import InputError, require_kind
from ..noun import Noun
from .channels import Channel, check_names
from .statespace_numbers import STATESPACE


@dataclass(frozen=True, eq=False)
class ModalPlant(Noun):
    """Modes of modal mass 1, each q'' + 2 zeta omega q' + omega² q = sum_j B_kj u_j.

    Output i is sum_k P_ik times q, q' or q'', by the quantity of its channel. Residual modes are
    the static contribution of all modes that were left out, as Ritz vectors of the inputs.

    Parameters
    ----------
    frequencies_hz, damping : (n_mode,) float
        Undamped natural frequencies; fractions of critical.
    drive : (n_mode, n_input) float
        B; in SI units of forces and moments for a modal mass of 1 kg.
    sense : (n_output, n_mode) float
        P; modal coordinates are then in metres.
    inputs, outputs : tuple of Channel
    residual_modes : int
        The last so many.
    band_hz : float or None
        Up to where it is meant to be used.
    error : float or None
        What is left out at the upper end of the band, where it is largest: the largest
        difference of a receptance to the one of the whole model, over the median of that
        receptance in the band; None where it is not known.
    si : bool
        In SI units; otherwise in those of the deck.

    Raises
    ------
    InputError
        Shapes that disagree, numbers that are not finite, names that collide, an unstable mode.
    """

    frequencies_hz: Floats
    damping: Floats
    drive: Floats
    sense: Floats
    inputs: tuple[Channel, ...]
    outputs: tuple[Channel, ...]
    residual_modes: int = 0
    band_hz: float | None = None
    error: float | None = None
    si: bool = True

    def __post_init__(self) -> None:
        for c in (*self.inputs, *self.outputs):
            require_kind(c, Channel, "a channel of ModalPlant")
        check_names((*self.inputs, *self.outputs))
        hold(self, "frequencies_hz", np.float64, ("n",), "frequencies")
        n = len(self.frequencies_hz)
        hold(self, "damping", np.float64, (n,), "damping ratios")
        hold(self, "drive", np.float64, (n, len(self.inputs)), "drive")
        hold(self, "sense", np.float64, (len(self.outputs), n), "sense")
        for name in ("frequencies_hz", "damping", "drive", "sense"):
            require_finite(getattr(self, name), f"{name} of ModalPlant")
        for k, (f, z) in enumerate(zip(self.frequencies_hz, self.damping, strict=True), 1):
            if f < 0.0 or z < 0.0:
                what = f"a frequency of {f:g} Hz" if f < 0.0 else f"a damping ratio of {z:g}"
                raise InputError(f"mode {k} has {what}: the model is unstable")

    def __len__(self) -> int:
        return len(self.frequencies_hz)

    @property
    def quantity(self) -> Numbers:
        """Of each output: how often displacement is differentiated, (n_output,) int."""
        return np.array([c.quantity for c in self.outputs], dtype=np.int64)

    @property
    def state_names(self) -> list[str]:
        """``mode[1].q``, ``mode[1].qd``, ... of the states in their order."""
        return [f"mode[{k}].{q}" for k in range(1, len(self) + 1) for q in ("q", "qd")]

    def matrices(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Return A, B, C, D for states q1, q1', q2, q2' and so on."""
        n, w = len(self), 2.0 * np.pi * self.frequencies_hz
        q, v = np.arange(0, 2 * n, 2), np.arange(1, 2 * n, 2)
        A = np.zeros((2 * n, 2 * n))
        A[q, v], A[v, q], A[v, v] = 1.0, -(w**2), -2.0 * self.damping * w
        B = np.zeros((2 * n, len(self.inputs)))
        B[v] = self.drive
        by = self.quantity[:, None]
        C = np.zeros((len(self.outputs), 2 * n))
        C[:, q] = np.select([by == 0, by == 2], [self.sense, -self.sense * w**2], 0.0)
        C[:, v] = np.select([by == 1, by == 2], [self.sense, -2.0 * self.sense * self.damping * w])
        D = np.where(by == 2, self.sense @ self.drive, 0.0)
        return A, B, C, D

    def responses(self, hz: Floats) -> Numbers:
        """Return the frequency responses, (n_output, n_input, n_line) complex."""
        s = 2j * np.pi * np.asarray(hz, dtype=float)
        return np.asarray(self.receptances(hz) * s ** self.quantity[:, None, None])

    def frfs(self, lines: int = STATESPACE.written) -> Frfs:
        """Return the frequency responses at so many even lines up to the end of the band.

        Raises
        ------
        InputError
            No band, outputs of several quantities, or a grid and a sensor of one number.
        """
        kinds = sorted({c.quantity for c in self.outputs})
        if len(kinds) > 1:
            mixed = " and ".join(QUANTITIES[k] for k in kinds)
            raise InputError(f"the outputs are {mixed}; functions of a file are of one quantity")
        if self.band_hz is None:
            raise InputError("the upper end of the band is not known; give fmax")
        grids = {c.node for c in (*self.inputs, *self.outputs) if not c.sensor}
        both = sorted(grids & {c.node for c in self.outputs if c.sensor})
        if both:
            raise InputError(
                f"grid {both[0]} and sensor {both[0]} would be one node of a file of functions; "
                "write sensors and grids into files of their own"
            )
        hz = self.band_hz / lines * np.arange(1, lines + 1)
        into, out = (
            Dofs(
                np.array([c.node for c in channels]),
                np.array([c.component for c in channels]),
                np.array([c.direction for c in channels]),
            )
            for channels in (self.inputs, self.outputs)
        )
        return Frfs(hz, out, into, self.responses(hz), QUANTITIES[kinds[0]], "modes")

    def receptances(self, hz: Floats) -> Numbers:
        """Return displacements per force, whatever the outputs are, (n_output, n_input, n_line)."""
        s = 2j * np.pi * np.asarray(hz, dtype=float)
        w = 2.0 * np.pi * self.frequencies_hz[:, None]
        modal = 1.0 / (s**2 + 2.0 * self.damping[:, None] * w * s + w**2)
        H = np.einsum("ik,kj,kf->ijf", self.sense, self.drive, modal, optimize=True)
        return np.asarray(H)

    def with_error(self, error: float) -> ModalPlant:
        """Return the plant with what it leaves out at the end of its band."""
        return replace(self, error=error)

    def in_si(self, length: float, mass: float) -> ModalPlant:
        """Return the plant in SI units: `length` metres and `mass` kilograms are one of its own."""
        turning = np.array([c.turns for c in self.inputs], dtype=bool)
        drive = self.drive / np.where(turning, length, 1.0) / np.sqrt(mass)
        rotating = np.array([c.turns for c in self.outputs], dtype=bool)
        sense = self.sense / np.where(rotating, length, 1.0)[:, None] / np.sqrt(mass)
        return replace(self, drive=drive, sense=sense, si=True)
