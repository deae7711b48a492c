"""The tables of normal modes."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..arrays import Floats
from .plain import Table, Tables, key


@dataclass(frozen=True)
class ModeRow:
    """A normal mode; its generalised mass belongs to the scale in which its shape is given."""

    frequency_hz: float = field(metadata={"unit": "Hz"})
    generalized_mass: float


@dataclass(frozen=True)
class Checks:
    """What an eigensolution was checked by; `missed` by the Sturm count, None: not counted."""

    residual: float
    orthonormality: float
    missed: int | None


@dataclass(frozen=True, eq=False, kw_only=True)
class SolveTables(Tables):
    """What ``solve`` answers; `mass` and `centre_of_gravity` (3,) are those of a deck."""

    verb = "solve"
    deck_file: str = field(metadata=key("deck"))
    modes: Table[ModeRow]
    rigid_body_modes: int
    mass: float | None
    centre_of_gravity: Floats | None
    checks: Checks
    degrees_of_freedom: int
    backend: str
    seconds: float
    warnings: tuple[str, ...]
