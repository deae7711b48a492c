"""The deck completed by what was found, read back, solved and compared again."""

from collections.abc import Sequence
from dataclasses import dataclass

from ....core.correlation.comparison import Placed, compare
from ....core.correlation.criteria import Criteria
from ....core.data.parametric_model import Model
from ....core.discovery.findings import Discovery
from ....core.discovery.screening.completed_model import SolvedModel, sound_test
from ....core.eigen.normal_modes import modes_of
from ....core.errors import InputError
from ..assembly.deck_damping import free_damping
from ..assembly.read_back import read_back
from ..deck.read_deck import Deck
from ..editing.changed_deck import ChangedDeck
from ..editing.set_values import set_values
from ..fields.parameter_references import ParameterSpec, moved
from ..text.deck_text import DeckText
from .write_effect import adopt
from .writers.site import plain


@dataclass(frozen=True, eq=False)
class CompletedDeck:
    """A deck completed by a discovery.

    Parameters
    ----------
    deck : ChangedDeck
    again : Deck
        As it was read back.
    after : SolvedModel
        It, solved in full and compared with the test again.
    cards : tuple of tuple of str
        By finding, the cards as they stand in the deck.
    refused : tuple of str
        Effects that no card could be written for, and why.
    """

    deck: ChangedDeck
    again: Deck
    after: SolvedModel
    cards: tuple[tuple[str, ...], ...]
    refused: tuple[str, ...]


def complete(
    deck: Deck,
    specs: Sequence[ParameterSpec],
    model: Model,
    found: Discovery,
    placed: Placed,
    criteria: Criteria,
    n_modes: int,
) -> CompletedDeck:
    """Write what was found into the deck, read it back, solve it in full, correlate it again.

    Parameters
    ----------
    deck : Deck
    specs : sequence of ParameterSpec
        Of the parameters of `model`.
    model : Model
        Of the deck as it is.
    found : Discovery
    placed : Placed
        The test on `model`.
    criteria : Criteria
    n_modes : int
        Modes to find.
    """
    original = deck.text
    text = _moved(original, specs, model, found)
    cards: list[tuple[str, ...]] = []
    refused: list[str] = []
    for f in found.findings:
        written: tuple[str, ...] = ()
        if f.side == "model" and found.completes:
            try:
                adopted = adopt(text, deck, f)
                text, written = adopted.deck, adopted.cards
            except InputError as error:
                refused.append(f"the {f.kind.replace('_', ' ')} was not written: {error}")
        cards.append(written)
    changed = ChangedDeck.of(original, text)
    again = read_back(changed, n_modes)
    sound = sound_test(placed, found, model.dofs, again.model.dofs)
    modes, rigid = modes_of(again.model, again.solution), again.solution.rigid_body_modes
    after = compare(again.model.geometry, modes, sound, criteria, rigid)
    solved = SolvedModel(after, again.solution, free_damping(again.deck, again.model))
    return CompletedDeck(changed, again.deck, solved, _standing(cards, text), tuple(refused))


def _moved(
    text: DeckText, specs: Sequence[ParameterSpec], model: Model, found: Discovery
) -> DeckText:
    """Return the deck with the known properties that moved."""
    factors = [m.written for m in found.parameters]
    known = [m.number for m in found.parameters]
    values = moved([specs[k] for k in known], [model.parameters[k] for k in known], factors)
    return set_values(text, {ref: plain(value) for ref, value in values.items()})


def _standing(cards: Sequence[tuple[str, ...]], text: DeckText) -> tuple[tuple[str, ...], ...]:
    """Return the cards that no later effect changed again."""
    there = {
        line.decode(f.encoding, "replace").rstrip()
        for f in text.files
        for line in f.data.splitlines()
    }
    return tuple(tuple(c for c in own if there.issuperset(c.split("\n"))) for own in cards)
