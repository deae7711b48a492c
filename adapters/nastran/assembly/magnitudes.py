"""How large a model is in everything that a slip of units would show in."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress

from ....core.eigen.normal_modes import solve
from ....core.errors import CheckError, InputError
from ..deck.read_deck import Deck
from .build_model import build_model
from .drawn_model import drawn_model
from .grid_point_weight import weight

_WEIGHED = 50_000
"""Cards up to which a deck is weighed for a first look."""
_SOLVED = 8_000
"""Cards up to which its first frequency is found, too."""


def magnitudes(deck: Deck) -> dict[str, float | str]:
    """Return size, moduli, densities, mass and first elastic frequency [Hz], in deck units.

    Those that cannot be had, or not in a second or two, are left out.
    """
    found: dict[str, float | str] = {}
    with suppress(InputError):  # a part of a deck: what it refers to may stand in another file
        found["size"] = _rounded(drawn_model(deck).geometry.size)
    cards = deck.bulk.table("MAT1").values()
    found |= {"E": _range(c.e for c in cards), "density": _range(c.rho for c in cards)}
    size = sum(deck.counts.values()) if not deck.refused else _WEIGHED + 1
    with suppress(InputError, CheckError):
        if size <= _WEIGHED:
            found["mass"] = _rounded(weight(deck).mass)
        if size <= _SOLVED:
            solution = solve(build_model(deck), 7)
            elastic = solution.frequencies_hz[solution.rigid_body_modes :]
            if len(elastic):
                found["first_frequency_hz"] = _rounded(float(elastic[0]))
    return {name: value for name, value in found.items() if value}


def _range(values: Iterable[float | None]) -> float | str:
    given = sorted(v for v in values if v)
    if not given:
        return ""
    low, high = _rounded(given[0]), _rounded(given[-1])
    return low if low == high else f"{low:g} to {high:g}"


def _rounded(value: float) -> float:
    return float(f"{value:.4g}")
