"""The lines of a deck in the order Nastran sees them, each with its file and line number."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from ...core.errors import InputError
from .editing.includes import locate_include, parse_include

_LONGEST_INCLUDE = 60


class Line(NamedTuple):
    """One line of the deck: its text without the line end, file index, line number from 1."""

    text: str
    file: int
    number: int


@dataclass(frozen=True, eq=False)
class Sections:
    """A deck's lines by section, INCLUDE files put in place.

    Parameters
    ----------
    files : tuple of Path
        The main deck first, then the included files in the order met.
    executive, case, bulk : tuple of Line
        Lines of each section, without CEND, BEGIN BULK, ENDDATA and what follows it.
    """

    files: tuple[Path, ...]
    executive: tuple[Line, ...]
    case: tuple[Line, ...]
    bulk: tuple[Line, ...]


def read_sections(path: Path) -> Sections:
    """Read a deck and all its INCLUDE files, and divide it at CEND, BEGIN BULK and ENDDATA.

    A file with neither CEND nor BEGIN BULK is taken as bulk data alone.

    Raises
    ------
    InputError
        A file that cannot be read, an INCLUDE that names no file or includes itself.
    """
    files: list[Path] = []
    lines: list[Line] = []
    _expand(Path(path), files, (), None, lines)
    marks = {"CEND": -1, "BEGIN": -1}
    for k, line in enumerate(lines):
        head = line.text[:80].split("$", 1)[0].upper().split()
        if head and head[0].startswith("CEND") and marks["CEND"] < 0 > marks["BEGIN"]:
            marks["CEND"] = k
        elif head and head[0] == "BEGIN" and marks["BEGIN"] < 0:
            marks["BEGIN"] = k
        if head and head[0] == "BEGIN" and not _is_bulk(head):
            raise InputError(
                f"{files[line.file]} line {line.number}: {line.text.strip()!r} starts a part of "
                "the deck that trueup does not read (superelement or similar): "
                "give the assembled deck"
            )
    cend, begin = marks["CEND"], marks["BEGIN"]
    if cend >= 0 > begin:
        raise InputError(f"{path}: there is CEND but no BEGIN BULK: the deck is not complete")
    case_start = cend + 1
    bulk = tuple(_until_enddata(lines[begin + 1 :]))
    case = lines[case_start:begin] if begin >= 0 else []
    return Sections(tuple(files), tuple(lines[: max(cend, 0)]), tuple(case), bulk)


def _is_bulk(head: list[str]) -> bool:
    return len(head) == 1 or (len(head) == 2 and head[1].startswith("BULK"))


def _until_enddata(lines: list[Line]) -> list[Line]:
    for k, line in enumerate(lines):
        if line.text[:7].upper() == "ENDDATA":
            return lines[:k]
    return lines


def _read_text(path: Path, asked: str) -> list[str]:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"{asked}cannot read {path}: {error.strerror}") from None
    if b"\0" in data[:4096]:
        raise InputError(f"{asked}{path} is not a text file: a Nastran deck is expected")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return re.split(r"\r\n|\n|\r", text)


def _expand(
    path: Path, files: list[Path], parents: tuple[Path, ...], asked: str | None, lines: list[Line]
) -> bool:
    """Append the lines of a file and of what it includes; return whether ENDDATA was met.

    Nastran reads nothing after it: an INCLUDE down there may name a file that does not exist.
    """
    texts = _read_text(path, "" if asked is None else f"{asked}: ")
    file = len(files)
    files.append(path)
    parents = (*parents, path.resolve())
    k = 0
    while k < len(texts):
        head = texts[k][:7].upper()
        if head != "INCLUDE" or texts[k][7:8].isalnum():
            lines.append(Line(texts[k], file, k + 1))
            if head == "ENDDATA":
                return True
            k += 1
            continue
        here = f"{path} line {k + 1}"
        name, used = parse_include(texts[k : k + _LONGEST_INCLUDE], here)
        child = locate_include(name, path, files[0], here)
        if child.resolve() in parents:
            raise InputError(f"{here}: INCLUDE {name!r} includes itself")
        if _expand(child, files, parents, here, lines):
            return True
        k += used
    return False
