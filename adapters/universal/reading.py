"""Read one or several universal files into one content."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

from ...core.errors import InputError
from .container import Section
from .content import Dataset, Header, Skipped, Trace, Units, UniversalContent
from .drawing import Element, drawn_geometry, read_2412
from .facts import read_header, read_model_header, read_units
from .frames import node_frames
from .functions import read_head
from .joining import agreed_units, join_modes
from .names import name_of
from .nodes import NodeTable, read_15, read_18, read_82, read_2411, read_2420
from .responses import Record, Report, assemble
from .shapes import Shape, read_55, read_2414
from .source import DatasetError, Source, open_source
from .systems import CoordinateSystem


@dataclass(frozen=True)
class Selection:
    """Which mode shapes (counted from 1) and reference nodes are wanted; None: all."""

    modes: Collection[int] | None = None
    references: Collection[int] | None = None


@dataclass
class _Gathered:
    """What has been read so far, file by file."""

    wanted: Selection
    n_shape: int = 0
    nodes: list[NodeTable] = field(default_factory=list)
    elements: list[Element] = field(default_factory=list)
    systems: dict[int, CoordinateSystem] = field(default_factory=dict)
    systems_of: dict[str, dict[int, CoordinateSystem]] = field(default_factory=dict)
    traces: list[Trace] = field(default_factory=list)
    shapes: list[Shape] = field(default_factory=list)
    functions: list[Record] = field(default_factory=list)
    units: list[tuple[Units, str, int]] = field(default_factory=list)
    headers: list[Header] = field(default_factory=list)
    datasets: list[Dataset] = field(default_factory=list)
    skipped: list[Skipped] = field(default_factory=list)
    failed: list[InputError] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


def read_universal(
    paths: Sequence[Path] | Path,
    *,
    modes: Collection[int] | None = None,
    references: Collection[int] | None = None,
    values: bool = True,
) -> UniversalContent:
    """Read universal files (.unv, .uff) and merge what they hold.

    Modes or frequency responses, geometry, coordinate systems and units may stand in different
    files; the order does not matter.

    Parameters
    ----------
    paths : sequence of Path, or Path
        Files that make up one test.
    modes : collection of int, optional
        Read only these mode shapes, counted from 1 over all files. Default: all.
    references : collection of int, optional
        Read only the functions with these reference nodes. Default: all.
    values : bool
        False: neither mode shapes nor functions are read, only what surrounds them; the
        inventory `datasets` still lists them.

    Returns
    -------
    UniversalContent
        What was not asked for is not in `skipped`.

    Raises
    ------
    InputError
        A file that is missing or not universal, or in which nothing can be read; the message
        names the file and line. A dataset that is cut off, damaged or not finite does not stop
        the others: it is listed in `skipped` with its line.
    """
    files = [Path(paths)] if isinstance(paths, str | Path) else [Path(p) for p in paths]
    if not files:
        raise InputError("no universal file was given")
    wanted = Selection(modes, references) if values else Selection((), ())
    if wanted == Selection():
        return _content(files, wanted, exact_lines=True)
    # Line numbers behind binary blocks cost reading the blocks: worth it only if one is quoted.
    try:
        content = _content(files, wanted, exact_lines=False)
    except InputError:
        return _content(files, wanted, exact_lines=True)
    if content.skipped or content.warnings:
        return _content(files, wanted, exact_lines=True)
    return content


def _content(files: Sequence[Path], wanted: Selection, exact_lines: bool) -> UniversalContent:
    gathered = _Gathered(wanted)
    warnings = gathered.warnings
    with ExitStack() as open_files:
        for path in files:
            source = open_files.enter_context(open_source(path, exact_lines))
            gathered.skipped += source.skipped
            warnings += source.warnings
            for section in source.sections:
                _read(source, section, gathered)
        known = [
            {**gathered.systems, **gathered.systems_of.get(t.path, {})} for t in gathered.nodes
        ]
        frames = node_frames(gathered.nodes, known, warnings, gathered.skipped)
        units = agreed_units(gathered.units, gathered.skipped)
        unit = units.length_unit if units else None
        report = Report(gathered.skipped, warnings, gathered.failed)
        frfs, functions = assemble(gathered.functions, frames.at, unit, report)
    if gathered.failed and not (len(frames.ids) or gathered.shapes or frfs or functions):
        raise gathered.failed[0]
    return UniversalContent(
        files=tuple(str(p) for p in files),
        geometry=drawn_geometry(frames, gathered.elements, gathered.traces, unit, warnings),
        modes=join_modes(gathered.shapes, frames, warnings),
        frfs=frfs,
        functions=functions,
        units=units,
        headers=tuple(gathered.headers),
        systems=gathered.systems,
        traces=tuple(gathered.traces),
        datasets=tuple(gathered.datasets),
        skipped=tuple(gathered.skipped),
        warnings=tuple(dict.fromkeys(warnings)),
    )


def _read(source: Source, section: Section, into: _Gathered) -> None:
    """Read one dataset into what has been gathered; list it where it cannot be read."""
    number = section.number
    try:
        if not section.closed and number != 58:  # a function knows by itself whether it is whole
            raise source.error(
                section.line,
                f"the file ends inside dataset {number} that starts here (no closing -1); "
                "it is cut off, export or copy it again",
            )
        count = _READERS.get(number, _skip)(source, section, into)
    except DatasetError as error:
        what = f"dataset {number} ({name_of(number)})"
        harm = "test" if number in _SOUND else "lost"
        into.skipped.append(Skipped(what, error.line, error.why, source.name, harm))
        into.failed.append(error)
        count = 0
    into.datasets.append(Dataset(number, section.line, name_of(number), count, source.name))


def _skip(source: Source, section: Section, into: _Gathered) -> int:
    what = f"dataset {section.number} ({name_of(section.number)})"
    into.skipped.append(Skipped(what, section.line, "not read by trueup", source.name))
    return 0


def _nodes(reader: Callable[[Source, Section], NodeTable]) -> _Reader:
    def read(source: Source, section: Section, into: _Gathered) -> int:
        into.nodes.append(reader(source, section))
        return len(into.nodes[-1].ids)

    return read


def _shape(
    reader: Callable[[Source, Section, Callable[[], bool]], Shape | Skipped | None],
) -> _Reader:
    def read(source: Source, section: Section, into: _Gathered) -> int:
        def wanted() -> bool:
            into.n_shape += 1
            return into.wanted.modes is None or into.n_shape in into.wanted.modes

        shape = reader(source, section, wanted)
        if isinstance(shape, Skipped):
            into.skipped.append(shape)
        elif shape is not None:
            into.shapes.append(shape)
            return len(shape.nodes)
        return 0

    return read


def _elements(source: Source, section: Section, into: _Gathered) -> int:
    found = read_2412(source, section, into.skipped)
    into.elements += found
    return len(found)


def _traces(source: Source, section: Section, into: _Gathered) -> int:
    found = read_82(source, section)
    into.traces += found
    return len(found)


def _systems_18(source: Source, section: Section, into: _Gathered) -> int:
    own = into.systems_of.get(source.name, {})
    return _defined(read_18(source, section, {**into.systems, **own}), source, into)


def _systems_2420(source: Source, section: Section, into: _Gathered) -> int:
    return _defined(read_2420(source, section), source, into)


def _defined(found: Mapping[int, CoordinateSystem], source: Source, into: _Gathered) -> int:
    """Note systems for all files, and that those of a file go before other files' of one number."""
    into.systems.update(found)
    into.systems_of.setdefault(source.name, {}).update(found)
    return len(found)


