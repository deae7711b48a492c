"""Values at nodes as datasets 55 and 2414 list them, and their checks."""

from collections.abc import Sequence

import numpy as np

from ....core.arrays import Floats, Ints
from ..text.number_fields import NotANumber, floats, node_numbers
from .section_lines import Lines


def node_values(lines: Lines, width: int) -> tuple[Ints, Floats]:
    """Node numbers (n,) and their values (n, width); each node takes the same number of lines."""
    first, body = lines.at, lines.lines[lines.at :]
    if not body:
        return np.zeros(0, np.int64), np.zeros((0, width))
    with lines.numbers(first):
        rows = _rows(body, width)
    stride = 1 + (rows or 1)
    if rows is None or len(body) % stride:
        raise lines.error(
            first + len(body) // stride * stride,
            f"a node needs its number and {width} values on line(s) of their own; the file is "
            "cut off or damaged, export it again",
        )
    with lines.numbers(first, stride, "a node number is expected, found {}"):
        nodes = node_numbers(body[0::stride])
    data = [text_line for k, text_line in enumerate(body) if k % stride]
    try:
        values = floats(data)
    except NotANumber as error:
        node, row = divmod(error.row, rows)
        raise lines.error(
            first + node * stride + 1 + row,
            f"{error.text!r} is not a number; remove node {nodes[node]} from the test or export "
            "the file again",
        ) from None
    if len(values) != width * len(nodes):
        k = _first_short(data, rows, width)
        why = f"node {nodes[k]} does not have {width} values; export the file again"
        raise lines.error(first + 1 + k * stride, why)
    values = values.reshape(-1, width)
    wrong = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if len(wrong):
        raise lines.error(
            first + 1 + int(wrong[0]) * stride,
            f"the shape is not a finite number at node {nodes[wrong[0]]}; remove that node from "
            "the test or export it again",
        )
    unique, counts = np.unique(nodes, return_counts=True)
    if len(unique) < len(nodes):
        raise lines.error(-1, f"it gives node {unique[counts > 1][0]} twice")
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


def _first_short(data: Sequence[bytes], rows: int, width: int) -> int:
    """Which node is the first with a wrong number of values."""
    for k in range(len(data) // rows):
        if len(floats(data[k * rows : (k + 1) * rows])) != width:
            return k
    return 0
