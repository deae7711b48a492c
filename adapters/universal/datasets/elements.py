"""Dataset 2412: elements."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....core.data.geometry import Geometry
from ..container import Section
from ..open_file import Source
from ..text.number_fields import integers
from ..text.printing import dataset
from ..universal_content import Skipped, UniversalContent
from .dataset_kind import DatasetKind, Gathered, Outgoing
from .section_lines import Lines

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
_COLOR = 7


@dataclass(frozen=True)
class Element:
    """An element by its shape and corner nodes."""

    shape: str
    number: int
    nodes: tuple[int, ...]


def _read(source: Source, section: Section, into: Gathered) -> int:
    """Read dataset 2412; elements of no shape that can be drawn are listed as skipped."""
    lines = Lines.filled(source, section)
    found, other = list[Element](), Counter[tuple[int, int]]()
    while lines.more():
        row, head = lines.head(6, starts := "an element starts with six integers")
        number, descriptor, n = head[0], head[1], head[5]
        if n < 1:
            raise lines.error(row, starts)
        ahead = integers(lines.lines[lines.at]) if lines.more() else []
        if descriptor in _BEAMS and len(ahead) == 3 and (n != 3 or lines.at + 1 < len(lines.lines)):
            lines.at += 1  # orientation and end references of a beam
        nodes = lines.gathered(n, integers)
        if len(nodes) != n:
            raise lines.error(row, f"element {number} announces {n} nodes, {len(nodes)} are there")
        element = _element(number, descriptor, nodes)
        if element is None:
            other[descriptor, n] += 1
        else:
            found.append(element)
    for (descriptor, n), count in other.items():
        what = f"dataset 2412: {count} element(s) of descriptor {descriptor} with {n} nodes"
        into.skipped.append(Skipped(what, section.line, "no shape to draw them by", source.name))
    into.add(*found)
    return len(found)


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


def _tell(content: UniversalContent) -> dict[str, Any]:
    elements = content.geometry.elements if content.geometry is not None else {}
    return {"elements": {k: len(v) for k, v in elements.items()}} if elements else {}


def are_elements(geometry: Geometry) -> bool:
    """Whether the lines are bars of a mesh (each its own number) rather than trace lines."""
    numbers = geometry.element_ids.get("line")
    others = any(shape not in ("line", "point") for shape in geometry.elements)
    return others and numbers is not None and len(np.unique(numbers)) == len(numbers)


def _write(out: Outgoing) -> Iterator[bytes]:
    if out.geometry is None:
        return
    drawn = out.geometry.elements
    bars = are_elements(out.geometry)
    printed = [_printed(out.geometry, shape) for shape in drawn if shape != "line" or bars]
    if any(printed):
        yield dataset(2412, *printed)


def _printed(geometry: Geometry, shape: str) -> bytes:
    corners = geometry.elements[shape]
    descriptor, order = _DESCRIPTORS[shape]
    numbers = geometry.element_ids.get(shape, np.arange(1, len(corners) + 1))
    n = len(order)
    beam = f"{0:10d}{1:10d}{1:10d}\n" if shape == "line" else ""
    line = f"%10d{descriptor:10d}{1:10d}{1:10d}{_COLOR:10d}{n:10d}\n{beam}" + "%10d" * n + "\n"
    table = np.column_stack([numbers, geometry.ids[corners[:, list(order)]]])
    return (line * len(corners) % tuple(table.ravel().tolist())).encode("ascii")


ELEMENTS = DatasetKind(2412, "elements", _read, _tell, _write)
