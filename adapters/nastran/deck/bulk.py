"""Bulk data cards: cut from the lines, read by pyNastran's card classes, found by number."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple

from ...core.errors import InputError
from .catalogue import READ, SHARED_NUMBERS, Kind
from .continuations import in_order
from .lines import Line
from .raw_fields import Fields as Fields
from .raw_fields import as_pynastran_reads, not_finite
from .raw_fields import fields_of as fields_of
from .raw_fields import to_float as to_float

Card = Any
"""A card as pyNastran's class holds it, or its raw fields (a list of str or None)."""


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


@dataclass(frozen=True, eq=False)
class Bulk:
    """The cards of a deck.

    Parameters
    ----------
    files : tuple of Path
        What `Raw.file` counts.
    tables : mapping
        By card name, then by the card's number: for cards whose number is unique.
    lists : mapping
        By card name, in the deck's order: the others.
    raw : mapping
        By card name, the raw cards in the order of `tables` or `lists`.
    numbered : mapping
        By card name, then by number: the raw cards of `tables`.
    """

    files: tuple[Path, ...]
    tables: Mapping[str, Mapping[int, Card]]
    lists: Mapping[str, list[Card]]
    raw: Mapping[str, list[Raw]]
    numbered: Mapping[str, Mapping[int, Raw]]

    def table(self, name: str) -> Mapping[int, Card]:
        """Cards of one name by number; empty when the deck has none."""
        return self.tables.get(name, {})

    def listed(self, name: str) -> list[Card]:
        """Cards of one name whose numbers may repeat, in the deck's order."""
        return self.lists.get(name, [])

    def find(self, names: Iterable[str], number: int) -> tuple[str, Card] | None:
        """Return the first of several kinds of cards that has this number, with its name."""
        for name in names:
            card = self.tables.get(name, {}).get(number)
            if card is not None:
                return name, card
        return None

    def replaced(self, cards: Mapping[tuple[str, int], Card]) -> Bulk:
        """Return the deck with some numbered cards replaced."""
        tables = dict(self.tables)
        for name in {name for name, _ in cards}:
            tables[name] = {**tables[name], **{k: c for (n, k), c in cards.items() if n == name}}
        return replace(self, tables=tables)

    def place(self, name: str, number: int) -> str:
        """``CBAR 12 (models/wing.bdf line 40)``, for messages."""
        raw = self.numbered.get(name, {}).get(number)
        return f"{name} {number}" if raw is None else f"{name} {number} ({self.at(raw)})"

    def place_listed(self, name: str, index: int) -> str:
        """``SPC1 (wing.bdf line 40)``, for messages about cards without a number of their own."""
        return f"{name} ({self.at(self.raw[name][index])})"

    def at(self, raw: Raw) -> str:
        """``models/wing.bdf line 40``, the path as it was given."""
        return f"{self.files[raw.file]} line {raw.line}"


_NAME = re.compile(r"[A-Z][A-Z0-9_/]*")
_NUMBER = re.compile(r"-?\d+\.?\d*")
_SEPARATOR = re.compile(r"[,\t ]")


def cut(lines: Iterable[Line], files: tuple[Path, ...]) -> Iterator[Raw]:
    """Cut bulk data lines into cards.

    Continuations follow the card they continue, as preprocessors write them.

    Raises
    ------
    InputError
        A line that neither starts a card nor continues one; replicated cards.
    """
    current: Raw | None = None
    for line in lines:
        text = line.text.split("$", 1)[0].rstrip() if "$" in line.text else line.text.rstrip()
        if not text:
            continue
        if text[0] in "+* ,\t" and not _indented(text):
            if current is None:
                at = f"{files[line.file]} line {line.number}"
                raise InputError(f"{at}: a continuation without its card")
            current.lines.append(text)
            continue
        if current is not None:
            yield current
        text = _from_first_column(text)
        name = _SEPARATOR.split(text[:10], maxsplit=1)[0][:8].upper().rstrip("*")
        if not _NAME.fullmatch(name):
            what = "replication, which is not supported" if "=" in name else "not a card's name"
            raise InputError(f"{files[line.file]} line {line.number}: {name!r} is {what}")
        current = Raw(name, [text], line.file, line.number)
    if current is not None:
        yield current


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


