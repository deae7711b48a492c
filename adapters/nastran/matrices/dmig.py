"""DMIG matrices of punch files and bulk data."""

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Ints, Numbers
from ....core.errors import Place
from ....core.files import reading
from ..deck.field_values import Fields
from ..deck.logical_lines import Line
from ..deck.raw_cards import cut, fields_of
from ..op4.exported_matrix import RECTANGULAR, SYMMETRIC, DofMap, NastranMatrix, symmetrised
from ..text.real_numbers import parse_real
from .dmig_punched import parts, punched_columns


class Entries:
    """The entries of one matrix as they are met: columns and rows as keys of a `DofMap`."""

    def __init__(self, form: int, kind: int, polar: bool = False) -> None:
        self.form, self.kind, self.polar = form, kind, polar
        self.columns: list[Ints] = []
        self.rows: list[Ints] = []
        self.values: list[Numbers] = []

    @property
    def is_complex(self) -> bool:
        """Whether the values have imaginary parts."""
        return self.kind in (3, 4)


def read_dmig(path: Path | str, names: Iterable[str] | None = None) -> tuple[NastranMatrix, ...]:
    """Read the DMIG matrices of a punch file or of a file of bulk data.

    Large-field cards as Nastran punches them are read at once; all other forms (small and free
    field, several entries on a card) card by card.

    Parameters
    ----------
    path : path
    names : iterable of str, optional
        Only these matrices.

    Returns
    -------
    tuple of NastranMatrix
        Each on its own set of degrees of freedom, in Nastran's order: those that occur in its
        rows or columns (equal for square matrices). What the punch leaves out is zero.

    Raises
    ------
    InputError
        A file that cannot be read, a card that is not one of DMIG's: the line.
    """
    path = Path(path)
    wanted = None if names is None else {n.upper() for n in names}
    found: dict[str, Entries] = {}
    with reading(path):
        for number, part in parts(path):
            if b"\0" in part[:4096]:
                raise Place(path).fault("is not a text file: a punch file is expected")
            _take_part(part, number, path, found)
    matrices = (
        matrix_of_entries(name, e) for name, e in found.items() if not wanted or name in wanted
    )
    return tuple(matrices)


def _take_part(part: bytes, number: int, path: Path, found: dict[str, Entries]) -> None:
    """Take some whole cards: all at once where they are as Nastran punches them."""
    punched = punched_columns(part, {name: e.is_complex for name, e in found.items()})
    if punched is not None:
        for name, (columns, rows, values) in punched.items():
            found[name].columns.append(columns)
            found[name].rows.append(rows)
            found[name].values.append(values)
        return
    for start, card in _cards(part.split(b"\n"), path, number):
        place = Place(path, number + start + 1)
        try:
            if len(card) > 2 and card[2] == "0":
                _begin(card, found, place)
            else:
                _column(card, found)
        except (ValueError, IndexError):
            raise place.error("this DMIG card cannot be read") from None
        except LookupError:
            raise place.error(f"DMIG {card[1]} has a column before its header card") from None


def _cards(lines: list[bytes], path: Path, number: int) -> Iterator[tuple[int, Fields]]:
    """Yield the first line and the fields of each DMIG card."""
    at = 0
    count = len(lines)
    while at < count:
        start, at = at, at + 1
        if lines[start][:4].upper() != b"DMIG" or lines[start][4:5].isalpha():
            continue
        while at < count and (lines[at][:1] in (b"*", b"+", b" ", b",", b"$") or not lines[at]):
            at += 1
        block = enumerate(lines[start:at], number + start + 1)
        card = next(cut([Line(x.decode("latin-1"), 0, k) for k, x in block], (path,)))
        yield start, fields_of(card.lines)


def _begin(card: Fields, found: dict[str, Entries], place: Place) -> None:
    """Take the card that says what a matrix is: NAME 0 IFO TIN TOUT POLAR."""
    words, name = [*card, *[None] * 10], str(card[1]).upper()
    if name in found and found[name].rows:
        raise place.error(f"matrix {name} begins a second time: give the file of one run")
    found[name] = Entries(int(words[3] or 1), int(words[4] or 2), int(words[6] or 0) > 0)


def _column(card: Fields, found: dict[str, Entries]) -> None:
    """Take a column in any form: NAME GJ CJ - G1 C1 A1 B1, then G2 C2 A2 B2 and so on."""
    entries = found[str(card[1]).upper()]
    column = 8 * int(card[2] or 0) + int(card[3] or 0)
    rest: Fields = list(card[5:])
    rows, values = [], []
    for k in range(0, len(rest), 4):
        point, component, real, imaginary = (*rest[k : k + 4], None, None, None)[:4]
        if point is None:
            if component is not None or real is not None:
                raise ValueError(card[1])
            continue
        rows.append(8 * int(point) + int(component or 0))
        value: complex = parse_real(real or "0.")
        if entries.is_complex:
            value += 1j * parse_real(imaginary or "0.")
        values.append(value)
    entries.rows.append(np.array(rows, np.int64))
    entries.columns.append(np.full(len(rows), column, np.int64))
    entries.values.append(np.array(values))


def matrix_of_entries(name: str, entries: Entries) -> NastranMatrix:
    """Put the entries of one matrix together, on the degrees of freedom that they name."""
    rows = np.concatenate([*entries.rows, np.zeros(0, np.int64)])
    columns = np.concatenate([*entries.columns, np.zeros(0, np.int64)])
    values = np.concatenate([*entries.values, np.zeros(0)])
    if entries.polar and entries.is_complex:  # magnitudes and phases in degrees
        values = values.real * np.exp(1j * np.deg2rad(values.imag))
    row_keys, column_keys = np.unique(rows), np.unique(columns)
    if entries.form not in (RECTANGULAR, 9):
        row_keys = column_keys = np.union1d(row_keys, column_keys)
    matrix = sp.coo_matrix(
        (values, (np.searchsorted(row_keys, rows), np.searchsorted(column_keys, columns))),
        shape=(len(row_keys), len(column_keys)),
    ).tocsc()
    if entries.form == SYMMETRIC:
        matrix = symmetrised(matrix)
    return NastranMatrix(
        name,
        matrix,
        entries.form,
        DofMap.of_keys(row_keys),
        DofMap.of_keys(column_keys),
        single=entries.kind in (1, 3),
    )
