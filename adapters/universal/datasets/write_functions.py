"""Print frequency responses and other functions (datasets 58 and 58b)."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np

from ....core.arrays import Floats, Numbers
from ....core.data.dofs import Dofs
from ....core.data.frfs import Frfs
from ....core.errors import InputError
from ..text.layout58 import records
from ..text.print_columns import print_lines
from ..text.printing import DELIMITER, text_line, tight
from .dataset_kind import Outgoing
from .function_names import KINDS, QUANTITIES

_LETTERS = ("X", "Y", "Z", "RX", "RY", "RZ")


def write_functions(out: Outgoing) -> Iterator[bytes]:
    """Print frequency responses, each measured combination, and then the other functions.

    Nodes in `systems` have displacement axes of their own. The numbers of a function are those of
    the file it came from.

    Raises
    ------
    InputError
        Values that are not finite: the format cannot say so.
    """
    if out.frfs is not None:
        yield from _responses(out, out.frfs)
    for f in out.functions:
        words = (f.kind, f.over, f.quantity, f.per)
        names = (KINDS, QUANTITIES, QUANTITIES, QUANTITIES)
        kind, over, quantity, per = map(_number, names, words, f.codes)
        axes = _axis_line(over, unit=f.abscissa_unit) + _axis_line(quantity, unit=f.ordinate_unit)
        axes += _axis_line(per) + _axis_line(0)
        what = f"the {f.kind} of node {f.response[0]}"
        spaced = spacing(f.abscissa)
        head = (f.ids, kind, f.response, f.reference, axes)
        yield from _printed(out, what, head, f.abscissa, f.values, spaced)


def _responses(out: Outgoing, frfs: Frfs) -> Iterator[bytes]:
    spaced = spacing(frfs.frequencies_hz)
    responses, references = (_directions(d, out.systems) for d in (frfs.responses, frfs.references))
    axes = _axis_line(18, label="Frequency", unit="Hz")
    axes += _axis_line(_number(QUANTITIES, frfs.quantity, 0), length=1)
    axes += _axis_line(13, force=1) + _axis_line(0)
    for (i, response), (j, reference) in product(enumerate(responses), enumerate(references)):
        values = frfs.values[i, j]
        if np.isnan(values).all():
            continue
        names = _name(*response), _name(*reference)
        head = (("/".join(names),), 4, response, reference, axes)
        what = f"response {' to '.join(names)}"
        yield from _printed(out, what, head, frfs.frequencies_hz, values, spaced)


def _printed(
    out: Outgoing,
    what: str,
    head: tuple[Sequence[str], int, tuple[int, int], tuple[int, int], bytes],
    x: Floats,
    values: Numbers,
    spaced: tuple[float, float, bool],
) -> Iterator[bytes]:
    """Print a function; `head` is its text lines, type, response, reference and axes."""
    if not (np.isfinite(x).all() and np.isfinite(values).all()):
        raise InputError(
            f"{what} holds values that are not finite numbers; a universal file cannot say so"
        )
    (ids, function, response, reference, axes), (start, step, even) = head, spaced
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


def _axis_line(
    kind: int, length: int = 0, force: int = 0, label: str = "NONE", unit: str = "NONE"
) -> bytes:
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
