"""The tables of runs, decks or modes side by side."""

from __future__ import annotations

from dataclasses import dataclass

from .plain import Table, Tables


@dataclass(frozen=True)
class SourceRow:
    """One of those compared, and how far it is from the reference: the test, or the first of them.

    `mass` is that of a deck, in its unit, `kilograms` the same where its densities leave no doubt;
    None what is not known of it.
    """

    name: str
    what: str
    modes: int
    rigid_body_modes: int | None
    mass: float | None
    pairs: int | None
    mean_abs_deviation_percent: float | None
    worst_deviation_percent: float | None
    mean_mac: float | None
    kilograms: float | None = None


@dataclass(frozen=True)
class MatchRow:
    """A mode of the reference, and its partner in a source (None: it has none there)."""

    mode: int
    hz: float
    source: str
    partner: int | None
    partner_hz: float | None
    deviation_percent: float | None
    mac: float | None


@dataclass(frozen=True)
class ValueRow:
    """A value that is not the same in all: of a card, or of a parameter that a run moved."""

    name: str
    source: str
    value: float


@dataclass(frozen=True, eq=False, kw_only=True)
class CompareTables(Tables):
    """What ``compare`` answers; `reference` is what the others stand beside."""

    verb = "compare"
    reference: str
    sources: Table[SourceRow]
    modes: Table[MatchRow]
    values: Table[ValueRow]
    warnings: tuple[str, ...] = ()
