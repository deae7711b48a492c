"""A thin wrapper over MKL PARDISO, when the optional ``mkl`` wheel is installed.

Only the two symmetric real types are used: 2 (positive definite, Cholesky) and -2 (indefinite,
Bunch-Kaufman pivots inside supernodes, which gives the inertia).
"""

import ctypes
import functools
import importlib.metadata
import os
import sys
import weakref
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Numbers
from ..errors import CheckError, InputError

_ANALYSE, _FACTORISE, _SOLVE, _FORWARD, _RELEASE = 11, 22, 33, 331, -1

_ALIKE = 90
"""Per cent of their entries that rows share which make a block."""

_ERRORS = {
    -1: "input inconsistent",
    -2: "not enough memory",
    -3: "reordering problem",
    -4: "zero or negative pivot",
    -5: "unclassified internal error",
    -6: "reordering failed",
    -7: "diagonal matrix is singular",
    -8: "32-bit integer overflow",
    -9: "not enough memory for out-of-core work",
    -10: "cannot open out-of-core files",
    -11: "error with out-of-core files",
}


class NotDefinite(CheckError):
    """A matrix promised to be positive definite met a zero or negative pivot."""

    def __init__(self) -> None:
        super().__init__("a matrix that should be positive definite is not")


def _candidates() -> Iterator[Path]:
    """Where the runtime library of MKL may be, best guess first."""
    try:
        files = importlib.metadata.files("mkl") or []
    except importlib.metadata.PackageNotFoundError:
        files = []
    for file in files:
        if file.name.removeprefix("lib").startswith("mkl_rt.") and ".lib" not in file.name:
            yield Path(str(file.locate())).resolve()
    for folder in ("lib", "Library/bin"):
        yield from sorted(Path(sys.prefix, folder).glob("*mkl_rt*"))


@functools.cache
def library() -> ctypes.CDLL | None:
    """Return the MKL runtime, or None where it is not installed or does not load."""
    for path in _candidates():
        if not path.is_file():
            continue
        try:
            if sys.platform == "win32":
                os.add_dll_directory(str(path.parent))
            found = ctypes.CDLL(str(path))
            found.pardiso  # noqa: B018 - raises AttributeError when the symbol is missing
        except (OSError, AttributeError):
            continue
        return found
    return None


class Pardiso:
    """One symmetric factorisation, its pattern analysed once.

    Parameters
    ----------
    upper : (n, n) csr_matrix
        Upper triangle with sorted indices and every diagonal entry stored.
    definite : bool
        True for Cholesky; False for the indefinite type.

    Raises
    ------
    NotDefinite
        Cholesky met a zero or negative pivot.
    InputError
        Not enough memory.
    CheckError
        Any other error code of PARDISO.
    """

    def __init__(self, upper: sp.csr_matrix, definite: bool) -> None:
        self.n = int(upper.shape[0])
        wide = upper.nnz >= np.iinfo(np.int32).max
        self._int: type[np.signedinteger[Any]] = np.int64 if wide else np.int32
        self._call = _routine(wide)
        self._mtype = 2 if definite else -2
        self._pt = np.zeros(64, np.int64)
        self._iparm = _settings(self._int, definite)
        self._ia = upper.indptr.astype(self._int, copy=False)
        self._ja = upper.indices.astype(self._int, copy=False)
        self._a = np.ascontiguousarray(upper.data, np.float64)
        weakref.finalize(self, _release, self._call, self._pt, self._mtype, self._iparm, self.n)
        self._run(_ANALYSE)
        self._factorise()

    def refactorise(self, data: Floats) -> None:
        """Factorise new values, (nnz,), on the pattern that was analysed."""
        if data.shape != self._ja.shape:
            raise InputError(f"{data.shape[0]} values for a pattern of {self._ja.shape[0]}")
        self._a = np.ascontiguousarray(data, np.float64)
        self._factorise()

    def _factorise(self) -> None:
        self._run(_FACTORISE)
        if self._mtype == 2:
            self._a = np.zeros(1)  # only a factor with replaced pivots is refined by the matrix

    @property
    def negative(self) -> int:
        """Number of negative pivots: the negative eigenvalues of the matrix."""
        return int(self._iparm[22])

    @property
    def perturbed(self) -> int:
        """Number of pivots that were too small and were replaced."""
        return int(self._iparm[13])

    def solve(self, b: Numbers) -> Floats:
        """Return the solution of A x = b for b of shape (n, n_rhs), Fortran order."""
        b = np.asfortranarray(b, np.float64)
        x = np.empty_like(b, order="F")
        if b.shape[1]:
            self._run(_SOLVE, b, x)
        return x

    def half_solve(self, b: Numbers) -> Floats:
        """Return L⁻¹ b for b of shape (n, n_rhs), rows in the order of the Cholesky factor L."""
        b = np.array(b, np.float64, order="F")
        x = np.empty_like(b, order="F")
        if b.shape[1]:
            self._run(_FORWARD, b, x)
        return x

    def _run(self, phase: int, b: Floats | None = None, x: Floats | None = None) -> None:
        zero = np.zeros(1)
        code = _call(
            self._call, self._pt, self._mtype, phase, self._iparm, self.n,
            (self._a, self._ia, self._ja), (zero if b is None else b, zero if x is None else x),
            1 if b is None else b.shape[1],
        )  # fmt: skip
        if code in (-4, -7) and self._mtype == 2:
            raise NotDefinite
        if code in (-2, -9):
            raise InputError(
                f"not enough memory to factorise {self.n} degrees of freedom: "
                "use a machine with more memory or a smaller model"
            )
        if code != 0:
            raise CheckError(f"PARDISO failed: {_ERRORS.get(code, f'code {code}')}")


