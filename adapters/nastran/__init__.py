"""Nastran decks and results; each name is imported when it is used."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...core.late_imports import lazy_names

if TYPE_CHECKING:
    from .assembly.build_model import build_model
    from .assembly.grid_point_weight import Weight, weight
    from .deck.read_deck import Deck, EigenRequest
    from .deck_contents import deck_geometry, describe_deck
    from .deck_reader import read_deck
    from .editing.add_cards import add_cards
    from .editing.deck_diff import unified_diff
    from .editing.find_cards import free_id
    from .editing.set_values import read_value, set_values
    from .editing.split_property import Split, split_property
    from .editing.write_deck import write_deck, write_in_place
    from .fields.parameter_references import FieldRef, ParameterSpec, parse_parameter
    from .matrices.exported_matrix import DofMap, NastranMatrix, is_runs
    from .matrices.exported_runs import read_runs, write_runs
    from .matrices.matrix_model import (
        matrix_of,
        model_matrices,
        model_of_matrices,
        stiffness_and_mass,
    )
    from .matrices.op4 import is_op4, read_op4
    from .matrices.read_matrices import describe_matrices, matrix_file_kind, read_matrices
    from .matrices.run_terms import describe_runs, terms_of_runs
    from .matrices.write_matrices import write_dmig, write_op4
    from .results.read_modes import read_modes
    from .results_contents import describe_results
    from .text.deck_text import DeckText, read_deck_text
    from .text.real_numbers import writable

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

__getattr__ = lazy_names(
    __name__,
    {
        ".assembly.build_model": "build_model",
        ".assembly.grid_point_weight": "Weight weight",
        ".deck.read_deck": "Deck EigenRequest",
        ".deck_contents": "deck_geometry describe_deck",
        ".results_contents": "describe_results",
        ".editing.add_cards": "add_cards",
        ".editing.deck_diff": "unified_diff",
        ".editing.find_cards": "free_id",
        ".editing.set_values": "read_value set_values",
        ".editing.split_property": "Split split_property",
        ".editing.write_deck": "write_deck write_in_place",
        ".fields.parameter_references": "FieldRef ParameterSpec parse_parameter",
        ".matrices.exported_matrix": "DofMap NastranMatrix is_runs",
        ".matrices.exported_runs": "read_runs write_runs",
        ".matrices.matrix_model": "matrix_of model_matrices model_of_matrices stiffness_and_mass",
        ".matrices.op4": "is_op4 read_op4",
        ".matrices.read_matrices": "describe_matrices matrix_file_kind read_matrices",
        ".matrices.run_terms": "describe_runs terms_of_runs",
        ".matrices.write_matrices": "write_dmig write_op4",
        ".deck_reader": "read_deck",
        ".results.read_modes": "read_modes",
        ".text.deck_text": "DeckText read_deck_text",
        ".text.real_numbers": "writable",
    },
)
