"""The analysis set: ASET, OMIT, and the sets of component modes (b, c, q)."""

from dataclasses import dataclass

import numpy as np

from ....core.arrays import Bools
from ....core.errors import Place
from ..deck.card_definition import Card
from ..deck.read_deck import Deck
from .grids import Points

_PAIRS, _LISTED = "[G>nodes:i! C>components:c=0]", "C>components:c=0 G>nodes:*"
_KINDS = {
    "ASET": ("ASET", "ASET1"),
    "OMIT": ("OMIT", "OMIT1"),
    "b": ("BSET", "BSET1", "BNDFIX", "BNDFIX1"),
    "c": ("CSET", "CSET1", "BNDFREE", "BNDFRE1", "BNDFREE1"),
    "q": ("QSET", "QSET1"),
}

CARDS = (
    *(Card(n, _LISTED if n[-1] == "1" else _PAIRS) for kinds in _KINDS.values() for n in kinds),
    Card("SUPORT", _PAIRS),
    Card("SUPORT1", "SID:i! [G>nodes:i! C>components:c=0]"),
)


@dataclass(frozen=True, eq=False)
class AnalysisSet:
    """What of the g-set stays in a reduced model.

    Parameters
    ----------
    kept : (n_dof,) bool
        Physical degrees of freedom.
    held : (n_dof,) bool
        Those of them that are fixed in the component modes (b-set).
    modal : (n_dof,) bool
        What stands for the component modes (q-set).
    """

    kept: Bools
    held: Bools
    modal: Bools


def read_analysis_set(deck: Deck, points: Points) -> AnalysisSet | None:
    """Return what stays after reduction; None: all.

    With ASET or boundary sets everything else is omitted, with OMIT alone everything else stays.
    ASET belongs to the b-set.

    Raises
    ------
    InputError
        Grids or components that do not exist, a degree of freedom in two sets.
    """
    masks = {name: np.zeros(points.n_dof, dtype=bool) for name in _KINDS}
    for name, kinds in _KINDS.items():
        for kind in kinds:
            for card, place in deck.bulk.placed(kind):
                masks[name][list(points.named(card, place))] = True
    for one, other in (("ASET", "OMIT"), ("b", "c"), ("ASET", "q"), ("b", "q"), ("c", "q")):
        both = np.flatnonzero(masks[one] & masks[other])
        if len(both):
            names = (n if len(n) > 1 else f"the {n}-set" for n in (one, other))
            raise Place(deck.path).error(
                f"{points.label(both[0])} (grid:component) is in {' and in '.join(names)}"
            )
    held = (masks["ASET"] | masks["b"]) & ~masks["c"]
    kept = held | masks["c"]
    if not any(mask.any() for mask in masks.values()):
        return None
    if masks["OMIT"].any() and not kept.any():
        kept = ~masks["OMIT"] & ~masks["q"]
        held = kept.copy()
    return AnalysisSet(kept, held, masks["q"])
