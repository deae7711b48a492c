"""Write a missing effect into a deck as the cards a Nastran engineer would write."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.discovery.findings import Finding
from ...core.errors import InputError
from .editing.add import add_cards
from .editing.decktext import DeckText
from .editing.edit import edit_cards, read_value, set_values
from .editing.find import Card, find_card, free_id
from .editing.split import split_property
from .editing.written import written_cards
from .parameters import FieldRef
from .read import Deck

Row = list[Any]

_SHELL = ("PSHELL", "PCOMP", "PCOMPG")
_SHELLS = ("CQUAD4", "CTRIA3", "CQUADR", "CTRIAR", "CQUAD8", "CTRIA6")
_PROPERTIES = {
    **dict.fromkeys(_SHELLS, _SHELL),
    "CBAR": ("PBAR", "PBARL"),
    "CBEAM": ("PBEAM", "PBEAML"),
    "CROD": ("PROD",),
}
"""Properties by the elements that may have them."""
_FIRST_GRID = {
    **dict.fromkeys(("CBAR", "CBEAM", "CROD", "CTUBE", *_SHELLS), 2),
    **dict.fromkeys(("CTETRA", "CPENTA", "CHEXA", "CPYRAM"), 2),
    "CONROD": 1,
}
"""Field of the first grid of elements that a new grid can take over."""
_LEFT = ("RBE2", "RBE3", "RBAR", "RBE1", "CELAS1", "CELAS2", "CBUSH", "CONM1", "CONM2")


@dataclass(frozen=True)
class Adopted:
    """The deck with an effect in it, and every card that is new or changed as it stands there."""

    deck: DeckText
    cards: tuple[str, ...]


def adopt(text: DeckText, deck: Deck, finding: Finding) -> Adopted:
    """Return the deck completed by one finding of the model side.

    Parameters
    ----------
    text : DeckText
        Not changed.
    deck : Deck
        The deck as read, for its grids and elements.
    finding : Finding

    Raises
    ------
    InputError
        A kind that has no cards here, or a deck that cannot take them.
    """
    if finding.kind not in _WRITERS:
        raise InputError(f"there is no way yet to write a {finding.kind} into a deck")
    done = _WRITERS[finding.kind](text, deck, finding)
    return Adopted(done, written_cards(text, done))


def plain(value: float) -> float:
    """Return a value with as many figures as a field of eight columns shows."""
    return float(f"{value:.6g}")


def _note(finding: Finding) -> str:
    return (
        f"trueup discover: {finding.kind.replace('_', ' ')}, "
        f"confidence {finding.confidence:.2f}\n{finding.sentence}"
    )


def _grid_xyz(deck: Deck, grid: int) -> np.ndarray[Any, Any]:
    from .grids import read_points

    points = read_points(deck.bulk)
    row = int(np.searchsorted(points.ids, grid))
    return np.asarray(points.xyz[row])


def _point_mass(text: DeckText, deck: Deck, finding: Finding) -> DeckText:
    """Put the mass on the grids named, in equal parts.

    An offset CONM2 would hang on the drilling stiffness of a shell, which is next to nothing.
    """
    grids, number = finding.where["grids"], free_id(text, "element")
    part = plain(float(finding.magnitude["mass"]) / len(grids))
    rows: list[Row] = [["CONM2", number + i, g, None, part] for i, g in enumerate(grids)]
    return add_cards(text, rows, _note(finding), ("GRID", grids[0]))


def _ground_spring(text: DeckText, deck: Deck, finding: Finding) -> DeckText:
    """Put springs to ground on the grids named, in equal parts.

    A grid whose displacements are not in basic axes gets a companion that follows it and is.
    """
    grids, number = finding.where["grids"], free_id(text, "element")
    part = plain(float(finding.magnitude["stiffness"]) / len(grids))
    new, rows = free_id(text, "grid"), list[Row]()
    for g in grids:
        host = g
        if deck.bulk.table("GRID")[g].cd:
            host, new = new, new + 1
            rows.append(["GRID", host, 0, *(float(v) for v in _grid_xyz(deck, g)), 0])
            rows.append(["RBE2", number, g, "123456", host])
            number += 1
        for c in finding.magnitude["components"]:
            rows.append(["CELAS2", number, part, host, c])
            number += 1
    return add_cards(text, rows, _note(finding), ("GRID", grids[0]))


def _local_damper(text: DeckText, deck: Deck, finding: Finding) -> DeckText:
    """Put dashpots to ground on the grids named, in equal parts.

    A grid whose displacement system is not the basic one takes them by a bushing in basic axes.
    """
    grids, number = finding.where["grids"], free_id(text, "element")
    part = plain(float(finding.magnitude["damping"]) / len(grids))
    components = finding.magnitude["components"]
    rows: list[Row] = []
    turned = [g for g in grids if int(deck.bulk.table("GRID")[g].cd or 0)]
    if turned:
        pid = free_id(text, "property")
        along = [part if k in components else None for k in range(1, 7)]
        rows.append(["PBUSH", pid, "B", *along[: max(components)]])
        rows += [
            ["CBUSH", number + i, pid, g, None, None, None, None, 0] for i, g in enumerate(turned)
        ]
    at = [(g, c) for g in grids if g not in turned for c in components]
    rows += [["CDAMP2", number + len(turned) + i, part, g, c] for i, (g, c) in enumerate(at)]
    note = f"{_note(finding)}\nDampers do not enter normal modes: complex ones show what it does."
    return add_cards(text, rows, note, ("GRID", grids[0]))


def _by_property(
    text: DeckText, deck: Deck, elements: list[int]
) -> dict[tuple[str, int], list[int]]:
    """Elements of a patch by the property they refer to in the text as it stands.

    An effect written before may have given some of them a property of their own.
    """
    out: dict[tuple[str, int], list[int]] = {}
    for name, properties in _PROPERTIES.items():
        table = deck.bulk.table(name)
        for e in elements:
            if e in table:
                number = int(find_card(text, name, e).text(1) or e)
                card = next((p for p in properties if _has(text, p, number)), properties[0])
                out.setdefault((card, number), []).append(e)
    return out


def _has(text: DeckText, card: str, number: int) -> bool:
    return any(n == number for s in text.segments for _, n in text.rows_in(s, card))


def _local_stiffness(text: DeckText, deck: Deck, finding: Finding) -> DeckText:
    for (card, pid), elements in _by_property(text, deck, finding.where["elements"]).items():
        split = split_property(text, card, pid, elements, _note(finding))
        values = {}
        for new in split.materials.values():
            for name in ("E", "G"):
                ref = FieldRef("MAT1", new, name)
                old = read_value(split.deck, ref)
                if old:
                    values[ref] = old * float(finding.magnitude["factor"])
        text = set_values(split.deck, values)
    return text


def _distributed_mass(text: DeckText, deck: Deck, finding: Finding) -> DeckText:
    per_area = float(finding.magnitude["mass_per_area"])
    for (card, pid), elements in _by_property(text, deck, finding.where["elements"]).items():
        split = split_property(text, card, pid, elements, _note(finding), copy_materials=False)
        ref = FieldRef(card, split.property, "NSM")
        old = read_value(split.deck, ref) or 0.0
        text = set_values(split.deck, {ref: old + per_area})
    return text


def _joint(text: DeckText, deck: Deck, finding: Finding) -> DeckText:
    """Put a coincident grid at a beam's end: rigid in translation, sprung in rotation."""
    elements = [int(e) for e in finding.where["elements"]]
    return _detached(text, deck, finding, elements, [4, 5, 6], finding.where["grids"][0])


