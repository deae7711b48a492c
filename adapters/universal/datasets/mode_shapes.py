"""Datasets 55 and 2414: mode shapes at nodes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Floats, Ints, Numbers
from .container import Section
from .content import Skipped
from .fields import NotANumber, floats, integers, node_numbers, text
from .source import Source

_ANALYSES = {
    0: "unknown",
    1: "static",
    2: "normal mode",
    3: "complex eigenvalue, first order",
    4: "transient",
    5: "frequency response",
    6: "buckling",
    7: "complex eigenvalue, second order",
    9: "static non-linear",
}
_COMPLEX_MODES = (3, 7)
_HEADER = 16  # more lines than any header has
_HUGE = 1e300  # some programs print the largest number there is where they know none


@dataclass(frozen=True, eq=False)
class Shape:
    """One mode shape as a dataset holds it.

    `values` is (n_node, 3 or 6), real or complex, along each node's displacement axes.
    """

    frequency_hz: float
    damping: float
    generalized_mass: float
    nodes: Ints
    values: Numbers
    ids: tuple[str, ...]
    line: int
    path: str


@dataclass(frozen=True)
class _Head:
    """What the header lines of either dataset say."""

    analysis: int
    specific: int
    data_type: int
    n_value: int
    reals: tuple[float, ...]
    ids: tuple[str, ...]
    n_line: int


def read_55(
    source: Source, section: Section, wanted: Callable[[], bool] = lambda: True
) -> Shape | Skipped | None:
    """Read dataset 55; anything but a mode shape with 3 or 6 values a node is skipped.

    `wanted` is asked once the header shows a mode shape; where it says no, the values are not
    read and the answer is None.
    """
    lines, _ = source.head(section, _HEADER)
    if len(lines) < 8:
        raise source.error(section.line, "dataset 55 is cut off within its header")
    kind = _integers(source, section, lines, 5, 6)
    counts = _integers(source, section, lines, 6, 2)
    n_real = counts[1]
    rows = max(1, math.ceil(n_real / 6))
    reals = _header_floats(source, section, lines, 7, 7 + rows)
    ids = tuple(text(line) for line in lines[:5])
    head = _Head(kind[1], kind[3], kind[4], kind[5], reals, ids, 7 + rows)
    return _shape(source, section, head, _modal_55(head), wanted)


def read_2414(
    source: Source, section: Section, wanted: Callable[[], bool] = lambda: True
) -> Shape | Skipped | None:
    """Read dataset 2414; as `read_55`."""
    lines, _ = source.head(section, _HEADER)
    if len(lines) < 13:
        raise source.error(section.line, "dataset 2414 is cut off within its header")
    place = _integers(source, section, lines, 2, 1)[0]
    if place != 1:
        return _skip(source, section, "data not at nodes")
    kind = _integers(source, section, lines, 8, 6)
    reals = _header_floats(source, section, lines, 11, 13)
    ids = tuple(text(line) for line in (lines[1], *lines[3:8]))
    head = _Head(kind[1], kind[3], kind[4], kind[5], reals, ids, 13)
    return _shape(source, section, head, _modal_2414(head), wanted)


def _modal_55(head: _Head) -> tuple[float, float, float]:
    """Frequency [Hz], damping ratio and modal mass of records 7 and 8 of dataset 55."""
    r = (*head.reals, 0.0, 0.0, 0.0, 0.0)
    if head.analysis in _COMPLEX_MODES:
        return *_of_eigenvalue(complex(r[0], r[1])), math.nan
    return r[0], _damping(r[2], r[3]), _known(r[1])


def _modal_2414(head: _Head) -> tuple[float, float, float]:
    """Frequency [Hz], damping ratio and modal mass of records 12 and 13 of dataset 2414."""
    r = (*head.reals, *[0.0] * 12)
    frequency, mass = r[1], _known(r[3])
    if head.analysis in _COMPLEX_MODES and (r[6] or r[7]):
        return *_of_eigenvalue(complex(r[6], r[7])), math.nan
    if frequency == 0.0 and r[2] > 0.0:
        frequency = math.sqrt(r[2]) / (2.0 * math.pi)
    return frequency, _damping(r[4], r[5]), mass


def _of_eigenvalue(pole: complex) -> tuple[float, float]:
    """Frequency [Hz] and damping ratio of an eigenvalue [rad/s]; no real part: not given."""
    size = abs(pole)
    return size / (2.0 * math.pi), (-pole.real / size if pole.real else math.nan)


def _damping(viscous: float, hysteretic: float) -> float:
    """Damping ratio; zero stands for not given. Structural damping is twice the ratio."""
    if viscous and abs(viscous) < _HUGE:
        return viscous
    return hysteretic / 2.0 if hysteretic and abs(hysteretic) < _HUGE else math.nan


def _known(value: float) -> float:
    """Return a positive number that is not a placeholder, else NaN."""
    return value if 0.0 < value < _HUGE else math.nan


def _shape(
    source: Source,
    section: Section,
    head: _Head,
    modal: tuple[float, float, float],
    wanted: Callable[[], bool],
) -> Shape | Skipped | None:
    if head.analysis != 2 and head.analysis not in _COMPLEX_MODES:
        kind = _ANALYSES.get(head.analysis, f"analysis type {head.analysis}")
        return _skip(source, section, f"{kind} results are no modes")
    if head.specific not in (0, 1, 8, 11, 12):
        return _skip(source, section, f"specific data type {head.specific} is no motion")
    if head.n_value not in (3, 6):
        return _skip(source, section, f"{head.n_value} values a node where 3 or 6 are expected")
    if head.data_type not in (2, 4, 5, 6):
        raise source.error(
            section.line,
            f"dataset {section.number}: data type {head.data_type} is none of 2, 4, 5, 6",
        )
    if not math.isfinite(modal[0]):
        raise source.error(section.line, f"dataset {section.number}: the frequency is not a number")
    if not wanted():
        return None
    width = head.n_value * (2 if head.data_type in (5, 6) else 1)
    nodes, values = _values(source, section, source.lines(section), head.n_line, width)
    if head.data_type in (5, 6):
        values = np.ascontiguousarray(values).view(np.complex128)
    return Shape(*modal, nodes, values, head.ids, section.line, source.name)


def _values(
    source: Source, section: Section, lines: list[bytes], first: int, width: int
) -> tuple[Ints, Floats]:
    """Node numbers (n,) and their values (n, width); each node takes the same number of lines."""
    while len(lines) > first and not lines[-1].strip(b" \t\x00"):
        lines.pop()
    body = lines[first:]
    if not body:
        return np.zeros(0, np.int64), np.zeros((0, width))
    line = section.line + 1 + first
    try:
        rows = _rows(body, width)
    except NotANumber as error:
        raise source.error(
            line + error.row, f"dataset {section.number}: {error.text!r} is not a number"
        ) from None
    stride = 1 + (rows or 1)
    if rows is None or len(body) % stride:
        raise source.error(
            line + (len(body) // stride) * stride,
            f"dataset {section.number}: a node needs its number and {width} values on "
            "line(s) of their own; the file is cut off or damaged, export it again",
        )
    try:
        nodes = node_numbers(body[0::stride])
    except NotANumber as error:
        raise source.error(
            line + error.row * stride,
            f"dataset {section.number}: a node number is expected, found {error.text!r}",
        ) from None
    data = [text_line for k, text_line in enumerate(body) if k % stride]
    try:
        values = floats(data)
    except NotANumber as error:
        at = error.row // rows * stride + 1 + error.row % rows
        raise source.error(
            line + at,
            f"dataset {section.number}: {error.text!r} is not a number; remove node "
            f"{nodes[error.row // rows]} from the test or export the file again",
        ) from None
    if len(values) != width * len(nodes):
        k = _first_short(data, rows, width)
        raise source.error(
            line + 1 + k * stride,
            f"dataset {section.number}: node {nodes[k]} does not have {width} values; "
            "export the file again",
        )
    values = values.reshape(-1, width)
    _check(source, section, nodes, values, line + 1, stride)
    return nodes, values


def _rows(body: Sequence[bytes], width: int) -> int | None:
    """How many lines the values of one node take; None if the first node shows it is damaged."""
    have = 0
    for rows, line in enumerate(body[1:], 1):
        try:
            have += len(floats([line]))
        except NotANumber as error:
            raise NotANumber(rows, error.text) from None
        if have >= width:
            return rows if have == width else None
    return None


def _check(
    source: Source, section: Section, nodes: Ints, values: Floats, line: int, stride: int
) -> None:
    """Refuse values that are not finite and nodes given twice."""
    wrong = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if len(wrong):
        k = int(wrong[0])
        raise source.error(
            line + k * stride,
            f"dataset {section.number}: the shape is not a finite number at node {nodes[k]}; "
            "remove that node from the test or export it again",
        )
    unique, counts = np.unique(nodes, return_counts=True)
    if len(unique) < len(nodes):
        raise source.error(
            section.line, f"dataset {section.number} gives node {unique[counts > 1][0]} twice"
        )


def _first_short(data: Sequence[bytes], rows: int, width: int) -> int:
    """Which node is the first with a wrong number of values."""
    for k in range(len(data) // rows):
        if len(floats(data[k * rows : (k + 1) * rows])) != width:
            return k
    return 0


def _integers(source: Source, section: Section, lines: list[bytes], row: int, n: int) -> list[int]:
    found = integers(lines[row])
    if len(found) < n:
        raise source.error(
            section.line + 1 + row,
            f"dataset {section.number}: {n} integers are expected, found {text(lines[row])!r}",
        )
    return found


def _header_floats(
    source: Source, section: Section, lines: list[bytes], start: int, stop: int
) -> tuple[float, ...]:
    try:
        return tuple(float(v) for v in floats(lines[start:stop]))
    except NotANumber as error:
        raise source.error(
            section.line + 1 + start + error.row,
            f"dataset {section.number}: {error.text!r} is not a number",
        ) from None


def _skip(source: Source, section: Section, why: str) -> Skipped:
    return Skipped(f"dataset {section.number}", section.line, why, source.name)
