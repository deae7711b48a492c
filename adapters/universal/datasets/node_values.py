"""Values at nodes as datasets 55 and 2414 list them, and their checks."""

from collections.abc import Sequence

import numpy as np

from ....core.arrays import Floats, Ints
from ..container import Section
from ..open_file import Source
from ..text.number_fields import NotANumber, floats, node_numbers


def node_values(
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
