"""Read-only array construction shared by the neutral nouns."""

from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import InputError

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]
Numbers = npt.NDArray[Any]

Matrices = tuple[Floats | None, Floats | None]
"""Stiffness and mass of some elements, each (n, m, m) or None where there is none."""


def frozen(values: npt.ArrayLike, dtype: npt.DTypeLike = None) -> Numbers:
    """Return a read-only copy of `values`, or `values` itself if it is read-only and its own."""
    if (
        isinstance(values, np.ndarray)
        and values.base is None
        and not values.flags.writeable
        and dtype in (None, values.dtype)
    ):
        return values
    array = np.array(values, dtype=dtype)
    array.flags.writeable = False
    return array


def skew(r: Floats) -> Floats:
    """Return the matrices [r x], (..., 3, 3), of the vectors `r`, (..., 3)."""
    out = np.zeros((*r.shape[:-1], 3, 3))
    out[..., 0, 1], out[..., 0, 2], out[..., 1, 2] = -r[..., 2], r[..., 1], -r[..., 0]
    return np.asarray(out - np.swapaxes(out, -1, -2))


def require_finite(values: Numbers, what: str) -> None:
    """Raise `InputError` when an array holds NaN or infinity."""
    bad = int(values.size - np.count_nonzero(np.isfinite(values)))
    if bad:
        raise InputError(f"{what} holds {bad} value(s) that are not finite numbers")


def require_shape(values: Numbers, shape: tuple[int, ...], what: str) -> None:
    """Raise `InputError` when an array does not have the shape its neighbours ask for."""
    if values.shape != shape:
        raise InputError(f"{what} has shape {values.shape}, expected {shape}")
