"""What masses are counted in."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class MassUnit:
    """What masses are counted in.

    Parameters
    ----------
    card : float
        Of a mass as cards have it, in one unit of the mass matrix: 1/WTMASS.
    kilograms : float or None
        In one unit of the mass matrix; None where the deck's units are not known.
    stiffness : str
        Force over length in the deck's units; empty where they are not known.
    """

    card: float = 1.0
    kilograms: float | None = None
    stiffness: str = ""

    def figure(self, mass: float) -> str:
        """Return the number of a mass of cards, in kilograms where they are known."""
        return f"{mass if self.kilograms is None else mass / self.card * self.kilograms:.3g}"

    def per_length(self, components: Sequence[int]) -> str:
        """Return the unit of a stiffness in some components, those that turn in deck units."""
        return self.stiffness if self.stiffness and max(components) <= 3 else "(deck units)"

    def said(self, mass: float) -> str:
        """Return the same with its unit."""
        return f"{self.figure(mass)} {'(deck units)' if self.kilograms is None else 'kg'}"
