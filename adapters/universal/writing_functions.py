"""Print functions of any kind (datasets 58 and 58b) as they were read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ...core.errors import InputError
from .content import Function
from .functions import KINDS, QUANTITIES
from .layout58 import records
from .printing import DELIMITER, text_line, tight
from .writing_frfs import axis_line, numbers, spacing


def function_datasets(functions: Sequence[Function], binary: bool, single: bool) -> Iterator[bytes]:
    """Print each function; its numbers are those of the file it came from.

    Raises
    ------
    InputError
        Values that are not finite: the format cannot say so.
    """
    for f in functions:
        x, values = f.abscissa, f.values
        if not (np.isfinite(x).all() and np.isfinite(values).all()):
            raise InputError(
                f"the {f.kind} of node {f.response[0]} holds values that are not finite numbers; "
                "a universal file cannot say so"
            )
        start, step, even = spacing(x)
        kind = (5 if single else 6) if np.iscomplexobj(values) else (2 if single else 4)
        number = b"    58"
        if binary:
            size = len(x) * sum(records(kind, even)[0])
            number += b"b%6d%6d%12d%12d%6d%6d%12d%12d" % (1, 2, 11, size, 0, 0, 0, 0)
        yield DELIMITER + number + b"\n"
        yield b"".join(text_line(t) for t in (*f.ids, *["NONE"] * 5)[:5])
        yield b"%5d%10d%5d%10d %10s%10d%4d %10s%10d%4d\n" % (
            _number(KINDS, f.kind), 0, 1, 0, b"NONE", *f.response, b"NONE", *f.reference,
        )  # fmt: skip
        form = b"%10d%10d%10d" % (kind, len(x), int(even))
        yield form + (tight(start) + tight(step) if even else tight(0.0) * 2) + tight(0.0) + b"\n"
        over, quantity, per = (_number(QUANTITIES, q) for q in (f.over, f.quantity, f.per))
        yield axis_line(over, 0, 0, "NONE", f.abscissa_unit)
        yield axis_line(quantity, 0, 0, "NONE", f.ordinate_unit)
        yield axis_line(per, 0, 0, "NONE", "NONE") + axis_line(0, 0, 0, "NONE", "NONE")
        yield from numbers(x, values, even, single, binary)
        yield DELIMITER


def _number(names: Mapping[int, str], said: str) -> int:
    """Return the number of a name, also of one that has no name (``function type 41``)."""
    for number, name in names.items():
        if name == said:
            return number
    last = said.rsplit(" ", 1)[-1]
    return int(last) if last.lstrip("-").isdigit() else 0
