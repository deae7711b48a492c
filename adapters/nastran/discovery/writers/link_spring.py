"""CBUSH1D for a spring between two places."""

from ...editing.find_cards import free_id
from ...text.deck_text import DeckText
from .site import Site, plain


def write(text: DeckText, site: Site) -> DeckText:
    """Put a spring along the line between the two grids named."""
    number, a, b = free_id(text, "element"), *site.grids
    own = free_id(text, "property")
    rows = [
        ("CBUSH1D", number, own, a, b),
        ("PBUSH1D", own, plain(site.total("stiffness"))),
    ]
    return site.added(text, rows)
