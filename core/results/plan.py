"""The tables of a plan for a test."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..arrays import Floats
from ..noun import key
from .plain import Table, Tables


@dataclass(frozen=True)
class PlannedSensor:
    """A sensor: grid, direction along a basic axis, position in the frame of the deck."""

    node: int
    direction: str
    xyz: tuple[float, ...]


@dataclass(frozen=True)
class PlannedExciter:
    """A place to drive; `share` of the largest drive-point residue for its `least` excited mode."""

    node: int
    direction: str
    share: float
    least: int


@dataclass(frozen=True)
class PlannedMode:
    """A mode that the test is for.

    `worst_mac` is the largest MAC at the sensors with another (`like`) of them, `reached` the
    share of the largest drive-point residue that the exciters have.
    """

    mode: int
    hz: float
    worst_mac: float
    like: int | None
    reached: float


@dataclass(frozen=True, eq=False, kw_only=True)
class PlanTables(Tables):
    """What ``plan`` answers; `auto_mac` (n_mode, n_mode) is that of the modes at the sensors."""

    verb = "plan"
    deck_file: str = field(metadata=key("deck"))
    method: str
    sensors: Table[PlannedSensor]
    exciters: Table[PlannedExciter]
    modes: Table[PlannedMode]
    largest_off_diagonal: float
    auto_mac: Floats
    warnings: tuple[str, ...] = ()
