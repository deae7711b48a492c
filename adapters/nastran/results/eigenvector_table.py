"""Eigenvectors as a results file holds them: by subcase and superelement, in the file's axes."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ....core.arrays import Bools, Floats, Ints, Numbers, hold, require_finite, require_shape


@dataclass(frozen=True, eq=False, kw_only=True)
class ModeHead:
    """What is known of the eigenvectors of one subcase and superelement without their values.

    Parameters
    ----------
    subcase, superelement : int
        Superelement 0 is the residual structure.
    points : (n_point,) int
        Grid and scalar points.
    scalar : (n_point,) bool
        Which points are scalar: their one displacement stands in the first component.
    numbers : (n_mode,) int
        Mode numbers.
    eigenvalues : (n_mode,) float or complex
        Real: squared circular frequency [rad^2/s^2]; complex: the root [1/s].
    generalized_mass : (n_mode,) float
        NaN where the file has none.
    basic : bool
        Whether the components are along the basic axes; else each grid's displacement system.
    """

    subcase: int
    superelement: int
    points: Ints
    scalar: Bools
    numbers: Ints
    eigenvalues: Numbers
    generalized_mass: Floats
    basic: bool

    def __post_init__(self) -> None:
        n_point, n_mode = len(self.points), len(self.numbers)
        hold(self, "points scalar", None, (n_point,))
        hold(self, "numbers eigenvalues generalized_mass", None, (n_mode,))
        require_finite(self.eigenvalues, "the eigenvalues")

    @property
    def is_complex(self) -> bool:
        """Whether the eigenvalues are roots of a complex eigensolution."""
        return bool(np.iscomplexobj(self.eigenvalues))

    @property
    def frequencies_hz(self) -> Floats:
        """Undamped natural frequencies; of a negative eigenvalue that of its size, as printed."""
        size = np.abs(self.eigenvalues)
        omega: Floats = size if self.is_complex else np.sqrt(size)
        return omega / (2.0 * np.pi)

    @property
    def damping(self) -> Floats:
        """Fractions of critical; NaN for real modes."""
        size = np.abs(self.eigenvalues)
        if not self.is_complex:
            return np.full(len(size), np.nan)
        return np.divide(-self.eigenvalues.real, size, out=np.zeros(len(size)), where=size > 0.0)


@dataclass(frozen=True, eq=False, kw_only=True)
class ModeTable(ModeHead):
    """The eigenvectors of one subcase and superelement.

    Parameters
    ----------
    values : (6 n_point, n_mode) float64 or complex128
        Displacements in the axes that `basic` tells, six a point. Taken as it is, not copied:
        what a file of a gigabyte holds must not be there twice.
    """

    values: Numbers

    def __post_init__(self) -> None:
        super().__post_init__()
        self.values.flags.writeable = False
        require_shape(self.values, (6 * len(self.points), len(self.numbers)), "eigenvectors")
        for mode in range(len(self.numbers)):  # one by one: no second array of that size
            require_finite(self.values[:, mode], "the eigenvectors")

    def vector(self, mode: int) -> Numbers:
        """Return one eigenvector, (n_point, 6)."""
        return self.values[:, mode].reshape(-1, 6)

    def take(self, rows: Numbers | slice, modes: Numbers | slice) -> "ModeTable":
        """Return some points (indices or mask) and modes."""
        chosen = np.arange(len(self.points))[rows]
        picked = self.values[(6 * chosen[:, None] + np.arange(6)).ravel()][:, modes]
        return replace(
            self,
            points=self.points[rows],
            scalar=self.scalar[rows],
            numbers=self.numbers[modes],
            eigenvalues=self.eigenvalues[modes],
            values=np.asfortranarray(picked),
            generalized_mass=self.generalized_mass[modes],
        )


def room(n_point: int, n_mode: int, is_complex: bool) -> Numbers:
    """Return an array for the values of a table, to be filled mode by mode."""
    kind = np.complex128 if is_complex else np.float64
    return np.empty((6 * n_point, n_mode), kind, order="F")


def rows_of(summary: Floats, numbers: Ints) -> Floats | None:
    """Return the rows of some modes of a summary (mode, eigenvalue, mass) that lists each once."""
    row = {int(n): k for k, n in enumerate(summary[:, 0])}
    at = [row.get(int(n), -1) for n in numbers]
    return summary[at] if len(row) == len(summary) and min(at, default=-1) >= 0 else None


def generalized_mass(summaries: Iterable[Floats], numbers: Ints, eigenvalues: Numbers) -> Floats:
    """Return the masses of the summary that lists these eigenvalues; NaN where none does."""
    scale = np.abs(eigenvalues).max(initial=0.0)
    for summary in () if np.iscomplexobj(eigenvalues) else summaries:
        rows = rows_of(summary, numbers)
        if rows is not None and np.allclose(rows[:, 1], eigenvalues, rtol=1e-5, atol=1e-6 * scale):
            return np.asarray(rows[:, 2])
    return np.full(len(numbers), np.nan)
