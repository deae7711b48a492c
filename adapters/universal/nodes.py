"""Datasets 15 and 2411 (nodes), 82 (trace lines), 18 and 2420 (coordinate systems)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Floats, Ints
from .container import Section
from .content import Trace
from .fields import NotANumber, floats, integers, table, text
from .source import Source
from .systems import BASIC, KINDS, CoordinateSystem, from_points

_15 = (10, 10, 10, 10, 13, 13, 13)
_2411 = ((10, 10, 10, 10), (25, 25, 25))


@dataclass(frozen=True, eq=False)
class NodeTable:
    """Nodes as a dataset lists them: numbers, systems by number, coordinates as written."""

    ids: Ints
    definition: Ints
    displacement: Ints
    coordinates: Floats
    path: str
    line: int


def read_15(source: Source, section: Section) -> NodeTable:
    """Read dataset 15: coordinates stand in each node's definition system."""
    lines = _filled(source.lines(section))
    values = _table(source, section, lines, _15, 1)
    ids, definition, displacement = values[:, :3].astype(np.int64).T
    return NodeTable(ids, definition, displacement, values[:, 4:7], source.name, section.line)


def read_2411(source: Source, section: Section) -> NodeTable:
    """Read dataset 2411: coordinates stand in the part's own frame, whatever the systems."""
    lines = _filled(source.lines(section))
    if len(lines) % 2:
        raise source.error(
            section.line + len(lines), "dataset 2411 ends in the middle of a node; export it again"
        )
    labels = _table(source, section, lines[0::2], _2411[0], 2).astype(np.int64)
    xyz = _table(source, section, lines[1::2], _2411[1], 2, 1)
    zero = np.zeros(len(labels), np.int64)
    return NodeTable(labels[:, 0], zero, labels[:, 2], xyz, source.name, section.line)


def read_82(source: Source, section: Section) -> list[Trace]:
    """Read dataset 82: one trace line by the book, several one after another from some."""
    lines = _filled(source.lines(section))
    traces, at = [], 0
    while at < len(lines):
        head = integers(lines[at])
        if len(head) < 2 or at + 1 >= len(lines):
            raise source.error(
                section.line + 1 + at,
                "dataset 82: a trace line must start with its number and how many nodes it has",
            )
        name, nodes = text(lines[at + 1]), list[int]()
        first = at
        at += 2
        while len(nodes) < head[1] and at < len(lines):
            nodes += integers(lines[at])
            at += 1
        if len(nodes) < head[1]:
            raise source.error(
                section.line + 1 + first,
                f"dataset 82: trace line {head[0]} announces {head[1]} nodes but has {len(nodes)}",
            )
        color = head[2] if len(head) > 2 else 0
        traces.append(Trace(head[0], name, color, np.array(nodes[: head[1]], np.int64)))
        while at < len(lines) and not any(integers(lines[at])):
            at += 1  # some programs pad with lines of zeros
    return traces


def read_18(
    source: Source, section: Section, known: dict[int, CoordinateSystem]
) -> dict[int, CoordinateSystem]:
    """Read dataset 18; `known` are the systems defined before, which a new one may refer to."""
    lines = _filled(source.lines(section))
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
            values += _floats(source, section, lines, at)
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
    return found


def read_2420(source: Source, section: Section) -> dict[int, CoordinateSystem]:
    """Read dataset 2420: rows 1..3 of the matrix are the axes, row 4 the origin, in the part."""
    lines = _filled(source.lines(section))
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
            values += _floats(source, section, lines, at)
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
    return found


def _filled(lines: list[bytes]) -> list[bytes]:
    """Lines without the blank ones at the end."""
    while lines and not lines[-1].strip(b" \t\x00"):
        lines.pop()
    return lines


def _table(
    source: Source,
    section: Section,
    lines: Sequence[bytes],
    widths: Sequence[int],
    stride: int,
    shift: int = 0,
) -> Floats:
    try:
        values = table(lines, widths)
    except NotANumber as error:
        line = section.line + 1 + shift + stride * error.row
        raise source.error(
            line, f"dataset {section.number}: {error.text!r} does not hold {len(widths)} numbers"
        ) from None
    bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if len(bad):
        line = section.line + 1 + shift + stride * int(bad[0])
        raise source.error(line, f"dataset {section.number} holds a value that is not finite")
    return values


def _floats(source: Source, section: Section, lines: Sequence[bytes], at: int) -> list[float]:
    try:
        values = floats(lines[at : at + 1])
    except NotANumber as error:
        raise source.error(
            section.line + 1 + at, f"dataset {section.number}: {error.text!r} is not a number"
        ) from None
    if not np.all(np.abs(values) < 1e100):
        raise source.error(
            section.line + 1 + at, f"dataset {section.number} holds a value that is no position"
        )
    return list(values)
