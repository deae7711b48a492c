"""Neutral nouns to HDF5, atomically."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from ...core.data.dofs import Dofs
from ...core.data.frfs import Frfs
from ...core.data.geometry import Geometry
from ...core.data.modes import Modes
from ...core.errors import InputError, Place
from ...core.files import replacing
from .result_columns import write_table
from .store_content import FORMAT, FUNCTION_TEXTS, VERSION, Matrix, Record

if TYPE_CHECKING:
    import h5py

_COMPRESS_FROM = 4096  # bytes; smaller datasets grow by it
_FRF_UNITS = {
    "displacement": "test length unit per newton",
    "velocity": "test length unit per second per newton",
    "acceleration": "test length unit per second squared per newton",
}


def write_store(
    path: str | os.PathLike[str],
    *,
    geometry: Geometry | None = None,
    test_geometry: Geometry | None = None,
    modes: Mapping[str, Modes] | None = None,
    frfs: Mapping[str, Frfs] | None = None,
    dofs: Mapping[str, Dofs] | None = None,
    pairs: Sequence[Record] = (),
    mac: Mapping[str, Mapping[str, Any]] | None = None,
    matrices: Mapping[str, Any] | None = None,
    matrix_names: Mapping[str, str] | None = None,
    functions: Mapping[str, Record] | None = None,
    history: Sequence[Record] = (),
) -> None:
    """Write a store; it takes its name only when it is whole.

    Parameters
    ----------
    path : path
        Replaced if it exists.
    geometry, test_geometry : Geometry, optional
    modes, frfs, dofs : mapping of str to noun, optional
        Names may be nested by slashes, ``test/raw``.
    pairs, history : sequence of mapping
        Rows as in result.json.
    mac : mapping of str to {"test", "analysis", "values"}, optional
    matrices : mapping of str to array or scipy sparse matrix, optional
        Sparse ones are kept sparse.
    matrix_names : mapping of str to str, optional
        What matrices are called at their source, where by another name.
    functions : mapping of str to mapping, optional
        As in `StoreContent`.

    Raises
    ------
    InputError
        A name that is empty, or lies under the name of something else; a file that cannot be
        written.
    """
    import h5py

    target = Path(path)
    try:
        with replacing(target) as fresh, h5py.File(fresh, "w", libver=("earliest", "v110")) as file:
            file.attrs["format"], file.attrs["version"] = FORMAT, VERSION
            for key, noun in (("geometry", geometry), ("test_geometry", test_geometry)):
                if noun is not None:
                    _geometry(_group(file, key, "geometry"), noun)
            for key, kind, named, write in (
                ("modes", "modes", modes, _modes),
                ("frfs", "frfs", frfs, _frfs),
                ("dofs", "dofs", dofs, _dofs),
                ("mac", "mac", mac, _mac),
                ("matrices", "matrix", matrices, _matrix),
                ("functions", "function", functions, _function),
            ):
                for label, noun in _checked(named or {}, key).items():
                    write(_group(file, f"{key}/{label}", kind), noun)
            for label, own in (matrix_names or {}).items():
                file[f"matrices/{label}"].attrs["name"] = own
            for key, rows in (("pairs", pairs), ("history", history)):
                if rows:
                    write_table(_group(file, key, "table"), rows)
    except (ValueError, TypeError) as error:  # what HDF5 cannot hold
        raise Place(target).fault(f"cannot be written: {error}") from error


def _checked(named: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    for name in named:
        parts = name.split("/")
        if any(p in ("", ".", "..") or "\0" in p for p in parts):
            raise InputError(f"'{name}' is no name for {key}; use words joined by single slashes")
        above = next((o for o in named if o != name and name.startswith(f"{o}/")), None)
        if above is not None:
            raise InputError(f"the name '{name}' of {key} lies under '{above}'; give it another")
    return named


def _group(file: h5py.File, name: str, kind: str) -> h5py.Group:
    group = file.create_group(name)
    group.attrs["kind"] = kind
    return group


def _put(
    group: h5py.Group, name: str, values: npt.ArrayLike, units: str = "", meaning: str = ""
) -> None:
    array = np.asarray(values)
    packed = (
        {"compression": "gzip", "compression_opts": 4, "shuffle": True}
        if array.nbytes >= _COMPRESS_FROM and array.size
        else {}
    )
    dataset = group.create_dataset(name, data=array, **packed)
    dataset.attrs["units"] = units
    if meaning:
        dataset.attrs["meaning"] = meaning


def _geometry(group: h5py.Group, noun: Geometry) -> None:
    unit = noun.length_unit or "unknown"
    if noun.length_unit is not None:
        group.attrs["length_unit"] = noun.length_unit
    _put(group, "ids", noun.ids, meaning="node numbers")
    _put(group, "xyz", noun.xyz, unit, "positions in the basic frame")
    for shape, corners in noun.elements.items():
        _put(group, f"elements/{shape}", corners, meaning="corner nodes as rows of xyz")
    for shape, ids in noun.element_ids.items():
        _put(group, f"element_ids/{shape}", ids, meaning="element numbers")


def _dofs(group: h5py.Group, noun: Dofs) -> None:
    _put(group, "node", noun.node, meaning="node number")
    _put(group, "component", noun.component, meaning="1-3 translation, 4-6 rotation")
    _put(group, "axis", noun.axis, meaning="unit vector in the basic frame")


def _modes(group: h5py.Group, noun: Modes) -> None:
    group.attrs["source"] = noun.source
    _put(group, "frequencies_hz", noun.frequencies_hz, "Hz")
    _put(group, "shapes", noun.shapes, "length unit of the geometry", "rows: dofs, columns: modes")
    _put(group, "damping", noun.damping, "fraction of critical")
    _put(group, "generalized_mass", noun.generalized_mass, "mass unit of the source")
    _put(group, "doubted", noun.doubted, meaning="whether its identification doubts each")
    _dofs(_group(group, "dofs", "dofs"), noun.dofs)


def _frfs(group: h5py.Group, noun: Frfs) -> None:
    group.attrs["source"], group.attrs["quantity"] = noun.source, noun.quantity
    _put(group, "frequencies_hz", noun.frequencies_hz, "Hz")
    _put(
        group, "values", noun.values, _FRF_UNITS.get(noun.quantity, ""),
        "responses, references, frequency lines",
    )  # fmt: skip
    _dofs(_group(group, "responses", "dofs"), noun.responses)
    _dofs(_group(group, "references", "dofs"), noun.references)


def _function(group: h5py.Group, noun: Record) -> None:
    for key in FUNCTION_TEXTS:
        group.attrs[key] = str(noun.get(key, ""))
    for key in ("response", "reference"):
        group.attrs[key] = np.array(noun[key], np.int64)
    if "codes" in noun:
        group.attrs["codes"] = np.array(noun["codes"], np.int64)
    group.attrs["ids"] = [str(text) for text in noun.get("ids", ())] or [""]
    _put(group, "abscissa", noun["abscissa"], str(noun.get("abscissa_unit", "")))
    _put(group, "values", noun["values"], str(noun.get("ordinate_unit", "")))


def _mac(group: h5py.Group, noun: Mapping[str, Any]) -> None:
    values = np.array(noun["values"], dtype=float)
    for k, side in enumerate(("test", "analysis")):
        modes = noun.get(side)
        numbers = np.arange(1, values.shape[k] + 1) if modes is None else np.asarray(modes)
        _put(group, side, numbers, meaning=f"{side} mode numbers")
    _put(group, "values", values, "1", "rows: test modes, columns: analysis modes")


def _matrix(group: h5py.Group, noun: Matrix) -> None:
    if not sp.issparse(noun):
        group.attrs["storage"] = "dense"
        _put(group, "data", noun, "units of the source")
        return
    matrix = sp.csr_matrix(noun)
    group.attrs["storage"], group.attrs["shape"] = "csr", np.array(matrix.shape, np.int64)
    _put(group, "data", matrix.data, "units of the source")
    _put(group, "indices", matrix.indices, meaning="columns of the data")
    _put(group, "indptr", matrix.indptr, meaning="where each row starts in the data")
