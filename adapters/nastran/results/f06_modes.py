"""Eigenvectors from the printed output (F06), the last resort: seven digits."""

import cmath
import math
import re
from pathlib import Path

from ....core.errors import Place
from ....core.files import reading
from ..text.real_numbers import parse_real
from .eigenvector_table import ModeTable
from .gather_vectors import Vector, tables_of

_VALUE = re.compile(r"\bEIGENVALUE =\s*([-+.\dE]+)")
_TITLE = re.compile(r"R E A L\s+E I G E N V E C T O R\s+N O \.\s+(\d+)")
_COMPLEX = re.compile(r"C O M P L E X\s+E I G E N V E C T O R\s+N ?O ?\.\s+(\d+)")
_ROOT = re.compile(r"COMPLEX EIGENVALUE =\s*([-+.\dE]+)\s*,\s*([-+.\dE]+)")
_SECOND_ROW = re.compile(r"^\s{14,}([-+.\dE]+(?:\s+[-+.\dE]+)*)\s*$")
_SUBCASE = re.compile(r"\bSUBCASE\s+(\d+)")
_SUPERELEMENT = re.compile(r"\bSUPERELEMENT\s+(\d+)")
_ROW = re.compile(r"^[0 ]\s*(\d+)\s+([GS])\s+(\S.*)$")
_SUMMARY = re.compile(r"R E A L\s+E I G E N V A L U E S")
_SUMMARY_ROW = re.compile(r"^\s+(\d+)\s+(\d+)" + r"\s+([-+.\dE]+)" * 5 + r"\s*$")


def is_f06(text: str) -> bool:
    """Whether the start of a file is that of Nastran's printed output."""
    capitals = text.upper()
    return "N A S T R A N" in capitals or "EXECUTIVE   CONTROL   ECHO" in capitals


def read_f06_tables(path: Path) -> tuple[list[ModeTable], tuple[str, ...]]:
    """Read all eigenvectors of an F06, real or complex.

    Returns
    -------
    tables : list of ModeTable
        In the displacement systems of the grids; eigenvalues and shapes with the seven digits
        that are printed.
    names : tuple of str
        What the file prints, for inspection.

    Raises
    ------
    InputError
        A file that cannot be read; a row of an eigenvector that is not one: the line.
    """
    with reading(path):
        lines = path.read_text("latin-1").splitlines()
    printed = _Printed(path)
    for k, line in enumerate(lines):
        printed.take(line, k)
    vectors = [v for v in printed.vectors if v.rows]
    return tables_of(vectors, path, printed.masses), tuple(printed.names)


class _Printed:
    """What has been met so far, line by line."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.names: dict[str, None] = {}
        self.masses: dict[int, float] = {}
        self.vectors: list[Vector] = []
        self._new_page()

    def _new_page(self) -> None:
        self.reading: Vector | None = None
        self.is_complex, self.polar = False, False
        self.in_summary = False
        self.subcase, self.superelement = 0, 0
        self.value: complex = 0.0

    def take(self, line: str, k: int) -> None:
        if line[:1] == "1":
            self._new_page()
        try:
            self._take(line, k)
        except ValueError:
            raise Place(self.path, k + 1).error("a number cannot be read") from None

    def _take(self, line: str, k: int) -> None:
        self._take_head(line)
        real, both = _TITLE.search(line), _COMPLEX.search(line)
        if found := real or both:
            self.is_complex = both is not None
            self.names[f"{'complex' if both else 'real'} eigenvectors"] = None
            self.reading = Vector(self.subcase, self.superelement, int(found[1]), self.value)
            self.vectors.append(self.reading)
        elif "(MAGNITUDE/PHASE)" in line:
            self.polar = True
        elif self.reading is not None:
            second = _SECOND_ROW.match(line) if self.is_complex else None
            if second is not None and self.reading.rows:
                _add_second(self.reading, second[1], self.polar)
            else:
                _add_row(self.reading, line, k, self.path)
        elif self.in_summary and (found := _SUMMARY_ROW.match(line)):
            self.masses[int(found[1])] = parse_real(found[6])

    def _take_head(self, line: str) -> None:
        if found := _SUBCASE.search(line[60:]):
            self.subcase = int(found[1])
        if found := _SUPERELEMENT.search(line):
            self.superelement = int(found[1])
        if _SUMMARY.search(line):
            self.in_summary, self.names["real eigenvalues"] = True, None
        elif found := _ROOT.search(line):
            self.value = complex(parse_real(found[1]), parse_real(found[2]))
        elif found := _VALUE.search(line):
            self.value = parse_real(found[1])


def _add_second(vector: Vector, text: str, polar: bool) -> None:
    """Put the imaginary parts, or the phases, of a point beside what its first line gave."""
    point, scalar, first = vector.rows[-1]
    second = [parse_real(v) for v in text.split()]
    if polar:
        turns = [cmath.rect(1.0, math.radians(b)) for b in second]
        row = tuple(a * turn for a, turn in zip(first, turns, strict=True))
    else:
        row = tuple(a + 1j * b for a, b in zip(first, second, strict=True))
    vector.rows[-1] = (point, scalar, row)


def _add_row(vector: Vector, line: str, k: int, path: Path) -> None:
    found = _ROW.match(line)
    if not found:
        return
    try:
        values = tuple(complex(parse_real(v)) for v in found[3].split())
    except ValueError:
        raise Place(path, k + 1).error("a row of an eigenvector cannot be read") from None
    point = int(found[1])
    if found[2] == "S":  # scalar points in a row are numbered one after another
        vector.rows += [(point + n, True, (v,)) for n, v in enumerate(values)]
    elif len(values) != 6:
        raise Place(path, k + 1).error(f"a grid has six components, not {len(values)}")
    else:
        vector.rows.append((point, False, values))
