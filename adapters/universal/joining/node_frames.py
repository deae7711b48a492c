"""Nodes of one or several files with positions and displacement axes in the basic frame."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ....core.arrays import Floats, Ints
from ..datasets.nodes import NodeTable
from ..systems import BASIC, CoordinateSystem
from ..universal_content import Skipped

_TURNED = 1e-6  # difference of direction cosines from which axes are not the same


@dataclass(frozen=True, eq=False)
class NodeFrames:
    """Nodes: numbers (n,), basic positions (n, 3), displacement axes (n, 3, 3) as rows."""

    ids: Ints
    xyz: Floats
    frames: Floats

    def at(self, nodes: Ints) -> Floats:
        """Displacement axes (n, 3, 3) of nodes; the basic ones where a node is not known."""
        frames = np.broadcast_to(np.eye(3), (len(nodes), 3, 3)).copy()
        if len(self.ids):
            order = np.argsort(self.ids, kind="stable")
            found = order[np.minimum(np.searchsorted(self.ids[order], nodes), len(order) - 1)]
            known = self.ids[found] == nodes
            frames[known] = self.frames[found[known]]
        return frames


def node_frames(
    tables: Sequence[NodeTable],
    systems: Sequence[Mapping[int, CoordinateSystem]],
    warnings: list[str],
    skipped: list[Skipped],
) -> NodeFrames:
    """Merge node tables; of a node given twice the first is kept, and another place is told.

    `systems` are those that each table may refer to.
    """
    undefined: dict[int, int] = {}
    known = zip(tables, systems, strict=True)
    parts = [_placed(table, those, undefined, warnings) for table, those in known]
    for number, count in undefined.items():
        warnings.append(
            f"coordinate system {number}, used by {count} node(s), is not defined (dataset 18 or "
            "2420); the basic frame is used in its place"
        )
    if not parts:
        return NodeFrames(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 3, 3)))
    ids, xyz, frames = (np.concatenate(p) for p in zip(*parts, strict=True))
    of_row = np.repeat(np.arange(len(tables)), [len(p[0]) for p in parts])
    keep = _first_of_each(ids, xyz, [tables[k] for k in of_row], warnings, skipped)
    kept = NodeFrames(ids[keep], xyz[keep], frames[keep])
    turned = np.abs(frames - kept.at(ids)).max(axis=(1, 2)) > _TURNED
    if turned.any():
        warnings.append(
            f"node(s) {some(np.unique(ids[turned]))} are given again with another displacement "
            "system; the first is kept for all files"
        )
    return kept


def _placed(
    table: NodeTable,
    systems: Mapping[int, CoordinateSystem],
    undefined: dict[int, int],
    warnings: list[str],
) -> tuple[Ints, Floats, Floats]:
    xyz, where = table.coordinates.copy(), f"{table.path} line {table.line}"
    for number in np.unique(table.definition):
        rows = table.definition == number
        system = _system(int(number), systems, undefined, int(rows.sum()))
        if system is not BASIC:
            xyz[rows] = system.positions(xyz[rows])
        if system.kind != "rectangular":
            warnings.append(
                f"{where}: {rows.sum()} node(s) have {system.kind} coordinates; their "
                "angles are taken in degrees"
            )
    frames = np.broadcast_to(np.eye(3), (len(xyz), 3, 3)).copy()
    for number in np.unique(table.displacement):
        rows = table.displacement == number
        system = _system(int(number), systems, undefined, int(rows.sum()))
        frames[rows] = system.directions(xyz[rows])
        on_axis = table.ids[rows][system.on_axis(xyz[rows])]
        if len(on_axis):
            warnings.append(
                f"{where}: node(s) {some(on_axis)} lie on the axis of their {system.kind} "
                "displacement system, where radial and tangential are not defined; x is taken as "
                "radial"
            )
    return table.ids, xyz, frames


def _first_of_each(
    ids: Ints, xyz: Floats, tables: Sequence[NodeTable], warnings: list[str], skipped: list[Skipped]
) -> Ints:
    """Rows of the first mention of each node; `tables` are those of the rows."""
    unique, first, inverse = np.unique(ids, return_index=True, return_inverse=True)
    if len(unique) == len(ids):
        return np.arange(len(ids))
    size = max(float(np.ptp(xyz, axis=0).max()), 1e-30)
    apart = np.abs(xyz - xyz[first[inverse]]).max(axis=1) > 1e-4 * size
    where = " and ".join(dict.fromkeys(f"{t.path} line {t.line}" for t in tables))
    if apart.any():
        table, count = tables[np.flatnonzero(apart)[0]], int(np.count_nonzero(apart))
        what = f"node {ids[apart][0]}" + (f" and {count - 1} more" if count > 1 else "")
        why = (
            f"{what} given twice at different positions, the first is kept; remove one, or give "
            "files of one test only"
        )
        skipped.append(Skipped(what, table.line, why, table.path, "test"))
    same = len(ids) - len(unique) - int(np.count_nonzero(apart))
    if same:
        warnings.append(f"{where}: {same} node(s) are given more than once at the same position")
    return np.sort(first)


def _system(
    number: int, systems: Mapping[int, CoordinateSystem], undefined: dict[int, int], count: int
) -> CoordinateSystem:
    """Return a system by its number; 0 and an undefined 1 are the basic frame."""
    if number in systems:
        return systems[number]
    if number not in (0, 1):
        undefined[number] = max(count, undefined.get(number, 0))
    return BASIC


def some(numbers: Sequence[int] | Ints) -> str:
    """Return the first few of many numbers, for a message."""
    listed = [str(int(n)) for n in numbers]
    return ", ".join(listed[:6]) + (f" and {len(listed) - 6} more" if len(listed) > 6 else "")
