"""Scalar springs: CELAS1 ... CELAS4."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ....core.arrays import Ints
from ....core.assembly import Matrices
from ..cards import Bulk, Card
from .common import Context, Group, Key, numbered, property_of

_PAIR = np.array([[1.0, -1.0], [-1.0, 1.0]])

_PROPERTY: dict[str, tuple[str, str] | None] = {
    "CELAS1": ("PELAS", "k"),
    "CELAS2": None,
    "CELAS3": ("PELAS", "k"),
    "CELAS4": None,
}


def springs(context: Context) -> list[Group]:
    """Make the groups of springs between two degrees of freedom or one and the ground."""
    groups = []
    for name in _PROPERTY:
        groups.extend(scalar_groups(context, name, _PROPERTY[name], "k", kind=0))
    return groups


def scalar_groups(
    context: Context, name: str, via: tuple[str, str] | None, own: str, kind: int
) -> list[Group]:
    """Make the groups of scalar elements of one kind of card.

    Parameters
    ----------
    context : Context
        The deck.
    name : str
        Card name.
    via : (str, str) or None
        Property card and its attribute that hold the value; None where the element holds it.
    own : str
        Attribute of the element that holds the value.
    kind : {0, 1}
        Whether the value is a stiffness or a mass.
    """
    table = context.bulk.table(name)
    by_size: dict[int, list[tuple[Card, list[int]]]] = {1: [], 2: []}
    for card in table.values():
        dofs = _dofs(context, name, card)
        if len(dofs) == 2 and dofs[0] == dofs[1]:
            continue  # a spring from a degree of freedom to itself
        if dofs:
            by_size[len(dofs)].append((card, dofs))
    groups = []
    for size, members in by_size.items():
        if not members:
            continue
        cards = [m[0] for m in members]
        keys = [_key(context, name, card, via) for card in cards]
        sources, source_of = numbered(frozenset([k]) for k in keys)
        groups.append(
            Group(
                card=name,
                ids=np.array([c.eid for c in cards], dtype=np.int64),
                places=np.array([m[1] for m in members], dtype=np.int64),
                width=1,
                matrices=_routine(keys, via[1] if via else own, size, kind),
                sources=sources,
                source_of=source_of,
            )
        )
    return groups


def _dofs(context: Context, name: str, card: Card) -> list[int]:
    """Degrees of freedom of a scalar element, one where the other end is the ground."""
    place = context.bulk.place(name, card.eid)
    components = (getattr(card, "c1", 0), getattr(card, "c2", 0))
    return [
        context.points.dof(int(point), int(component or 0), place)
        for point, component in zip(card.nodes, components, strict=False)
        if point
    ]


def _key(context: Context, name: str, card: Card, via: tuple[str, str] | None) -> Key:
    if via is None:
        return name, int(card.eid)
    found = property_of(
        context.bulk, [via[0]], card.pid, lambda: context.bulk.place(name, card.eid)
    )
    return found[0], int(card.pid)


def _routine(
    keys: list[Key], attribute: str, size: int, kind: int
) -> Callable[[Bulk, Ints, tuple[bool, bool]], Matrices]:
    def matrices(bulk: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        if not wanted[kind]:
            return None, None
        chosen = (keys[r] for r in rows)
        values = np.array([getattr(bulk.table(n)[i], attribute) or 0.0 for n, i in chosen])
        pattern = _PAIR if size == 2 else np.ones((1, 1))
        result = values.astype(np.float64)[:, None, None] * pattern
        return (result, None) if kind == 0 else (None, result)

    return matrices
