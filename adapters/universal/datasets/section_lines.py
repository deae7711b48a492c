"""The lines of a dataset as numbers; errors name file and line."""

from collections.abc import Sequence

import numpy as np

from ....core.arrays import Floats
from ..container import Section
from ..open_file import Source
from ..text.number_fields import NotANumber, floats, table


def filled(source: Source, section: Section) -> list[bytes]:
    """Return the lines without the blank ones at the end."""
    lines = source.lines(section)
    while lines and not lines[-1].strip(b" \t\x00"):
        lines.pop()
    return lines


def rows_of_numbers(
    source: Source,
    section: Section,
    lines: Sequence[bytes],
    widths: Sequence[int],
    stride: int,
    shift: int = 0,
) -> Floats:
    """Return a table (n_line, n_width) of finite numbers; line k is ``stride * k + shift``."""
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


def positions(source: Source, section: Section, lines: Sequence[bytes], at: int) -> list[float]:
    """Return the numbers of line `at`, none of them too large for a position."""
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
