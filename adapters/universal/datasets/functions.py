"""Dataset 58 and 58b: one function at a nodal degree of freedom."""

import math
from collections import Counter
from dataclasses import dataclass
from typing import Any

from ..container import Section
from ..open_file import Source
from ..text.layout58 import HEADER_LINES, form
from ..text.number_fields import integers, numbers_of, text
from ..universal_content import UniversalContent
from .dataset_kind import DatasetKind, Gathered
from .dof_names import dofs_of
from .function_names import KINDS
from .section_lines import Lines
from .write_functions import write_functions


@dataclass(frozen=True)
class Axis:
    """What an axis of a function shows (records 8 to 11)."""

    quantity: int = 0
    label: str = ""
    unit: str = ""


@dataclass(frozen=True, eq=False)
class Head58:
    """The eleven header lines of a function."""

    section: Section
    ids: tuple[str, ...]
    function: int
    response: tuple[int, int]
    reference: tuple[int, int]
    ordinate_type: int
    n_point: int
    even: bool
    start: float
    step: float
    abscissa: Axis
    ordinate: Axis
    denominator: Axis
    data_at: int
    named: bool = False

    @property
    def kind(self) -> str:
        """What dataset 58 calls this type of function."""
        return KINDS.get(self.function, f"function type {self.function}")

    @property
    def is_complex(self) -> bool:
        """Whether the ordinates are complex."""
        return self.ordinate_type in (5, 6)


@dataclass(frozen=True, eq=False)
class Record:
    """The header of a function with the file it stands in."""

    source: Source
    head: Head58

    @property
    def where(self) -> str:
        """File and line of the dataset."""
        return f"{self.source.name} line {self.head.section.line}"


def _read(source: Source, section: Section, into: Gathered) -> int:
    head = read_head(source, section)
    if into.wanted.references is None or head.reference[0] in into.wanted.references:
        into.add(Record(source, head))
    if not section.closed:
        into.warnings.append(
            f"{source.name} line {section.line}: the file ends without the -1 that closes the "
            "last dataset"
        )
    return head.n_point


def read_head(source: Source, section: Section) -> Head58:
    """Read the header of a function.

    Raises
    ------
    InputError
        A header that is cut off, or whose counts are no numbers.
    """
    lines, data_at = source.head(section, HEADER_LINES)
    read = Lines(source, section, lines)
    if len(lines) < HEADER_LINES:
        raise read.error(
            -1,
            f"it is cut off: {len(lines)} of its {HEADER_LINES} header lines are there; "
            "export or copy the file again",
        )
    ids = tuple(text(line) for line in lines[:5])
    try:
        function, numbered, named = dofs_of(lines[5], ids)
    except ValueError:
        said = text(lines[5])
        raise read.error(5, f"{said!r} does not name a response and a reference") from None
    layout = form(lines[6])
    if not layout:
        raise read.error(6, "data type, count and spacing are expected")
    with read.numbers(6):
        steps = numbers_of(lines[6][30:], (13, 13, 13))
    steps = [*steps, 0.0, 0.0][: max(2, len(steps))]
    if layout[2] != 0 and not all(map(math.isfinite, steps[:2])):
        raise read.error(6, "its start or step is not a finite number")
    return Head58(
        section,
        ids,
        function,
        *named,
        ordinate_type=layout[0],
        n_point=layout[1],
        even=layout[2] != 0,
        start=steps[0],
        step=steps[1],
        abscissa=_axis(lines[7]),
        ordinate=_axis(lines[8]),
        denominator=_axis(lines[9]),
        data_at=data_at,
        named=named != numbered,
    )


def _axis(line: bytes) -> Axis:
    """Read a record that describes an axis: quantity, exponents, label, unit."""
    quantity = integers(line[:10])
    return Axis(quantity[0] if quantity else 0, text(line[25:46]), text(line[46:67]))


def _tell(content: UniversalContent) -> dict[str, Any]:
    told: dict[str, Any] = {}
    if content.frfs is not None:
        f = content.frfs
        told["frequency_responses"] = {
            "responses": len(f.responses),
            "references": len(f.references),
            "lines": len(f.frequencies_hz),
            "from_hz": float(f.frequencies_hz[0]),
            "to_hz": float(f.frequencies_hz[-1]),
            "quantity": f.quantity,
            "reference_dofs": f.references.labels,
        }
    if content.functions:
        told["other_functions"] = dict(Counter(f.kind for f in content.functions))
    return told


FUNCTIONS_58 = DatasetKind(
    58, "function at nodal dof", _read, _tell, write_functions, tells_own_end=True
)
