"""Materials that depend on temperature: MATT1, MATT2, MATT8, MATT9 at the initial temperature."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....core.errors import InputError, Place
from ..deck.bulk import Bulk
from ..deck.card_definition import Card, Known, Values
from ..deck.field_values import FieldError, Fields, take
from ..deck.read_deck import Deck
from ..text.real_numbers import parse_real

Key = tuple[str, int]

_MATERIALS = {
    "MATT1": "E,G,NU,RHO,A,-,GE,ST,SC,SS",
    "MATT2": "G11,G12,G13,G22,G23,G33,RHO,A1,A2,A3,-,GE,ST,SC,SS",
    "MATT8": "E1,E2,NU12,G12,G1Z,G2Z,RHO,A1,A2,-,XT,XC,YT,YC,S,GE,F12",
    "MATT9": "G11,G12,G13,G14,G15,G16,G22,G23,G24,G25,G26,G33,G34,G35,G36,G44,G45,G46,G55,G56,G66,"
    "RHO,A1,A2,A3,A4,A5,A6,-,GE",
}
"""Cards that name a table for each field of the material of the same number."""


def read_points(fields: Fields, _: Known) -> tuple[tuple[float, ...], ...]:
    """Read x and y of a table; pairs with SKIP are left out."""
    pairs = [(k, fields[k : k + 2]) for k in range(9, _end(fields), 2)]
    kept = [k for k, pair in pairs if "SKIP" not in [str(text).upper() for text in pair]]
    x, y = ([take(fields, k + i, f"{name}:r!") for k in kept] for i, name in enumerate("xy"))
    if not x:
        raise FieldError(9, "x", "must be given")
    return tuple(x), tuple(y)


def _coefficients(fields: Fields, _: Known) -> tuple[tuple[float, ...]]:
    return (tuple(take(fields, k, "A:r=0.") for k in range(9, _end(fields))),)


def _end(fields: Fields) -> int:
    words = [str(text).upper() for text in fields]
    if "ENDT" not in words:
        raise FieldError(len(fields), "ENDT", "is missing at the end of the table")
    return words.index("ENDT")


def _table(number: int, layout: str, more: Callable[[Fields, Known], Any], extra: str) -> Card:
    layout = f"TID:i! {layout}"
    return Card(f"TABLEM{number}", layout, "tid", more=more, extra=extra)


_TABLES = (
    _table(1, "XAXIS:w=LINEAR YAXIS:w=LINEAR", read_points, "x y"),
    _table(2, "X1:r=0. EXTRAP:i=0", read_points, "x y"),
    _table(3, "X1:r! X2:r! EXTRAP:i=0", read_points, "x y"),
    _table(4, "X1:r! X2:r! X3:r! X4:r!", _coefficients, "a"),
)

CARDS = (
    *(Card(name, f"MID:i! {row}>tables:i=0", "mid") for name, row in _MATERIALS.items()),
    *_TABLES,
    Card("TEMP", "SID:i! [G>nodes:i! T:r!]"),
    Card("TEMPD", "[SID:i! T:r!]"),
)


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
            value = factor if absolute else factor * parse_real(str(text))
            out.extend([None] * (index + 1 - len(out)))
            out[index] = repr(value)
        return out

    def applied(self, bulk: Bulk) -> Bulk:
        """Return the deck's cards with all materials at the temperature."""
        return bulk.replaced({k: self.fields(bulk, k, bulk.fields(*k)) for k in self.tables})


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
    for name in _MATERIALS:
        target = f"MAT{name[4:]}"
        fields = bulk.definitions[name].fields
        places = [k for k, field in enumerate(fields, 1) if field.attribute == "tables"]
        for mid, card in bulk.table(name).items():
            if mid not in bulk.table(target):
                raise bulk.place(name, mid).fault(f"has no {target} {mid} beside it")
            columns = {k: table for k, table in zip(places, card.tables, strict=True) if table > 0}
            if columns:
                tables[target, mid] = columns
    if number is None or not tables:
        return Thermal(0.0, {})
    return Thermal(_uniform(deck, number), tables)


