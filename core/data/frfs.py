"""Frequency response functions of a test."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Floats, Ints, Numbers, hold, require_finite
from ..errors import require_kind
from ..noun import Noun
from .dofs import Dofs

QUANTITIES = ("displacement", "velocity", "acceleration")


@dataclass(frozen=True, eq=False)
class Frfs(Noun):
    """Frequency responses between response and reference degrees of freedom.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
        Frequency axis, increasing.
    responses, references : Dofs
        Length n_response and n_reference.
    values : (n_response, n_reference, n_line) complex
        Response over reference; NaN for a combination that was not measured.
    quantity : {"displacement", "velocity", "acceleration"}
        What the responses are, per unit force.
    source : str
        Where they came from.
    """

    frequencies_hz: Floats
    responses: Dofs
    references: Dofs
    values: Numbers
    quantity: str = "acceleration"
    source: str = ""

    def __post_init__(self) -> None:
        require_kind(self.responses, Dofs, "responses of Frfs")
        require_kind(self.references, Dofs, "references of Frfs")
        hold(self, "frequencies_hz", np.float64, ("n",), "the frequency axis")
        shape = (len(self.responses), len(self.references), len(self.frequencies_hz))
        hold(self, "values", np.complex128, shape, "frequency responses")
        require_finite(self.frequencies_hz, "the frequency axis")

    @property
    def order(self) -> int:
        """How often displacement is differentiated by time to give the quantity."""
        return QUANTITIES.index(self.quantity)

    @property
    def as_acceleration(self) -> Frfs:
        """The same functions as accelerations per unit force."""
        more = len(QUANTITIES) - 1 - self.order
        if not more:
            return self
        with np.errstate(over="ignore", invalid="ignore"):
            values = self.values * (2j * np.pi * self.frequencies_hz) ** more
        return replace(self, values=values, quantity=QUANTITIES[-1])

    def at(self, rows: Ints, columns: Ints | None = None) -> Frfs:
        """Return the functions of some responses, and of some references."""
        columns = np.arange(len(self.references)) if columns is None else columns
        own = self.responses.take(rows), self.references.take(columns)
        values = self.values[np.ix_(rows, columns)]
        return Frfs(self.frequencies_hz, *own, values, self.quantity, self.source)
