"""Normal or complex modes of an analysis or a test."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats, Numbers, hold, require_finite
from ..errors import require_kind
from ..noun import Noun
from .dofs import Dofs


@dataclass(frozen=True, eq=False)
class Modes(Noun):
    """Natural frequencies and mode shapes.

    Parameters
    ----------
    frequencies_hz : (n_mode,) float
        Undamped natural frequencies, in the order of the source.
    shapes : (n_dof, n_mode) float or complex
        One column per mode, one row per degree of freedom, displacement in the length unit of
        the geometry that the modes belong to.
    dofs : Dofs
        What the rows are.
    damping : (n_mode,) float, optional
        Fractions of critical; NaN where unknown.
    generalized_mass : (n_mode,) float, optional
        Modal mass for the scaling of `shapes`; NaN where unknown.
    source : str
        Where they came from, for messages and reports.
    doubted : (n_mode,) bool, optional
        Those of a test that their own identification doubts to be modes; none where not given.

    Raises
    ------
    InputError
        Shapes that disagree, or shapes or frequencies that are not finite.
    """

    frequencies_hz: Floats
    shapes: Numbers
    dofs: Dofs
    damping: Floats = None  # type: ignore[assignment]
    generalized_mass: Floats = None  # type: ignore[assignment]
    source: str = ""
    doubted: Bools = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        require_kind(self.dofs, Dofs, "dofs of Modes")
        of = f"of {self.source or 'modes'}"
        hold(self, "frequencies_hz", np.float64, ("n",), f"frequencies {of}")
        n = len(self.frequencies_hz)
        hold(self, "shapes", None, (len(self.dofs), n), f"mode shapes {of}")
        require_finite(self.frequencies_hz, f"frequencies {of}")
        require_finite(self.shapes, f"mode shapes {of}")
        for name in ("damping", "generalized_mass"):
            if getattr(self, name) is None:
                object.__setattr__(self, name, np.full(n, np.nan))
            hold(self, name, np.float64, (n,))
        if self.doubted is None:
            object.__setattr__(self, "doubted", np.zeros(n, bool))
        hold(self, "doubted", np.bool_, (n,))

    def __len__(self) -> int:
        return len(self.frequencies_hz)

    @property
    def is_complex(self) -> bool:
        """Whether the shapes are complex."""
        return bool(np.iscomplexobj(self.shapes))

    def take(self, modes: Numbers) -> Modes:
        """Return the modes of the given columns (indices or mask)."""
        by_mode = self.frequencies_hz[modes], self.shapes[:, modes]
        known = self.damping[modes], self.generalized_mass[modes]
        return Modes(*by_mode, self.dofs, *known, self.source, self.doubted[modes])