def unused_tables(deck: Deck) -> tuple[str, ...]:
    """Say that materials follow a temperature, but that none is selected."""
    named = [name for name in _MATERIALS if deck.bulk.table(name)]
    if not named or deck.case.temperature is not None:
        return ()
    return (
        f"{deck.path}: {', '.join(named)} are not used: case control selects no temperature "
        "(TEMPERATURE(INITIAL), (MATERIAL) or (BOTH)); materials are as their own cards have them",
    )


def _uniform(deck: Deck, number: int) -> float:
    """Return the one temperature of a set: TEMP of the grids, TEMPD of those without."""
    own = {
        grid: (value, place)
        for card, place in deck.bulk.placed("TEMP")
        for grid, value in zip(card.nodes, card.t, strict=True)
        if card.sid == number
    }
    default = [
        (value, place)
        for card, place in deck.bulk.placed("TEMPD")
        for sid, value in zip(card.sid, card.t, strict=True)
        if sid == number
    ]
    covered = own and all(grid in own for grid in deck.bulk.table("GRID"))
    values = dict([*own.values(), *([] if covered else default)])
    if not values:
        raise Place(deck.path).error(
            f"case control asks for the temperature set {number}, but the deck has "
            "no TEMP or TEMPD of that set"
        )
    if len(values) > 1:
        shown = " and ".join(f"{v:g} in {place}" for v, place in list(values.items())[:2])
        raise InputError(
            f"materials depend on temperature and the initial temperatures differ ({shown}): only "
            "one temperature for all grids is supported"
        )
    return float(next(iter(values)))


def _value(bulk: Bulk, table: int, x: float, asked_by: Key) -> tuple[float, bool]:
    """Value of a TABLEMi, and whether it replaces the field (TABLEM1) or multiplies it."""
    found = bulk.find([card.name for card in _TABLES], table)
    if found is None:
        raise bulk.place(f"MATT{asked_by[0][3:]}", asked_by[1]).fault(
            f"refers to table {table}, but there is no TABLEM1, TABLEM2, TABLEM3 or TABLEM4 {table}"
        )
    name, card = found
    value = _EVALUATE[name](card, x)
    if not np.isfinite(value):
        raise bulk.place(name, table).error(f"has no finite value at the temperature {x:g}")
    return value, name == "TABLEM1"


def interpolated(card: Values, x: float) -> float:
    """Return y of a table at x: linear between its points and beyond the ends."""
    xs, ys = np.array(card.x), np.array(card.y)
    if len(xs) == 1:
        return float(ys[0])
    k = int(np.clip(np.searchsorted(xs, x) - 1, 0, len(xs) - 2))
    if xs[k + 1] == xs[k]:
        return float(0.5 * (ys[k] + ys[k + 1]))
    return float(ys[k] + (ys[k + 1] - ys[k]) * (x - xs[k]) / (xs[k + 1] - xs[k]))


def _polynomial(card: Values, x: float) -> float:
    t = (min(max(x, card.x3), card.x4) - card.x1) / card.x2
    return float(sum(a * t**i for i, a in enumerate(card.a)))


def _on_axes(card: Values, x: float) -> float:
    """Value of a TABLEM1, of which each axis may be logarithmic."""
    across, up = card.xaxis == "LOG", card.yaxis == "LOG"
    with np.errstate(divide="ignore", invalid="ignore"):
        card = card._replace(
            x=np.log(card.x) if across else card.x, y=np.log(card.y) if up else card.y
        )
        value = interpolated(card, float(np.log(x)) if across else x)
    return float(np.exp(value)) if up else value


def _held(card: Values, x: float) -> float:
    """Value of a TABLEM2 or TABLEM3, which may keep its end values beyond its points."""
    return interpolated(card, float(np.clip(x, min(card.x), max(card.x))) if card.extrap else x)


_EVALUATE: Mapping[str, Callable[[Values, float], float]] = {
    "TABLEM1": _on_axes,
    "TABLEM2": lambda card, x: _held(card, x - card.x1),
    "TABLEM3": lambda card, x: _held(card, (x - card.x1) / card.x2),
    "TABLEM4": _polynomial,
}
