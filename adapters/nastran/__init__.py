"""Nastran decks and results."""

from .build import build_model
from .describe import describe_deck
from .editing.add import add_cards
from .editing.decktext import DeckText, read_deck_text
from .editing.diff import unified_diff
from .editing.edit import read_value, set_values
from .editing.find import free_id
from .editing.numbers import writable
from .editing.split import Split, split_property
from .editing.write import write_deck, write_in_place
from .parameters import FieldRef, ParameterSpec, parse_parameter
from .read import Deck, EigenRequest, read_deck
from .results.describe import describe_results
from .results.modes import read_modes
from .weight import Weight, weight

__all__ = [
    "Deck",
    "DeckText",
    "EigenRequest",
    "FieldRef",
    "ParameterSpec",
    "Split",
    "Weight",
    "add_cards",
    "build_model",
    "describe_deck",
    "describe_results",
    "free_id",
    "parse_parameter",
    "read_deck",
    "read_deck_text",
    "read_modes",
    "read_value",
    "set_values",
    "split_property",
    "unified_diff",
    "weight",
    "writable",
    "write_deck",
    "write_in_place",
]
