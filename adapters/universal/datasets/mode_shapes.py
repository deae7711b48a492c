"""Datasets 55 and 2414: mode shapes at nodes."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from ....core.arrays import Ints, Numbers
from ....core.data.modes import Modes
from ..container import Section
from ..open_file import Source
from ..text.number_fields import floats, integers, text
from ..text.printing import dataset, text_line, tight
from ..universal_content import Skipped, UniversalContent
from .axis_components import node_vectors
from .dataset_kind import DatasetKind, Gathered, Outgoing
from .node_values import node_values
from .section_lines import Lines

_ANALYSES = {
    0: "unknown",
    1: "static",
    2: "normal mode",
    3: "complex eigenvalue, first order",
    4: "transient",
    5: "frequency response",
    6: "buckling",
    7: "complex eigenvalue, second order",
    9: "static non-linear",
}
_COMPLEX_MODES = (3, 7)
_HEADER = 16  # more lines than any header has
_DOUBTED = "its identification doubts that it is a mode"
_HUGE = 1e300  # some programs print the largest number there is where they know none


@dataclass(frozen=True, eq=False)
class Shape:
    """One mode shape as a dataset holds it.

    `values` is (n_node, 3 or 6), real or complex, along each node's displacement axes.
    """

    frequency_hz: float
    damping: float
    generalized_mass: float
    nodes: Ints
    values: Numbers
    ids: tuple[str, ...]
    line: int
    path: str

    @property
    def doubted(self) -> bool:
        """Whether the program that identified it doubts that it is a mode."""
        return _DOUBTED in self.ids


@dataclass(frozen=True)
class _Head:
    """What the header lines of either dataset say."""

    analysis: int
    specific: int
    data_type: int
    n_value: int
    reals: tuple[float, ...]
    ids: tuple[str, ...]
    n_line: int

    @classmethod
    def of(cls, lines: Lines, kind: int, ids: Sequence[int], reals: range) -> Self:
        """Read the line of kinds, lines of text and lines of reals."""
        found = _integers(lines, kind, 6)
        with lines.numbers(reals.start):
            numbers = tuple(floats(lines.lines[reals.start : reals.stop]).tolist())
        said = tuple(text(lines.lines[k]) for k in ids)
        return cls(found[1], found[3], found[4], found[5], numbers, said, reals.stop)


def _header(source: Source, section: Section, least: int) -> Lines:
    lines = Lines(source, section, source.head(section, _HEADER)[0])
    if len(lines.lines) < least:
        raise lines.error(-1, "it is cut off within its header")
    return lines


def _read_55(source: Source, section: Section, into: Gathered) -> Shape | Skipped | None:
    """Read dataset 55; anything but a mode shape with 3 or 6 values a node is skipped.

    None where a mode shape was not asked for: its values are not read.
    """
    lines = _header(source, section, 8)
    rows = max(1, math.ceil(_integers(lines, 6, 2)[1] / 6))
    head = _Head.of(lines, 5, range(5), range(7, 7 + rows))
    return _shape(source, section, head, _modal_55(head), into)


def _read_2414(source: Source, section: Section, into: Gathered) -> Shape | Skipped | None:
    """Read dataset 2414; as `_read_55`."""
    lines = _header(source, section, 13)
    if _integers(lines, 2, 1)[0] != 1:
        return _skip(source, section, "data not at nodes")
    head = _Head.of(lines, 8, (1, *range(3, 8)), range(11, 13))
    return _shape(source, section, head, _modal_2414(head), into)


def _modal_55(head: _Head) -> tuple[float, float, float]:
    """Frequency [Hz], damping ratio and modal mass of records 7 and 8 of dataset 55."""
    r = (*head.reals, 0.0, 0.0, 0.0, 0.0)
    if head.analysis in _COMPLEX_MODES:
        return *_of_eigenvalue(complex(r[0], r[1])), math.nan
    return r[0], _damping(r[2], r[3]), _known(r[1])


def _modal_2414(head: _Head) -> tuple[float, float, float]:
    """Frequency [Hz], damping ratio and modal mass of records 12 and 13 of dataset 2414."""
    r = (*head.reals, *[0.0] * 12)
    frequency, mass = r[1], _known(r[3])
    if head.analysis in _COMPLEX_MODES and (r[6] or r[7]):
        return *_of_eigenvalue(complex(r[6], r[7])), math.nan
    if frequency == 0.0 and r[2] > 0.0:
        frequency = math.sqrt(r[2]) / (2.0 * math.pi)
    return frequency, _damping(r[4], r[5]), mass


def _of_eigenvalue(pole: complex) -> tuple[float, float]:
    """Frequency [Hz] and damping ratio of an eigenvalue [rad/s]; no real part: not given."""
    size = abs(pole)
    return size / (2.0 * math.pi), (-pole.real / size if pole.real else math.nan)


def _damping(viscous: float, hysteretic: float) -> float:
    """Damping ratio; zero stands for not given. Structural damping is twice the ratio."""
    if viscous and abs(viscous) < _HUGE:
        return viscous
    return hysteretic / 2.0 if hysteretic and abs(hysteretic) < _HUGE else math.nan


def _known(value: float) -> float:
    """Return a positive number that is not a placeholder, else NaN."""
    return value if 0.0 < value < _HUGE else math.nan


def _shape(
    source: Source, section: Section, head: _Head, modal: tuple[float, float, float], into: Gathered
) -> Shape | Skipped | None:
    if head.analysis != 2 and head.analysis not in _COMPLEX_MODES:
        kind = _ANALYSES.get(head.analysis, f"analysis type {head.analysis}")
        return _skip(source, section, f"{kind} results are no modes")
    if head.specific not in (0, 1, 8, 11, 12):
        return _skip(source, section, f"specific data type {head.specific} is no motion")
    if head.n_value not in (3, 6):
        return _skip(source, section, f"{head.n_value} values a node where 3 or 6 are expected")
    what = f"dataset {section.number}:"
    if head.data_type not in (2, 4, 5, 6):
        why = f"{what} data type {head.data_type} is none of 2, 4, 5, 6"
        raise source.error(section.line, why)
    if not math.isfinite(modal[0]):
        raise source.error(section.line, f"{what} the frequency is not a number")
    if not into.next_shape_is_wanted():
        return None
    width = head.n_value * (2 if head.data_type in (5, 6) else 1)
    lines = Lines.filled(source, section)
    lines.at = head.n_line
    nodes, values = node_values(lines, width)
    if head.data_type in (5, 6):
        values = np.ascontiguousarray(values).view(np.complex128)
    return Shape(*modal, nodes, values, head.ids, section.line, source.name)


def _integers(lines: Lines, row: int, n: int) -> list[int]:
    found = integers(lines.lines[row])
    if len(found) < n:
        said = text(lines.lines[row])
        raise lines.error(row, f"{n} integers are expected, found {said!r}")
    return found


def _skip(source: Source, section: Section, why: str) -> Skipped:
    return Skipped(f"dataset {section.number}", section.line, why, source.name)


def _adding(
    read: Callable[[Source, Section, Gathered], Shape | Skipped | None],
) -> Callable[[Source, Section, Gathered], int]:
    def added(source: Source, section: Section, into: Gathered) -> int:
        shape = read(source, section, into)
        if isinstance(shape, Skipped):
            into.skipped.append(shape)
        elif shape is not None:
            into.add(shape)
            return len(shape.nodes)
        return 0

    return added


def _tell(content: UniversalContent) -> dict[str, Any]:
    m = content.modes
    if m is None:
        return {}
    return {
        "modes": {
            "number": len(m),
            "kind": "complex" if m.is_complex else "real",
            "nodes": len(set(m.dofs.node.tolist())),
            "values_per_node": int(m.dofs.component.max()),
            "frequencies_hz": m.frequencies_hz.tolist(),
        }
    }


def _write(out: Outgoing) -> Iterator[bytes]:
    """Print each mode as a dataset 55.

    Complex modes are written by their eigenvalue (analysis type 3), or as type 2 with complex
    data where modal masses are known, which type 3 has no place for.
    """
    modes, systems = out.modes, out.systems
    if modes is None:
        return
    nodes, vectors = node_vectors(modes.dofs, modes.shapes)
    for row, node in enumerate(nodes.tolist()):
        if node in systems:
            for half in range(vectors.shape[1] // 3):
                part = slice(3 * half, 3 * half + 3)
                vectors[row, part] = systems[node] @ vectors[row, part]
    width = vectors.shape[1]
    n_value = width * (2 if modes.is_complex else 1)
    lines = "".join("%13.5E" * min(6, n_value - k) + "\n" for k in range(0, n_value, 6))
    form = "".join(f"{node:10d}\n{lines}" for node in nodes.tolist())
    for k in range(len(modes)):
        values = np.ascontiguousarray(vectors[:, :, k])
        if modes.is_complex:
            values = values.view(np.float64)
        kind, head = _modal_lines(modes, k)
        ids = (modes.source or "NONE", "NONE", _DOUBTED if modes.doubted[k] else "NONE",
               f"mode {k + 1}", f"{modes.frequencies_hz[k]:.6f} Hz")  # fmt: skip
        yield dataset(
            55,
            *(text_line(said) for said in ids),
            b"%10d%10d%10d%10d%10d%10d\n"
            % (1, kind, 2 if width == 3 else 3, 8, 5 if modes.is_complex else 2, width),
            *head,
            (form % tuple(values.ravel().tolist())).encode("ascii"),
        )


def _modal_lines(modes: Modes, k: int) -> tuple[int, tuple[bytes, bytes]]:
    """Analysis type and records 7 and 8 of a mode."""
    frequency, damping = float(modes.frequencies_hz[k]), float(modes.damping[k])
    mass = float(modes.generalized_mass[k])
    known = [0.0 if math.isnan(v) else v for v in (damping, mass)]
    if modes.is_complex and math.isnan(mass) and abs(known[0]) < 1.0:
        omega = 2.0 * math.pi * frequency
        pole = (-known[0] * omega, omega * math.sqrt(1.0 - known[0] ** 2))
        reals = (*pole, 0.0, 0.0, 0.0, 0.0)
        return 3, (_printed(2, 6, 1, k + 1), b"".join(map(tight, reals)) + b"\n")
    reals4 = (frequency, known[1], known[0], 0.0)
    return 2, (_printed(2, 4, 1, k + 1), b"".join(map(tight, reals4)) + b"\n")


def _printed(*numbers: int) -> bytes:
    return b"".join(b"%10d" % n for n in numbers) + b"\n"


SHAPES_55 = DatasetKind(55, "data at nodes", _adding(_read_55), _tell, _write, vital=True)
SHAPES_2414 = DatasetKind(2414, "analysis data", _adding(_read_2414), vital=True)
