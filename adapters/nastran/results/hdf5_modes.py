"""Eigenvectors from Nastran's HDF5 result files."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ....core.arrays import Floats, Ints, Numbers
from ....core.errors import InputError, Place
from .eigenvector_table import ModeHead, ModeTable, generalized_mass, room

_DOMAINS = "NASTRAN/RESULT/DOMAINS"
_REAL = "NASTRAN/RESULT/NODAL/EIGENVECTOR"
_COMPLEX = "NASTRAN/RESULT/NODAL/EIGENVECTOR_CPLX"
_SUMMARY = "NASTRAN/RESULT/SUMMARY/EIGENVALUE"
_GRIDS = "NASTRAN/INPUT/NODE/GRID"
_COMPONENTS = ("X", "Y", "Z", "RX", "RY", "RZ")
_MODES, _COMPLEX_MODES = 2, 9


def read_hdf5_tables(
    path: Path, modes: Collection[int] | None = None
) -> tuple[list[ModeTable], tuple[str, ...]]:
    """Read the eigenvectors of a Nastran HDF5 file, all or those of some mode numbers.

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
    with opened(path) as file:
        groups = [g for name in (_REAL, _COMPLEX) for g in _groups(file, name, path, modes)]
        return [_table(file, g, path) for g in groups], _data_sets(file)


def read_hdf5_heads(path: Path) -> tuple[list[ModeHead], tuple[str, ...]]:
    """Read what `read_hdf5_tables` gives but the values: costs what it reads."""
    with opened(path) as file:
        groups = [g for name in (_REAL, _COMPLEX) for g in _groups(file, name, path)]
        return [g.head for g in groups], _data_sets(file)


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """Open a Nastran HDF5 file; every failure of HDF5 or of the layout told as one sentence."""
    import h5py

    try:
        with h5py.File(path, "r") as file:
            if "NASTRAN" not in file:
                raise Place(path).fault("is HDF5, but not a result file of Nastran")
            yield file
    except OSError as error:
        reason = error.strerror if error.errno else "it is not HDF5, or is cut short"
        raise InputError(f"cannot read {path}: {reason}", file=path) from None
    except (
        KeyError, ValueError, IndexError, RuntimeError, TypeError, AttributeError, MemoryError,
    ) as error:  # fmt: skip
        reason = " ".join(str(error).strip("'").split())[:120]
        raise Place(path).fault(f"is not laid out as Nastran's HDF5 results: {reason}") from None


def grids_with_own_systems(path: Path) -> Ints:
    """Return the grids of a file whose displacement system (CD) is not basic, where it says so."""
    with opened(path) as file:
        grids = file[_GRIDS][()] if _GRIDS in file else np.zeros(0, [("ID", int), ("CD", int)])
        return np.asarray(grids["ID"][grids["CD"] != 0], np.int64)


def _data_sets(file: Any) -> tuple[str, ...]:
    found: list[str] = []
    if "NASTRAN/RESULT" in file:
        file["NASTRAN/RESULT"].visititems(
            lambda name, item: found.append(name) if hasattr(item, "dtype") else None
        )
    return tuple(found)


@dataclass(frozen=True)
class _Group:
    """The modes of one subcase and superelement: where the rows of each stand."""

    name: str
    head: ModeHead
    rows: tuple[slice, ...]


def _groups(
    file: Any, name: str, path: Path, modes: Collection[int] | None = None
) -> Iterator[_Group]:
    if name not in file:
        return
    if _DOMAINS not in file:
        raise Place(path).error("the table of domains is missing, the modes cannot be told apart")
    domains = file[_DOMAINS][()]
    used = domains[np.isin(domains["ANALYSIS"], (_MODES, _COMPLEX_MODES))]
    if modes is not None:
        used = used[np.isin(used["MODE"], list(modes))]
    places = _places(file, name, path)
    used = used[[int(d) in places for d in used["ID"]]]
    known_grids = np.asarray(file[_GRIDS]["ID"], np.int64) if _GRIDS in file else None
    for subcase, superelement in np.unique(used[["SUBCASE", "SE"]]).tolist():
        mine = used[(used["SUBCASE"] == subcase) & (used["SE"] == superelement)]
        mine = mine[np.argsort(mine["MODE"], kind="stable")]
        rows = tuple(places[int(d)] for d in mine["ID"])
        points = np.asarray(file[name].fields("ID")[rows[0]], np.int64)
        scalar = np.zeros(len(points), bool)
        if known_grids is not None:
            scalar = ~np.isin(points, known_grids)
        eigenvalues: Numbers = np.asarray(mine["TIME_FREQ_EIGR"], np.float64)
        if name == _COMPLEX:
            eigenvalues = eigenvalues + 1j * mine["EIGI"]
        numbers = np.asarray(mine["MODE"], np.int64)
        head = ModeHead(
            subcase=int(subcase),
            superelement=int(superelement),
            points=points,
            scalar=scalar,
            numbers=numbers,
            eigenvalues=eigenvalues,
            generalized_mass=generalized_mass(_summaries(file), numbers, eigenvalues),
            basic=False,
        )
        yield _Group(name, head, rows)


def _places(file: Any, name: str, path: Path) -> dict[int, slice]:
    """Return the rows of each domain: from the file's index, else from the rows themselves."""
    if f"INDEX/{name}" in file:
        index = file[f"INDEX/{name}"][()]
        starts = np.asarray(index["POSITION"], np.int64)
        stops = starts + np.asarray(index["LENGTH"], np.int64)
        domains = np.asarray(index["DOMAIN_ID"], np.int64)
        if (starts < 0).any() or (stops > len(file[name])).any():
            raise Place(path).error("the index of the eigenvectors points outside of them")
    else:
        of_row = np.asarray(file[name].fields("DOMAIN_ID")[()], np.int64)
        starts = np.flatnonzero(np.diff(of_row, prepend=np.nan))
        stops = np.append(starts, len(of_row))[1:]
        domains = of_row[starts]
        if len(np.unique(domains)) < len(domains):
            raise Place(path).error("the rows of one eigenvector do not stand together")
    rows = zip(domains.tolist(), starts.tolist(), stops.tolist(), strict=True)
    return {domain: slice(a, b) for domain, a, b in rows if b > a}


def _table(file: Any, group: _Group, path: Path) -> ModeTable:
    """Read the values, one mode after another; all must list the same points."""
    head = group.head
    vectors = file[group.name]
    values = room(len(head.points), len(group.rows), group.name == _COMPLEX)
    for k, rows in enumerate(group.rows):
        block = vectors[rows]
        if len(block) != len(head.points) or not np.array_equal(block["ID"], head.points):
            raise Place(path).error("the eigenvectors of one subcase list different grids")
        column = values[:, k].reshape(-1, 6)
        for c, component in enumerate(_COMPONENTS):
            if group.name == _COMPLEX:
                column[:, c].real = block[f"{component}R"]
                column[:, c].imag = block[f"{component}I"]
            else:
                column[:, c] = block[component]
    return ModeTable(**vars(head), values=values)


def _summaries(file: Any) -> list[Floats]:
    """Return mode number, eigenvalue and generalized mass, (n, 3), of all domains and of each."""
    if _SUMMARY not in file:
        return []
    told = file[_SUMMARY][()]
    every = np.column_stack([told[name] for name in ("MODE", "EIGEN", "MASS")])
    domains = told["DOMAIN_ID"]
    return [every, *(every[domains == domain] for domain in np.unique(domains))]
