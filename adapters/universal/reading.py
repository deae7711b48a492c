"""Read one or several universal files into one content."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...core.arrays import Floats, Ints, Numbers
from ...core.dofs import Dofs
from ...core.errors import InputError
from ...core.geometry import Geometry
from ...core.modes import Modes
from .container import Section, Source, open_source
from .content import Dataset, Header, Skipped, Trace, Units, UniversalContent
from .facts import read_header, read_units
from .functions import read_head
from .names import name_of
from .nodes import NodeTable, read_15, read_18, read_82, read_2411, read_2420
from .responses import Record, Report, assemble
from .shapes import Shape, read_55, read_2414
from .systems import BASIC, CoordinateSystem


@dataclass
class _Gathered:
    """What has been read so far, file by file."""

    nodes: list[NodeTable] = field(default_factory=list)
    systems: dict[int, CoordinateSystem] = field(default_factory=dict)
    traces: list[Trace] = field(default_factory=list)
    shapes: list[Shape] = field(default_factory=list)
    functions: list[Record] = field(default_factory=list)
    units: list[tuple[Units, str]] = field(default_factory=list)
    headers: list[Header] = field(default_factory=list)
    datasets: list[Dataset] = field(default_factory=list)
    skipped: list[Skipped] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


def read_universal(paths: Sequence[Path] | Path) -> UniversalContent:
    """Read universal files (.unv, .uff) and merge what they hold.

    Modes or frequency responses, geometry, coordinate systems and units may stand in different
    files; the order does not matter.

    Parameters
    ----------
    paths : sequence of Path, or Path
        Files that make up one test.

    Returns
    -------
    UniversalContent

    Raises
    ------
    InputError
        A file that is missing, not universal, cut off or damaged, or values that are not finite;
        the message names the file and line.
    """
    files = [Path(paths)] if isinstance(paths, str | Path) else [Path(p) for p in paths]
    if not files:
        raise InputError("no universal file was given")
    gathered = _Gathered()
    for path in files:
        source = open_source(path)
        gathered.skipped += source.skipped
        gathered.warnings += source.warnings
        for section in source.sections:
            _read(source, section, gathered)
    frames = _NodeFrames.of(gathered)
    units = _units(gathered)
    frfs, functions = assemble(
        gathered.functions,
        frames.at,
        units.length_unit if units else None,
        Report(gathered.skipped, gathered.warnings),
    )
    return UniversalContent(
        files=tuple(str(p) for p in files),
        geometry=frames.geometry(gathered),
        modes=_modes(gathered, frames),
        frfs=frfs,
        functions=functions,
        units=units,
        headers=tuple(gathered.headers),
        systems=gathered.systems,
        traces=tuple(gathered.traces),
        datasets=tuple(gathered.datasets),
        skipped=tuple(gathered.skipped),
        warnings=tuple(dict.fromkeys(gathered.warnings)),
    )


def _read(source: Source, section: Section, into: _Gathered) -> None:
    """Read one dataset into what has been gathered."""
    number, count = section.number, 0
    if not section.closed and number != 58:
        raise source.error(
            section.line,
            f"the file ends inside dataset {number} that starts here (no closing -1); "
            "it is cut off, export or copy it again",
        )
    if number in (15, 2411):
        nodes = (read_15 if number == 15 else read_2411)(source, section)
        into.nodes.append(nodes)
        count = len(nodes.ids)
    elif number == 82:
        traces = read_82(source, section)
        into.traces += traces
        count = len(traces)
    elif number in (18, 2420):
        found = (
            read_18(source, section, into.systems) if number == 18 else read_2420(source, section)
        )
        into.systems.update(found)
        count = len(found)
    elif number in (55, 2414):
        shape = (read_55 if number == 55 else read_2414)(source, section)
        if isinstance(shape, Skipped):
            into.skipped.append(shape)
        else:
            into.shapes.append(shape)
            count = len(shape.nodes)
    elif number == 58:
        head = read_head(source, section)
        into.functions.append(Record(source, head))
        count = head.n_point
    elif number == 151:
        into.headers.append(read_header(source, section))
        count = 1
    elif number == 164:
        units = read_units(source, section, into.warnings)
        into.units.append((units, f"{source.name} line {section.line}"))
        count = 1
    else:
        into.skipped.append(
            Skipped(f"dataset {number} ({name_of(number)})", section.line, "not read", source.name)
        )
    into.datasets.append(Dataset(number, section.line, name_of(number), count, source.name))


@dataclass(frozen=True, eq=False)
class _NodeFrames:
    """Nodes with positions and displacement axes in the basic frame."""

    ids: Ints
    xyz: Floats
    frames: Floats

    @staticmethod
    def of(gathered: _Gathered) -> _NodeFrames:
        """Merge the node tables; a node given twice must stand in the same place."""
        undefined: dict[int, int] = {}
        on_axis: list[int] = []
        parts = []
        for nodes in gathered.nodes:
            xyz = nodes.coordinates.copy()
            for number in np.unique(nodes.definition):
                rows = nodes.definition == number
                system = _system(int(number), gathered.systems, undefined)
                if system is not BASIC:
                    xyz[rows] = system.positions(xyz[rows])
            frames = np.broadcast_to(np.eye(3), (len(xyz), 3, 3)).copy()
            for number in np.unique(nodes.displacement):
                rows = nodes.displacement == number
                system = _system(int(number), gathered.systems, undefined)
                frames[rows] = system.frames(xyz[rows])
                on_axis += list(nodes.ids[rows][system.on_axis(xyz[rows])])
            parts.append((nodes.ids, xyz, frames))
        for number, count in undefined.items():
            gathered.warnings.append(
                f"coordinate system {number}, used by {count} nodes, is not defined (dataset 18 or "
                "2420); the basic frame is used in its place"
            )
        if on_axis:
            gathered.warnings.append(
                f"node(s) {_some(on_axis)} lie on the axis of their cylindrical or spherical "
                "displacement system, where radial and tangential are not defined; "
                "x is taken as radial"
            )
        if not parts:
            return _NodeFrames(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 3, 3)))
        ids, xyz, frames = (np.concatenate(p) for p in zip(*parts, strict=True))
        return _NodeFrames(*_unique(ids, xyz, frames, gathered))

    def geometry(self, gathered: _Gathered) -> Geometry | None:
        """Nodes with the trace lines as line elements; None where no node is given."""
        if not len(self.ids):
            return None
        units = _units(gathered, quiet=True)
        plain = Geometry(self.ids, self.xyz, units.length_unit if units else None)
        pairs, numbers = [], []
        for trace in gathered.traces:
            rows = np.where(trace.nodes == 0, -2, plain.index_of(trace.nodes))
            missing = trace.nodes[rows == -1]
            if len(missing):
                gathered.warnings.append(
                    f"trace line {trace.number} passes node(s) {_some(missing)}, "
                    "which do not exist; those segments are left out"
                )
            segments = np.column_stack([rows[:-1], rows[1:]])
            segments = segments[(segments >= 0).all(axis=1) & (segments[:, 0] != segments[:, 1])]
            pairs.append(segments)
            numbers.append(np.full(len(segments), trace.number))
        if not pairs or not sum(map(len, pairs)):
            return plain
        return Geometry(
            self.ids,
            self.xyz,
            plain.length_unit,
            {"line": np.concatenate(pairs)},
            {"line": np.concatenate(numbers)},
        )

    def at(self, nodes: Ints) -> Floats:
        """Displacement axes (n, 3, 3) of nodes; the basic ones where a node is not known."""
        frames = np.broadcast_to(np.eye(3), (len(nodes), 3, 3)).copy()
        if len(self.ids):
            order = np.argsort(self.ids, kind="stable")
            found = order[np.minimum(np.searchsorted(self.ids[order], nodes), len(order) - 1)]
            known = self.ids[found] == nodes
            frames[known] = self.frames[found[known]]
        return frames


def _unique(
    ids: Ints, xyz: Floats, frames: Floats, gathered: _Gathered
) -> tuple[Ints, Floats, Floats]:
    """Drop repeats of a node; repeats elsewhere than the first are an error."""
    unique, first, inverse = np.unique(ids, return_index=True, return_inverse=True)
    if len(unique) == len(ids):
        return ids, xyz, frames
    size = max(float(np.ptp(xyz, axis=0).max()), 1e-30)
    apart = np.abs(xyz - xyz[first[inverse]]).max(axis=1) > 1e-4 * size
    if apart.any():
        files = " and ".join(dict.fromkeys(n.where for n in gathered.nodes))
        raise InputError(
            f"{files}: node {ids[apart][0]} is given twice at different positions; "
            "remove one, or give files of one test only"
        )
    gathered.warnings.append(
        f"{len(ids) - len(unique)} node(s) are given more than once at the same position"
    )
    keep = np.sort(first)
    return ids[keep], xyz[keep], frames[keep]


def _system(
    number: int, systems: dict[int, CoordinateSystem], undefined: dict[int, int]
) -> CoordinateSystem:
    """Return a system by its number; 0 and an undefined 1 are the basic frame."""
    if number in systems:
        return systems[number]
    if number not in (0, 1):
        undefined[number] = undefined.get(number, 0) + 1
    return BASIC


def _modes(gathered: _Gathered, frames: _NodeFrames) -> Modes | None:
    """Join the mode shapes: rows of the nodes that every mode has, columns in file order."""
    shapes = gathered.shapes
    if not shapes:
        return None
    nodes = shapes[0].nodes
    if any(not np.array_equal(s.nodes, nodes) for s in shapes):
        everywhere = nodes
        for s in shapes[1:]:
            everywhere = np.intersect1d(everywhere, s.nodes)
        dropped = np.setdiff1d(np.unique(np.concatenate([s.nodes for s in shapes])), everywhere)
        if len(dropped):
            gathered.warnings.append(
                f"node(s) {_some(dropped)} are missing in some modes and are left out of all"
            )
        nodes = nodes[np.isin(nodes, everywhere)]
    if not len(nodes):
        raise InputError(
            f"{shapes[0].path} line {shapes[0].line}: no node has values in every mode; "
            "give modes of one test only"
        )
    width = max(s.values.shape[1] for s in shapes)
    columns: list[Numbers] = []
    for s in shapes:
        order = np.argsort(s.nodes, kind="stable")
        rows = order[np.searchsorted(s.nodes[order], nodes)]
        values = np.zeros((len(nodes), width), s.values.dtype)
        values[:, : s.values.shape[1]] = s.values[rows]
        columns.append(values.ravel())
    if len({s.values.shape[1] for s in shapes}) > 1:
        gathered.warnings.append(
            "some modes have 3 values a node, others 6; rotations are left out"
        )
        columns = [c.reshape(-1, 6)[:, :3].ravel() for c in columns]
        width = 3
    axes = frames.at(nodes)
    axis = np.concatenate([axes, axes], axis=1)[:, :width].reshape(-1, 3)
    component = np.tile(np.arange(1, width + 1), len(nodes))
    return Modes(
        np.array([s.frequency_hz for s in shapes]),
        np.column_stack(columns),
        Dofs(np.repeat(nodes, width), component, axis),
        np.array([s.damping for s in shapes]),
        np.array([s.generalized_mass for s in shapes]),
        ", ".join(dict.fromkeys(s.path for s in shapes)),
    )


def _units(gathered: _Gathered, quiet: bool = False) -> Units | None:
    """Return the units on which all files agree."""
    if not gathered.units:
        return None
    first, where = gathered.units[0]
    for other, elsewhere in gathered.units[1:]:
        if abs(other.length_factor / first.length_factor - 1.0) > 1e-6 and not quiet:
            raise InputError(
                f"{where} and {elsewhere}: dataset 164 declares different length units "
                f"(factors {first.length_factor:g} and {other.length_factor:g}); "
                "export all files in one unit"
            )
    return first


def _some(numbers: Sequence[int] | Ints) -> str:
    """Return the first few of many numbers, for a message."""
    listed = [str(int(n)) for n in numbers]
    return ", ".join(listed[:6]) + (f" and {len(listed) - 6} more" if len(listed) > 6 else "")
