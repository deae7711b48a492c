"""Rows of a result as columns of HDF5, and back.

A column of whole numbers, numbers (missing ones NaN), equally long lists of numbers or texts is
stored as what it is; any other column as JSON texts. The attribute ``type`` says which.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .store_content import Record

if TYPE_CHECKING:
    import h5py

_UNITS = {
    "test_hz": "Hz",
    "analysis_hz": "Hz",
    "deviation_percent": "%",
    "deviations_percent": "%",
    "rotation_deg": "degree",
    "mac": "1",
    "factors": "1",
}
_EXACT = 2**53
_ABSENT = "\0absent"


def write_table(group: h5py.Group, rows: Sequence[Record]) -> None:
    """Write rows; columns in the order in which keys appear."""
    names = list(dict.fromkeys(key for row in rows for key in row))
    group.attrs["columns"] = json.dumps(names)
    group.attrs["rows"] = len(rows)
    for k, name in enumerate(names):
        kind, values = _column([row.get(name, _ABSENT) for row in rows])
        dataset = group.create_dataset(f"c{k}", data=values, dtype=_dtype(kind))
        dataset.attrs["name"], dataset.attrs["type"] = name, kind
        dataset.attrs["units"] = _UNITS.get(name, "")


def read_table(group: h5py.Group) -> tuple[dict[str, Any], ...]:
    """Read rows; a missing number is None."""
    rows: list[dict[str, Any]] = [{} for _ in range(int(group.attrs["rows"]))]
    for k, name in enumerate(json.loads(group.attrs["columns"])):
        dataset = group[f"c{k}"]
        kind = dataset.attrs["type"]
        values = dataset.asstr()[()] if kind in ("text", "json") else dataset[()]
        for row, value in zip(rows, values.tolist(), strict=True):
            read = _value(kind, value)
            if not isinstance(read, str) or read != _ABSENT:
                row[name] = read
    return tuple(rows)


def _column(values: list[Any]) -> tuple[str, Any]:
    plain = [_plain(v) for v in values]
    if all(isinstance(v, str) and "\0" not in v for v in plain):
        return "text", np.array(plain, dtype=object)
    if all(_whole(v) or v is None for v in plain) and any(v is not None for v in plain):
        return "whole", np.array([math.nan if v is None else float(v) for v in plain])
    if all(isinstance(v, float) or v is None for v in plain) and any(v is not None for v in plain):
        return "number", np.array([math.nan if v is None else v for v in plain])
    lists = all(isinstance(v, list) and v for v in plain) and len({len(v) for v in plain}) == 1
    if lists and all(isinstance(x, float) for v in plain for x in v):
        return "numbers", np.array(plain)
    return "json", np.array([json.dumps(v) for v in plain], dtype=object)


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    return None if isinstance(value, float) and math.isnan(value) else value


def _whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and abs(value) < _EXACT


def _dtype(kind: str) -> Any:
    import h5py

    return h5py.string_dtype() if kind in ("text", "json") else np.float64


def _value(kind: str, value: Any) -> Any:
    if kind == "json":
        return json.loads(value)
    if kind in ("text", "numbers"):
        return value
    if math.isnan(value):
        return None
    return int(value) if kind == "whole" else value
