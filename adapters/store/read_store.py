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
            geometry=_geometry(file["geometry"]) if "geometry" in file else None,
            test_geometry=_geometry(file["test_geometry"]) if "test_geometry" in file else None,
            modes=_named(file, "modes", _modes),
            frfs=_named(file, "frfs", _frfs),
            dofs=_named(file, "dofs", _dofs),
            mac=_named(file, "mac", _mac),
            matrices=_named(file, "matrices", _matrix),
            matrix_names={k: n for k, n in _named(file, "matrices", _own_name).items() if n},
            functions=_named(file, "functions", _function),
            pairs=read_table(file["pairs"]) if "pairs" in file else (),
            history=read_table(file["history"]) if "history" in file else (),
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
    try:
        file = h5py.File(source, "r")
    except OSError as error:
        raise _damaged(source, error) from error
    with file:
        try:
            form, version = file.attrs.get("format"), file.attrs.get("version")
        except DAMAGE as error:
            raise _damaged(source, error) from error
        if form != FORMAT:
            raise Place(source).fault("is an HDF5 file but no store of trueup")
        if version != VERSION:
            raise Place(source).fault(
                f"is a store of version {version}; this trueup reads version {VERSION}"
            )
        try:
            yield file
        except DAMAGE as error:
            raise _damaged(source, error) from error


DAMAGE = (
    InputError, OSError, LookupError, RuntimeError, ValueError, TypeError, AttributeError,
    MemoryError,
)  # fmt: skip
"""What h5py raises for damaged files."""


def _damaged(source: Path, error: Exception) -> InputError:
    reason = " ".join(str(error).strip(chr(39)).split())[:200] or type(error).__name__
    return Place(source).fault(f"is a damaged store: {reason}")


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
        {shape: d[()] for shape, d in group[key].items()} if key in group else {}
        for key in ("elements", "element_ids")
    )
    return Geometry(
        group["ids"][()], group["xyz"][()], group.attrs.get("length_unit"), elements, ids
    )


def _dofs(group: h5py.Group) -> Dofs:
    return Dofs(group["node"][()], group["component"][()], group["axis"][()])


def _modes(group: h5py.Group) -> Modes:
    return Modes(
        group["frequencies_hz"][()],
        group["shapes"][()],
        _dofs(group["dofs"]),
        group["damping"][()],
        group["generalized_mass"][()],
        group.attrs["source"],
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
    said = {key: group.attrs[key] for key in FUNCTION_TEXTS}
    return {
        "abscissa": group["abscissa"][()],
        "values": group["values"][()],
        "response": tuple(int(n) for n in group.attrs["response"]),
        **{k: tuple(int(n) for n in group.attrs[k]) for k in ("codes",) if k in group.attrs},
        "reference": tuple(int(n) for n in group.attrs["reference"]),
        "ids": tuple(str(t) for t in group.attrs["ids"]),
        **said,
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
