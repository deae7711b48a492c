"""Decks of several configurations, read and solved by whoever does independent work."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from ...core.data.parametric_model import Model
from ...core.eigen.normal_modes import Eigensolution
from ..analysis import Analysis, read_analysis
from ..studies.executors import executor
from ..studies.study import Study

if TYPE_CHECKING:
    from ...adapters.nastran import Deck
    from ...adapters.nastran.editing.changed_deck import ChangedDeck
    from ...adapters.nastran.text.deck_text import DeckText

_WORTH_SENDING = 3000
"""Grids of the largest deck from which on solving takes longer than starting a process."""

Asked = tuple["Deck", Study, float]
"""A deck, what is asked of it, and the frequency up to which its modes count, Hz."""
Solved = tuple[Model, Eigensolution]


def analyses(asked: Sequence[Asked], who: str) -> Iterator[Analysis]:
    """Give the analysis side of each deck, as `read_analysis` finds it."""
    from ...adapters.nastran.assembly.wide_parameters import parameters_of

    if not _worth_sending([deck for deck, *_ in asked]):
        yield from (read_analysis(*one) for one in asked)
        return
    with executor(who) as each:
        found = each(_analysis, [(deck.text, study, fmax) for deck, study, fmax in asked])
        for (deck, study, _), analysis in zip(asked, found, strict=True):
            moved, _ = parameters_of(deck, study.parameters)
            yield replace(analysis, deck=moved, given=deck)


def solved_again(
    decks: Sequence[tuple[ChangedDeck, int]], given: Sequence[Deck], who: str
) -> Iterator[Solved]:
    """Give model and modes, so many of them, of each changed deck as its files say it.

    Raises
    ------
    InputError, CheckError
        As `read_back`.
    """
    if not _worth_sending(given):
        yield from map(_solved_again, decks)
        return
    with executor(who) as each:
        yield from each(_solved_again, decks)


def _analysis(asked: tuple[DeckText, Study, float]) -> Analysis:
    from ...adapters.nastran import read_deck

    text, study, fmax = asked
    return replace(read_analysis(read_deck(text), study, fmax), deck=None, given=None)


def _solved_again(asked: tuple[ChangedDeck, int]) -> Solved:
    from ...adapters.nastran.assembly.read_back import read_back

    again = read_back(*asked)
    return again.model, replace(again.solution, factor=None)


def _worth_sending(decks: Sequence[Deck]) -> bool:
    most = max((len(deck.bulk.table("GRID")) for deck in decks), default=0)
    return len(decks) > 1 and most >= _WORTH_SENDING
