"""Print frequency responses and other functions (datasets 58 and 58b)."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np

from ....core.arrays import Floats, Numbers
from ....core.data.dofs import Dofs
from ....core.errors import InputError
from ..text.layout58 import records
from ..text.print_columns import print_lines
from ..text.printing import DELIMITER, text_line, tight
from .dataset_kind import Outgoing
from .function_names import KINDS, QUANTITIES

_LETTERS = ("X", "Y", "Z", "RX", "RY", "RZ")


def frf_datasets(out: Outgoing) -> Iterator[bytes]:
    """Print each measured combination; nodes in `systems` have displacement axes of their own.

    Raises
    ------
    InputError
        Values that are not finite: the format cannot say so.
    """
    if out.frfs is None:
        return
    frfs, spaced = out.frfs, spacing(out.frfs.frequencies_hz)
    responses, references = (_directions(d, out.systems) for d in (frfs.responses, frfs.references))
    axes = _axis_line(18, 0, 0, "Frequency", "Hz")
    axes += _axis_line(_number(QUANTITIES, frfs.quantity, 0), 1, 0, "NONE", "NONE")
    axes += _axis_line(13, 0, 1, "NONE", "NONE") + _axis_line(0, 0, 0, "NONE", "NONE")
    for (i, response), (j, reference) in product(enumerate(responses), enumerate(references)):
        values = frfs.values[i, j]
        if np.isnan(values).all():
            continue
        name = f"{_name(*response)}/{_name(*reference)}"
        if not np.isfinite(values).all():
            raise InputError(
                f"response {name.replace('/', ' to ')} holds values that are not finite numbers; "
                "a universal file cannot say so"
            )
        yield from _printed(
            out, (name,), 4, response, reference, axes, frfs.frequencies_hz, values, spaced
        )


def function_datasets(out: Outgoing) -> Iterator[bytes]:
    """Print each function; its numbers are those of the file it came from.

    Raises
    ------
    InputError
        Values that are not finite: the format cannot say so.
    """
    for f in out.functions:
        if not (np.isfinite(f.abscissa).all() and np.isfinite(f.values).all()):
            raise InputError(
                f"the {f.kind} of node {f.response[0]} holds values that are not finite numbers; "
                "a universal file cannot say so"
            )
        words = (f.kind, f.over, f.quantity, f.per)
        names = (KINDS, QUANTITIES, QUANTITIES, QUANTITIES)
        kind, over, quantity, per = map(_number, names, words, f.codes)
        axes = _axis_line(over, 0, 0, "NONE", f.abscissa_unit)
        axes += _axis_line(quantity, 0, 0, "NONE", f.ordinate_unit)
        axes += _axis_line(per, 0, 0, "NONE", "NONE") + _axis_line(0, 0, 0, "NONE", "NONE")
        yield from _printed(
            out, f.ids, kind, f.response, f.reference, axes, f.abscissa, f.values,
            spacing(f.abscissa),
        )  # fmt: skip


def _printed(
    out: Outgoing,
    ids: Sequence[str],
    function: int,
    response: tuple[int, int],
    reference: tuple[int, int],
    axes: bytes,
    x: Floats,
    values: Numbers,
    spaced: tuple[float, float, bool],
) -> Iterator[bytes]:
    start, step, even = spaced
    kind = (2 if out.single else 4) + (np.iscomplexobj(values) and (3 if out.single else 2))
    number = b"    58"
    if out.binary:
        size = len(x) * sum(records(kind, even)[0])
        number += b"b%6d%6d%12d%12d%6d%6d%12d%12d" % (1, 2, 11, size, 0, 0, 0, 0)
    yield DELIMITER + number + b"\n"
    yield b"".join(text_line(t) for t in (*ids, *["NONE"] * 5)[:5])
    yield b"%5d%10d%5d%10d %10s%10d%4d %10s%10d%4d\n" % (
        function, 0, 1, 0, b"NONE", *response, b"NONE", *reference,
    )  # fmt: skip
    form = b"%10d%10d%10d" % (kind, len(x), int(even))
    yield form + (tight(start) + tight(step) if even else tight(0.0) * 2) + tight(0.0) + b"\n"
    yield axes
    if out.binary:
        yield _packed(x, values, even, out.single)
    else:
        yield from _text(x, values, even, out.single)
    yield DELIMITER


def _number(names: Mapping[int, str], said: str, code: int) -> int:
    """Return the number of a name, `code` where it has none."""
    return next((number for number, name in names.items() if name == said), code)


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


def _axis_line(kind: int, length: int, force: int, label: str, unit: str) -> bytes:
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


def _text(x: Floats, values: Numbers, even: bool, single: bool) -> Iterator[bytes]:
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
