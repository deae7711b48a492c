"""Materials that depend on temperature: MATT1, MATT2, MATT8, MATT9 at the initial temperature."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ...core.errors import InputError
from .cards import Bulk, Card, CardReader, Fields, fields_of, to_float
from .read import Deck

Key = tuple[str, int]

_TABLES = ("TABLEM1", "TABLEM2", "TABLEM3", "TABLEM4")
_MATERIALS = {"MATT1": "MAT1", "MATT2": "MAT2", "MATT8": "MAT8", "MATT9": "MAT9"}


@dataclass(frozen=True, eq=False)
class Thermal:
    """Tables by which materials follow the initial temperature.

    Parameters
    ----------
    temperature : float
        The one temperature of all grids.
    tables : mapping of Key to mapping of int to int
        By material card: which field (index) follows which table.
    """

    temperature: float
    tables: dict[Key, dict[int, int]]

    def fields(self, bulk: Bulk, key: Key, fields: Fields) -> Fields:
        """Return a material's fields at the temperature."""
        out = list(fields)
        for index, table in self.tables.get(key, {}).items():
            factor, absolute = _value(bulk, table, self.temperature, key)
            text = out[index] if index < len(out) else None
            if not absolute and text is None:
                continue
            value = factor if absolute else factor * to_float(str(text))
            out.extend([None] * (index + 1 - len(out)))
            out[index] = repr(value)
        return out

    def applied(self, bulk: Bulk) -> Bulk:
        """Return the deck's cards with all materials at the temperature."""
        reader = CardReader(bulk.files)
        changed: dict[Key, Card] = {}
        for key in self.tables:
            raw = bulk.numbered[key[0]][key[1]]
            changed[key] = reader.read(raw, self.fields(bulk, key, fields_of(raw.lines)))
        return bulk.replaced(changed) if changed else bulk


def read_thermal(deck: Deck) -> Thermal:
    """Find which materials follow the temperature that case control selects as initial.

    Raises
    ------
    InputError
        Temperatures that differ from grid to grid; a table or material that does not exist.
    """
    bulk = deck.bulk
    number = deck.case.temperature
    tables: dict[Key, dict[int, int]] = {}
    for name, target in _MATERIALS.items():
        for mid, card in bulk.table(name).items():
            if mid not in bulk.table(target):
                raise InputError(f"{bulk.place(name, mid)} has no {target} {mid} beside it")
            columns = {
                index: int(text)
                for index, text in enumerate(card[2:], start=2)
                if text is not None and text.isdigit() and int(text) > 0
            }
            if columns:
                tables[target, mid] = columns
    if number is None or not tables:
        return Thermal(0.0, {})
    return Thermal(_uniform(deck, number), tables)


def _uniform(deck: Deck, number: int) -> float:
    """Return the one temperature of a set: TEMP of the grids, TEMPD of those without."""
    own = {
        grid: (value, place)
        for fields, place in _placed(deck, "TEMP")
        for sid, grid, value in _grid_entries(fields, place)
        if sid == number
    }
    default = [
        (value, place)
        for fields, place in _placed(deck, "TEMPD")
        for sid, value in _entries(fields, place)
        if sid == number
    ]
    covered = own and all(grid in own for grid in deck.bulk.table("GRID"))
    values = dict([*own.values(), *([] if covered else default)])
    if not values:
        raise InputError(
            f"{deck.path}: case control asks for the temperature set {number}, but the deck has "
            "no TEMP or TEMPD of that set"
        )
    if len(values) > 1:
        shown = " and ".join(f"{v:g} in {place}" for v, place in list(values.items())[:2])
        raise InputError(
            f"materials depend on temperature and the initial temperatures differ ({shown}): only "
            "one temperature for all grids is supported"
        )
    return next(iter(values))


def _placed(deck: Deck, name: str) -> Iterator[tuple[Fields, str]]:
    for k, fields in enumerate(deck.bulk.listed(name)):
        yield fields, deck.bulk.place_listed(name, k)


def _grid_entries(fields: Fields, place: str) -> list[tuple[int, int, float]]:
    """(set, grid, temperature) of a TEMP card."""
    try:
        sid = int(str(fields[1]))
        pairs = zip(fields[2::2], fields[3::2], strict=False)
        return [(sid, int(str(g)), to_float(str(t))) for g, t in pairs if g is not None]
    except (IndexError, ValueError):
        raise InputError(f"{place}: a set, a grid or a temperature is not a number") from None


def _entries(fields: Fields, place: str) -> list[tuple[int, float]]:
    """(set, temperature) pairs of a TEMPD card."""
    try:
        pairs = zip(fields[1::2], fields[2::2], strict=False)
        return [(int(str(a)), to_float(str(b))) for a, b in pairs if a is not None]
    except (IndexError, ValueError):
        raise InputError(f"{place}: a set or a temperature is not a number") from None


def _value(bulk: Bulk, table: int, x: float, asked_by: Key) -> tuple[float, bool]:
    """Value of a TABLEMi, and whether it replaces the field (TABLEM1) or multiplies it."""
    found = bulk.find(_TABLES, table)
    if found is None:
        name = next(n for n, t in _MATERIALS.items() if t == asked_by[0])
        raise InputError(
            f"{bulk.place(name, asked_by[1])} refers to table {table}, but there is no TABLEM1, "
            f"TABLEM2, TABLEM3 or TABLEM4 {table}"
        )
    name, card = found
    return _EVALUATE[name](card, x), name == "TABLEM1"


def _interpolate(card: Card, x: float) -> float:
    """Linear between points and beyond the ends."""
    xs, ys = np.array(card.x, dtype=np.float64), np.array(card.y, dtype=np.float64)
    if len(xs) == 1:
        return float(ys[0])
    k = int(np.clip(np.searchsorted(xs, x) - 1, 0, len(xs) - 2))
    if xs[k + 1] == xs[k]:
        return float(0.5 * (ys[k] + ys[k + 1]))
    return float(ys[k] + (ys[k + 1] - ys[k]) * (x - xs[k]) / (xs[k + 1] - xs[k]))


def _polynomial(card: Card, x: float) -> float:
    x = min(max(x, float(card.x3)), float(card.x4))
    t = (x - float(card.x1)) / float(card.x2)
    return float(sum(a * t**i for i, a in enumerate(card.a)))


_EVALUATE: dict[str, Callable[[Card, float], float]] = {
    "TABLEM1": _interpolate,
    "TABLEM2": lambda card, x: _interpolate(card, x - float(card.x1)),
    "TABLEM3": lambda card, x: _interpolate(card, (x - float(card.x1)) / float(card.x2)),
    "TABLEM4": _polynomial,
}
