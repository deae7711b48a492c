"""The modes of the model as it is, from which a discovery starts."""

from __future__ import annotations

from ...data.parametric_model import Model
from ...eigen import normal_modes
from ...eigen.normal_modes import Eigensolution
from .screening_numbers import SCREENING


def reference_modes(model: Model, top_hz: float) -> Eigensolution:
    """Solve a model for a discovery; the factor is kept.

    Parameters
    ----------
    model : Model
    top_hz : float
        Up to where modes may pair with the test.
    """
    fmax = SCREENING.modes_above * top_hz / SCREENING.usual
    solution = normal_modes.solve(model, fmax=fmax, keep_factor=True)
    least = SCREENING.modes_least
    if len(solution.eigenvalues) < least < model.n_free // SCREENING.modes_times:
        solution = normal_modes.solve(model, n_modes=least, keep_factor=True)
    return solution
