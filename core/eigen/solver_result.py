"""What an eigenvalue iteration hands back, before it is checked and joined."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..arrays import Floats
from ..noun import Noun
from ..numerics.factorisation import Factorisation


@dataclass(frozen=True, eq=False)
class Spectrum(Noun):
    """Modes besides the rigid-body modes that were known beforehand.

    Parameters
    ----------
    values : (n_mode,) float
        Ascending.
    vectors : (n, n_mode) float
        M-orthonormal, and M-orthogonal to the known ones.
    residual : (n_mode,) float
        ||x - (lambda - sigma) A^-1 M x||_M with A = K - sigma M.
    sigma : float
        The shift.
    complete : bool
        Whether these are all modes that the mass matrix allows.
    missed : int or None
        Eigenvalues that the inertia count shows but that are not here; None without a count.
    factor : Factorisation or None
        Of K - sigma M.
    ahead : (n,) float
        Rough values of the next eigenvalues, to find a gap.
    """

    values: Floats
    vectors: Floats
    residual: Floats
    sigma: float
    complete: bool
    missed: int | None
    factor: Factorisation | None = None
    ahead: Floats = field(default_factory=lambda: np.zeros(0))
