"""CONM2 for an attached mass."""

from ...editing.find_cards import free_id
from ...text.deck_text import DeckText
from .site import Site


def write(text: DeckText, site: Site) -> DeckText:
    """Put the mass on the grids named, in equal parts.

    An offset CONM2 would hang on the drilling stiffness of a shell, which is next to nothing.
    """
    number, part = free_id(text, "element"), site.each("mass")
    return site.added(
        text, [("CONM2", number + i, g, None, part) for i, g in enumerate(site.grids)]
    )
