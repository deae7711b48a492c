"""Products of large matrices: by MKL where the optional wheel is installed, else by numpy's BLAS.

The BLAS that a wheel of numpy brings may know the processor by an older name only and then takes
the slowest of its kernels; one that comes with the solver is as new as that. Sparse products of
scipy are loops over rows; MKL's are in vectors. Small products stay with numpy.
"""

import ctypes
from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats
from .pardiso import library, pointer

_LARGE = 1_000_000
"""Multiplications from which on the way to MKL is worth its call."""

_ROW_MAJOR, _AS_IT_IS, _TRANSPOSED = 101, 111, 112
_SPARSE_AS_IT_IS, _GENERAL = 10, 20


class _Description(ctypes.Structure):
    """``struct matrix_descr``."""

    _fields_ = (("type", ctypes.c_int), ("mode", ctypes.c_int), ("diag", ctypes.c_int))


def product(a: Floats, b: Floats, out: Floats | None = None, *, add: bool = False) -> Floats:
    """Return a @ b of dense matrices (n, k) and (k, m), (n, m), in `out` where that is given.

    With `add` it is added to what is there.
    """
    found = library()
    (n, k), m = a.shape, b.shape[1]
    small = found is None or n * k * m < _LARGE or not _doubles(a, b)
    if out is None:
        if small:
            return np.asarray(a @ b)
        out = np.empty((n, m))
    by_rows, led = _led(out)
    if found is None or small or not led:
        np.add(out, a @ b, out=out) if add else np.matmul(a, b, out=out)
        return out
    if not by_rows:
        product(b.T, a.T, out.T, add=add)
        return out
    (a, op_a, lda), (b, op_b, ldb) = _taken(a), _taken(b)
    one, of_old = ctypes.c_double(1.0), ctypes.c_double(float(add))
    found.cblas_dgemm(
        _ROW_MAJOR, op_a, op_b, n, m, k, one, pointer(a), lda, pointer(b), ldb, of_old,
        pointer(out), led,
    )  # fmt: skip
    return out


def stacked_product(a: Floats, b: Floats) -> Floats:
    """Return a @ b of stacks of few rows each, (n, q, k), and one matrix (k, m): (n, q, m)."""
    flat = product(a.reshape(-1, a.shape[-1]), b)
    return flat.reshape(*a.shape[:-1], b.shape[1])


def sparse_product(a: sp.csr_matrix, x: Floats) -> Floats:
    """Return a @ x of a sparse matrix (n, k) and a dense one (k, m), (n, m)."""
    found = library()
    large = x.ndim == 2 and a.nnz * x.shape[1] >= _LARGE
    if found is None or not large or a.indices.dtype != np.int32 or not _doubles(a.data, x):
        return np.asarray(a @ x)
    x, out = np.ascontiguousarray(x), np.empty((a.shape[0], x.shape[1]))
    handle, m = ctypes.c_void_p(), x.shape[1]
    ends = ctypes.c_void_p(a.indptr.ctypes.data + a.indptr.itemsize)
    _done(
        found.mkl_sparse_d_create_csr,
        ctypes.byref(handle), 0, *a.shape,
        pointer(a.indptr), ends, pointer(a.indices), pointer(a.data),
    )  # fmt: skip
    one, zero = ctypes.c_double(1.0), ctypes.c_double(0.0)
    try:
        _done(
            found.mkl_sparse_d_mm,
            _SPARSE_AS_IT_IS, one, handle, _Description(_GENERAL, 0, 0), _ROW_MAJOR,
            pointer(x), m, m, zero, pointer(out), m,
        )  # fmt: skip
    finally:
        found.mkl_sparse_destroy(handle)
    return out


def _done(routine: Callable[..., int], *arguments: object) -> None:
    if routine(*arguments):
        raise MemoryError


def _doubles(*arrays: Floats) -> bool:
    return all(x.dtype == np.float64 for x in arrays)


def _taken(x: Floats) -> tuple[Floats, int, int]:
    """Return a matrix as BLAS takes it, a copy where need be: whether transposed, and `_led`."""
    by_rows, led = _led(x)
    if not led:
        return np.ascontiguousarray(x), _AS_IT_IS, x.shape[1]
    return x, _AS_IT_IS if by_rows else _TRANSPOSED, led


def _led(x: Floats) -> tuple[bool, int]:
    """Whether a matrix lies by rows, and how far from one row (or column) to the next; else 0."""
    size, (rows, columns) = x.itemsize, x.strides
    if columns == size and rows >= x.shape[1] * size and rows % size == 0:
        return True, rows // size
    if rows == size and columns >= x.shape[0] * size and columns % size == 0:
        return False, columns // size
    return True, 0
