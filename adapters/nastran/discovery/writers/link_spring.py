"""CBUSH1D for a spring between two places."""

from typing import Any

from ...editing.find_cards import free_id
from ...text.deck_text import DeckText
from .site import Site, follower, plain


def write(text: DeckText, site: Site) -> DeckText:
    """Put a spring along the line between two places, each a grid or one that follows several."""
    number, new = free_id(text, "element"), free_id(text, "grid")
    ends, rows = list[int](), list[list[Any]]()
    for grids in site.finding.where.ends or tuple((g,) for g in site.grids):
        end = grids[0]
        if len(grids) > 1:
            end, new = new, new + 1
            rows += follower(site, grids, end, number)
            number += 1
        ends.append(end)
    own = free_id(text, "property")
    rows += [
        ["CBUSH1D", number, own, *ends],
        ["PBUSH1D", own, plain(site.total("stiffness"))],
    ]
    return site.added(text, rows)
