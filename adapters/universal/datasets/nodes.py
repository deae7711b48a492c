"""Datasets 15 and 2411: nodes."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....core.arrays import Floats, Ints
from ..container import Section
from ..open_file import Source
from ..text.printing import dataset
from ..universal_content import UniversalContent
from .coordinate_systems import key, numbered
from .dataset_kind import DatasetKind, Gathered, Outgoing
from .section_lines import Lines

_15 = (10, 10, 10, 10, 13, 13, 13)
_2411 = ((10, 10, 10, 10), (25, 25, 25))
_COLOR = 11


@dataclass(frozen=True, eq=False)
class NodeTable:
    """Nodes as a dataset lists them: numbers, systems by number, coordinates as written."""

    ids: Ints
    definition: Ints
    displacement: Ints
    coordinates: Floats
    path: str
    line: int


def _read_15(source: Source, section: Section, into: Gathered) -> int:
    """Read dataset 15: coordinates stand in each node's definition system."""
    values = Lines.filled(source, section).table(_15)
    ids, definition, displacement = values[:, :3].astype(np.int64).T
    into.add(NodeTable(ids, definition, displacement, values[:, 4:7], source.name, section.line))
    return len(ids)


def _read_2411(source: Source, section: Section, into: Gathered) -> int:
    """Read dataset 2411: coordinates stand in the part's own frame, whatever the systems."""
    lines = Lines.filled(source, section)
    if len(lines.lines) % 2:
        last = len(lines.lines) - 1
        raise lines.error(last, "it ends in the middle of a node; export it again")
    labels = lines.table(_2411[0], 2).astype(np.int64)
    xyz = lines.table(_2411[1], 2, 1)
    zero = np.zeros(len(labels), np.int64)
    into.add(NodeTable(labels[:, 0], zero, labels[:, 2], xyz, source.name, section.line))
    return len(labels)


def _tell(content: UniversalContent) -> dict[str, Any]:
    if content.geometry is None:
        return {}
    return {"nodes": len(content.geometry.ids), "size": content.geometry.size}


def _writing(number: int, line: str) -> Callable[[Outgoing], Iterator[bytes]]:
    def write(out: Outgoing) -> Iterator[bytes]:
        if out.geometry is None or out.node_dataset != number:
            return
        numbers = numbered(out.systems)
        system = {node: numbers[key(axes)] for node, axes in out.systems.items()}
        values: list[float] = []
        for node, xyz in zip(out.geometry.ids.tolist(), out.geometry.xyz.tolist(), strict=True):
            values += [node, 0, system.get(node, 0), _COLOR, *xyz]
        yield dataset(number, (line * len(out.geometry.ids) % tuple(values)).encode("ascii"))

    return write


NODES_15 = DatasetKind(
    15, "nodes", _read_15,
    write=_writing(15, "%10d%10d%10d%10d%13.5E%13.5E%13.5E\n"), vital=True,
)  # fmt: skip
NODES_2411 = DatasetKind(
    2411, "nodes", _read_2411, _tell,
    _writing(2411, "%10d%10d%10d%10d\n%25.16E%25.16E%25.16E\n"), vital=True,
)  # fmt: skip