def _support(text: DeckText, deck: Deck, finding: Finding) -> DeckText:
    """Put a coincident grid between every support and everything attached to it.

    Components that are free get no spring.
    """
    components = list(finding.magnitude["components"])
    free = list(finding.magnitude.get("free_components", []))
    for grid in finding.where["grids"]:
        _refuse_others(deck, grid)
        text = _detached(text, deck, finding, _attached(deck, grid), components, grid, free)
    return text


def _attached(deck: Deck, grid: int) -> list[int]:
    """Elements of a grid."""
    return [
        int(number)
        for name in _FIRST_GRID
        for number, card in deck.bulk.table(name).items()
        if grid in _grids(card)
    ]


def _grids(card: Any) -> list[int]:
    """Grids that a card as read refers to."""
    if card.type in ("RBE2", "RBE3", "RBE1"):
        return [*card.independent_nodes, *card.dependent_nodes]
    return [n for n in card.node_ids if n]


def _refuse_others(deck: Deck, grid: int) -> None:
    """Refuse a grid that carries what cannot be moved to a new one."""
    for name in _LEFT:
        for number, card in deck.bulk.table(name).items():
            if grid in _grids(card):
                raise InputError(
                    f"grid {grid} also carries {name} {number}, which stays where it is: put the "
                    "spring between the two by hand"
                )


