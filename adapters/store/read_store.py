"""HDF5 to neutral nouns."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp

from ...core.data.dofs import Dofs
from ...core.data.frfs import Frfs
from ...core.data.geometry import Geometry
from ...core.data.modes import Modes
from ...core.errors import InputError, Place
from .result_columns import read_table
from .store_content import FORMAT, FUNCTION_TEXTS, VERSION, Matrix, Record, StoreContent

if TYPE_CHECKING:
    import h5py


def read_store(path: str | os.PathLike[str]) -> StoreContent:
    """Read everything a store holds.

    Raises
    ------
    InputError
        A file that is missing, is not HDF5, is not of trueup, is of a later version, or is
        damaged.
    """
    with opened(path) as file:
        return StoreContent(
            **{key: read(file[key]) for key, read in _WHOLE.items() if key in file},
            modes=_named(file, "modes", _modes),
            frfs=_named(file, "frfs", _frfs),
            dofs=_named(file, "dofs", _dofs),
            mac=_named(file, "mac", _mac),
            matrices=_named(file, "matrices", _matrix),
            matrix_names={k: n for k, n in _named(file, "matrices", _own_name).items() if n},
            functions=_named(file, "functions", _function),
        )


@contextmanager
def opened(path: str | os.PathLike[str]) -> Iterator[h5py.File]:
    """Open a store, every failure of HDF5 or of the layout told as one sentence."""
    import h5py

    source = Path(path)
    if not source.is_file():
        raise Place(source).fault("does not exist or is not a file")
    if not h5py.is_hdf5(source):
        raise Place(source).fault("is not an HDF5 file or is truncated at its head")
    foreign = None
    try:
        with h5py.File(source, "r") as file:
            form, version = file.attrs.get("format"), file.attrs.get("version")
            if form != FORMAT:
                foreign = "is an HDF5 file but no store of trueup"
            elif version != VERSION:
                foreign = f"is a store of version {version}; this trueup reads version {VERSION}"
            if foreign is None:
                yield file
                return
    except DAMAGE as error:
        reason = " ".join(str(error).strip(chr(39)).split())[:200] or type(error).__name__
        raise Place(source).fault(f"is a damaged store: {reason}") from error
    raise Place(source).fault(foreign)


DAMAGE = (
    InputError, OSError, LookupError, RuntimeError, ValueError, TypeError, AttributeError,
    MemoryError,
)  # fmt: skip
"""What h5py raises for damaged files."""


def _named(file: h5py.File, key: str, read: Callable[[h5py.Group], Any]) -> dict[str, Any]:
    if key not in file:
        return {}
    found: dict[str, Any] = {}

    def visit(group: h5py.Group, prefix: str) -> None:
        for name, child in group.items():
            if "kind" in child.attrs:
                found[prefix + name] = read(child)
            else:
                visit(child, f"{prefix}{name}/")

    visit(file[key], "")
    return found


def _geometry(group: h5py.Group) -> Geometry:
    elements, ids = (
        {shape: d[()] for shape, d in group.get(key, {}).items()}
        for key in ("elements", "element_ids")
    )
    unit = group.attrs.get("length_unit")
    return Geometry(group["ids"][()], group["xyz"][()], unit, elements, ids)


def _dofs(group: h5py.Group) -> Dofs:
    return Dofs(group["node"][()], group["component"][()], group["axis"][()])


def _modes(group: h5py.Group) -> Modes:
    hz = group["frequencies_hz"][()]
    return Modes(
        hz,
        group["shapes"][()],
        _dofs(group["dofs"]),
        group["damping"][()],
        group["generalized_mass"][()],
        group.attrs["source"],
        group["doubted"][()] if "doubted" in group else np.zeros(len(hz), bool),
    )


def _frfs(group: h5py.Group) -> Frfs:
    return Frfs(
        group["frequencies_hz"][()],
        _dofs(group["responses"]),
        _dofs(group["references"]),
        group["values"][()],
        group.attrs["quantity"],
        group.attrs["source"],
    )


def _function(group: h5py.Group) -> Record:
    numbers = ("response", "reference", *({"codes"} & set(group.attrs)))
    return {
        **{key: group[key][()] for key in ("abscissa", "values")},
        **{key: tuple(map(int, group.attrs[key])) for key in numbers},
        **{key: group.attrs[key] for key in FUNCTION_TEXTS},
        "ids": tuple(map(str, group.attrs["ids"])),
    }


def _mac(group: h5py.Group) -> dict[str, Any]:
    return {key: group[key][()] for key in ("test", "analysis", "values")}


def _own_name(group: h5py.Group) -> str:
    return str(group.attrs.get("name", ""))


def _matrix(group: h5py.Group) -> Matrix:
    data = group["data"][()]
    if group.attrs["storage"] == "dense":
        return np.asarray(data)
    shape = tuple(int(n) for n in group.attrs["shape"])
    return sp.csr_matrix((data, group["indices"][()], group["indptr"][()]), shape=shape)


_WHOLE: dict[str, Callable[[h5py.Group], Any]] = {
    "geometry": _geometry, "test_geometry": _geometry, "pairs": read_table, "history": read_table,
}  # fmt: skip
"""What stands in a store once, under a name of its own."""