def _routine(wide: bool) -> Any:
    found = library()
    if found is None:
        raise InputError("PARDISO was asked for but the mkl package is not installed")
    return found.pardiso_64 if wide else found.pardiso


def _settings(integer: type[np.signedinteger[Any]], definite: bool) -> Numbers:
    iparm = np.zeros(64, integer)
    iparm[0] = 1  # the values below, not the defaults
    iparm[1] = 2  # METIS ordering
    iparm[9] = 13  # replace pivots below 1e-13 (the matrix comes scaled)
    iparm[20] = 1  # 1x1 and 2x2 pivots
    iparm[34] = 1  # indices start at zero
    iparm[36] = -_ALIKE if definite else 0  # in blocks of rows alike: a copy of A saved
    return iparm


def pointer(array: Numbers) -> ctypes.c_void_p:
    """Return the address of an array's first entry."""
    return ctypes.c_void_p(array.ctypes.data)


def _call(
    routine: Any,
    pt: Numbers,
    mtype: int,
    phase: int,
    iparm: Numbers,
    n: int,
    matrix: tuple[Numbers, Numbers, Numbers],
    vectors: tuple[Numbers, Numbers],
    n_rhs: int,
) -> int:
    integer = iparm.dtype.type
    scalars = {
        name: np.array([value], integer)
        for name, value in (
            ("one", 1), ("mtype", mtype), ("phase", phase), ("n", n), ("n_rhs", n_rhs),
            ("perm", 0), ("silent", 0), ("error", 0),
        )
    }  # fmt: skip
    p = {name: pointer(value) for name, value in scalars.items()}
    a, ia, ja = matrix
    routine(
        pointer(pt), p["one"], p["one"], p["mtype"], p["phase"], p["n"],
        pointer(a), pointer(ia), pointer(ja), p["perm"], p["n_rhs"],
        pointer(iparm), p["silent"], pointer(vectors[0]), pointer(vectors[1]), p["error"],
    )  # fmt: skip
    return int(scalars["error"][0])


def _release(routine: Any, pt: Numbers, mtype: int, iparm: Numbers, n: int) -> None:
    none = np.zeros(1)
    index = np.zeros(1, iparm.dtype)
    _call(routine, pt, mtype, _RELEASE, iparm, n, (none, index, index), (none, none), 1)