class CardReader:
    """Turns raw cards into pyNastran's card objects; errors become one sentence with the place."""

    def __init__(self, files: tuple[Path, ...]) -> None:
        from pyNastran.bdf import bdf
        from pyNastran.bdf.bdf_interface.bdf_card import BDFCard

        self._classes = bdf
        self._card = BDFCard
        self._files = files
        self._defaults: dict[str, Card] = {}

    def set_default(self, name: str, card: Card) -> None:
        """Keep the BAROR or BEAMOR that later CBAR or CBEAM cards take their blanks from."""
        self._defaults[name] = card

    def read(self, raw: Raw, fields: Fields | None = None) -> Card:
        """Return the card object of one (part of a) raw card.

        Parameters
        ----------
        raw : Raw
            The card.
        fields : list of str or None, optional
            Fields to read instead of its own, for a card with other values.

        Raises
        ------
        InputError
            A field that does not hold what it should: file, line, card, field.
        """
        kind = READ[raw.name]
        fields = fields_of(raw.lines) if fields is None else fields
        if not kind.cls:
            return fields
        self._check_numbers(raw, fields)
        card = self._card(as_pynastran_reads(raw.name, fields), has_none=False)
        try:
            return self._make(kind, raw, card)
        except (
            SyntaxError, AssertionError, KeyError, ValueError, TypeError, IndexError, RuntimeError,
            AttributeError, NotImplementedError,
        ) as error:  # fmt: skip
            at = f"{self._files[raw.file]} line {raw.line}"
            number = fields[1] if len(fields) > 1 and fields[1] else ""
            raise InputError(f"{at}: {raw.name} {number}: {_reason(error)}") from None

    def _check_numbers(self, raw: Raw, fields: Fields) -> None:
        """Refuse words that Python would read as a number and Nastran would not."""
        k = not_finite(fields)
        if k is not None:
            at = f"{self._files[raw.file]} line {raw.line}"
            raise InputError(
                f"{at}: {raw.name} {fields[1]}: field {k + 1} holds {fields[k]!r}, which is not a "
                "finite number"
            )

    def _make(self, kind: Kind, raw: Raw, card: Any) -> Card:
        words = kind.cls.split()
        if len(words) == 3:  # a solid: corner nodes only, or midside nodes too
            cls = words[0] if card.nfields <= int(words[2]) else words[1]
            return getattr(self._classes, cls).add_card(card)
        cls = getattr(self._classes, kind.cls)
        if kind.stride:
            return cls.add_card(card, raw.part)
        if raw.name == "CBAR":
            return cls.add_card(card, baror=self._defaults.get("BAROR"))
        if raw.name == "CBEAM":
            return cls.add_card(card, beamor=self._defaults.get("BEAMOR"))
        return cls.add_card(card)


_NO_NUMBER = re.compile(r"(?:invalid literal for int|could not convert string to float).*?'(.*?)'")


def _reason(error: BaseException) -> str:
    """Boil a pyNastran message down to one sentence."""
    if isinstance(error, (KeyError, TypeError, IndexError, AttributeError)):
        return "the card cannot be read: a field is missing or of the wrong type"
    text = " ".join(line.strip() for line in str(error).splitlines() if line.strip())
    if "norm(" in text or "coords are colinear" in text.lower():
        return "its three points coincide or stand in a line"
    literal = re.search(
        r"(?:invalid literal for int|could not convert string to float).*?'(.*?)'", text
    )
    if literal:
        return f"{literal.group(1)!r} stands where a number belongs"
    text = re.split(r"\s*(?:card\s*=|\bfields?=\[|\['|BDFCard|\[\")", text)[0].strip(" ;:,")
    return text[:160] or "the card cannot be read"


def read_bulk(lines: Iterable[Line], files: tuple[Path, ...]) -> tuple[Bulk, dict[str, list[Raw]]]:
    """Read all cards that `catalogue.READ` names; return them and the raw others by name.

    Raises
    ------
    InputError
        A card that cannot be read; two cards of one kind with the same number.
    """
    with redirect_stdout(StringIO()):  # pyNastran prints before some of its errors
        return _read_bulk(lines, files)