def _detached(
    text: DeckText,
    deck: Deck,
    finding: Finding,
    elements: list[int],
    components: list[int],
    grid: int,
    free: Sequence[int] = (),
) -> DeckText:
    """Attach some elements of a grid to a new one, sprung or free in some components only.

    The bushing between the two lies in the displacement system of the grid.
    """
    new, number, pid = (free_id(text, what) for what in ("grid", "element", "property"))
    xyz = _grid_xyz(deck, grid)
    cd = int(deck.bulk.table("GRID")[grid].cd or 0)
    stiff = "".join(str(c) for c in range(1, 7) if c not in (*components, *free))
    k = plain(float(finding.magnitude["stiffness"]) / len(finding.where["grids"]))
    along = [k if c in components else None for c in range(1, max(components) + 1)]
    rows: list[Row] = [
        ["GRID", new, 0, *(float(v) for v in xyz), cd],
        *([["RBE2", number, grid, stiff, new]] if stiff else []),
        ["PBUSH", pid, "K", *along],
        ["CBUSH", number + 1, pid, grid, new, None, None, None, cd],
    ]
    edits = []
    for name, first in _FIRST_GRID.items():
        table = deck.bulk.table(name)
        for e in elements:
            if e in table:
                member = find_card(text, name, e)
                places = range(first, first + len(table[e].node_ids))
                edits.append((member, {next(i for i in places if _is(member, i, grid)): new}))
    changed = edit_cards(text, edits)
    return add_cards(changed, rows, _note(finding), ("GRID", grid))


def _absorber(text: DeckText, deck: Deck, finding: Finding) -> DeckText:
    """Put a scalar point on a spring in the direction of the finding.

    A grid held in the other directions would hold a free structure to ground. It hangs on the
    grid itself where that is one grid in basic axes, else on a grid that follows all those named.
    """
    grids, (c,) = finding.where["grids"], finding.magnitude["components"]
    m, hz = float(finding.magnitude["mass"]), float(finding.magnitude["frequency_hz"])
    m = plain(m)
    stiffness = plain(m * deck.param("WTMASS", 1.0) * (2.0 * np.pi * hz) ** 2)
    new, number = free_id(text, "grid"), free_id(text, "element")
    xyz = [float(v) for v in np.mean([_grid_xyz(deck, g) for g in grids], axis=0)]
    host, rows = grids[0], list[Row]()
    if len(grids) > 1:
        moves = "123" if len(grids) > 2 else "123456"
        host, new = new, new + 1
        rows += [
            ["GRID", host, 0, *xyz, 0, "456"],
            ["RBE3", number, None, host, "123", 1.0, moves, *grids],
        ]
    elif deck.bulk.table("GRID")[host].cd:
        host, new = new, new + 1
        rows += [["GRID", host, 0, *xyz, 0], ["RBE2", number, grids[0], "123456", host]]
    rows += [
        ["SPOINT", new],
        ["CELAS2", number + 1, stiffness, host, c, new],
        ["CMASS2", number + 2, m, new],
    ]
    return add_cards(text, rows, _note(finding), ("GRID", grids[0]))


def _is(card: Card, field: int, number: int) -> bool:
    """Whether a field of a card holds a number; an earlier effect may have changed it."""
    text = card.text(field)
    return text.isdigit() and int(text) == number


_WRITERS: dict[str, Callable[[DeckText, Deck, Finding], DeckText]] = {
    "point_mass": _point_mass,
    "ground_spring": _ground_spring,
    "local_stiffness": _local_stiffness,
    "distributed_mass": _distributed_mass,
    "joint_flexibility": _joint,
    "local_damper": _local_damper,
    "support_flexibility": _support,
    "tuned_absorber": _absorber,
}
