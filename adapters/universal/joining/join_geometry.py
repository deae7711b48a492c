"""Nodes of all files with what is drawn between them as one geometry."""

from collections.abc import Sequence

import numpy as np

from ....core.arrays import Ints
from ....core.data.geometry import Geometry
from ..datasets.elements import Element
from ..universal_content import Trace
from .node_frames import NodeFrames, some


def drawn_geometry(
    nodes: NodeFrames,
    elements: Sequence[Element],
    traces: Sequence[Trace],
    length_unit: str | None,
    warnings: list[str],
) -> Geometry | None:
    """Nodes with elements and trace lines between them; None where no node is given."""
    if not len(nodes.ids):
        return None
    plain = Geometry(nodes.ids, nodes.xyz, length_unit)
    corners: dict[str, list[Ints]] = {}
    numbers: dict[str, list[Ints]] = {}
    for shape in dict.fromkeys(e.shape for e in elements):
        same = [e for e in elements if e.shape == shape]
        rows = plain.index_of(np.array([e.nodes for e in same]).ravel()).reshape(len(same), -1)
        whole = (rows >= 0).all(axis=1)
        number = np.array([e.number for e in same])
        if not whole.all():
            warnings.append(
                f"{shape} element(s) {some(number[~whole])} use nodes that do not exist and are "
                "left out"
            )
        corners[shape], numbers[shape] = [rows[whole]], [number[whole]]
    for trace in traces:
        segments = _segments(trace, plain, warnings)
        corners.setdefault("line", []).append(segments)
        numbers.setdefault("line", []).append(np.full(len(segments), trace.number))
    tables = {shape: np.concatenate(part) for shape, part in corners.items()}
    labels = {shape: np.concatenate(part) for shape, part in numbers.items()}
    kept = [shape for shape, table in tables.items() if len(table)]
    return Geometry(
        nodes.ids,
        nodes.xyz,
        length_unit,
        {shape: tables[shape] for shape in kept},
        {shape: labels[shape] for shape in kept},
    )


def _segments(trace: Trace, geometry: Geometry, warnings: list[str]) -> Ints:
    """Rows of the two ends of each drawn segment, (n, 2)."""
    rows = np.where(trace.nodes == 0, -2, geometry.index_of(trace.nodes))
    missing = trace.nodes[rows == -1]
    if len(missing):
        warnings.append(
            f"trace line {trace.number} passes node(s) {some(missing)}, which do not exist; "
            "those segments are left out"
        )
    ends = np.column_stack([rows[:-1], rows[1:]])
    return np.asarray(ends[(ends >= 0).all(axis=1) & (ends[:, 0] != ends[:, 1])])
