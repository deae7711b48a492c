"""Dataset 82: trace lines."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from ..container import Section
from ..open_file import Source
from ..text.number_fields import integers, text
from ..text.printing import dataset, text_line
from ..universal_content import Trace
from .dataset_kind import DatasetKind, Gathered, Outgoing
from .elements import are_elements
from .section_lines import filled

_COLOR = 11
_PER_LINE = 8


def _read(source: Source, section: Section, into: Gathered) -> int:
    """Read dataset 82: one trace line by the book, several one after another from some."""
    lines = filled(source, section)
    traces, at = [], 0
    while at < len(lines):
        head = integers(lines[at])
        if len(head) < 2 or at + 1 >= len(lines):
            raise source.error(
                section.line + 1 + at,
                "dataset 82: a trace line must start with its number and how many nodes it has",
            )
        name, nodes = text(lines[at + 1]), list[int]()
        first = at
        at += 2
        while len(nodes) < head[1] and at < len(lines):
            nodes += integers(lines[at])
            at += 1
        if len(nodes) < head[1]:
            raise source.error(
                section.line + 1 + first,
                f"dataset 82: trace line {head[0]} announces {head[1]} nodes but has {len(nodes)}",
            )
        color = head[2] if len(head) > 2 else 0
        traces.append(Trace(head[0], name, color, np.array(nodes[: head[1]], np.int64)))
        while at < len(lines) and not any(integers(lines[at])):
            at += 1  # some programs pad with lines of zeros
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
