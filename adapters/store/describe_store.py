"""What is in a store, without reading its arrays."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .read_store import DAMAGE, opened
from .store_content import FORMAT, VERSION

if TYPE_CHECKING:
    import h5py


def is_store(path: str | os.PathLike[str]) -> bool:
    """Whether a file is a store of trueup (any version); other HDF5 files are not."""
    import h5py

    source = Path(path)
    if not source.is_file() or not h5py.is_hdf5(source):
        return False
    try:
        with h5py.File(source, "r") as file:
            return bool(file.attrs.get("format") == FORMAT)
    except DAMAGE:  # what HDF5 says of a damaged header
        return False


def describe_store(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return ``{format, contents, skipped}`` of a store, as ``trueup inspect`` shows it.

    Raises
    ------
    InputError
        As `read_store`.
    """
    contents: list[dict[str, Any]] = []
    with opened(path) as file:
        for key in ("geometry", "test_geometry"):
            if key in file:
                contents.append(_geometry(key, file[key]))

        def visit(name: str, item: h5py.Group) -> None:
            top = name.split("/")[0]
            if "kind" in item.attrs and top in _SAID and name.count("/") >= 1:
                inner = name.split("/", 1)[1]
                if item.parent.attrs.get("kind") is None:
                    contents.append({"what": item.attrs["kind"], "name": inner, **_SAID[top](item)})

        file.visititems(visit)
        for key in ("pairs", "history"):
            if key in file:
                contents.append({"what": key, "rows": int(file[key].attrs["rows"])})
    return {"format": f"trueup store, version {VERSION}", "contents": contents, "skipped": []}


def _geometry(key: str, group: h5py.Group) -> dict[str, Any]:
    shapes = group["elements"].items() if "elements" in group else ()
    return {
        "what": key.replace("_", " "),
        "nodes": int(group["ids"].shape[0]),
        "elements": {shape: int(d.shape[0]) for shape, d in shapes},
        "length_unit": group.attrs.get("length_unit"),
    }


def _modes(group: h5py.Group) -> dict[str, Any]:
    hz = group["frequencies_hz"][()]
    return {
        "modes": len(hz),
        "dofs": int(group["shapes"].shape[0]),
        "complex": group["shapes"].dtype.kind == "c",
        "from_hz": float(hz.min()) if len(hz) else None,
        "to_hz": float(hz.max()) if len(hz) else None,
        "source": group.attrs["source"],
    }


def _frfs(group: h5py.Group) -> dict[str, Any]:
    responses, references, lines = (int(n) for n in group["values"].shape)
    return {
        "responses": responses,
        "references": references,
        "lines": lines,
        "quantity": group.attrs["quantity"],
    }


def _matrix(group: h5py.Group) -> dict[str, Any]:
    sparse = group.attrs["storage"] == "csr"
    shape = group.attrs["shape"] if sparse else group["data"].shape
    nonzeros = {"nonzeros": int(group["data"].shape[0])} if sparse else {}
    return {"shape": [int(n) for n in shape], "storage": group.attrs["storage"], **nonzeros}


def _function(group: h5py.Group) -> dict[str, Any]:
    return {
        "function": str(group.attrs["function"]),
        "points": int(group["values"].shape[0]),
        "complex": group["values"].dtype.kind == "c",
    }


_SAID = {
    "modes": _modes,
    "frfs": _frfs,
    "dofs": lambda g: {"dofs": int(g["node"].shape[0])},
    "mac": lambda g: {"shape": [int(n) for n in g["values"].shape]},
    "matrices": _matrix,
    "functions": _function,
}
