"""Cards as they stand in the deck: cut from its lines, and their fields cut from them."""

import re
from collections.abc import Iterable, Iterator
from itertools import zip_longest
from pathlib import Path
from typing import NamedTuple

from ....core.errors import Place
from .field_values import Fields
from .logical_lines import Line


class Raw(NamedTuple):
    """A card as it stands in the deck.

    Parameters
    ----------
    name : str
        In capitals, without the star of large fields.
    lines : list of str
        Its lines without comments.
    file, line : int
        Index of the file, number of the first line.
    part : int
        Which of several properties on one card (0: the first).
    """

    name: str
    lines: list[str]
    file: int
    line: int
    part: int = 0


_NAME = re.compile(r"[A-Z][A-Z0-9_/]*")
_SEPARATOR = re.compile(r"[,\t ]")


def cut(lines: Iterable[Line], files: tuple[Path, ...]) -> Iterator[Raw]:
    """Cut bulk data lines into cards.

    Continuations follow the card they continue, as preprocessors write them.

    Raises
    ------
    InputError
        A line that neither starts a card nor continues one, or with a symbol to be substituted.
    """
    current: Raw | None = None
    seen: set[str] = set()
    for line in lines:
        text = _uncommented(line, files)
        if not text:
            continue
        name = text[:8].rstrip()
        if name in seen or _NAME.fullmatch(name):
            seen.add(name)
            if current is not None:  # fixed fields from column 1, as most lines are
                yield current
            current = Raw(name, [text], line.file, line.number)
            continue
        if text[0] in "+* ,\t" and not _indented(text):
            if current is None:
                at = Place(files[line.file], line.number)
                raise at.error("a continuation without its card")
            current.lines.append(text)
            continue
        if current is not None:
            yield current
        text = _from_first_column(text)
        name = _SEPARATOR.split(text[:10], maxsplit=1)[0][:8].upper().rstrip("*")
        if not _NAME.fullmatch(name):
            raise Place(files[line.file], line.number).error(f"{name!r} is not a card's name")
        current = Raw(name, [text], line.file, line.number)
    if current is not None:
        yield current


def _uncommented(line: Line, files: tuple[Path, ...]) -> str:
    text = line.text.split("$", 1)[0].rstrip() if "$" in line.text else line.text.rstrip()
    if "%" in text:
        raise Place(files[line.file], line.number).error(
            f"{text.strip()!r}: symbols (%) are not substituted: give the deck with their values "
            "put in"
        )
    return text


def _indented(text: str) -> bool:
    """Whether a line that starts with a blank holds a card's name within its first field."""
    head = text[:8].strip()
    return text[0] == " " and bool(head) and head[0] not in "+*,"


def _from_first_column(text: str) -> str:
    """Return a card set in a little with its name in column 1, fixed fields in their columns."""
    bare = text.lstrip()
    if len(bare) == len(text) or "," in bare[:10]:
        return bare
    text = text.expandtabs()
    return text[:8].strip().ljust(8) + text[8:]


def fields_of(lines: list[str]) -> Fields:
    """Return a card's fields, name first, eight a line, None where blank, none blank at the end."""
    if len(lines) == 1 and not any(mark in lines[0] for mark in ",*\t"):
        line = lines[0]
        fields: Fields = [line[i : i + 8].strip() or None for i in range(0, min(len(line), 72), 8)]
        fields[0] = fields[0].upper() if fields[0] else None
        while fields and fields[-1] is None:
            fields.pop()
        return fields
    fields = []
    for k, line in enumerate(lines):
        if "," in line[:10]:
            part = line.split(",")
            wide = 4 if "*" in part[0] else 8
            part = [*part[: wide + 1], *[""] * (wide + 1 - len(part))]
        else:
            text = line.expandtabs() if "\t" in line else line
            if "*" in text[:8]:
                part = [text[:8], text[8:24], text[24:40], text[40:56], text[56:72]]
            else:
                part = [text[i : i + 8] for i in range(0, 72, 8)]
        fields.extend([f.strip() or None for f in (part if k == 0 else part[1:])])
    if fields and fields[0]:
        fields[0] = fields[0].rstrip("*").upper()
    while fields and fields[-1] is None:
        fields.pop()
    return fields


def columns_of(cards: list[list[str]]) -> list[list[str]]:
    """Return the fields of many cards column by column, without the name's."""
    rows = [lines[0] for lines in cards]
    text = "".join(rows)
    if max(map(len, cards)) > 1 or any(mark in text for mark in ",*\t"):
        return [[cell or "" for cell in c] for c in zip_longest(*map(fields_of, cards))][1:]
    return [[row[k : k + 8] for row in rows] for k in range(8, min(max(map(len, rows)), 72), 8)]
