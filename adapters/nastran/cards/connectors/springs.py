"""Scalar springs: CELAS1 ... CELAS4."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .....core.arrays import Ints, Matrices
from .....core.elements.connectors.lumped import SPRING, spring_stiffness
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Values
from ...deck.movable_values import Moves
from ..element_group import Context, Group, Key, numbered, property_key

ENDS = "G1>nodes:i=0 C1>components:i=0 G2>nodes:i=0 C2>components:i=0"
"""Two ends of a scalar element; 0 is the ground."""

_K = Moves(linear=("K",), concentrated=("K",))

CARDS = (
    Card("CELAS1", f"EID:i! PID:i=EID {ENDS}", "eid", elements="spring", properties="PELAS"),
    Card("CELAS2", f"EID:i! K:r! {ENDS} GE:r=0. S:r=0.", "eid", elements="spring", moves=_K),
    Card(
        "CELAS3", "EID:i! PID:i=EID S1,S2>scalars:i=0", "eid", elements="spring", properties="PELAS"
    ),
    Card("CELAS4", "EID:i! K:r! S1,S2>scalars:i=0", "eid", elements="spring", moves=_K),
    Card(
        "PELAS",
        "PID:i! K:r! GE:r=0. S:r=0.",
        "pid",
        several=4,
        companions="PELAST",
        moves=replace(_K, also={"K1": "K", "GE1": "GE", "S1": "S"}),
    ),
)


def springs(context: Context) -> list[Group]:
    """Make the groups of springs between two degrees of freedom or one and the ground."""
    return [g for card in CARDS if card.elements for g in scalar_groups(context, card, "k", 0)]


def scalar_groups(context: Context, definition: Card, attribute: str, kind: int) -> list[Group]:
    """Make the groups of scalar elements of one kind of card.

    Parameters
    ----------
    context : Context
        The deck.
    definition : Card
        Which.
    attribute : str
        Of the property, or of the element where it has none, that holds the value.
    kind : {0, 1}
        Whether the value is a stiffness (or a damping) or a mass.
    """
    name = definition.name
    table = context.bulk.table(name)
    by_size: dict[int, list[tuple[Values, list[int]]]] = {1: [], 2: []}
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
        keys = [
            property_key(context.bulk, name, c.eid, c.pid)
            if definition.properties
            else (name, c.eid)
            for c in cards
        ]
        sources, source_of = numbered(frozenset([k]) for k in keys)
        groups.append(
            Group(
                card=name,
                ids=np.array([c.eid for c in cards], dtype=np.int64),
                element=SPRING,
                nodes=np.array([m[1] for m in members], dtype=np.int64),
                matrices=_routine(keys, attribute, size, kind),
                sources=sources,
                source_of=source_of,
            )
        )
    return groups


def _dofs(context: Context, name: str, card: Values) -> list[int]:
    """Degrees of freedom of a scalar element, one where the other end is the ground."""
    place = context.bulk.place(name, card.eid)
    scalars = getattr(card, "scalars", None)
    ends = zip(scalars or card.nodes, (0, 0) if scalars else card.components, strict=True)
    return [context.points.dof(point, component, place) for point, component in ends if point]


def _routine(
    keys: list[Key], attribute: str, size: int, kind: int
) -> Callable[[Bulk, Ints, tuple[bool, bool]], Matrices]:
    def matrices(bulk: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        if not wanted[kind]:
            return None, None
        chosen = (keys[r] for r in rows)
        values = np.array([getattr(bulk.table(n)[i], attribute) or 0.0 for n, i in chosen])
        result = spring_stiffness(values.astype(np.float64), size)
        return (result, None) if kind == 0 else (None, result)

    return matrices
