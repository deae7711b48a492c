"""Which degrees of freedom the rows of an exported matrix are, from a deck or an assembly file."""

from pathlib import Path

import numpy as np

from ....core.arrays import Ints
from ....core.errors import InputError, Place
from ....core.files import reading
from ..deck.field_values import Fields
from ..deck.logical_lines import Line
from ..deck.raw_cards import cut, fields_of
from ..deck.read_deck import Deck
from ..op4.exported_matrix import DofMap
from ..properties.grids import read_points

_SETS = ("ASET", "ASET1", "BSET", "BSET1", "CSET", "CSET1", "QSET", "QSET1", "SUPORT")


def deck_maps(deck: Deck) -> dict[str, DofMap]:
    """Return the sets of a deck in Nastran's internal order (by point number).

    ``g``: six a grid and one a scalar point; ``a``: what ASET, BSET, CSET, QSET and SUPORT name,
    where they name any; ``f``: what neither SPC, MPC, rigid elements nor AUTOSPC take.
    """
    points = read_points(deck.bulk)
    grids = (8 * points.ids[:, None] + np.arange(1, 7)).reshape(-1)
    maps = {"g": DofMap.of_keys(np.sort(np.concatenate([grids, 8 * points.scalar_ids])))}
    chosen = _analysis_set(deck, set(points.scalar_ids.tolist()))
    if len(chosen):
        maps["a"] = DofMap.of_keys(chosen)
    free = _free_set(deck)
    if free is not None:
        maps["f"] = free
    return maps


def map_of_size(maps: dict[str, DofMap], size: int, name: str, where: str) -> DofMap:
    """Choose the map that a square matrix fits, by its name's last letters or its size.

    Raises
    ------
    InputError
        No set of that size.
    """
    fitting = {k: m for k, m in maps.items() if len(m) == size}
    for letter in (name.rstrip("X")[-1:].lower(), *("a", "f", "g")):
        if letter in fitting:
            return fitting[letter]
    sizes = ", ".join(f"{k}-set {len(m)}" for k, m in maps.items())
    raise InputError(
        f"matrix {name} has {size} rows, which is none of the sets of {where} ({sizes}): give the "
        "deck that belongs to it"
    )


def _free_set(deck: Deck) -> DofMap | None:
    from ..assembly.build_model import build_model

    try:
        labels = build_model(deck).free_labels
    except InputError:  # elements that trueup does not assemble; the export knows them all
        return None
    return DofMap.of_keys(np.sort(DofMap.of_labels(labels).keys)) if labels else None


def _analysis_set(deck: Deck, scalar: set[int]) -> Ints:
    cards = (card for name in _SETS for card in deck.bulk.raw.get(name, []))
    keys = [k for card in cards for k in set_keys(fields_of(card.lines))]
    return np.unique(np.array([8 * (k // 8) if k // 8 in scalar else k for k in keys], np.int64))


def set_keys(card: Fields) -> list[int]:
    """Return the degrees of freedom that ASET, ASET1, SUPORT, EXTRN or the like names, as keys."""
    name = str(card[0])
    if name.endswith("1"):
        return [8 * p + c for p in _points(card[2:]) for c in _components(card[1])]
    pairs = zip(card[1::2], [*card[2::2], None], strict=False)
    return [8 * int(p) + c for p, components in pairs if p for c in _components(components)]


def _components(field: str | None) -> list[int]:
    return sorted({int(c) for c in field}) if field else [0]


def _points(fields: Fields) -> list[int]:
    words = [f for f in fields if f]
    if len(words) == 3 and words[1].upper() == "THRU":
        return list(range(int(words[0]), int(words[2]) + 1))
    return [int(w) for w in words]


def read_extrn(path: Path | str) -> DofMap:
    """Read the dof map of an external superelement from the punch file beside its OP4.

    Taken is EXTRN, in the order in which it names the degrees of freedom.

    Raises
    ------
    InputError
        A file that cannot be read or has no EXTRN.
    """
    path = Path(path)
    with reading(path):
        text = path.read_text("latin-1")
    lines = [Line(t, 0, k + 1) for k, t in enumerate(text.splitlines())]
    starts = [k for k, line in enumerate(lines) if line.text[:5].upper() == "EXTRN"]
    if not starts:
        raise Place(path).fault("has no EXTRN card that says what the rows of the matrices are")
    stop = starts[0] + 1
    while stop < len(lines) and lines[stop].text[:1] in (" ", "+", "*"):
        stop += 1
    card = fields_of(next(cut(lines[starts[0] : stop], (path,))).lines)
    try:
        keys = np.array(set_keys(card), np.int64)
    except ValueError:
        raise Place(path, starts[0] + 1).error("this EXTRN card cannot be read") from None
    return DofMap.of_keys(keys)
