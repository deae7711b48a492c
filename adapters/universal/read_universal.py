"""Read one or several universal files into one content."""

from collections.abc import Collection, Sequence
from contextlib import ExitStack
from pathlib import Path

from ...core.errors import InputError
from .container import Section
from .datasets.dataset_kind import Gathered, Selection
from .datasets.elements import Element
from .datasets.functions import Record
from .datasets.known_datasets import dataset_of, name_of
from .datasets.mode_shapes import Shape
from .datasets.nodes import NodeTable
from .datasets.units import DeclaredUnits
from .joining.join_geometry import drawn_geometry
from .joining.join_modes import agreed_units, join_modes
from .joining.join_responses import Report, assemble
from .joining.node_frames import node_frames
from .open_file import DatasetError, Source, open_source
from .universal_content import Dataset, Header, Skipped, Trace, UniversalContent


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
    into = Gathered(wanted)
    warnings = into.warnings
    with ExitStack() as open_files:
        for path in files:
            source = open_files.enter_context(open_source(path, exact_lines))
            into.skipped += source.skipped
            warnings += source.warnings
            for section in source.sections:
                _read(source, section, into)
        tables = into.of(NodeTable)
        known = [{**into.systems, **into.systems_of.get(t.path, {})} for t in tables]
        frames = node_frames(tables, known, warnings, into.skipped)
        units = agreed_units(into.of(DeclaredUnits), into.skipped)
        unit = units.length_unit if units else None
        report = Report(into.skipped, warnings, into.failed)
        frfs, functions = assemble(into.of(Record), frames.at, unit, report)
    extensions = [n for kind, found in into.nouns.items() if kind not in _JOINED for n in found]
    if into.failed and not (len(frames.ids) or into.of(Shape) or frfs or functions or extensions):
        raise into.failed[0]
    traces = into.of(Trace)
    return UniversalContent(
        files=tuple(str(p) for p in files),
        geometry=drawn_geometry(frames, into.of(Element), traces, unit, warnings),
        modes=join_modes(into.of(Shape), frames, warnings),
        frfs=frfs,
        functions=functions,
        units=units,
        headers=tuple(into.of(Header)),
        systems=into.systems,
        traces=tuple(traces),
        datasets=tuple(into.datasets),
        skipped=tuple(into.skipped),
        warnings=tuple(dict.fromkeys(warnings)),
        extensions=tuple(extensions),
    )


_JOINED = {NodeTable, DeclaredUnits, Record, Shape, Trace, Element, Header}
"""What is joined into geometry, modes, responses, units and headers."""


def _read(source: Source, section: Section, into: Gathered) -> None:
    """Read one dataset into what has been gathered; list it where it cannot be read."""
    number = section.number
    kind, name = dataset_of(number), name_of(number)
    what, count = f"dataset {number} ({name})", 0
    if kind is None:
        into.skipped.append(Skipped(what, section.line, "not read by trueup", source.name))
    else:
        try:
            if not section.closed and not kind.tells_own_end:
                raise source.error(
                    section.line,
                    f"the file ends inside dataset {number} that starts here (no closing -1); "
                    "it is cut off, export or copy it again",
                )
            count = kind.read(source, section, into)
        except DatasetError as error:
            harm = "test" if kind.vital else "lost"
            into.skipped.append(Skipped(what, error.line or 0, error.why, source.name, harm))
            into.failed.append(error)
    into.datasets.append(Dataset(number, section.line, name, count, source.name))
