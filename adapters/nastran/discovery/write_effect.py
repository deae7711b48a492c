"""Write a missing effect into a deck as the cards a Nastran engineer would write."""

from dataclasses import dataclass

from ....core.discovery.findings import Finding
from ..deck.read_deck import Deck
from ..editing.changed_cards import written_cards
from ..text.deck_text import DeckText
from .writers import writer_of
from .writers.site import Site


@dataclass(frozen=True)
class Adopted:
    """The deck with an effect in it, and every card that is new or changed as it stands there."""

    deck: DeckText
    cards: tuple[str, ...]


def adopt(text: DeckText, deck: Deck, finding: Finding) -> Adopted:
    """Return the deck completed by one finding of the model side.

    Parameters
    ----------
    text : DeckText
        Not changed.
    deck : Deck
        The deck as read, for its grids and elements.
    finding : Finding

    Raises
    ------
    InputError
        A kind that has no cards here, or a deck that cannot take them.
    """
    done = writer_of(finding.kind)(text, Site(deck, finding))
    return Adopted(done, written_cards(text, done))
