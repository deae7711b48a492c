"""A property and materials of their own for elements that are softer or stiffer."""

from ...editing.set_values import read_value, set_values
from ...editing.split_property import split_property
from ...fields.parameter_references import FieldRef
from ...text.deck_text import DeckText
from .patched_properties import by_property
from .site import Site


def write(text: DeckText, site: Site) -> DeckText:
    """Give the elements materials whose moduli are those of the deck times the factor."""
    elements = site.elements
    for (card, pid), own in by_property(text, site.deck, elements).items():
        split = split_property(text, card, pid, own, site.note)
        values = {}
        for new in split.materials.values():
            for name in ("E", "G"):
                ref = FieldRef("MAT1", new, name)
                old = read_value(split.deck, ref)
                if old:
                    values[ref] = old * site.total("factor")
        text = set_values(split.deck, values)
    return text
