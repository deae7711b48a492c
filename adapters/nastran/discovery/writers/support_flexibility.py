"""CBUSH between a support and what it holds."""

from ...text.deck_text import DeckText
from .detached_elements import attached, detached
from .site import Site


def write(text: DeckText, site: Site) -> DeckText:
    """Put a coincident grid between every support and everything attached to it.

    Components that are free get no spring.
    """
    free = site.finding.magnitude.get("free_components", [])
    for grid in site.grids:
        text = detached(text, site, attached(site.deck, grid), grid, free)
    return text
