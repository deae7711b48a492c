"""What a result was made of, by which version, and what the decks weigh."""

from __future__ import annotations

from dataclasses import dataclass, field

from .plain import Table, Tables


@dataclass(frozen=True)
class InputRow:
    """A file that was read, and the SHA-256 of its bytes."""

    path: str
    sha256: str


@dataclass(frozen=True)
class WeightRow:
    """What a deck weighs: `mass` in its own unit (WTMASS applied), centre of gravity basic.

    `kilograms` where its densities leave no doubt of its unit; `length_unit` of the centre, None
    where neither the deck nor the test tells it.
    """

    deck: str
    mass: float
    kilograms: float | None
    x: float
    y: float
    z: float
    length_unit: str | None


@dataclass(frozen=True)
class ModeNameRow:
    """What the user calls a test mode."""

    test: int
    name: str


@dataclass(frozen=True, eq=False, kw_only=True)
class MadeTables(Tables):
    """Base of what a verb answers that reads files: `version` of trueup made it of `inputs`."""

    version: str = ""
    inputs: Table[InputRow] = field(default_factory=lambda: Table((), InputRow))
