"""A changed deck as its files say it: written, read back, assembled and solved."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

from ....core.data.parametric_model import Model
from ....core.eigen.normal_modes import Eigensolution, solve
from ..deck.read_deck import Deck
from ..deck_reader import read_deck
from ..editing.changed_deck import ChangedDeck
from .build_model import build_model


@dataclass(frozen=True, eq=False)
class ReadBack:
    """A deck with its model and its normal modes."""

    deck: Deck
    model: Model
    solution: Eigensolution


def read_back(changed: ChangedDeck, n_modes: int) -> ReadBack:
    """Write a deck beside the user's files, read it as anyone would, and solve it in full.

    Raises
    ------
    InputError
        The deck cannot be read or assembled any more.
    CheckError
        The eigensolution does not meet its own check.
    """
    with tempfile.TemporaryDirectory(prefix="trueup-") as folder:
        deck = read_deck(changed.write(Path(folder) / "deck"))
    model = build_model(deck)
    return ReadBack(deck, model, solve(model, n_modes=min(n_modes, model.n_free)))
