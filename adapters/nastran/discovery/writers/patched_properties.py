"""Properties that the elements of a patch refer to."""

from ...deck.read_deck import Deck
from ...editing.find_cards import find_card
from ...text.deck_text import DeckText


def by_property(
    text: DeckText, deck: Deck, elements: list[int]
) -> dict[tuple[str, int], list[int]]:
    """Elements of a patch by the property they refer to in the text as it stands.

    An effect written before may have given some of them a property of their own.
    """
    out: dict[tuple[str, int], list[int]] = {}
    for name, definition in deck.bulk.definitions.items():
        properties = definition.properties.split()
        made = properties and definition.element and definition.element.material
        table = deck.bulk.table(name) if made else {}
        for e in elements:
            if e in table:
                number = int(find_card(text, name, e).text(1) or e)
                held = (p for p in properties for s in text.segments if text.rows_of(s, p, number))
                card = next(held, properties[0])
                out.setdefault((card, number), []).append(e)
    return out
