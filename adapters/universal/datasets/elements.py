"""What is drawn between nodes: elements (dataset 2412) and trace lines (82)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Ints
from ...core.geometry import Geometry
from .container import Section
from .content import Skipped, Trace
from .fields import integers
from .frames import NodeFrames, some
from .source import Source

_BEAMS = (11, 21, 22, 23, 24, 31, 32)
_LINES = (*_BEAMS, 121, 136, 137, 141, 151, 171)
_POINTS = (138, 139, 142, 152, 161)
# Corners of parabolic and cubic elements, which list their edges corner, middle, corner, ...
_SHELLS = {
    3: ("tria", (0, 1, 2)),
    4: ("quad", (0, 1, 2, 3)),
    6: ("tria", (0, 2, 4)),
    8: ("quad", (0, 2, 4, 6)),
    9: ("tria", (0, 3, 6)),
    12: ("quad", (0, 3, 6, 9)),
}
_SOLIDS = {
    4: ("tetra", (0, 1, 2, 3)),
    6: ("penta", (0, 1, 2, 3, 4, 5)),
    8: ("hexa", (0, 1, 2, 3, 4, 5, 6, 7)),
    10: ("tetra", (0, 2, 4, 9)),
    15: ("penta", (0, 2, 4, 9, 11, 13)),
    20: ("hexa", (0, 2, 4, 6, 12, 14, 16, 18)),
}


@dataclass(frozen=True)
class Element:
    """An element by its shape and corner nodes."""

    shape: str
    number: int
    nodes: tuple[int, ...]


def read_2412(source: Source, section: Section, skipped: list[Skipped]) -> list[Element]:
    """Read dataset 2412; elements of no shape that can be drawn are listed in `skipped`."""
    lines = source.lines(section)
    while lines and not lines[-1].strip(b" \t\x00"):
        lines.pop()
    found, other, at = [], dict[tuple[int, int], int](), 0
    while at < len(lines):
        head = integers(lines[at])
        line, at = section.line + 1 + at, at + 1
        if len(head) < 6 or head[5] < 1:
            raise source.error(line, "dataset 2412: an element starts with six integers")
        n = head[5]
        ahead = integers(lines[at]) if at < len(lines) else []
        if head[1] in _BEAMS and len(ahead) == 3 and (n != 3 or at + 1 < len(lines)):
            at += 1  # orientation and end references of a beam
        nodes: list[int] = []
        while len(nodes) < n and at < len(lines):
            nodes += integers(lines[at])
            at += 1
        if len(nodes) != n:
            raise source.error(
                line, f"dataset 2412: element {head[0]} announces {n} nodes, {len(nodes)} are there"
            )
        element = _element(head[0], head[1], nodes)
        if element is None:
            other[head[1], n] = other.get((head[1], n), 0) + 1
        else:
            found.append(element)
    for (descriptor, n), count in other.items():
        what = f"dataset 2412: {count} element(s) of descriptor {descriptor} with {n} nodes"
        skipped.append(Skipped(what, section.line, "no shape to draw them by", source.name))
    return found


def _element(number: int, descriptor: int, nodes: Sequence[int]) -> Element | None:
    n = len(nodes)
    if descriptor in _POINTS or n == 1:
        return Element("point", number, (nodes[0],))
    if descriptor in _LINES and n in (2, 3):
        return Element("line", number, (nodes[0], nodes[-1]))
    table = _SHELLS if 41 <= descriptor <= 96 else _SOLIDS if 101 <= descriptor <= 118 else {}
    if n not in table:
        return None
    shape, corners = table[n]
    chosen = tuple(nodes[k] for k in corners)
    if shape == "hexa" and len(set(chosen[4:])) == 1:
        return Element("pyramid", number, chosen[:5])
    return Element(shape, number, chosen)


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
