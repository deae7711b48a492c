"""Eigenvectors from Nastran's HDF5 result files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ....core.arrays import Floats, Ints, Numbers
from ....core.errors import InputError
from .table import ModeTable

_DOMAINS = "NASTRAN/RESULT/DOMAINS"
_REAL = "NASTRAN/RESULT/NODAL/EIGENVECTOR"
_COMPLEX = "NASTRAN/RESULT/NODAL/EIGENVECTOR_CPLX"
_SUMMARY = "NASTRAN/RESULT/SUMMARY/EIGENVALUE"
_GRIDS = "NASTRAN/INPUT/NODE/GRID"
_COMPONENTS = ("X", "Y", "Z", "RX", "RY", "RZ")
_MODES, _COMPLEX_MODES = 2, 9


def read_hdf5_tables(path: Path) -> tuple[list[ModeTable], tuple[str, ...]]:
    """Read all eigenvectors of a Nastran HDF5 file.

    Returns
    -------
    tables : list of ModeTable
    names : tuple of str
        All result data sets of the file, for inspection.

    Raises
    ------
    InputError
        The file cannot be read, or is HDF5 of another kind.
    """
    import h5py

    try:
        with h5py.File(path, "r") as file:
            if "NASTRAN" not in file:
                raise InputError(f"{path} is HDF5, but not a result file of Nastran")
            tables = [t for name in (_REAL, _COMPLEX) for t in _tables(file, name, path)]
            return tables, tuple(_data_sets(file))
    except OSError as error:
        reason = error.strerror if error.errno else "it is not HDF5, or is cut short"
        raise InputError(f"cannot read {path}: {reason}") from None
    except (KeyError, ValueError, RuntimeError, TypeError) as error:
        raise InputError(f"{path} is not laid out as Nastran's HDF5 results: {error}") from None


def grids_with_own_systems(path: Path) -> Ints:
    """Return the grids of a file whose displacement system (CD) is not basic, where it says so."""
    import h5py

    with h5py.File(path, "r") as file:
        grids = file[_GRIDS][()] if _GRIDS in file else np.zeros(0, [("ID", int), ("CD", int)])
    return np.asarray(grids["ID"][grids["CD"] != 0], np.int64)


def _data_sets(file: Any) -> Iterator[str]:
    found: list[str] = []
    results = file.get("NASTRAN/RESULT")
    if results is not None:
        results.visititems(
            lambda name, item: found.append(name) if hasattr(item, "dtype") else None
        )
    return iter(found)


def _tables(file: Any, name: str, path: Path) -> Iterator[ModeTable]:
    if name not in file:
        return
    if _DOMAINS not in file:
        raise InputError(f"{path}: the table of domains is missing, the modes cannot be told apart")
    domains = file[_DOMAINS][()]
    vectors = file[name][()]
    used = domains[np.isin(domains["ID"], vectors["DOMAIN_ID"])]
    used = used[np.isin(used["ANALYSIS"], (_MODES, _COMPLEX_MODES))]
    known_grids = np.asarray(file[_GRIDS]["ID"], np.int64) if _GRIDS in file else None
    for subcase, superelement in np.unique(used[["SUBCASE", "SE"]]).tolist():
        mine = used[(used["SUBCASE"] == subcase) & (used["SE"] == superelement)]
        mine = mine[np.argsort(mine["MODE"], kind="stable")]
        points, shapes = _shapes(vectors, mine["ID"], path)
        scalar = np.zeros(len(points), bool)
        if known_grids is not None:
            scalar = ~np.isin(points, known_grids)
        eigenvalues = np.asarray(mine["TIME_FREQ_EIGR"], np.float64)
        if name == _COMPLEX:
            eigenvalues = eigenvalues + 1j * mine["EIGI"]
        numbers = np.asarray(mine["MODE"], np.int64)
        mass = _generalized_mass(file, numbers, eigenvalues)
        yield ModeTable(
            int(subcase), int(superelement), points, scalar, numbers, eigenvalues, shapes, mass,
            basic=False,
        )  # fmt: skip


def _shapes(vectors: Any, domains: Ints, path: Path) -> tuple[Ints, Numbers]:
    """Return points and shapes (n_point, 6, n_mode) of some domains, which list equal points."""
    order = np.argsort(vectors["DOMAIN_ID"], kind="stable")
    sorted_domains = vectors["DOMAIN_ID"][order]
    bounds = zip(
        np.searchsorted(sorted_domains, domains, "left"),
        np.searchsorted(sorted_domains, domains, "right"),
        strict=True,
    )
    blocks = [vectors[order[first:stop]] for first, stop in bounds]
    points = np.asarray(blocks[0]["ID"], np.int64)
    if any(not np.array_equal(b["ID"], points) for b in blocks):
        raise InputError(f"{path}: the eigenvectors of one subcase list different grids")
    return points, np.stack([_components(b) for b in blocks], axis=2)


def _components(block: Any) -> Numbers:
    if "X" in block.dtype.names:
        return np.stack([block[c] for c in _COMPONENTS], axis=1)
    real: Numbers = np.stack([block[f"{c}R"] for c in _COMPONENTS], axis=1)
    imaginary: Numbers = np.stack([block[f"{c}I"] for c in _COMPONENTS], axis=1)
    return np.asarray(real + 1j * imaginary)


def _generalized_mass(file: Any, numbers: Ints, eigenvalues: Numbers) -> Floats:
    """Return the masses of the summary that lists these eigenvalues; NaN where none does."""
    unknown = np.full(len(numbers), np.nan)
    if _SUMMARY not in file or np.iscomplexobj(eigenvalues):
        return unknown
    summary = file[_SUMMARY][()]
    scale = np.abs(eigenvalues).max(initial=0.0)
    for domains in (None, *np.unique(summary["DOMAIN_ID"])):
        rows = summary if domains is None else summary[summary["DOMAIN_ID"] == domains]
        row_of = {int(n): k for k, n in enumerate(rows["MODE"])}
        if len(row_of) < len(rows) or not set(numbers.tolist()) <= row_of.keys():
            continue
        at = np.array([row_of[int(n)] for n in numbers], np.int64)
        if np.allclose(rows["EIGEN"][at], eigenvalues, rtol=1e-6, atol=1e-9 * scale):
            return np.asarray(rows["MASS"][at], np.float64)
    return unknown
