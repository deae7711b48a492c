"""Bulk data cards: cut from the lines, read by their definitions, found by number."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain, groupby
from operator import attrgetter
from pathlib import Path

from ....core.errors import Place
from ....core.noun import Noun
from ..text.real_numbers import parse_real
from .card_definition import Card, Values
from .card_reading import read_card, read_columns
from .continuations import in_order, wrong_labels
from .field_values import FieldError, Fields
from .logical_lines import Line
from .raw_cards import Raw, columns_of, cut, fields_of
from .replication import written_out


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
    renumbered : frozenset of (name, number)
        Cards of superelements whose numbers are not those on the raw card.
    """

    reader: CardReader
    tables: Mapping[str, Mapping[int, Values]]
    lists: Mapping[str, list[Values]]
    raw: Mapping[str, list[Raw]]
    numbered: Mapping[str, Mapping[int, Raw]]
    renumbered: frozenset[tuple[str, int]] = frozenset()

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
        """Return the deck with other fields on some numbered cards.

        Raises
        ------
        InputError
            A field that does not hold what it should; a card that has another number than in its
            superelement.
        """
        if apart := sorted(self.renumbered & fields.keys()):
            raise self.place(*apart[0]).fault(
                "has a number that several superelements use, and cannot vary: give it its own"
            )
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

    def placed(self, name: str) -> Iterator[tuple[Values, Place]]:
        """Yield `listed`, each card with ``SPC1 (wing.bdf line 40)``, for messages about it."""
        for card, raw in zip(self.listed(name), self.raw.get(name, ()), strict=True):
            yield card, Place(self.files[raw.file], raw.line, name)

    def at(self, raw: Raw) -> Place:
        """``models/wing.bdf line 40``, the path as it was given."""
        return self.reader.at(raw)


_NUMBER = re.compile(r"-?\d+\.?\d*")


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
            return read_card(card, fields)
        except FieldError as error:
            named = f"{raw.name} {fields[1]}" if len(fields) > 1 and fields[1] else raw.name
            column = error.index + 1 + card.several * raw.part
            what = f"{error.name} (field {column}) {error.what}" if error.name else error.what
            raise self.at(raw).error(f"{named}: {what}", named) from None

    def read_all(self, run: list[Raw]) -> Iterator[tuple[Raw, Values]]:
        """Yield the cards of one name with their values, as `read` gives them, and quicker."""
        card, lines = self.definitions[run[0].name], [raw.lines for raw in run]
        if any("," in line for line in chain.from_iterable(lines)):
            for raw in run:
                _check_length(raw, self)
        values = None
        if not card.several and card.blanks_from not in self.defaults:
            values = read_columns(card, columns_of(lines), len(run))
        if values is not None:
            yield from zip(run, values, strict=True)
            return
        for raw in run:
            fields = fields_of(raw.lines)
            for part in range(_parts(card, fields)):
                this = raw._replace(part=part) if part else raw
                yield this, self.read(this, fields)


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
) -> tuple[Bulk, dict[str, list[Raw]], tuple[str, ...]]:
    """Read all cards that have a layout; return them, the raw others by name, and warnings.

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
    ordered = in_order(written_out(lines, files))
    raws = list(cut(ordered, files))
    wanted = {card.blanks_from for card in definitions.values()}
    defaults = {raw.name: fields_of(raw.lines) for raw in raws if raw.name in wanted}
    reader = CardReader(files, definitions, defaults)
    for name, run in groupby(raws, key=attrgetter("name")):
        card = definitions.get(name)
        if card is None or card.ignored or card.refused:
            others.setdefault(name, []).extend(run)
            continue
        held = kept.setdefault(name, [])
        for raw, values in reader.read_all(list(run)):
            if card.number:
                table, places = tables.setdefault(name, {}), numbered.setdefault(name, {})
                number = getattr(values, card.number)
                if number in table:
                    if card.unique:
                        _check_repeated(places[number], number, raw, reader)
                        continue
                    number = -1 - len(table)
                table[number] = values
                places[number] = raw
            else:
                lists.setdefault(name, []).append(values)
            held.append(raw)
    _check_spaces(numbered, reader)
    warnings = _labels_told(wrong_labels(ordered), files)
    return Bulk(reader, tables, lists, kept, numbered), others, warnings


def _labels_told(wrong: list[tuple[Line, str]], files: tuple[Path, ...]) -> tuple[str, ...]:
    """Say which continuations bear a wrong label: the first, and how many more."""
    if not wrong:
        return ()
    line, what = wrong[0]
    more = f" (and {len(wrong) - 1} more)" if wrong[1:] else ""
    return (
        f"{Place(files[line.file], line.number)}: the continuation {what}{more}; it is taken as "
        "the continuation of that line",
    )


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
    """Accept a card repeated with the same values, as Nastran does."""
    same = (_comparable(fields_of(lines), raw.name) for lines in (first.lines, raw.lines))
    if next(same) != next(same):
        raise reader.at(raw).error(
            f"{raw.name} {number} is defined twice, first in {reader.at(first)}: keep one of them",
            f"{raw.name} {number}",
        )


def _comparable(fields: Fields, name: str) -> list[float | str | None]:
    """Numbers of fields where they are such; a blank one of a grid is 0."""
    out: list[float | str | None] = []
    for text in fields:
        try:
            out.append(parse_real(text or ("0" if name == "GRID" else "")))
        except ValueError:
            out.append(text)
    while out and not out[-1]:
        out.pop()
    return out
