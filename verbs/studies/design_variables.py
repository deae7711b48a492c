"""Parameters and the design variables of SOL 200: those of a deck taken, a deck of them made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from ...core.data.parameter import Parameter
from ...core.errors import InputError
from ...core.updating.residuals.frequencies import FREQUENCIES
from .study import Study

if TYPE_CHECKING:
    from ...adapters.nastran import Deck, ParameterSpec
    from ...adapters.nastran.editing.changed_deck import ChangedDeck

NOT_NAMED = (
    "no parameter is named, and the deck has no design variables; say what may move, for example "
    "'PBAR 11 I1'"
)


def with_design_variables(asked: Study, deck: Deck) -> tuple[Study, tuple[str, ...]]:
    """Return the study; where it names no parameter, with those that the deck has, and remarks."""
    from ...adapters.nastran.design.design_variables import design_parameters

    if asked.parameters:
        return asked, ()
    named, remarks = design_parameters(deck)
    return replace(asked, parameters=named), remarks


def optimised(
    given: Deck,
    deck: Deck,
    moved: Sequence[tuple[ParameterSpec, Parameter]],
    aims: Sequence[tuple[int, float]],
    asked: Study,
) -> tuple[ChangedDeck | None, tuple[str, ...]]:
    """Return the deck as one for SOL 200, or why there is none.

    Parameters
    ----------
    given, deck
        As it came, and with properties split where parameters need it.
    moved
        Parameters as they were asked for, and as they are in the model.
    aims
        Number of an analysis mode, and the frequency [Hz] of its test mode.
    asked : Study
    """
    from ...adapters.nastran.design.write_sol200 import Aim, sol200
    from ...adapters.nastran.editing.changed_deck import ChangedDeck

    sigma = asked.weights.sigma(FREQUENCIES)
    to = [Aim(mode, hz, sigma) for mode, hz in aims]
    specs, parameters = [s for s, _ in moved], [p for _, p in moved]
    try:
        most = deck.eigen.nd if deck.eigen else None
        text = sol200(deck.text, specs, parameters, to, asked.regularisation, most)
    except InputError as error:
        return None, (f"no deck for SOL 200 was made: {error}",)
    return ChangedDeck.of(given.text, text), ()
