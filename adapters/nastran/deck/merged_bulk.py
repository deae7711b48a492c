"""Cards of several bulk data sections in one: numbers that clash are changed."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from .bulk import Bulk
from .card_definition import Values

_SPACES = {
    "grid": "id nodes g gn gm refgrid groups ends gs scalars gj x",
    "element": "eid",
    "property": "pid",
    "material": "mid mid1 mid2 mid3 mid4 mids",
    "coordinate": "cp cd cid rid cordm mcid mcsid ocid theta",
    "table": "tid tables",
}
"""Attributes of cards that hold numbers of each kind."""

MANY = {space: f"{space}s" for space in _SPACES}
MANY |= {"property": "properties", "coordinate": "coordinate systems"}
_SPACE_OF = {name: space for space, names in _SPACES.items() for name in names.split()}
SHARED = ("property", "material", "coordinate", "table")
"""Kinds of numbers that may mean the same in several bulk data sections."""


class Numbers(NamedTuple):
    """New numbers of a part: those listed, others by adding `more` to them."""

    listed: Mapping[int, int]
    more: int = 0

    def __call__(self, number: int) -> int:
        """Return what a number became; 0 and less stay where they are not listed."""
        return self.listed.get(number, number + self.more if number > 0 else number)


def every_one(nodes: Any) -> Iterator[int]:
    """Yield the numbers of a list with those of its ranges."""
    for k in nodes:
        yield from k if isinstance(k, range) else (k,)


def scalar_points(part: Bulk) -> list[int]:
    """Return the numbers on SPOINT cards."""
    return [k for card in part.listed("SPOINT") for k in every_one(card.nodes)]


def highest_number(bulk: Bulk) -> int:
    """Return the highest number that a card or a scalar point has."""
    numbers = (max(table, default=0) for table in bulk.tables.values())
    return max((*numbers, *scalar_points(bulk)), default=0)


def clash(space: str, main: Bulk, part: Bulk, joints: Mapping[int, int]) -> bool:
    """Whether a part gives to a number another meaning than what is joined so far."""
    if space == "grid":
        taken = {*main.table("GRID"), *scalar_points(main)}
        return any(
            g in taken for g in (*part.table("GRID"), *scalar_points(part)) if g not in joints
        )
    for name, table in part.tables.items():
        if _SPACE_OF.get(part.definitions[name].number) != space:
            continue
        for number in table.keys() & main.table(name).keys():
            if space == "element" or table[number] != main.table(name)[number]:
                return True
        kinds = part.definitions[name].space
        others = (
            n for n, c in part.definitions.items() if kinds and c.space == kinds and n != name
        )
        if any(table.keys() & main.table(n).keys() for n in others):
            return True
    return False


def merged(main: Bulk, part: Bulk, numbers: Mapping[str, Numbers]) -> Bulk:
    """Add the cards of a part, in their new numbers, to what is joined so far."""
    tables, lists = dict(main.tables), dict(main.lists)
    raw, numbered = dict(main.raw), dict(main.numbered)
    fixed = set(main.renumbered)
    every = [*part.table("GRID"), *scalar_points(part)]
    for name, table in part.tables.items():
        definition = part.definitions[name]
        into, at = dict(tables.get(name, {})), dict(numbered.get(name, {}))
        for number, card in table.items():
            new = _renumbered(card, numbers, every)
            key = getattr(new, definition.number) if number > 0 else -1 - len(into)
            if name == "GRID" and key in into:
                into[key] = into[key]._replace(ps=_union(into[key].ps, new.ps))
                continue
            if key in into:
                continue
            into[key], at[key] = new, part.numbered[name][number]
            if new != card:
                fixed.add((name, key))
        tables[name], numbered[name] = into, at
        raw[name] = [at[key] for key in into]
    for name, cards in part.lists.items():
        new = [_renumbered(card, numbers, every) for card in cards]
        lists[name] = [*lists.get(name, []), *new]
        raw[name] = [*raw.get(name, []), *part.raw[name]]
    return replace(
        main, tables=tables, lists=lists, raw=raw, numbered=numbered, renumbered=frozenset(fixed)
    )


def _union(a: str | None, b: str | None) -> str | None:
    return "".join(sorted({*(a or ""), *(b or "")} - {"0"})) or None


def _renumbered(card: Values, numbers: Mapping[str, Numbers], every: list[int]) -> Values:
    """Return a card with other numbers of grids, elements, properties and so on."""
    changed = {
        name: _mapped(value, numbers[_SPACE_OF[name]], every)
        for name, value in zip(card._fields, card, strict=True)
        if name in _SPACE_OF and value is not None
    }
    return card._replace(**changed)


def _mapped(value: Any, number: Numbers, every: list[int]) -> Any:
    if isinstance(value, range):
        return tuple(number(k) for k in every if k in value)
    if isinstance(value, tuple):
        if any(isinstance(v, range) for v in value):
            value = tuple(k for v in value for k in (_within(v, every)))
        return tuple(_mapped(v, number, every) for v in value)
    return number(value) if isinstance(value, int) else value


def _within(value: Any, every: list[int]) -> tuple[int, ...]:
    return tuple(k for k in every if k in value) if isinstance(value, range) else (value,)
