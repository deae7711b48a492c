"""Shells and solids of a deck: which middle nodes they have, where they stand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ....core.arrays import Bools, Floats, Ints
from ....core.data.shapes import HEXA, PENTA
from ....core.elements import ELEMENTS, Element
from ....core.elements.middle_nodes import spread
from ..deck.card_definition import Values
from .element_group import Context, Key, check_shape, connected


@dataclass(frozen=True, eq=False)
class Placed:
    """Elements of one card that have the same middle nodes.

    Parameters
    ----------
    nodes : (n, n_there) int
        Grid rows of the nodes that are there.
    xyz : (n, nodes, 3) float
        Of all nodes.
    spread : (nodes, n_there) float or None
        All nodes from those that are there (`middle_nodes.spread`).
    keys, of : list of Key, (n,) int
        Properties used, and which of them each has.
    """

    name: str
    element: Element
    cards: list[Values]
    ids: Ints
    nodes: Ints
    xyz: Floats
    spread: Floats | None
    keys: list[Key]
    of: Ints

    def take(self, rows: Bools) -> Placed:
        """Return some of them, with the properties that they have."""
        cards = [card for card, there in zip(self.cards, rows, strict=True) if there]
        kept = {name: getattr(self, name)[rows] for name in ("ids", "nodes", "xyz")}
        used, of = np.unique(self.of[rows], return_inverse=True)
        return replace(self, cards=cards, keys=[self.keys[k] for k in used], of=of, **kept)

    def of_nodes_there(self, K: Floats) -> Floats:
        """Stiffness of the nodes that are there from that of all nodes."""
        if self.spread is None:
            return K
        T = np.kron(self.spread, np.eye(self.element.freedoms))
        return np.asarray(T.T @ K @ T)

    def mass(self, rows: Ints, density: Floats, coupled: bool) -> Floats:
        """Mass of some elements on the nodes that are there."""
        assert self.element.mass is not None
        there = () if self.spread is None else (self.spread,)
        return self.element.mass(self.xyz[rows], density, coupled, *there)


def placed(context: Context, may_have: str) -> Iterator[Placed]:
    """Yield the elements of every card that may have a property.

    Raises
    ------
    InputError
        An element that is flat, turned inside out, or names what does not exist.
    """
    for name, definition in context.bulk.definitions.items():
        kinds = [ELEMENTS[kind] for kind in definition.elements.split()]
        patterns: dict[tuple[bool, ...], list[Values]] = {}
        if kinds and may_have in definition.properties.split():
            for card in context.bulk.table(name).values():
                there = tuple(bool(n) for n in card.nodes[kinds[0].corners :])
                patterns.setdefault(there if any(there) else (), []).append(card)
        for kind in {kinds[-1] if present else kinds[0]: 0 for present in patterns}:
            if kind.unknown:
                context.notes.append(
                    f"{name} with {kind.nodes} nodes: Nastran's law of {kind.unknown} is not "
                    "known; another stands for it, off by some per cent on a coarse mesh"
                )
        for present, cards in patterns.items():
            yield _placed(context, name, kinds[-1] if present else kinds[0], cards, present)


def _placed(
    context: Context, name: str, element: Element, cards: list[Values], present: tuple[bool, ...]
) -> Placed:
    kept = np.zeros(element.nodes, dtype=bool)
    kept[: element.corners] = True
    kept[element.corners :][: len(present)] = present
    used = [[n for n, there in zip(c.nodes, kept, strict=False) if there] for c in cards]
    ids, nodes, keys, of = connected(context, name, cards, used)
    if element.dimension == 3:
        _refuse_repeated(context, name, ids, nodes)
    T = spread(element.edges, kept)
    if T is None:
        nodes = _upright(context, name, element, ids, nodes)
    xyz = context.points.xyz[nodes] if T is None else T @ context.points.xyz[nodes]
    check_shape(context, name, element, ids, xyz)
    return Placed(name, element, cards, ids, nodes, xyz, T, keys, of)


def _upright(context: Context, name: str, element: Element, ids: Ints, nodes: Ints) -> Ints:
    """Exchange the faces of bricks and wedges whose second face lies behind the first.

    Nastran asks for consecutive grids about a face and those opposite, either way round.
    """
    if element.shape not in (HEXA, PENTA) or element.sound is None:
        return nodes
    half, every = element.corners // 2, np.arange(element.nodes)
    faces = [every[half : 2 * half], every[:half]]
    edges = every[2 * half :].reshape(-1, half)[::-1].ravel()
    turned = nodes[:, np.concatenate([*faces, edges])]
    behind = ~element.sound(context.points.xyz[nodes])
    behind[behind] = element.sound(context.points.xyz[turned[behind]])
    if behind.any():
        place = context.bulk.place(name, int(ids[np.flatnonzero(behind)[0]]))
        more = f" (and {int(behind.sum()) - 1} more)" if behind.sum() > 1 else ""
        context.notes.append(
            f"{place}{more}: the second face lies behind the first; taken the other way round"
        )
    return np.where(behind[:, None], turned, nodes)


def _refuse_repeated(context: Context, name: str, ids: Ints, nodes: Ints) -> None:
    """Raise `InputError` for a solid that names a grid twice."""
    ordered = np.sort(nodes, axis=1)
    twice = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
    if twice.any():
        place = context.bulk.place(name, int(ids[np.flatnonzero(twice)[0]]))
        raise place.fault(
            "names a grid twice; use the element of the shape it stands for "
            "(CPENTA, CPYRAM, CTETRA)"
        )
