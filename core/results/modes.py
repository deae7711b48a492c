"""The tables of modes: identified, and solved for."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import Floats
from ..data.dofs import Dofs
from ..eigen.normal_modes import Checks
from ..noun import key
from .made import MadeTables
from .plain import Table, finite

if TYPE_CHECKING:
    from ..identification.result import Identification

_HZ = {"unit": "Hz"}


@dataclass(frozen=True)
class IdentifiedRow:
    """A mode of the test with its uncertainty and quality, see `Identification`."""

    frequency_hz: float = field(metadata=_HZ)
    damping_ratio: float
    frequency_std: float = field(metadata=_HZ)
    damping_std: float
    mpc: float
    mpd: float = field(metadata={"unit": "deg"})
    mode_indicator: float
    quality: float
    generalized_mass: float
    close_pair_possible: bool
    rigid_body_share: float | None
    suspension: bool
    remark: str


@dataclass(frozen=True)
class PlaceRow:
    """Where a response was measured or the structure driven."""

    node: int
    direction: str


@dataclass(frozen=True)
class RejectedRow:
    """A root that was considered and is not among the modes."""

    frequency_hz: float = field(metadata=_HZ)
    damping_ratio: float
    reason: str


@dataclass(frozen=True)
class FaultRow:
    """What is wrong with functions of the survey, see `Fault`; `functions` response/reference."""

    kind: str
    functions: tuple[str, ...]
    sentence: str
    done: str


@dataclass(frozen=True)
class DrivingPointRow:
    """What a driving point says, see `DrivingPoint`."""

    function: str
    positive_share: float
    phase_deg: float | None = field(metadata={"unit": "deg"})


@dataclass(frozen=True)
class ReciprocityRow:
    """A function between driving points and its reciprocal, see `Reciprocity`."""

    function: str
    reciprocal: str
    correlation: float
    difference: float | None


@dataclass(frozen=True)
class BandRow:
    """A band that was fitted by itself."""

    low_hz: float = field(metadata=_HZ)
    high_hz: float = field(metadata=_HZ)


@dataclass(frozen=True)
class FunctionRow:
    """A function that was fitted; `frac` is the assurance of what the modes make of it, 0..1."""

    node: int
    direction: str
    reference_node: int
    reference_direction: str
    frac: float


@dataclass(frozen=True, eq=False, kw_only=True)
class IdentifyTables(MadeTables):
    """What ``identify`` answers; `lines` were used, from `range_hz`[0] to `range_hz`[1]."""

    verb = "identify"
    frf: tuple[str, ...]
    modes: Table[IdentifiedRow]
    rejected: Table[RejectedRow]
    references: Table[PlaceRow]
    responses: Table[PlaceRow]
    bands: Table[BandRow]
    quantity: str
    lines: int
    range_hz: tuple[float, float]
    faults: Table[FaultRow] = field(default_factory=lambda: Table((), FaultRow))
    driving_points: Table[DrivingPointRow] = field(
        default_factory=lambda: Table((), DrivingPointRow)
    )
    reciprocity: Table[ReciprocityRow] = field(default_factory=lambda: Table((), ReciprocityRow))
    warnings: tuple[str, ...]
    functions: Table[FunctionRow] = field(default_factory=lambda: Table((), FunctionRow))


def mode_rows(found: Identification) -> Table[IdentifiedRow]:
    """Return one row an identified mode."""
    each = {
        "frequency_hz": found.modes.frequencies_hz,
        "damping_ratio": found.modes.damping,
        "frequency_std": found.frequency_std,
        "damping_std": found.damping_std,
        "mpc": found.mpc,
        "mpd": found.mpd,
        "mode_indicator": found.mode_indicator,
        "quality": found.quality,
        "generalized_mass": found.real_modes.generalized_mass,
    }
    rows = (
        IdentifiedRow(
            close_pair_possible=bool(found.close_pair_possible[k]),
            rigid_body_share=finite(found.rigid_share[k]),
            suspension=bool(found.suspension[k]),
            remark=found.remarks[k],
            **{name: float(values[k]) for name, values in each.items()},
        )
        for k in range(len(found.modes))
    )
    return Table(rows, IdentifiedRow)


def place_rows(dofs: Dofs) -> Table[PlaceRow]:
    """Return one row a degree of freedom."""
    return Table(map(PlaceRow, dofs.node.tolist(), dofs.directions), PlaceRow)


def rejected_rows(found: Identification) -> Table[RejectedRow]:
    """Return one row a root that is no mode."""
    return Table((RejectedRow(**vars(r)) for r in found.rejected), RejectedRow)


def fault_rows(found: Identification) -> Table[FaultRow]:
    """Return one row a fault of the survey."""
    return Table((FaultRow(**vars(f)) for f in found.faults), FaultRow)


def driving_rows(found: Identification) -> Table[DrivingPointRow]:
    """Return one row a driving point."""
    rows = (
        DrivingPointRow(d.function, d.positive_share, finite(d.phase_deg))
        for d in found.driving_points
    )
    return Table(rows, DrivingPointRow)


def reciprocity_rows(found: Identification) -> Table[ReciprocityRow]:
    """Return one row a pair of driving points."""
    rows = (
        ReciprocityRow(r.function, r.reciprocal, r.correlation, finite(r.difference))
        for r in found.reciprocity
    )
    return Table(rows, ReciprocityRow)


def function_rows(found: Identification) -> Table[FunctionRow]:
    """Return one row a function, response by response."""
    of, by = (list(zip(d.node.tolist(), d.directions, strict=True))
              for d in (found.measured.responses, found.measured.references))  # fmt: skip
    rows = (
        FunctionRow(*of[o], *by[i], float(frac))
        for (o, i), frac in np.ndenumerate(found.frac)
        if np.isfinite(frac)
    )
    return Table(rows, FunctionRow)


def band_rows(found: Identification) -> Table[BandRow]:
    """Return one row a band."""
    return Table((BandRow(b.band.low, b.band.high) for b in found.bands), BandRow)


@dataclass(frozen=True)
class ModeRow:
    """A normal mode; its generalised mass belongs to the scale in which its shape is given."""

    frequency_hz: float = field(metadata={"unit": "Hz"})
    generalized_mass: float


@dataclass(frozen=True, eq=False, kw_only=True)
class SolveTables(MadeTables):
    """What ``solve`` answers; `mass` and `centre_of_gravity` (3,) are those of a deck.

    `kilograms` where the deck states its length unit and its densities leave no doubt.
    """

    verb = "solve"
    deck_file: str = field(metadata=key("deck"))
    modes: Table[ModeRow]
    rigid_body_modes: int
    mass: float | None
    kilograms: float | None = None
    length_unit: str | None = None
    centre_of_gravity: Floats | None
    checks: Checks
    degrees_of_freedom: int
    backend: str
    seconds: float
    warnings: tuple[str, ...]
