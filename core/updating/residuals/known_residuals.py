"""The list of residuals, how users name them, and what they are weighed by."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ...arrays import Floats
from ...errors import InputError, require_kind
from ..updating_numbers import UPDATING
from .antiresonances import ANTIRESONANCES
from .damping import DAMPING
from .declaration import Residual
from .deflections import DEFLECTIONS
from .frequencies import FREQUENCIES
from .frfs import FRFS
from .prior import PRIOR
from .relations import RELATIONS
from .shapes import SHAPES
from .weight import CENTRE_OF_GRAVITY, MASS

RESIDUALS: list[Residual] = [
    FREQUENCIES,
    SHAPES,
    MASS,
    CENTRE_OF_GRAVITY,
    DEFLECTIONS,
    DAMPING,
    FRFS,
    ANTIRESONANCES,
    PRIOR,
    RELATIONS,
]
"""What an update may minimise; `register_residual` adds to it."""

BOTH = "both"
"""What users say for frequencies and shapes."""


def register_residual(residual: Residual) -> None:
    """Add a residual to the list: its name goes into studies from then on, and so does its key.

    Raises
    ------
    InputError
        A name or a key that another has.
    """
    require_kind(residual, Residual, "what is registered")
    names = [BOTH, *(r.name for r in RESIDUALS)]
    if residual.name in names or residual.weight in [r.weight for r in RESIDUALS]:
        raise InputError(f"there is a residual '{residual.name}' or '{residual.weight}' already")
    RESIDUALS.append(residual)


def residuals_named(words: str) -> tuple[Residual, ...]:
    """Return the residuals of a name, of several with commas between, or of ``both``.

    Raises
    ------
    InputError
        A name that no residual has.
    """
    known = {BOTH: (FREQUENCIES, SHAPES), **{r.name: (r,) for r in RESIDUALS}}
    said = [word.strip() for word in words.split(",")]
    if not all(word in known for word in said):
        names = ", ".join([*(r.name for r in RESIDUALS), BOTH])
        raise InputError(f"residuals is '{words}'; give one of {names}, or several with commas")
    return tuple(dict.fromkeys(r for word in said for r in known[word]))


@dataclass(frozen=True)
class Weights:
    """Standard deviations that make W = diag(1/σ²), and the regularisation W_p.

    Parameters
    ----------
    sigmas : mapping of str to float
        Standard deviations by the key of their residual, for example ``frequency_sigma``; what
        is not given is the residual's default.
    regularisation : float
        Standard deviation of a parameter step is 1/√regularisation; 0 leaves W_p out.
    modes : mapping of int to float
        What a test mode, by its number from 1, counts beside the others: 0.2 makes its variance
        five times as large; what is not given is 1.
    """

    sigmas: Mapping[str, float] = field(default_factory=dict)
    regularisation: float = UPDATING.regularisation
    modes: Mapping[int, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        known = [r.weight for r in RESIDUALS]
        for key, sigma in self.sigmas.items():
            if key not in known:
                raise InputError(f"no residual is weighed by '{key}'; known: {', '.join(known)}")
            if not sigma > 0.0:
                raise InputError(f"{key} is a standard deviation; it must be above 0")
        if self.regularisation < 0.0:
            raise InputError("the regularisation must not be negative")
        for mode, weight in self.modes.items():
            if mode < 1 or not weight > 0.0:
                raise InputError(f"the weight of test mode {mode} is {weight:g}; give one above 0")

    @property
    def all(self) -> dict[str, float]:
        """Standard deviations of all residuals by their keys, defaults included."""
        return {r.weight: self.sigma(r) for r in RESIDUALS}

    def sigma(self, residual: Residual) -> float:
        """Return the standard deviation of a residual."""
        return float(self.sigmas.get(residual.weight, residual.sigma))

    def of(self, modes: Iterable[int]) -> Floats:
        """Return the weights of test modes, (n,), which count from 0 here."""
        return np.array([self.modes.get(t + 1, 1.0) for t in modes])