def _function(source: Source, section: Section, into: _Gathered) -> int:
    head = read_head(source, section)
    if into.wanted.references is None or head.reference[0] in into.wanted.references:
        into.functions.append(Record(source, head))
    if not section.closed:
        into.warnings.append(
            f"{source.name} line {section.line}: the file ends without the -1 that closes the "
            "last dataset"
        )
    return head.n_point


def _header(source: Source, section: Section, into: _Gathered) -> int:
    into.headers.append(read_header(source, section))
    return 1


def _model_header(source: Source, section: Section, into: _Gathered) -> int:
    into.headers.append(read_model_header(source, section))
    return 1


def _units(source: Source, section: Section, into: _Gathered) -> int:
    units = read_units(source, section, into.warnings)
    into.units.append((units, source.name, section.line))
    return 1


_Reader = Callable[[Source, Section, _Gathered], int]
_SOUND = (15, 18, 55, 164, 2411, 2414, 2420)
"""Datasets that no test can do without."""
_READERS: dict[int, _Reader] = {
    15: _nodes(read_15),
    18: _systems_18,
    55: _shape(read_55),
    58: _function,
    82: _traces,
    151: _header,
    164: _units,
    2400: _model_header,
    2411: _nodes(read_2411),
    2412: _elements,
    2414: _shape(read_2414),
    2420: _systems_2420,
}
