"""Dataset 82: trace lines."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from ..container import Section
from ..open_file import Source
from ..text.number_fields import integers
from ..text.printing import dataset, text_line
from ..universal_content import Trace
from .dataset_kind import DatasetKind, Gathered, Outgoing
from .elements import are_elements
from .section_lines import Lines

_COLOR = 11
_PER_LINE = 8


def _read(source: Source, section: Section, into: Gathered) -> int:
    """Read dataset 82: one trace line by the book, several one after another from some."""
    lines, traces = Lines.filled(source, section), list[Trace]()
    while lines.more():
        starts = "a trace line must start with its number and how many nodes it has"
        row, (number, count, *color) = lines.head(2, starts)
        if not lines.more():
            raise lines.error(row, starts)
        name, nodes = lines.name(), lines.gathered(count, integers)
        if len(nodes) < count:
            why = f"trace line {number} announces {count} nodes but has {len(nodes)}"
            raise lines.error(row, why)
        traces.append(Trace(number, name, (*color, 0)[0], np.array(nodes[:count], np.int64)))
        while lines.more() and not any(integers(lines.lines[lines.at])):
            lines.at += 1  # some programs pad with lines of zeros
    into.add(*traces)
    return len(traces)


def _write(out: Outgoing) -> Iterator[bytes]:
    """Print lines as trace lines: runs of one number, the pen lifted where they do not join."""
    geometry = out.geometry
    if geometry is None or are_elements(geometry) or not len(geometry.elements.get("line", ())):
        return
    ends = geometry.ids[geometry.elements["line"]]
    numbers = geometry.element_ids.get("line", np.ones(len(ends), np.int64))
    cuts = np.flatnonzero(np.diff(numbers)) + 1
    for start, stop in pairwise([0, *cuts.tolist(), len(ends)]):
        path: list[int] = []
        for a, b in ends[start:stop].tolist():
            if not path:
                path += [a, b]
            elif path[-1] == a:
                path.append(b)
            else:
                path += [0, a, b]
        rows = [path[k : k + _PER_LINE] for k in range(0, len(path), _PER_LINE)]
        yield dataset(
            82,
            b"%10d%10d%10d\n" % (int(numbers[start]), len(path), _COLOR),
            text_line("NONE"),
            *(b"".join(b"%10d" % node for node in row) + b"\n" for row in rows),
        )


TRACE_LINES = DatasetKind(82, "trace lines", _read, write=_write)
