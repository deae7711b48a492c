"""The tables of a discovery."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Self

from ..correlation.comparison import Comparison
from ..discovery.findings import ADOPTED, Alternative, Discovery, Finding
from ..noun import OPTIONAL, Noun
from .correlation import Gap, PairRow, gap
from .evidence import DampingTable, MisfitTable, ResponseTable
from .plain import Table
from .update import ChangingTables


@dataclass(frozen=True)
class HeldOut:
    """The gap on the test modes and at the sensors that were kept out of the search."""

    test_modes: tuple[int, ...]
    sensors: tuple[int, ...]
    before: Gap | None
    after: Gap | None


@dataclass(frozen=True)
class GapTable(Noun):
    """How far apart model and test are before and after, and on what was held out."""

    before: Gap
    after: Gap
    held_out: HeldOut


@dataclass(frozen=True)
class JudgementTable:
    """Twice the log of how much likelier the verdict is, and the chance that it is right.

    `foretold` is by how many standard deviations test modes agree that what was found, fitted to
    others, foretells them better than the known parameters alone do. `error` is the diffuse error
    of the model, relative, completed by what was found, `error_alone` with the known parameters
    alone; `gain` is ln of how much likelier the test is by what was found, choices paid for;
    `adequacy` is the probability that a right model would leave a misfit as large: an error as
    large, and as many modes `unexplained`: test modes that no mode of the model explains.
    By `mesh`, relative, the deck's mesh makes frequencies too low on average: no parameter makes
    up for that. `looks_like` names an error without a place that would explain what is left, where
    one does. `proposal` says that the deck is completed by what was found though more is left
    than right models leave, and the verdict ``undecided``.
    """

    evidence: float
    posterior: float
    foretold: float
    error: float = 0.0
    error_alone: float = 0.0
    gain: float = 0.0
    adequacy: float = 1.0
    unexplained: tuple[int, ...] = ()
    proposal: bool = False
    mesh: float = 0.0
    looks_like: str = ""

    @classmethod
    def of(cls, found: Discovery) -> Self:
        """Return the judgement of a discovery."""
        return cls(
            found.evidence_for,
            found.posterior,
            found.foretold,
            found.error,
            found.error_alone,
            found.gain,
            found.adequacy,
            found.unexplained,
            found.proposal,
            found.mesh,
            found.looks_like,
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class DiscoverTables(ChangingTables):
    """What ``discover`` answers."""

    verb = "discover"
    verdict: str
    findings: Table[Finding]
    alternatives: Table[Alternative]
    gap: GapTable
    would_decide: tuple[str, ...]
    noise_scale: float
    judgement: JudgementTable
    pairs: Table[PairRow]
    damping: DampingTable | None = field(default=None, metadata=OPTIONAL)
    frf: ResponseTable | None = field(default=None, metadata=OPTIONAL)
    misfit: MisfitTable | None = field(default=None, metadata=OPTIONAL)

    @property
    def adopted(self) -> bool:
        """Whether what was found changed the deck."""
        return self.verdict in ADOPTED or self.judgement.proposal


def gap_table(found: Discovery, before: Comparison, after: Comparison) -> GapTable:
    """Return the gap, apart for what was held out from the search."""
    out = set(found.held_out_modes)
    sides = (before.correlation, after.correlation)
    was, now = (gap(c, {p.test + 1 for p in c.pairs} - out) for c in sides)
    held = [gap(c, out) if out else None for c in sides]
    return GapTable(was, now, HeldOut(found.held_out_modes, found.held_out_sensors, *held))
