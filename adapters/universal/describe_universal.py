"""What a universal file holds, in one screen."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .content import Dataset, UniversalContent
from .reading import read_universal


def describe_universal(path: Path) -> dict[str, Any]:
    """Say what a universal file holds.

    Returns
    -------
    dict
        ``format``, ``contents`` (tables by what they are), ``datasets`` (number, name, how many,
        first line), ``skipped`` (what, line, why) and ``warnings``.

    Raises
    ------
    InputError
        A file that cannot be read.
    """
    content = read_universal(path)
    return {
        "format": "universal file",
        "contents": _contents(content),
        "datasets": _datasets(content.datasets),
        "skipped": [{"what": s.what, "line": s.line, "why": s.why} for s in content.skipped],
        "warnings": list(content.warnings),
    }


def _contents(content: UniversalContent) -> dict[str, Any]:
    found: dict[str, Any] = {}
    if content.headers:
        h = content.headers[0]
        said = {"name": h.name, "description": h.description, "program": h.program}
        found["header"] = {k: v for k, v in said.items() if v and v != "NONE"}
    found["length_unit"] = content.length_unit
    if content.geometry is not None:
        shapes = {k: len(v) for k, v in content.geometry.elements.items()}
        found["nodes"] = len(content.geometry.ids)
        found["size"] = content.geometry.size
        if shapes:
            found["elements"] = shapes
    if content.systems:
        found["coordinate_systems"] = dict(Counter(s.kind for s in content.systems.values()))
    if content.modes is not None:
        m = content.modes
        found["modes"] = {
            "number": len(m),
            "kind": "complex" if m.is_complex else "real",
            "nodes": len(set(m.dofs.node.tolist())),
            "values_per_node": int(m.dofs.component.max()),
            "frequencies_hz": m.frequencies_hz.tolist(),
        }
    if content.frfs is not None:
        f = content.frfs
        found["frequency_responses"] = {
            "responses": len(f.responses),
            "references": len(f.references),
            "lines": len(f.frequencies_hz),
            "from_hz": float(f.frequencies_hz[0]),
            "to_hz": float(f.frequencies_hz[-1]),
            "quantity": f.quantity,
            "reference_dofs": f.references.labels,
        }
    if content.functions:
        found["other_functions"] = dict(Counter(f.kind for f in content.functions))
    return found


def _datasets(datasets: Sequence[Dataset]) -> list[dict[str, Any]]:
    """One entry for each kind of dataset: how many there are and where the first stands."""
    found: dict[int, dict[str, Any]] = {}
    for d in datasets:
        entry = found.setdefault(
            d.number, {"number": d.number, "what": d.what, "datasets": 0, "line": d.line}
        )
        entry["datasets"] += 1
    return [found[k] for k in sorted(found)]
