"""CBUSH between the end of a beam and its joint."""

from ...text.deck_text import DeckText
from .detached_elements import detached
from .site import Site


def write(text: DeckText, site: Site) -> DeckText:
    """Put a coincident grid at a beam's end: rigid in translation, sprung in rotation."""
    elements = site.elements
    return detached(text, site, elements, site.grids[0])
