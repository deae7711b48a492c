"""Eigenvectors from punch files, real or complex."""

import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

from ....core.errors import Place
from ....core.files import reading
from ..text.real_numbers import parse_real
from .eigenvector_table import ModeTable
from .gather_vectors import Row, Vector, tables_of

_EIGENVALUE = re.compile(
    r"\$(?:COMPLEX\s+)?EIGENVALUE\s*=\s*(?:\(?\s*)([-+.\dEeDd]+)(?:[\s,]+([-+.\dEeDd]+))?\s*\)?\s+"
    r"MODE\s*=\s*(\d+)"
)
_KINDS = ("$EIGENVECTOR", "$DISPLACEMENTS", "$COMPLEX EIGENVECTOR")


def is_punched_result(text: str) -> bool:
    """Whether the start of a file is that of punched results."""
    return "$TITLE" in text and "$SUBTITLE" in text and "$LABEL" in text


def read_punch_tables(path: Path) -> tuple[list[ModeTable], tuple[str, ...]]:
    """Read all eigenvectors of a punch file.

    Returns
    -------
    tables : list of ModeTable
        Numbers as printed: seven digits.
    names : tuple of str
        All kinds of results in the file, for inspection.

    Raises
    ------
    InputError
        A file that cannot be read, magnitudes and phases: the line.
    """
    with reading(path):
        lines = path.read_text("latin-1").splitlines()
    vectors: list[Vector] = []
    names: dict[str, None] = {}
    for head, at, body in _blocks(lines):
        kind = _kind(head)
        names[kind] = None
        match = next((m for line in head if (m := _EIGENVALUE.match(line))), None)
        if f"${kind}" not in _KINDS or match is None:
            continue
        if any(line.startswith("$MAGNITUDE") for line in head):
            raise Place(path, at).error("magnitudes and phases are not read: punch REAL or IMAG")
        vectors.append(_vector(head, match, body, at, path))
    return tables_of(vectors, path), tuple(names)


def _blocks(lines: list[str]) -> Iterator[tuple[list[str], int, list[str]]]:
    """Yield heads (lines with $), the line after them and what follows."""
    k = 0
    while k < len(lines):
        start = k
        while k < len(lines) and lines[k].startswith("$"):
            k += 1
        head = [line[:72].rstrip() for line in lines[start:k]]
        first = k
        while k < len(lines) and not lines[k].startswith("$"):
            k += 1
        if head:
            yield head, first + 1, lines[first:k]


def _kind(head: list[str]) -> str:
    """Return what the block is: the line after the label."""
    below = (after for line, after in pairwise(head) if line.startswith("$LABEL"))
    return next(below, head[0])[1:].strip()


def _integer(head: list[str], start: str) -> int:
    found = [line for line in head if line.startswith(start)]
    digits = re.search(r"=\s*(\d+)", found[0]) if found else None
    return int(digits[1]) if digits else 0


def _vector(head: list[str], match: re.Match[str], body: list[str], at: int, path: Path) -> Vector:
    is_complex = match[2] is not None or any(x.startswith("$REAL-IMAG") for x in head)
    value: complex = parse_real(match[1])
    if is_complex:
        value = complex(value, parse_real(match[2] or "0"))
    try:
        rows = list(_rows(body, is_complex))
    except (ValueError, IndexError):
        raise Place(path, at).error("the eigenvector that starts here cannot be read") from None
    return Vector(
        _integer(head, "$SUBCASE"), _integer(head, "$SUPERELEMENT"), int(match[3]), value, rows
    )


def _rows(body: list[str], is_complex: bool) -> Iterator[Row]:
    k = 0
    while k < len(body):
        if not body[k].strip():
            k += 1
            continue
        point, kind = int(body[k][:10]), body[k][10:18].strip()
        fields = _three(body[k])
        k += 1
        while k < len(body) and body[k].startswith("-CONT-"):
            fields += _three(body[k])
            k += 1
        if kind not in ("G", "S"):
            continue
        values = [parse_real(f.strip()) for f in fields if f.strip()]
        scalar = kind == "S"
        if is_complex:
            half = len(values) // 2
            row = tuple(complex(a, b) for a, b in zip(values[:half], values[half:], strict=True))
        else:
            row = tuple(complex(v) for v in values)
        yield point, scalar, row[:1] if scalar else row


def _three(line: str) -> list[str]:
    return [line[18:36], line[36:54], line[54:72]]