def _read_bulk(lines: Iterable[Line], files: tuple[Path, ...]) -> tuple[Bulk, dict[str, list[Raw]]]:
    reader = CardReader(files)
    tables: dict[str, dict[int, Card]] = {}
    lists: dict[str, list[Card]] = {}
    kept: dict[str, list[Raw]] = {}
    numbered: dict[str, dict[int, Raw]] = {}
    others: dict[str, list[Raw]] = {}
    raws = list(cut(in_order(lines), files))
    for name in ("BAROR", "BEAMOR"):
        for raw in raws:
            if raw.name == name:
                reader.set_default(name, reader.read(raw))
    for raw in raws:
        kind = READ.get(raw.name)
        if kind is None:
            others.setdefault(raw.name, []).append(raw)
            continue
        _check_length(raw, files)
        fields = fields_of(raw.lines)
        for part in range(_parts(kind, fields)):
            this = raw._replace(part=part) if part else raw
            card = reader.read(this, fields)
            if kind.id:
                table = tables.setdefault(raw.name, {})
                number = _number(kind, card, table, this, files)
                places = numbered.setdefault(raw.name, {})
                if number in table:
                    _check_repeated(places[number], number, this, files)
                    continue
                table[number] = card
                places[number] = this
            else:
                lists.setdefault(raw.name, []).append(card)
            kept.setdefault(raw.name, []).append(this)
    _check_unique(numbered, files)
    return Bulk(files, tables, lists, kept, numbered), others


def _check_unique(numbered: Mapping[str, Mapping[int, Raw]], files: tuple[Path, ...]) -> None:
    """Refuse numbers that two kinds of cards share where only one can be meant."""
    for names in SHARED_NUMBERS:
        first: dict[int, Raw] = {}
        for name in names:
            for number, raw in numbered.get(name, {}).items():
                other = first.setdefault(number, raw)
                if other is not raw:
                    raise InputError(
                        f"{files[raw.file]} line {raw.line}: {raw.name} {number} has the number "
                        f"of {other.name} {number} ({files[other.file]} line {other.line}): give "
                        "one of them another"
                    )


def _check_length(raw: Raw, files: tuple[Path, ...]) -> None:
    """Refuse a line of free fields that holds more than a line can."""
    for k, line in enumerate(raw.lines):
        if line.count(",") < 9:
            continue
        label, *rest = line.split(",")[9:]
        if _NUMBER.fullmatch(label.strip()) or any(f.strip() for f in rest):
            raise InputError(
                f"{files[raw.file]} line {raw.line + k}: {raw.name} has more than eight values on "
                "a line: put what follows the eighth on the next line"
            )


def _parts(kind: Kind, fields: Fields) -> int:
    """How many properties stand on one card."""
    if not kind.stride:
        return 1
    starts = range(1, len(fields), kind.stride)
    return max(sum(1 for start in starts if fields[start] is not None), 1)


def _number(
    kind: Kind, card: Card, table: dict[int, Card], raw: Raw, files: tuple[Path, ...]
) -> int:
    """Return the card's number; where numbers may repeat, a negative one from the second on."""
    if kind.id != "#":
        return int(getattr(card, kind.id))
    text = card[1] if len(card) > 1 else None
    if text is None or not text.isdigit():
        at = f"{files[raw.file]} line {raw.line}"
        raise InputError(f"{at}: {raw.name} {text or ''}: its number must be an integer")
    return int(text) if int(text) not in table else -1 - len(table)


def _check_repeated(first: Raw, number: int, raw: Raw, files: tuple[Path, ...]) -> None:
    """Accept a card repeated word for word, as Nastran does."""
    if fields_of(first.lines) != fields_of(raw.lines):
        raise InputError(
            f"{files[raw.file]} line {raw.line}: {raw.name} {number} is defined twice, "
            f"first in {files[first.file]} line {first.line}: keep one of them"
        )
