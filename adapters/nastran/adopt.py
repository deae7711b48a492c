"""Write a missing effect into a deck as the cards a Nastran engineer would write."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.discovery.findings import Finding
from ...core.errors import InputError
from .editing.add import add_cards
from .editing.decktext import DeckText
from .editing.edit import edit_cards, read_value, set_values
from .editing.find import find_card, free_id
from .editing.split import split_property
from .parameters import FieldRef
from .read import Deck

Row = list[Any]


@dataclass(frozen=True)
class Adopted:
    """The deck with an effect in it, and the cards that carry it."""

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
    return _WRITERS[finding.kind](text, deck, finding)


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


def _point_mass(text: DeckText, deck: Deck, finding: Finding) -> Adopted:
    """Put the mass on the grids named, in equal parts.

    An offset CONM2 would hang on the drilling stiffness of a shell, which is next to nothing.
    """
    grids, number = finding.where["grids"], free_id(text, "element")
    part = float(finding.magnitude["mass"]) / len(grids)
    rows: list[Row] = [["CONM2", number + i, g, None, part] for i, g in enumerate(grids)]
    return Adopted(
        add_cards(text, rows, _note(finding), ("GRID", grids[0])), tuple(_shown(r) for r in rows)
    )


def _ground_spring(text: DeckText, deck: Deck, finding: Finding) -> Adopted:
    grid, number = finding.where["grids"][0], free_id(text, "element")
    k = float(finding.magnitude["stiffness"])
    rows: list[Row] = [
        ["CELAS2", number + i, k, grid, c] for i, c in enumerate(finding.magnitude["components"])
    ]
    return Adopted(
        add_cards(text, rows, _note(finding), ("GRID", grid)), tuple(_shown(r) for r in rows)
    )


def _by_property(deck: Deck, elements: list[int]) -> dict[int, list[int]]:
    """Elements of a patch by the property they refer to."""
    out: dict[int, list[int]] = {}
    for name in ("CQUAD4", "CTRIA3", "CQUADR", "CTRIAR", "CQUAD8", "CTRIA6"):
        table = deck.bulk.table(name)
        for e in elements:
            if e in table:
                out.setdefault(int(table[e].pid), []).append(e)
    return out


def _local_stiffness(text: DeckText, deck: Deck, finding: Finding) -> Adopted:
    cards = []
    for pid, elements in _by_property(deck, finding.where["elements"]).items():
        split = split_property(text, "PSHELL", pid, elements, _note(finding))
        values = {}
        for new in split.materials.values():
            for name in ("E", "G"):
                ref = FieldRef("MAT1", new, name)
                old = read_value(split.deck, ref)
                if old:
                    values[ref] = old * float(finding.magnitude["factor"])
                    cards.append(f"MAT1 {new} {name} = {values[ref]:.6g}")
        text = set_values(split.deck, values)
        cards.append(f"PSHELL {split.property} on {len(elements)} elements")
    return Adopted(text, tuple(cards))


def _distributed_mass(text: DeckText, deck: Deck, finding: Finding) -> Adopted:
    cards = []
    per_area = float(finding.magnitude["mass_per_area"])
    for pid, elements in _by_property(deck, finding.where["elements"]).items():
        split = split_property(text, "PSHELL", pid, elements, _note(finding), copy_materials=False)
        ref = FieldRef("PSHELL", split.property, "NSM")
        old = read_value(split.deck, ref) or 0.0
        text = set_values(split.deck, {ref: old + per_area})
        cards.append(f"PSHELL {split.property} NSM = {old + per_area:.6g}")
    return Adopted(text, tuple(cards))


def _joint(text: DeckText, deck: Deck, finding: Finding) -> Adopted:
    """Put a coincident grid at a beam's end: rigid in translation, sprung in rotation."""
    return _detached(text, deck, finding, [int(e) for e in finding.where["elements"]], [4, 5, 6])


def _support(text: DeckText, deck: Deck, finding: Finding) -> Adopted:
    """Put a coincident grid between the support and everything attached to it."""
    grid = finding.where["grids"][0]
    attached = []
    for name in ("CBAR", "CBEAM", "CROD", "CQUAD4", "CTRIA3"):
        for number, card in deck.bulk.table(name).items():
            if grid in [n for n in card.node_ids if n]:
                attached.append(int(number))
    return _detached(text, deck, finding, attached, list(finding.magnitude["components"]))


def _detached(
    text: DeckText, deck: Deck, finding: Finding, elements: list[int], components: list[int]
) -> Adopted:
    grid = finding.where["grids"][0]
    new, number = free_id(text, "grid"), free_id(text, "element")
    xyz = _grid_xyz(deck, grid)
    cd = int(deck.bulk.table("GRID")[grid].cd or 0)
    stiff = "".join(str(c) for c in range(1, 7) if c not in components)
    k = float(finding.magnitude["stiffness"])
    rows: list[Row] = [
        ["GRID", new, 0, *(float(v) for v in xyz), cd],
        ["RBE2", number, grid, stiff, new],
        *(["CELAS2", number + 1 + i, k, grid, c, new, c] for i, c in enumerate(components)),
    ]
    edits = []
    for name in ("CBAR", "CBEAM", "CROD", "CQUAD4", "CTRIA3"):
        table = deck.bulk.table(name)
        for e in elements:
            if e in table:
                nodes = list(table[e].node_ids)
                edits.append((find_card(text, name, e), {2 + nodes.index(grid): new}))
    changed = edit_cards(text, edits)
    return Adopted(
        add_cards(changed, rows, _note(finding), ("GRID", grid)),
        (*(_shown(r) for r in rows), f"elements {elements} moved to grid {new}"),
    )


def _shown(row: Row) -> str:
    return ",".join(
        "" if v is None else f"{v:.6g}" if isinstance(v, float) else str(v) for v in row
    )


_WRITERS: dict[str, Callable[[DeckText, Deck, Finding], Adopted]] = {
    "point_mass": _point_mass,
    "ground_spring": _ground_spring,
    "local_stiffness": _local_stiffness,
    "distributed_mass": _distributed_mass,
    "joint_flexibility": _joint,
    "support_flexibility": _support,
}
