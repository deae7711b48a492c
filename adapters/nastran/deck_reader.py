"""Read a deck by the cards of the registry."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from .cards import definitions
from .deck import read_deck as by_definitions
from .deck.pynastran_bridge import file_of
from .deck.read_deck import Deck
from .op4.op4 import read_op4
from .properties.superelements import join_superelements
from .text.deck_text import DeckText


def read_deck(path: str | Path | DeckText | Any) -> Deck:
    """Read a deck with its INCLUDE files.

    Parameters
    ----------
    path : path, DeckText or pyNastran BDF
        The main file; executive and case control may be missing (bulk data alone). A text that
        was changed is read as it is, whatever its files on disk say.

    Raises
    ------
    InputError
        A file that cannot be read or is not a deck, a card that cannot be read: file and line.
    """
    if isinstance(path, DeckText):
        return _joined(by_definitions.read_deck(path, definitions()))
    file = file_of(path)
    deck = _joined(by_definitions.read_deck(file, definitions()))
    return replace(deck, on_disk=file is path)


def _joined(deck: Deck) -> Deck:
    def matrices(path: Path) -> dict[str, Any]:
        return {m.name: m.matrix for m in read_op4(path)}

    return join_superelements(deck, matrices)
