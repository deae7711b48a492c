"""A scalar point with CMASS2 on a CELAS2 for an absorber."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...editing.find_cards import free_id
from ...text.deck_text import DeckText
from .site import Site, companion, plain


def write(text: DeckText, site: Site) -> DeckText:
    """Put a scalar point on a spring in the direction of the finding.

    A grid held in the other directions would hold a free structure to ground. It hangs on the
    grid itself where that is one grid in basic axes, else on a grid that follows all those named.
    """
    return sprung(text, site, site.components, site.total("frequency_hz"))


def sprung(text: DeckText, site: Site, components: Sequence[int], hz: float) -> DeckText:
    """Put a mass on springs, the same in some directions."""
    grids, m = site.grids, plain(site.total("mass"))
    omega = 2.0 * np.pi * hz
    stiffness = plain(m * site.deck.param("WTMASS", 1.0) * omega**2)
    new, number = free_id(text, "grid"), free_id(text, "element")
    host, rows = grids[0], list[list[Any]]()
    if len(grids) > 1:
        moves = "123" if len(grids) > 2 else "123456"
        host, new = new, new + 1
        rows += [
            ["GRID", host, 0, *site.middle(grids), 0, "456"],
            ["RBE3", number, None, host, "123", 1.0, moves, *grids],
        ]
    elif site.arms or site.system(host):
        host, new = new, new + 1
        rows += companion(site, grids[0], host, number, *site.arms)
    for k, c in enumerate(components):
        rows += [
            ["SPOINT", new + k],
            ["CELAS2", number + 2 * k + 1, stiffness, host, c, new + k],
            ["CMASS2", number + 2 * k + 2, m, new + k],
        ]
    return site.added(text, rows)
