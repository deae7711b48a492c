"""Print frequency responses (datasets 58 and 58b)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from ...core.arrays import Floats, Numbers
from ...core.dofs import Dofs
from ...core.errors import InputError
from ...core.frfs import Frfs
from .digits import print_lines
from .layout58 import records
from .printing import DELIMITER, text_line, tight

_QUANTITIES = {"displacement": (8, 1, "NONE"), "velocity": (11, 1, "NONE"),
               "acceleration": (12, 1, "NONE")}  # fmt: skip
_LETTERS = ("X", "Y", "Z", "RX", "RY", "RZ")


def frf_datasets(
    frfs: Frfs, systems: Mapping[int, Floats], binary: bool, single: bool
) -> Iterator[bytes]:
    """Print each measured combination; nodes in `systems` have displacement axes of their own."""
    x = frfs.frequencies_hz
    start, step, even = spacing(x)
    kind = 5 if single else 6
    responses = _directions(frfs.responses, systems)
    references = _directions(frfs.references, systems)
    form = b"%10d%10d%10d" % (kind, len(x), int(even))
    form += (tight(start) + tight(step) if even else tight(0.0) * 2) + tight(0.0) + b"\n"
    quantity = _QUANTITIES[frfs.quantity]
    axes = axis_line(18, 0, 0, "Frequency", "Hz") + axis_line(
        *quantity[:1], 1, 0, "NONE", quantity[2]
    )
    axes += axis_line(13, 0, 1, "NONE", "NONE") + axis_line(0, 0, 0, "NONE", "NONE")
    number = b"    58"
    if binary:
        size = len(x) * sum(records(kind, even)[0])
        number += b"b%6d%6d%12d%12d%6d%6d%12d%12d" % (1, 2, 11, size, 0, 0, 0, 0)
    for i, response in enumerate(responses):
        for j, reference in enumerate(references):
            values = frfs.values[i, j]
            if np.isnan(values).all():
                continue
            if not np.isfinite(values).all():
                raise InputError(
                    f"response {_name(*response)} to {_name(*reference)} holds values that are "
                    "not finite numbers; a universal file cannot say so"
                )
            names = f"{_name(*response)}/{_name(*reference)}"
            yield DELIMITER + number + b"\n"
            yield b"".join(text_line(t) for t in (names, "NONE", "NONE", "NONE", "NONE"))
            yield b"%5d%10d%5d%10d %10s%10d%4d %10s%10d%4d\n" % (
                4, 0, 1, 0, b"NONE", *response, b"NONE", *reference,
            )  # fmt: skip
            yield form + axes
            yield from numbers(x, values, even, single, binary)
            yield DELIMITER


def numbers(x: Floats, values: Numbers, even: bool, single: bool, binary: bool) -> Iterator[bytes]:
    """Print or pack the numbers of a function, real or complex."""
    if binary:
        yield _packed(x, values, even, single)
    else:
        yield from _printed(x, values, even, single)


def spacing(x: Floats) -> tuple[float, float, bool]:
    """Start and step as they will be read, and whether they give the axis again."""
    if len(x) == 1:
        return float(x[0]), 0.0, float(tight(x[0])) == x[0]
    step = (x[-1] - x[0]) / (len(x) - 1)
    start, step = float(tight(x[0])), float(tight(step))
    again = start + step * np.arange(len(x))
    return start, step, bool(np.abs(again - x).max() <= 1e-9 * np.abs(x).max())


def _directions(dofs: Dofs, systems: Mapping[int, Floats]) -> list[tuple[int, int]]:
    """Node and signed direction of each dof within its node's displacement system."""
    found = []
    for node, component, axis in zip(
        dofs.node.tolist(), dofs.component.tolist(), dofs.axis, strict=True
    ):
        own = systems.get(node, np.eye(3))[(component - 1) % 3]
        found.append((node, component if own @ axis > 0.0 else -component))
    return found


def _name(node: int, direction: int) -> str:
    return f"{node}:{'-' if direction < 0 else '+'}{_LETTERS[abs(direction) - 1]}"


def axis_line(kind: int, length: int, force: int, label: str, unit: str) -> bytes:
    """Return a record that describes an axis: quantity, exponents, label and unit."""
    name, said = (w.encode("latin-1", "replace")[:20] for w in (label, unit))
    return b"%10d%5d%5d%5d %-20s %-20s\n" % (kind, length, force, 0, name, said)


def _packed(x: Floats, values: Numbers, even: bool, single: bool) -> bytes:
    letter = "c" if np.iscomplexobj(values) else "f"
    size = (4 if single else 8) * (2 if letter == "c" else 1)
    ordinates = values.astype(f"<{letter}{size}")
    if even:
        return ordinates.tobytes()
    layout = np.dtype([("x", "<f4"), ("y", ordinates.dtype)])  # by the book, x is single
    table = np.empty(len(x), layout)
    table["x"], table["y"] = x, ordinates
    return table.tobytes()


def _printed(x: Floats, values: Numbers, even: bool, single: bool) -> Iterator[bytes]:
    parts = np.ascontiguousarray(values).view(np.float64)
    if even:
        yield from print_lines(parts, 13, 5, 6) if single else print_lines(parts, 20, 12, 4)
        return
    n = 2 if np.iscomplexobj(values) else 1
    number = "%13.5E" if single else "%20.12E"
    lines = []
    per_line = {(1, True): 3, (1, False): 2, (2, True): 2, (2, False): 1}[n, single]
    rows = parts.reshape(-1, n).tolist()
    for k, (abscissa, row) in enumerate(zip(x.tolist(), rows, strict=True), 1):
        end = "\n" if k % per_line == 0 or k == len(rows) else ""
        lines.append(tight(abscissa).decode() + "".join(number % v for v in row) + end)
    yield "".join(lines).encode("ascii")
