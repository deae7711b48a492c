"""Nastran decks and results."""

from .build import build_model
from .describe import deck_geometry, describe_deck
from .editing.add import add_cards
from .editing.decktext import DeckText, read_deck_text
from .editing.diff import unified_diff
from .editing.edit import read_value, set_values
from .editing.find import free_id
from .editing.numbers import writable
from .editing.split import Split, split_property
from .editing.write import write_deck, write_in_place
from .matrices.content import DofMap, NastranMatrix
from .matrices.model import matrix_of, model_matrices, model_of_matrices, stiffness_and_mass
from .matrices.op4 import is_op4, read_op4
from .matrices.read import describe_matrices, matrix_file_kind, read_matrices
from .matrices.runs import read_runs, write_runs
from .matrices.runterms import describe_runs, is_runs, terms_of_runs
from .matrices.write import write_dmig, write_op4
from .parameters import FieldRef, ParameterSpec, parse_parameter
from .read import Deck, EigenRequest, read_deck
from .results.describe import describe_results
from .results.modes import read_modes
from .weight import Weight, weight

__all__ = [
    "Deck",
    "DeckText",
    "DofMap",
    "EigenRequest",
    "FieldRef",
    "NastranMatrix",
    "ParameterSpec",
    "Split",
    "Weight",
    "add_cards",
    "build_model",
    "deck_geometry",
    "describe_deck",
    "describe_matrices",
    "describe_results",
    "describe_runs",
    "free_id",
    "is_op4",
    "is_runs",
    "matrix_file_kind",
    "matrix_of",
    "model_matrices",
    "model_of_matrices",
    "parse_parameter",
    "read_deck",
    "read_deck_text",
    "read_matrices",
    "read_modes",
    "read_op4",
    "read_runs",
    "read_value",
    "set_values",
    "split_property",
    "stiffness_and_mass",
    "terms_of_runs",
    "unified_diff",
    "weight",
    "writable",
    "write_deck",
    "write_dmig",
    "write_in_place",
    "write_op4",
    "write_runs",
]
