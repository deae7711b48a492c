"""CELAS2 for a spring to ground."""

from typing import Any

from ...editing.find_cards import free_id
from ...text.deck_text import DeckText
from .site import Site, companion


def write(text: DeckText, site: Site) -> DeckText:
    """Put springs to ground on the grids named, in equal parts.

    A grid whose displacements are not in basic axes gets a companion that follows it and is, a
    place between grids one there.
    """
    new, number = free_id(text, "grid"), free_id(text, "element")
    part, rows = site.each("stiffness"), list[list[Any]]()
    for g in site.grids:
        host = g
        if site.arms or site.system(g):
            host, new = new, new + 1
            rows += companion(site, g, host, number, *site.arms)
            number += 1
        for c in site.components:
            rows.append(["CELAS2", number, part, host, c])
            number += 1
    return site.added(text, rows)
