"""Bulk data cards: cut from the lines, read by their definitions, found by number."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from ....core.errors import Place
from ....core.noun import Noun
from .card_definition import Card, FieldError, Fields, Values
from .continuations import in_order
from .logical_lines import Line
from .raw_fields import fields_of as fields_of


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
class Bulk(Noun):
    """The cards of a deck.

    Parameters
    ----------
    reader : CardReader
        How they are read.
    tables : mapping
        By card name, then by the card's number: for cards whose number is unique.
    lists : mapping
        By card name, in the deck's order: the others.
    raw : mapping
        By card name, the raw cards in the order of `tables` or `lists`.
    numbered : mapping
        By card name, then by number: the raw cards of `tables`.
    """

    reader: CardReader
    tables: Mapping[str, Mapping[int, Values]]
    lists: Mapping[str, list[Values]]
    raw: Mapping[str, list[Raw]]
    numbered: Mapping[str, Mapping[int, Raw]]

    @property
    def files(self) -> tuple[Path, ...]:
        """What `Raw.file` counts."""
        return self.reader.files

    @property
    def definitions(self) -> Mapping[str, Card]:
        """By card name: what it holds."""
        return self.reader.definitions

    def table(self, name: str) -> Mapping[int, Values]:
        """Cards of one name by number; empty when the deck has none."""
        return self.tables.get(name, {})

    def listed(self, name: str) -> list[Values]:
        """Cards of one name whose numbers may repeat, in the deck's order."""
        return self.lists.get(name, [])

    def find(self, names: Iterable[str], number: int) -> tuple[str, Values] | None:
        """Return the first of several kinds of cards that has this number, with its name."""
        for name in names:
            card = self.tables.get(name, {}).get(number)
            if card is not None:
                return name, card
        return None

    def replaced(self, fields: Mapping[tuple[str, int], Fields]) -> Bulk:
        """Return the deck with other fields on some numbered cards."""
        tables = dict(self.tables)
        for name in {name for name, _ in fields}:
            changed = {
                number: self.reader.read(self.numbered[name][number], new)
                for (n, number), new in fields.items()
                if n == name
            }
            tables[name] = {**tables[name], **changed}
        return replace(self, tables=tables)

    def fields(self, name: str, number: int) -> Fields:
        """Return the text of a card's fields, as the deck gives them."""
        return fields_of(self.numbered[name][number].lines)

    def place(self, name: str, number: int) -> Place:
        """``CBAR 12 (models/wing.bdf line 40)``, for messages."""
        raw = self.numbered.get(name, {}).get(number)
        card = f"{name} {number}"
        return Place(card=card) if raw is None else Place(self.files[raw.file], raw.line, card)

    def place_listed(self, name: str, index: int) -> Place:
        """``SPC1 (wing.bdf line 40)``, for messages about cards without a number of their own."""
        raw = self.raw[name][index]
        return Place(self.files[raw.file], raw.line, name)

    def at(self, raw: Raw) -> Place:
        """``models/wing.bdf line 40``, the path as it was given."""
        return self.reader.at(raw)


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
        name = text[:8].rstrip()
        if name.isalnum() and name.isupper() and text[:1].isalpha() and name.isascii():
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
            what = "replication, which is not supported" if "=" in name else "not a card's name"
            raise Place(files[line.file], line.number).error(f"{name!r} is {what}")
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


@dataclass(frozen=True, eq=False)
class CardReader:
    """Turns raw cards into values; errors become one sentence with the place.

    Parameters
    ----------
    files : tuple of Path
        What `Raw.file` counts.
    definitions : mapping
        By card name.
    defaults : mapping
        Fields of the cards that stand for blank ones, by their name (GRDSET, BAROR, BEAMOR).
    """

    files: tuple[Path, ...]
    definitions: Mapping[str, Card]
    defaults: Mapping[str, Fields]

    def at(self, raw: Raw) -> Place:
        """``models/wing.bdf line 40``, the path as it was given."""
        return Place(self.files[raw.file], raw.line)

    def read(self, raw: Raw, fields: Fields) -> Values:
        """Return the values of one (part of a) card.

        Parameters
        ----------
        raw : Raw
            The card.
        fields : list of str or None
            Its fields, or others to read in their place.

        Raises
        ------
        InputError
            A field that does not hold what it should: file, line, card, field.
        """
        card = self.definitions[raw.name]
        if card.several:
            first = 1 + raw.part * card.several
            fields = [raw.name, *fields[first : first + card.several]]
        if card.blanks_from in self.defaults:
            fields = _filled(card, fields, self.defaults[card.blanks_from])
        try:
            return card.read(fields)
        except FieldError as error:
            named = f"{raw.name} {fields[1]}" if len(fields) > 1 and fields[1] else raw.name
            column = error.index + 1 + card.several * raw.part
            what = f"{error.name} (field {column}) {error.what}" if error.name else error.what
            raise self.at(raw).error(f"{named}: {what}", named) from None


