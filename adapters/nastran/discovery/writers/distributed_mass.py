"""Non-structural mass of a property of their own for elements that carry more."""

from ...editing.set_values import read_value, set_values
from ...editing.split_property import split_property
from ...fields.parameter_references import FieldRef
from ...text.deck_text import DeckText
from .patched_properties import by_property
from .site import Site


def write(text: DeckText, site: Site) -> DeckText:
    """Give the elements a property with the mass per area in NSM."""
    elements = site.elements
    for (card, pid), own in by_property(text, site.deck, elements).items():
        split = split_property(text, card, pid, own, site.note, copy_materials=False)
        ref = FieldRef(card, split.property, "NSM")
        old = read_value(split.deck, ref) or 0.0
        text = set_values(split.deck, {ref: old + site.total("mass_per_area")})
    return text
