"""Print nodes (2411, 15), coordinate systems (2420), elements (2412) and trace lines (82)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise

import numpy as np

from ...core.arrays import Floats, Ints
from ...core.geometry import Geometry
from .printing import dataset, text_line

# Descriptor and corner order by shape; a pyramid is a brick whose upper face is one node.
_DESCRIPTORS = {
    "point": (161, (0,)),
    "line": (11, (0, 1)),
    "tria": (91, (0, 1, 2)),
    "quad": (94, (0, 1, 2, 3)),
    "tetra": (111, (0, 1, 2, 3)),
    "pyramid": (115, (0, 1, 2, 3, 4, 4, 4, 4)),
    "penta": (112, (0, 1, 2, 3, 4, 5)),
    "hexa": (115, (0, 1, 2, 3, 4, 5, 6, 7)),
}
_COLOR = 11
_PER_TRACE_LINE = 8


def geometry_datasets(
    geometry: Geometry, node_dataset: int, systems: Mapping[int, Floats]
) -> Iterator[bytes]:
    """Print a geometry; `systems` are displacement axes of nodes that have their own."""
    numbers: dict[bytes, int] = {}
    for axes in systems.values():
        numbers.setdefault(np.round(axes, 12).tobytes(), len(numbers) + 2)
    if systems:
        yield _systems(systems, numbers)
    label = {n: numbers[np.round(a, 12).tobytes()] for n, a in systems.items()}
    displacement = np.array([label.get(int(n), 0) for n in geometry.ids], np.int64)
    yield _nodes(geometry, displacement, node_dataset)
    lines_as_elements = _are_elements(geometry)
    printed = [
        _elements(geometry, shape)
        for shape in geometry.elements
        if shape != "line" or lines_as_elements
    ]
    if any(printed):
        yield dataset(2412, *printed)
    if not lines_as_elements:
        yield from _traces(geometry)


def _systems(systems: Mapping[int, Floats], numbers: Mapping[bytes, int]) -> bytes:
    found = {numbers[np.round(axes, 12).tobytes()]: axes for axes in systems.values()}
    lines = [b"%10d\n" % 1, text_line("trueup")]
    for number, axes in sorted(found.items()):
        lines += [b"%10d%10d%10d\n" % (number, 0, 8), text_line(f"CS{number}")]
        lines += [b"%25.16E%25.16E%25.16E\n" % tuple(row) for row in [*axes, np.zeros(3)]]
    return dataset(2420, *lines)


def _nodes(geometry: Geometry, displacement: Ints, node_dataset: int) -> bytes:
    line = "%10d%10d%10d%10d"
    line += "%13.5E%13.5E%13.5E\n" if node_dataset == 15 else "\n%25.16E%25.16E%25.16E\n"
    values: list[float] = []
    for node, system, xyz in zip(
        geometry.ids.tolist(), displacement.tolist(), geometry.xyz.tolist(), strict=True
    ):
        values += [node, 0, system, _COLOR, *xyz]
    return dataset(node_dataset, (line * len(geometry.ids) % tuple(values)).encode("ascii"))


def _are_elements(geometry: Geometry) -> bool:
    """Whether the lines are bars of a mesh (each its own number) rather than trace lines."""
    numbers = geometry.element_ids.get("line")
    others = any(shape not in ("line", "point") for shape in geometry.elements)
    return others and numbers is not None and len(np.unique(numbers)) == len(numbers)


def _elements(geometry: Geometry, shape: str) -> bytes:
    corners = geometry.elements[shape]
    descriptor, order = _DESCRIPTORS[shape]
    numbers = geometry.element_ids.get(shape, np.arange(1, len(corners) + 1))
    n = len(order)
    beam = f"{0:10d}{1:10d}{1:10d}\n" if shape == "line" else ""
    line = f"%10d{descriptor:10d}{1:10d}{1:10d}{7:10d}{n:10d}\n{beam}" + "%10d" * n + "\n"
    table = np.column_stack([numbers, geometry.ids[corners[:, list(order)]]])
    return (line * len(corners) % tuple(table.ravel().tolist())).encode("ascii")


def _traces(geometry: Geometry) -> Iterator[bytes]:
    """Print lines as trace lines: runs of one number, the pen lifted where they do not join."""
    if not len(geometry.elements.get("line", ())):
        return
    ends = geometry.ids[geometry.elements["line"]]
    numbers = geometry.element_ids.get("line", np.ones(len(ends), np.int64))
    cuts = np.flatnonzero(np.diff(numbers)) + 1
    for start, stop in pairwise([0, *cuts.tolist(), len(ends)]):
        path: list[int] = []
        for a, b in ends[start:stop].tolist():
            if not path:
                path += [a, b]
            elif path[-1] == a:
                path.append(b)
            else:
                path += [0, a, b]
        rows = [path[k : k + _PER_TRACE_LINE] for k in range(0, len(path), _PER_TRACE_LINE)]
        yield dataset(
            82,
            b"%10d%10d%10d\n" % (int(numbers[start]), len(path), _COLOR),
            text_line("NONE"),
            *(b"".join(b"%10d" % node for node in row) + b"\n" for row in rows),
        )
