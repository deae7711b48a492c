"""Nastran decks and results; each name is imported when it is used."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...core.late_imports import lazy_names

if TYPE_CHECKING:
    from .assembly.build_model import build_model as build_model
    from .assembly.craig_bampton import craig_bampton as craig_bampton
    from .assembly.drawn_model import drawn_model as drawn_model
    from .assembly.grid_point_weight import Weight as Weight, weight as weight
    from .deck.read_deck import Deck as Deck, EigenRequest as EigenRequest
    from .deck_contents import deck_geometry as deck_geometry, describe_deck as describe_deck
    from .deck_reader import read_deck as read_deck
    from .editing.add_cards import add_cards as add_cards
    from .editing.deck_diff import unified_diff as unified_diff
    from .editing.find_cards import free_id as free_id
    from .editing.set_values import read_value as read_value, set_values as set_values
    from .editing.split_property import Split as Split, split_property as split_property
    from .editing.write_deck import write_deck as write_deck, write_in_place as write_in_place
    from .fields.parameter_references import (
        FieldRef as FieldRef,
        ParameterSpec as ParameterSpec,
        parse_parameter as parse_parameter,
    )
    from .matrices.exported_runs import read_runs as read_runs, write_runs as write_runs
    from .matrices.matrix_model import (
        matrix_of as matrix_of,
        model_matrices as model_matrices,
        model_of_matrices as model_of_matrices,
        stiffness_and_mass as stiffness_and_mass,
    )
    from .matrices.read_matrices import (
        describe_matrices as describe_matrices,
        matrix_file_kind as matrix_file_kind,
        read_matrices as read_matrices,
    )
    from .matrices.run_terms import describe_runs as describe_runs, terms_of_runs as terms_of_runs
    from .matrices.write_matrices import write_dmig as write_dmig, write_op4 as write_op4
    from .op4.exported_matrix import (
        DofMap as DofMap,
        NastranMatrix as NastranMatrix,
        is_runs as is_runs,
    )
    from .op4.op4 import is_op4 as is_op4, read_op4 as read_op4
    from .results.op4_modes import dof_list as dof_list, read_op4_modes as read_op4_modes
    from .results.read_modes import read_modes as read_modes
    from .results_contents import describe_results as describe_results
    from .text.deck_text import DeckText as DeckText, read_deck_text as read_deck_text
    from .text.real_numbers import writable as writable

__getattr__, __all__ = lazy_names(
    __name__,
    {
        ".assembly.build_model": "build_model",
        ".assembly.craig_bampton": "craig_bampton",
        ".assembly.drawn_model": "drawn_model",
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
        ".op4.exported_matrix": "DofMap NastranMatrix is_runs",
        ".matrices.exported_runs": "read_runs write_runs",
        ".matrices.matrix_model": "matrix_of model_matrices model_of_matrices stiffness_and_mass",
        ".op4.op4": "is_op4 read_op4",
        ".matrices.read_matrices": "describe_matrices matrix_file_kind read_matrices",
        ".matrices.run_terms": "describe_runs terms_of_runs",
        ".matrices.write_matrices": "write_dmig write_op4",
        ".deck_reader": "read_deck",
        ".results.op4_modes": "dof_list read_op4_modes",
        ".results.read_modes": "read_modes",
        ".text.deck_text": "DeckText read_deck_text",
        ".text.real_numbers": "writable",
    },
)
