"""Datasets 18 and 2420: coordinate systems."""

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ....core.arrays import Floats
from ..container import Section
from ..open_file import Source
from ..systems import BASIC, KINDS, CoordinateSystem, from_points
from ..text.printing import dataset, text_line
from ..universal_content import UniversalContent
from .dataset_kind import DatasetKind, Gathered, Outgoing
from .section_lines import Lines


def _defined(found: Mapping[int, CoordinateSystem], source: Source, into: Gathered) -> int:
    """Note systems for all files, and that those of a file go before other files' of one number."""
    into.systems.update(found)
    into.systems_of.setdefault(source.name, {}).update(found)
    return len(found)


def _each(
    lines: Lines, least: int, starts: str, count: int
) -> Iterator[tuple[int, list[int], str, Floats]]:
    """Yield row, integers, name and rows of three numbers of each system."""
    while lines.more():
        row, head = lines.head(least, starts)
        if head[1] not in range(len(KINDS)):
            raise lines.error(row, starts)
        name, values = lines.name(), lines.positions(count)
        if len(values) < count:
            raise lines.error(row, f"system {head[0]} needs {count} values, has {len(values)}")
        yield row, head, name, np.array(values[:count]).reshape(-1, 3)


def _read_18(source: Source, section: Section, into: Gathered) -> int:
    """Read dataset 18; a system may refer to those defined before, first to those of its file."""
    known = {**into.systems, **into.systems_of.get(source.name, {})}
    lines, found = Lines.filled(source, section), dict[int, CoordinateSystem]()
    starts = "a system starts with number, type (0..2), reference"
    for row, (number, kind, to, *_), name, points in _each(lines, 3, starts, 9):
        reference = {**known, **found}.get(to, BASIC if to in (0, number) else None)
        if reference is None:
            raise lines.error(row, f"system {number} refers to {to}, not defined")
        try:
            found[number] = from_points(KINDS[kind], reference, points, name)
        except ValueError as error:
            raise lines.error(row, f"system {number}: {error}") from None
    return _defined(found, source, into)


def _read_2420(source: Source, section: Section, into: Gathered) -> int:
    """Read dataset 2420: rows 1..3 of the matrix are the axes, row 4 the origin, in the part."""
    lines, found = Lines.filled(source, section), dict[int, CoordinateSystem]()
    lines.at = 2
    starts = "a system starts with its number and type (0..2)"
    for row, (number, kind, *_), name, matrix in _each(lines, 2, starts, 12):
        if np.abs(matrix[:3] @ matrix[:3].T - np.eye(3)).max() > 1e-3:
            raise lines.error(row, f"the axes of system {number} are not orthogonal unit vectors")
        found[number] = CoordinateSystem(KINDS[kind], matrix[3], matrix[:3], name)
    return _defined(found, source, into)


def numbered(systems: Mapping[int, Floats]) -> dict[bytes, int]:
    """Return the numbers, from 2, of the different axes among those of nodes."""
    numbers: dict[bytes, int] = {}
    for axes in systems.values():
        numbers.setdefault(key(axes), len(numbers) + 2)
    return numbers


def key(axes: Floats) -> bytes:
    """Return what axes (3, 3) are told apart by."""
    return np.round(axes, 12).tobytes()


def _tell(content: UniversalContent) -> dict[str, Any]:
    kinds = Counter(s.kind for s in content.systems.values()) if content.systems else {}
    return {"coordinate_systems": dict(kinds)} if kinds else {}


def _write_2420(out: Outgoing) -> Iterator[bytes]:
    if out.geometry is None or not out.systems:
        return
    numbers = numbered(out.systems)
    found = {numbers[key(axes)]: axes for axes in out.systems.values()}
    lines = [b"%10d\n" % 1, text_line("trueup")]
    for number, axes in sorted(found.items()):
        lines += [b"%10d%10d%10d\n" % (number, 0, 8), text_line(f"CS{number}")]
        lines += [b"%25.16E%25.16E%25.16E\n" % tuple(row) for row in [*axes, np.zeros(3)]]
    yield dataset(2420, *lines)


SYSTEMS_18 = DatasetKind(18, "coordinate systems", _read_18, vital=True)
SYSTEMS_2420 = DatasetKind(2420, "coordinate systems", _read_2420, _tell, _write_2420, vital=True)
