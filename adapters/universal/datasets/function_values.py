"""Dataset 58 and 58b: one function at a nodal degree of freedom."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ...core.arrays import Floats, Numbers
from .container import Section
from .dof_names import dofs_of
from .fields import NotANumber, integers, numbers_of, text
from .fixed import block
from .layout58 import HEADER_LINES, REALS, columns, form, records
from .legacy_floats import decode
from .source import Source

KINDS = {
    0: "general",
    1: "time response",
    2: "auto spectrum",
    3: "cross spectrum",
    4: "frequency response",
    5: "transmissibility",
    6: "coherence",
    7: "auto correlation",
    8: "cross correlation",
    9: "power spectral density",
    10: "energy spectral density",
    11: "probability density",
    12: "spectrum",
    13: "cumulative frequency distribution",
    14: "peaks valley",
    15: "stress/cycles",
    16: "strain/cycles",
    17: "orbit",
    18: "mode indicator function",
    19: "force pattern",
    20: "partial power",
    21: "partial coherence",
    22: "eigenvalue",
    23: "eigenvector",
    24: "shock response spectrum",
    25: "finite impulse response filter",
    26: "multiple coherence",
    27: "order function",
    28: "phase compensation",
}
QUANTITIES = {
    0: "unknown",
    1: "general",
    2: "stress",
    3: "strain",
    5: "temperature",
    6: "heat flux",
    8: "displacement",
    9: "reaction force",
    11: "velocity",
    12: "acceleration",
    13: "force",
    15: "pressure",
    16: "mass",
    17: "time",
    18: "frequency",
    19: "rpm",
    20: "order",
    21: "sound pressure",
    22: "sound intensity",
    23: "sound power",
}
_ENDS = (b"\n", b"\r")
_TAIL = 3  # line end and a stray byte between a binary block and the closing -1


@dataclass(frozen=True)
class Axis:
    """What an axis of a function shows (records 8 to 11)."""

    quantity: int = 0
    label: str = ""
    unit: str = ""


@dataclass(frozen=True, eq=False)
class Head58:
    """The eleven header lines of a function."""

    section: Section
    ids: tuple[str, ...]
    function: int
    response: tuple[int, int]
    reference: tuple[int, int]
    ordinate_type: int
    n_point: int
    even: bool
    start: float
    step: float
    abscissa: Axis
    ordinate: Axis
    denominator: Axis
    data_at: int
    named: bool = field(default=False)

    @property
    def kind(self) -> str:
        """What dataset 58 calls this type of function."""
        return KINDS.get(self.function, f"function type {self.function}")

    @property
    def is_complex(self) -> bool:
        """Whether the ordinates are complex."""
        return self.ordinate_type in (5, 6)


def read_head(source: Source, section: Section) -> Head58:
    """Read the header of a function.

    Raises
    ------
    InputError
        A header that is cut off, or whose counts are no numbers.
    """
    lines, data_at = source.head(section, HEADER_LINES)
    if len(lines) < HEADER_LINES:
        raise source.error(
            section.line,
            f"dataset 58 is cut off: {len(lines)} of its {HEADER_LINES} header lines are there; "
            "export or copy the file again",
        )
    ids = tuple(text(line) for line in lines[:5])
    try:
        function, numbered, named = dofs_of(lines[5], ids)
    except ValueError:
        raise source.error(
            section.line + 6,
            f"dataset 58: {text(lines[5])!r} does not name a response and a reference",
        ) from None
    layout = form(lines[6])
    if not layout:
        raise source.error(
            section.line + 7, "dataset 58: data type, count and spacing are expected"
        )
    try:
        steps = numbers_of(lines[6][30:], (13, 13, 13))
    except NotANumber as error:
        raise source.error(
            section.line + 7, f"dataset 58: {error.text!r} is not a number"
        ) from None
    steps = [*steps, 0.0, 0.0][: max(2, len(steps))]
    if layout[2] != 0 and not all(map(math.isfinite, steps[:2])):
        raise source.error(section.line + 7, "dataset 58: its start or step is not a finite number")
    return Head58(
        section,
        ids,
        function,
        *named,
        ordinate_type=layout[0],
        n_point=layout[1],
        even=layout[2] != 0,
        start=steps[0],
        step=steps[1],
        abscissa=_axis(lines[7]),
        ordinate=_axis(lines[8]),
        denominator=_axis(lines[9]),
        data_at=data_at,
        named=named != numbered,
    )


def read_values(source: Source, head: Head58) -> tuple[Floats, Numbers]:
    """Read the abscissa (n,) and the ordinates (n,), real or complex.

    Raises
    ------
    NotANumber
        A value that is no number; `row` counts lines after the header.
    ValueError
        Fewer or more values than the header announces, or a type that is not known.
    """
    check_size(source, head)
    x, parts = (_binary if head.section.binary else _text)(source, head)
    y = np.ascontiguousarray(parts).view(np.complex128)[:, 0] if head.is_complex else parts[:, 0]
    if x is None:
        x = head.start + head.step * np.arange(head.n_point)
    return x, y


def check_size(source: Source, head: Head58) -> None:
    """Check that a function can hold what its header announces, before room is made for it.

    Raises
    ------
    ValueError
        It cannot; says why.
    """
    if head.ordinate_type not in REALS:
        raise ValueError(f"ordinate data type {head.ordinate_type} is none of 2, 4, 5, 6")
    if head.n_point < 1:
        raise ValueError(f"it announces {head.n_point} points")
    if head.section.binary:
        _record(source, head)
        return
    want = head.n_point * (REALS[head.ordinate_type] + (not head.even))
    room = head.section.end - head.data_at
    if want > room:  # not even one character for each number
        raise ValueError(f"it announces {want} numbers in {room} bytes")
    if not head.section.closed and source.read(head.section.end - 1, head.section.end) not in _ENDS:
        raise ValueError("its last line is not whole")


def _text(source: Source, head: Head58) -> tuple[Floats | None, Floats]:
    n = REALS[head.ordinate_type]
    per_point = n if head.even else n + 1
    widths = columns(head.ordinate_type, head.even)
    want = head.n_point * per_point
    values, surplus = block(source.read, head.data_at, head.section.end, widths, want)
    if len(values) < want or surplus >= len(widths):
        raise ValueError(f"it announces {want} numbers and holds {len(values) + surplus}")
    table = values.reshape(-1, per_point)
    return (None, table) if head.even else (table[:, 0], table[:, 1:])


def _record(source: Source, head: Head58) -> tuple[int, ...]:
    """Bytes of the numbers of one point, as they fit the size of the block."""
    header = (*head.section.header, 0, 0, 0, 0)
    if header[0] not in (1, 2) or header[1] not in (1, 2, 3):
        raise ValueError(
            f"byte order {header[0]} or floating-point format {header[1]} is not known"
        )
    tail = source.read(max(head.data_at, head.section.end - _TAIL), head.section.end)
    room = head.section.end - head.data_at
    ends = range(room - len(tail) + len(tail.rstrip(b" \r\n")), room + 1)
    layouts = records(head.ordinate_type, head.even)
    fitting = [r for r in layouts if head.n_point * sum(r) in ends]
    record = fitting[0] if fitting else layouts[0]
    want = head.n_point * sum(record)
    padded = want < room and header[3] in ends
    if not fitting and not padded:
        raise ValueError(f"its {head.n_point} points take {want} bytes and it holds {room}")
    return record


def _binary(source: Source, head: Head58) -> tuple[Floats | None, Floats]:
    record = _record(source, head)
    big, form = head.section.header[0] == 2, head.section.header[1]
    size = head.n_point * sum(record)
    content = source.read(head.data_at, head.data_at + size)
    raw = np.frombuffer(content, np.uint8).reshape(head.n_point, -1)
    if head.even:
        return None, decode(raw.reshape(-1, record[0]), big, form).reshape(head.n_point, -1)
    numbers, at = [], 0
    for width in record:
        numbers.append(decode(raw[:, at : at + width], big, form))
        at += width
    return numbers[0], np.column_stack(numbers[1:])


def _axis(line: bytes) -> Axis:
    """Read a record that describes an axis: quantity, exponents, label, unit."""
    quantity = integers(line[:10])
    return Axis(quantity[0] if quantity else 0, text(line[25:46]), text(line[46:67]))
