"""A scalar that may move."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import InputError


@dataclass(frozen=True)
class Parameter:
    """A factor on one or several property values of the deck, 1 being the deck as it is.

    Parameters
    ----------
    name : str
        What the user calls it.
    handle : tuple of str
        Opaque to the core; the adapter that made it finds the values again by it, e.g.
        ``("PBAR 11 I1", "PBAR 11 I2")``.
    deck_values : tuple of float
        Values in the deck of each handle, in deck units.
    lower, upper : float
        Bounds on the factor.
    weight : float
        Relative weight of this parameter in W_p (1: as the others).

    Raises
    ------
    InputError
        Bounds that leave nothing between them.
    """

    name: str
    handle: tuple[str, ...]
    deck_values: tuple[float, ...]
    lower: float = 0.2
    upper: float = 5.0
    weight: float = 1.0

    def __post_init__(self) -> None:
        if not 0.0 < self.lower < self.upper:
            raise InputError(
                f"{self.name}: bounds {self.lower:g} and {self.upper:g} leave nothing between; "
                "give 0 < lower < upper, factors on the deck's value"
            )
