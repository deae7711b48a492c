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


def frozen(values: npt.ArrayLike, dtype: npt.DTypeLike = None, what: str = "it") -> Numbers:
    """Return a read-only copy of `values`, or `values` itself if it is read-only and its own.

    Raises
    ------
    InputError
        They are no numbers; `what` should hold them.
    """
    if (
        isinstance(values, np.ndarray)
        and values.base is None
        and not values.flags.writeable
        and dtype in (None, values.dtype)
    ):
        return values
    try:
        array = np.array(values, dtype=dtype)
    except (TypeError, ValueError):
        array = np.array("")
    if array.dtype.kind not in "biufc":
        raise InputError(f"{what} must be an array of numbers")
    array.flags.writeable = False
    return array


def skew(r: Floats) -> Floats:
    """Return the matrices [r x], (..., 3, 3), of the vectors `r`, (..., 3)."""
    out = np.zeros((*r.shape[:-1], 3, 3))
    out[..., 0, 1], out[..., 0, 2], out[..., 1, 2] = -r[..., 2], r[..., 1], -r[..., 0]
    return np.asarray(out - np.swapaxes(out, -1, -2))


def hold(
    noun: object,
    names: str,
    dtype: npt.DTypeLike = None,
    shape: tuple[int | str, ...] | None = None,
    what: str = "",
) -> None:
    """Make fields of a frozen noun, named with blanks between, read-only arrays.

    Raises
    ------
    InputError
        One that holds no numbers, or has another shape (see `require_shape`).
    """
    for name in names.split():
        said = what or f"{name} of {type(noun).__name__}"
        array = frozen(getattr(noun, name), dtype, said)
        if shape is not None:
            if shape == (0, 3) and not array.size:
                array = array.reshape(0, 3)
            require_shape(array, shape, said)
        object.__setattr__(noun, name, array)


def require_finite(values: Numbers, what: str) -> None:
    """Raise `InputError` when an array holds NaN or infinity."""
    bad = int(values.size - np.count_nonzero(np.isfinite(values)))
    if bad:
        raise InputError(f"{what} holds {bad} value(s) that are not finite numbers")


def require_shape(values: object, shape: tuple[int | str, ...], what: str) -> None:
    """Raise `InputError` when an array does not have the shape its neighbours ask for.

    A letter in `shape` stands for any length.
    """
    have = getattr(values, "shape", ())
    fits = (isinstance(n, str) or n == length for n, length in zip(shape, have, strict=False))
    if len(shape) != len(have) or not all(fits):
        expected = str(shape).replace("'", "")
        raise InputError(f"{what} has shape {have}, expected {expected}")
