"""CDAMP2, or CBUSH, for a dashpot to ground."""

from typing import Any

from ...editing.find_cards import free_id
from ...text.deck_text import DeckText
from .site import Site

_UNSEEN = "\nDampers do not enter normal modes: complex ones show what it does."


def write(text: DeckText, site: Site) -> DeckText:
    """Put dashpots to ground on the grids named, in equal parts.

    A grid whose displacement system is not the basic one takes them by a bushing in basic axes.
    """
    number, part, components = free_id(text, "element"), site.each("damping"), site.components
    rows: list[list[Any]] = []
    turned = [g for g in site.grids if site.system(g)]
    if turned:
        pid = free_id(text, "property")
        along = [part if k in components else None for k in range(1, 7)]
        rows.append(["PBUSH", pid, "B", *along[: max(components)]])
        rows += [
            ["CBUSH", number + i, pid, g, None, None, None, None, 0] for i, g in enumerate(turned)
        ]
    at = [(g, c) for g in site.grids if g not in turned for c in components]
    rows += [["CDAMP2", number + len(turned) + i, part, g, c] for i, (g, c) in enumerate(at)]
    return site.added(text, rows, more=_UNSEEN)
