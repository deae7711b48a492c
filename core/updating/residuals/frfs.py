"""Frequency responses: log magnitudes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Floats, Ints, Numbers
from ...errors import InputError
from ...reduction.responses import Responding
from ..updating_numbers import UPDATING
from .declaration import Residual, Responses, Seen, Slopes


@dataclass(frozen=True, eq=False)
class Heard:
    """Responses of the test, and the model at the same parameter point."""

    measured: Responses
    model: Responding

    @property
    def observed(self) -> Floats:
        """Rows of the sensors on the basis, (n_out, n_basis)."""
        return self.model.rows(self.measured.observed)

    @property
    def driven(self) -> Floats:
        """Rows of the forces on the basis, (n_in, n_basis)."""
        return self.model.rows(self.measured.driven)


def heard(seen: Seen, name: str) -> Heard:
    """Return the responses of the test and the model that gives them.

    Raises
    ------
    InputError
        The test holds none that lie on the model.
    """
    pairs = seen.damped
    if pairs is None or pairs.responses is None:
        raise InputError(
            f"the residual '{name}' needs frequency responses at sensors and forces on the model, "
            "and the test holds none"
        )
    known = np.zeros(0) if pairs.measured is None else pairs.measured
    known = known[known > 0.0]
    ratio = float(np.exp(np.mean(np.log(known)))) if len(known) else UPDATING.ratio
    return Heard(pairs.responses, Responding(pairs.model, ratio))


def modes_up_to(highest_hz: float) -> float:
    """Return up to where modes make up responses to a frequency; above, static answers stand."""
    return UPDATING.heard * highest_hz


@dataclass(frozen=True, eq=False)
class _Chosen:
    """Lines and sensors that count, and what was measured there, (n_line, n_out, n_in)."""

    rows: Ints
    omega: Floats
    values: Numbers

    @property
    def good(self) -> Numbers:
        """Which of the values are there."""
        return np.isfinite(self.values) & (np.abs(self.values) > 0.0)


def _chosen(seen: Seen, r: Responses) -> _Chosen:
    hz = [q.test_hz for q in seen.pairs]
    low, high = UPDATING.band[0] * min(hz), UPDATING.band[1] * max(hz)
    inside = np.flatnonzero((r.frequencies_hz >= low) & (r.frequencies_hz <= high))
    if not len(inside):
        raise InputError("the residual 'frfs': no line of the responses lies near the pairs")
    lines = _spread(inside, UPDATING.lines)
    rows = _spread(np.arange(len(r.values)), UPDATING.functions)
    omega = 2.0 * np.pi * r.frequencies_hz[lines]
    values = r.values[np.ix_(rows, np.arange(r.values.shape[1]), lines)] / (1j * omega) ** r.order
    return _Chosen(rows, omega, np.moveaxis(values, 2, 0))


def _spread(every: Ints, most: int) -> Ints:
    return np.asarray(every[np.unique(np.linspace(0, len(every) - 1, most).astype(int))])


def _value(seen: Seen) -> Floats:
    """Log ratios of magnitudes, what all have in common left out: gain and unit of force."""
    told = heard(seen, "frfs")
    c = _chosen(seen, told.measured)
    H = told.model.responses(told.observed[c.rows], told.driven, c.omega)
    e = np.log(np.abs(H[c.good] / c.values[c.good]))
    return np.asarray((e - e.mean())[:, None])


def _derivative(seen: Seen, slopes: Slopes) -> Floats:
    told = heard(seen, "frfs")
    c = _chosen(seen, told.measured)
    where = told.observed[c.rows], told.driven, c.omega
    H, moved = told.model.responses(*where), told.model.slopes(*where, slopes.parameters)
    g = np.real(moved[c.good] / H[c.good][:, None])
    return np.asarray((g - g.mean(axis=0))[:, None, :])


FRFS = Residual(
    "frfs", "frf_sigma", UPDATING.response, _value, _derivative, damped=True, hears=True
)
"""Differences of the log magnitudes of frequency responses around the modes that pair."""
