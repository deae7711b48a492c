"""The lines of a deck in the order Nastran sees them, each with its file and line number."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from ....core.errors import Place
from ..text.deck_text import DeckText, read_deck_text

_PART = re.compile(r"BEGIN (?:BULK )?SUPER ?=? ?(\d+)")
_AUXILIARY = re.compile(r"BEGIN (?:BULK )?(?:AUXMODEL|ARBMODEL) ?=? ?(\d+)")
_LEFT_OUT = -1


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
    parts : dict
        Lines of the superelements (BEGIN SUPER) by their numbers.
    warnings : tuple of str
        Files that INCLUDE names ahead of CEND and that are not there; parts left out.
    """

    files: tuple[Path, ...]
    executive: tuple[Line, ...]
    case: tuple[Line, ...]
    bulk: tuple[Line, ...]
    parts: dict[int, tuple[Line, ...]]
    warnings: tuple[str, ...] = ()


def read_sections(source: Path | DeckText) -> Sections:
    """Read a deck and all its INCLUDE files, and divide it at CEND, BEGIN BULK and ENDDATA.

    A file with neither CEND nor BEGIN BULK is taken as bulk data alone.

    Raises
    ------
    InputError
        A file that cannot be read, an INCLUDE that names no file or includes itself.
    """
    deck = source if isinstance(source, DeckText) else read_deck_text(source)
    path = deck.files[0].path if isinstance(source, DeckText) else source
    lines = list(_lines(deck))
    files = [f.path for f in deck.files]
    marks = {"CEND": -1, "BEGIN": -1}
    starts: list[tuple[int, int]] = []
    told: list[str] = []
    for k, line in enumerate(lines):
        if line.text.lstrip()[:4].upper() not in ("CEND", "BEGI"):
            continue
        head = line.text[:80].split("$", 1)[0].upper().split()
        if head and head[0].startswith("CEND") and marks["CEND"] < 0 > marks["BEGIN"]:
            marks["CEND"] = k
        elif head and head[0] == "BEGIN" and marks["BEGIN"] < 0:
            marks["BEGIN"] = k
        if part := _PART.match(" ".join(head)):
            starts.append((k, int(part[1])))
        elif _AUXILIARY.match(" ".join(head)):
            starts.append((k, _LEFT_OUT))
            told.append(
                f"{Place(files[line.file], line.number)}: {line.text.strip()!r} starts a model "
                "of its own (auxiliary, of shapes or a cross section); it is left out"
            )
        elif head[:1] == ["BEGIN"] and head[1:] and not (head[1][:4] == "BULK" and not head[2:]):
            raise Place(files[line.file], line.number).error(
                f"{line.text.strip()!r} starts a part of the deck that trueup does not read "
                "(an auxiliary model or similar)"
            )
    cend, begin = marks["CEND"], marks["BEGIN"]
    if cend >= 0 > begin:
        raise Place(path).error("there is CEND but no BEGIN BULK: the deck is not complete")
    executive, case = lines[: max(cend, 0)], lines[cend + 1 : max(begin, 0)]
    ends = [*(k for k, _ in starts), len(lines)]
    parts = {
        number: tuple(lines[k + 1 : end])
        for (k, number), end in zip(starts, ends[1:], strict=True)
        if number != _LEFT_OUT
    }
    bulk = lines[begin + 1 : ends[0]]
    told += [
        f"{place}: the INCLUDE file {name!r} does not exist; ahead of CEND nothing is needed"
        for place, name in deck.absent
    ]
    return Sections(tuple(files), tuple(executive), tuple(case), tuple(bulk), parts, tuple(told))


def _lines(deck: DeckText) -> Iterator[Line]:
    texts = [_texts(f.data) for f in deck.files]
    for file, first, stop in deck.stretches:
        yield from (Line(texts[file][row], file, row + 1) for row in range(first, stop))


def _texts(data: bytes) -> list[str]:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return re.split(r"\r\n|\n|\r", text)
