"""The tables of several configurations that were updated together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ..noun import OPTIONAL
from ..updating.prior_evidence import PriorWeighed
from ..updating.update import Iteration
from .correlation import PairRow
from .made import MadeTables
from .parameters import LikenessTable
from .plain import Table
from .update import DrawsTable, ParameterRow, SampleRow, StartRow, UpdateTables


@dataclass(frozen=True)
class ConfigurationRow:
    """A configuration: its deck and test, the folder of its own result, and how far both are apart.

    Test modes that took part, those of them that pair, the mean of |deviation| and of the MAC of
    the pairs: of the deck as it came, and as updated; None without pairs.
    """

    name: str
    deck: str
    test: tuple[str, ...]
    folder: str
    test_modes: int
    pairs_before: int
    pairs: int
    mean_abs_deviation_percent_before: float | None
    mean_abs_deviation_percent: float | None
    mean_mac_before: float | None
    mean_mac: float | None


@dataclass(frozen=True)
class ConfigurationPairRow:
    """A test mode of a configuration, with its partners before and after; None where none is."""

    configuration: str
    test: int
    test_hz: float
    analysis_before: int | None
    analysis_before_hz: float | None
    deviation_before_percent: float | None
    mac_before: float | None
    analysis: int | None
    analysis_hz: float | None
    deviation_percent: float | None
    mac: float | None


@dataclass(frozen=True, eq=False, kw_only=True)
class TogetherTables(MadeTables):
    """What ``update`` answers of several configurations; each has a result of its own beside.

    `history` holds the deviations of one configuration after the other.
    """

    verb = "update-configurations"
    configurations: Table[ConfigurationRow]
    parameters: Table[ParameterRow]
    pairs: Table[ConfigurationPairRow]
    history: Table[Iteration]
    eigensolutions: int
    stopped: str
    seconds: float
    warnings: tuple[str, ...]
    starts: Table[StartRow] = field(default_factory=lambda: Table((), StartRow))
    posterior: LikenessTable | None = field(default=None, metadata=OPTIONAL)
    samples: Table[SampleRow] | None = field(default=None, metadata=OPTIONAL)
    draws: DrawsTable | None = field(default=None, metadata=OPTIONAL)
    evidence: Table[PriorWeighed] | None = field(default=None, metadata=OPTIONAL)


def configuration_rows(results: Mapping[str, UpdateTables]) -> Table[ConfigurationRow]:
    """Return one row a configuration."""
    return Table(
        ConfigurationRow(
            name,
            r.input_deck,
            r.test_files,
            name,
            len(r.after.test_modes),
            r.before.summary.pairs,
            r.after.summary.pairs,
            r.before.summary.mean_abs_deviation_percent,
            r.after.summary.mean_abs_deviation_percent,
            r.before.summary.mean_mac,
            r.after.summary.mean_mac,
        )
        for name, r in results.items()
    )


def pair_rows(results: Mapping[str, UpdateTables]) -> Table[ConfigurationPairRow]:
    """Return one row a test mode, one configuration after the other."""
    return Table(
        (row for name, r in results.items() for row in _pairs(name, r)), ConfigurationPairRow
    )


def _pairs(name: str, result: UpdateTables) -> Iterator[ConfigurationPairRow]:
    before, after = ({p.test: p for p in c.pairs} for c in result.states)
    for t in result.after.test_modes:
        hz = float(result.after.test_hz[t - 1])
        partners = *_partner(before.get(t)), *_partner(after.get(t))
        yield ConfigurationPairRow(name, t, hz, *partners)


def _partner(
    p: PairRow | None,
) -> tuple[int | None, float | None, float | None, float | None]:
    if p is None:
        return None, None, None, None
    return p.analysis, p.analysis_hz, p.deviation_percent, p.mac


def shared_rows(names: Sequence[str], results: Mapping[str, UpdateTables]) -> Table[ParameterRow]:
    """Return one row a parameter, with its cards of all configurations."""
    rows = []
    for name in names:
        first, *others = (p for r in results.values() for p in r.parameters if p.name == name)
        for p in others:
            more = [k for k, card in enumerate(p.cards) if card not in first.cards]
            first = replace(
                first,
                cards=(*first.cards, *(p.cards[k] for k in more)),
                initial=(*first.initial, *(p.initial[k] for k in more)),
                updated=(*first.updated, *(p.updated[k] for k in more)),
            )
        rows.append(first)
    return Table(rows, ParameterRow)
