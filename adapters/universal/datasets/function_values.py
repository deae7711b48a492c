"""The numbers of a dataset 58 or 58b."""

import numpy as np

from ....core.arrays import Floats, Numbers
from ..open_file import Source
from ..text.layout58 import REALS, columns, records
from ..text.legacy_floats import decode
from ..text.read_columns import block
from .functions import Head58

_ENDS = (b"\n", b"\r")
_TAIL = 3  # line end and a stray byte between a binary block and the closing -1


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
