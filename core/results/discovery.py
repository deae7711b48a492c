"""The tables of a discovery."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from ..correlation.comparison import Comparison
from ..discovery.findings import Discovery
from ..discovery.screening.completed_model import ADOPTED
from .correlation import Gap, PairRow, gap
from .evidence import DampingTable, MisfitTable, ResponseTable
from .plain import OPTIONAL, Json, Table, typed
from .update import ChangingTables


@dataclass(frozen=True, kw_only=True)
class Where:
    """Where something is: what is there, `xyz` in deck units, `region` in words.

    A place that explains the data about as well has the `kind` that would explain them there, and
    `weight`, its share of the probability.
    """

    grids: tuple[int, ...] | None = field(default=None, metadata=OPTIONAL)
    elements: tuple[int, ...] | None = field(default=None, metadata=OPTIONAL)
    sensors: tuple[int, ...] | None = field(default=None, metadata=OPTIONAL)
    components: tuple[int, ...] | None = field(default=None, metadata=OPTIONAL)
    free_components: tuple[int, ...] | None = field(default=None, metadata=OPTIONAL)
    xyz: tuple[float, ...]
    region: str | None = field(default=None, metadata=OPTIONAL)
    directions: tuple[str, ...] | None = field(default=None, metadata=OPTIONAL)
    weight: float | None = field(default=None, metadata=OPTIONAL)
    kind: str | None = field(default=None, metadata=OPTIONAL)

    @property
    def size(self) -> int:
        """Number of grids, elements or sensors that it names; at least 1."""
        return max(len(self.grids or ()), len(self.elements or ()), len(self.sensors or ()), 1)


@dataclass(frozen=True)
class FindingRow:
    """Something that is missing in the model or wrong in the test.

    `magnitude` holds the words of its kind; `interval` is that of the first, 95 %; `cards` stand
    as written to the deck.
    """

    side: str
    kind: str
    where: Where
    magnitude: dict[str, Json]
    interval: tuple[float, float] | None
    credible_set: tuple[Where, ...]
    confidence: float
    cards: tuple[str, ...]
    sentence: str


@dataclass(frozen=True)
class AlternativeRow:
    """What else was considered: where, how many times less likely it is, and `odds` in words."""

    kinds: tuple[str, ...]
    xyz: tuple[tuple[float, ...], ...]
    times_less_likely: float
    sentence: str
    where: str = ""
    odds: str = ""


@dataclass(frozen=True)
class HeldOut:
    """The gap on the test modes and at the sensors that were kept out of the search."""

    test_modes: tuple[int, ...]
    sensors: tuple[int, ...]
    before: Gap | None
    after: Gap | None


@dataclass(frozen=True)
class GapTable:
    """How far apart model and test are before and after, and on what was held out."""

    before: Gap
    after: Gap
    held_out: HeldOut


@dataclass(frozen=True)
class JudgementTable:
    """Twice the log of how much likelier the verdict is, its probability, what it foretold."""

    evidence: float
    posterior: float
    foretold: float


@dataclass(frozen=True, eq=False, kw_only=True)
class DiscoverTables(ChangingTables):
    """What ``discover`` answers."""

    verb = "discover"
    verdict: str
    findings: Table[FindingRow]
    alternatives: Table[AlternativeRow]
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
        """Whether the verdict changed the deck."""
        return self.verdict in ADOPTED


def finding_rows(found: Discovery, cards: Sequence[Sequence[str]]) -> Table[FindingRow]:
    """Return the findings, each with the cards that were written for it."""
    return Table(
        FindingRow(
            f.side,
            f.kind,
            typed(Where, f.where),
            f.magnitude,
            f.interval,
            tuple(typed(Where, place) for place in f.credible_set),
            f.confidence,
            tuple(own),
            f.sentence,
        )
        for f, own in zip(found.findings, cards, strict=True)
    )


def alternative_rows(found: Discovery) -> Table[AlternativeRow]:
    """Return what else was considered."""
    return Table(
        AlternativeRow(a.kinds, a.places, a.times_less_likely, a.sentence, a.where, a.odds)
        for a in found.alternatives
    )


def gap_table(found: Discovery, before: Comparison, after: Comparison) -> GapTable:
    """Return the gap, apart for what was held out from the search."""
    out = set(found.held_out_modes)
    used = [
        gap(c.correlation, {p.test + 1 for p in c.correlation.pairs} - out) for c in (before, after)
    ]
    held = [gap(c.correlation, out) if out else None for c in (before, after)]
    return GapTable(
        used[0], used[1], HeldOut(found.held_out_modes, found.held_out_sensors, held[0], held[1])
    )
