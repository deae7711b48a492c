"""Datasets 18 and 2420: coordinate systems."""

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ....core.arrays import Floats
from ..container import Section
from ..open_file import Source
from ..systems import BASIC, KINDS, CoordinateSystem, from_points
from ..text.number_fields import integers, text
from ..text.printing import dataset, text_line
from ..universal_content import UniversalContent
from .dataset_kind import DatasetKind, Gathered, Outgoing
from .section_lines import filled, positions


def _defined(found: Mapping[int, CoordinateSystem], source: Source, into: Gathered) -> int:
    """Note systems for all files, and that those of a file go before other files' of one number."""
    into.systems.update(found)
    into.systems_of.setdefault(source.name, {}).update(found)
    return len(found)


def _read_18(source: Source, section: Section, into: Gathered) -> int:
    """Read dataset 18; a system may refer to those defined before, first to those of its file."""
    known = {**into.systems, **into.systems_of.get(source.name, {})}
    lines = filled(source, section)
    found: dict[int, CoordinateSystem] = {}
    at = 0
    while at < len(lines):
        head = integers(lines[at])
        line = section.line + 1 + at
        if len(head) < 3 or head[1] not in range(3):
            raise source.error(
                line, "dataset 18: a system starts with number, type (0..2), reference"
            )
        name, at = text(lines[at + 1]) if at + 1 < len(lines) else "", at + 2
        values: list[float] = []
        while len(values) < 9 and at < len(lines):
            values += positions(source, section, lines, at)
            at += 1
        if len(values) < 9:
            raise source.error(
                line, f"dataset 18: system {head[0]} needs 9 values, has {len(values)}"
            )
        reference = {**known, **found}.get(head[2], BASIC if head[2] in (0, head[0]) else None)
        if reference is None:
            raise source.error(
                line, f"dataset 18: system {head[0]} refers to {head[2]}, not defined"
            )
        points = np.array(values[:9]).reshape(3, 3)
        try:
            found[head[0]] = from_points(KINDS[head[1]], reference, points, name)
        except ValueError as error:
            raise source.error(line, f"dataset 18, system {head[0]}: {error}") from None
    return _defined(found, source, into)


def _read_2420(source: Source, section: Section, into: Gathered) -> int:
    """Read dataset 2420: rows 1..3 of the matrix are the axes, row 4 the origin, in the part."""
    lines = filled(source, section)
    found: dict[int, CoordinateSystem] = {}
    at = 2
    while at < len(lines):
        head = integers(lines[at])
        line = section.line + 1 + at
        if len(head) < 2 or head[1] not in range(3):
            raise source.error(
                line, "dataset 2420: a system starts with its number and type (0..2)"
            )
        name, at = text(lines[at + 1]) if at + 1 < len(lines) else "", at + 2
        values: list[float] = []
        while len(values) < 12 and at < len(lines):
            values += positions(source, section, lines, at)
            at += 1
        if len(values) < 12:
            raise source.error(
                line, f"dataset 2420: system {head[0]} needs 12 values, has {len(values)}"
            )
        matrix = np.array(values[:12]).reshape(4, 3)
        if np.abs(matrix[:3] @ matrix[:3].T - np.eye(3)).max() > 1e-3:
            raise source.error(
                line, f"dataset 2420: the axes of system {head[0]} are not orthogonal unit vectors"
            )
        found[head[0]] = CoordinateSystem(KINDS[head[1]], matrix[:3], matrix[3], name)
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
