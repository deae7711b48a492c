"""DMIG matrices of punch files and bulk data."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Ints, Numbers
from ....core.errors import Place
from ....core.files import reading
from ..deck.bulk import cut, fields_of
from ..deck.card_definition import Fields
from ..deck.logical_lines import Line
from ..text.real_numbers import parse_real
from .dmig_punched import parts, punched_columns
from .exported_matrix import RECTANGULAR, SYMMETRIC, DofMap, NastranMatrix, symmetrised

_WIDE = 72
_LETTERLESS = (b"D", b"E")


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
    lines = part.split(b"\n")
    for start, stop, card in _cards(lines, path, number):
        _take(card, path, number + start, found, lines[start:stop])


def _cards(lines: list[bytes], path: Path, number: int) -> Iterable[tuple[int, int, Fields | None]]:
    """Yield line range and fields of each DMIG card; no fields where it is in punched form."""
    at = 0
    count = len(lines)
    while at < count:
        if lines[at][:4].upper() != b"DMIG" or lines[at][4:5].isalpha():
            at += 1
            continue
        start = at
        at += 1
        while at < count and (lines[at][:1] in (b"*", b"+", b" ", b",", b"$") or not lines[at]):
            at += 1
        block = lines[start:at]
        punched = lines[start][:5].upper() == b"DMIG*" and all(
            x[:8] == b"*       " and x[8:].strip() for x in block[1:]
        )
        if punched and b"," not in lines[start] and b"\t" not in b"".join(block):
            yield start, at, None
        else:
            yield start, at, _fields(block, path, number + start)


def _fields(block: list[bytes], path: Path, start: int) -> Fields:
    text = [Line(x.decode("latin-1"), 0, start + k + 1) for k, x in enumerate(block)]
    cards = list(cut(text, (path,)))
    return fields_of(cards[0].lines)


def _take(
    card: Fields | None,
    path: Path,
    start: int,
    found: dict[str, Entries],
    block: list[bytes],
) -> None:
    try:
        if card is None:
            _punched(block, found)
        elif len(card) > 2 and card[2] == "0":
            words = [*card, *[None] * 10]
            name = str(card[1]).upper()
            if name in found and found[name].rows:
                raise Place(path, start + 1).error(
                    f"matrix {name} begins a second time: give the file of one run"
                )
            polar = int(words[6] or 0) > 0
            found[name] = Entries(int(words[3] or 1), int(words[4] or 2), polar)
        else:
            _general(card, found)
    except (ValueError, IndexError):
        raise Place(path, start + 1).error("this DMIG card cannot be read") from None
    except LookupError:
        name = (card[1] if card else block[0][8:24].decode("latin-1").strip()) or ""
        raise Place(path, start + 1).error(
            f"DMIG {name} has a column before its header card"
        ) from None


def _punched(block: list[bytes], found: dict[str, Entries]) -> None:
    """One column in large field: a line ``DMIG* NAME GJ CJ``, then ``* GI CI A [B]`` each."""
    head = block[0].ljust(_WIDE)
    name = head[8:24].decode("latin-1").strip().upper()
    if head[24:40].strip() == b"0" and not head[56:72].strip() and len(block) == 1:
        raise ValueError(name)
    entries = found[name]
    column = 8 * int(head[24:40]) + int(head[40:56] or 0)
    lines = block[1:]
    if not lines:
        return
    points = [int(x[8:24]) for x in lines]
    components = [int(x[24:40].strip() or 0) for x in lines]
    values: Numbers = np.array([_number(x[40:56]) for x in lines])
    if entries.is_complex:
        values = values + 1j * np.array([_number(x[56:72]) for x in lines])
    entries.rows.append(8 * np.array(points, np.int64) + np.array(components, np.int64))
    entries.columns.append(np.full(len(lines), column, np.int64))
    entries.values.append(values)


def _number(field: bytes) -> float:
    field = field.strip()
    if not field:
        return 0.0
    try:
        return float(field.replace(b"D", b"E"))
    except ValueError:
        return parse_real(field.decode("latin-1"))


def _general(card: Fields, found: dict[str, Entries]) -> None:
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
