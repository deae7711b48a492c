"""Nastran decks and results."""

from .editing.add import add_cards
from .editing.decktext import DeckText, read_deck_text
from .editing.diff import unified_diff
from .editing.edit import read_value, set_values
from .editing.find import free_id
from .editing.numbers import writable
from .editing.split import Split, split_property
from .editing.write import write_deck, write_in_place
from .parameters import FieldRef, ParameterSpec, parse_parameter

__all__ = [
    "DeckText",
    "FieldRef",
    "ParameterSpec",
    "Split",
    "add_cards",
    "free_id",
    "parse_parameter",
    "read_deck_text",
    "read_value",
    "set_values",
    "split_property",
    "unified_diff",
    "writable",
    "write_deck",
    "write_in_place",
]
