"""What a deck asks for that the assembly does not support: refused before anything is built."""

from __future__ import annotations

from ...core.errors import InputError
from .catalogue import READ
from .families import SUPPORTED
from .read import Deck
from .rigid import RIGID

_WITHOUT_EFFECT = ("CORD", "CVISC", "CDAMP")
_ELEMENTS = frozenset(
    name
    for name in READ
    if name[0] == "C" and not name.startswith(_WITHOUT_EFFECT) and name not in SUPPORTED
)
_RIGID = frozenset(name for name in READ if name[0] == "R" and name not in RIGID)


def refuse_unsupported(deck: Deck) -> None:
    """Raise `InputError` for what carries stiffness, mass or constraint and is not supported."""
    refused = list(deck.refused)
    for name in (*sorted(_ELEMENTS), *sorted(_RIGID)):
        if deck.bulk.raw.get(name):
            raw = deck.bulk.raw[name][0]
            number = next(iter(deck.bulk.table(name)), "")
            refused.append(f"{deck.bulk.at(raw)}: {name} {number} is not supported yet")
    if refused:
        more = f" (and {len(refused) - 1} more that are not supported)" if refused[1:] else ""
        raise InputError(refused[0] + more)