def _filled(card: Card, fields: Fields, default: Fields) -> Fields:
    """Fields with the blank ones taken from another card; those of one attribute go together."""
    width = max(len(fields), len(default))
    out = [*fields, *[None] * (width - len(fields))]
    given = {f.attribute for f, text in zip(card.fields, out[1:], strict=False) if text is not None}
    for k, (f, text) in enumerate(zip(card.fields, default[1:], strict=False), start=1):
        if f.attribute not in given:
            out[k] = text
    return out


def read_bulk(
    lines: Iterable[Line], files: tuple[Path, ...], definitions: Mapping[str, Card]
) -> tuple[Bulk, dict[str, list[Raw]]]:
    """Read all cards that have a layout; return them and the raw others by name.

    Raises
    ------
    InputError
        A card that cannot be read; two cards of one kind with the same number.
    """
    tables: dict[str, dict[int, Values]] = {}
    lists: dict[str, list[Values]] = {}
    kept: dict[str, list[Raw]] = {}
    numbered: dict[str, dict[int, Raw]] = {}
    others: dict[str, list[Raw]] = {}
    raws = list(cut(in_order(lines), files))
    wanted = {card.blanks_from for card in definitions.values()}
    defaults = {raw.name: fields_of(raw.lines) for raw in raws if raw.name in wanted}
    reader = CardReader(files, definitions, defaults)
    for raw in raws:
        card = definitions.get(raw.name)
        if card is None or card.ignored or card.refused:
            others.setdefault(raw.name, []).append(raw)
            continue
        _check_length(raw, reader)
        fields = fields_of(raw.lines)
        for part in range(_parts(card, fields)) if card.several else (0,):
            this = raw._replace(part=part) if part else raw
            values = reader.read(this, fields)
            if card.number:
                table = tables.setdefault(raw.name, {})
                places = numbered.setdefault(raw.name, {})
                number = getattr(values, card.number)
                if number in table:
                    if card.unique:
                        _check_repeated(places[number], number, this, reader)
                        continue
                    number = -1 - len(table)
                table[number] = values
                places[number] = this
            else:
                lists.setdefault(raw.name, []).append(values)
            kept.setdefault(raw.name, []).append(this)
    _check_spaces(numbered, reader)
    return Bulk(reader, tables, lists, kept, numbered), others


def _check_spaces(numbered: Mapping[str, Mapping[int, Raw]], reader: CardReader) -> None:
    """Refuse numbers that two kinds of cards share where only one can be meant."""
    first: dict[tuple[str, int], Raw] = {}
    for name, cards in numbered.items():
        space = reader.definitions[name].space
        for number, raw in cards.items() if space else ():
            other = first.setdefault((space, number), raw)
            if other is not raw:
                raise reader.at(raw).error(
                    f"{raw.name} {number} has the number of {other.name} {number} "
                    f"({reader.at(other)}): give one of them another",
                    f"{raw.name} {number}",
                )


def _check_length(raw: Raw, reader: CardReader) -> None:
    """Refuse a line of free fields that holds more than a line can."""
    for k, line in enumerate(raw.lines):
        if line.count(",") < 9:
            continue
        label, *rest = line.split(",")[9:]
        if _NUMBER.fullmatch(label.strip()) or any(f.strip() for f in rest):
            raise Place(reader.files[raw.file], raw.line + k).error(
                f"{raw.name} has more than eight values on a line: put what follows the eighth on "
                "the next line",
                raw.name,
            )


def _parts(card: Card, fields: Fields) -> int:
    """How many properties stand on one card."""
    if not card.several:
        return 1
    starts = range(1, len(fields), card.several)
    return max(sum(1 for start in starts if fields[start] is not None), 1)


def _check_repeated(first: Raw, number: int, raw: Raw, reader: CardReader) -> None:
    """Accept a card repeated word for word, as Nastran does."""
    if fields_of(first.lines) != fields_of(raw.lines):
        raise reader.at(raw).error(
            f"{raw.name} {number} is defined twice, first in {reader.at(first)}: keep one of them",
            f"{raw.name} {number}",
        )
