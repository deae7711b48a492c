"""The tables of an update."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..arrays import Floats
from ..correlation.mode_errors import ModeErrors
from ..data.parameter import Parameter
from ..noun import OPTIONAL, Noun, key
from ..reduction.damped_poles import ratios
from ..updating.posterior import Start
from ..updating.prior_evidence import PriorWeighed
from ..updating.residuals import Seen
from ..updating.sampling import Sampled
from ..updating.update import Iteration, Updated
from . import export
from .correlation import Compared, PairRow, RunTables
from .parameters import LikenessTable
from .plain import Table, finite


@dataclass(frozen=True, eq=False)
class ParameterRow:
    """A parameter: values of its fields before and after, and the factor between them.

    `standard_error` of the factor is None where the test says nothing; `significant` is told by
    ``discover`` only, the 95 % `interval` where it is asked for: an end is None where a bound or
    the reach of the reduced model comes first.
    """

    name: str
    cards: tuple[str, ...]
    initial: tuple[float, ...]
    updated: tuple[float | None, ...]
    factor: float
    standard_error: float | None
    at_bound: bool
    significant: bool | None = field(default=None, metadata=OPTIONAL)
    interval: tuple[float | None, float | None] | None = field(default=None, metadata=OPTIONAL)


@dataclass(frozen=True)
class StartRow:
    """An update from other factors: `same` says whether it led to the optimum that was taken.

    `factors` and `objective` are None where nothing paired at the start.
    """

    start: tuple[float, ...]
    factors: tuple[float | None, ...]
    objective: float | None
    same: bool


@dataclass(frozen=True)
class DampingRow:
    """Damping ratios of a pair [%]: of the test, None unknown, and of the analysis.

    `before` is None where the test mode had no partner then.
    """

    test: int
    test_percent: float | None
    before: float | None
    after: float


@dataclass(frozen=True)
class SampleRow:
    """A factor in samples of the posterior: mean, standard deviation, quantiles.

    `effective` is how many independent samples would tell the mean as well, `spread` 1 where the
    chains agree.
    """

    name: str
    mean: float
    standard_deviation: float
    low: float
    median: float
    high: float
    effective: float
    spread: float


@dataclass(frozen=True, eq=False)
class DrawsTable(Noun):
    """Samples of the factors, spread evenly over the chains: `values` (n_draw, n), by name."""

    parameters: tuple[str, ...]
    values: Floats

    def __len__(self) -> int:
        return len(self.values)

    @property
    def _wide(self) -> tuple[list[export.Column], list[dict[str, object]]]:
        rows = [dict(zip(self.parameters, row, strict=True)) for row in self.values.tolist()]
        return [export.Column.of(name) for name in self.parameters], rows

    def to_csv(self, path: Path | str) -> None:
        """Write a CSV file, one row a sample."""
        export.write_csv(path, *self._wide)

    def _repr_html_(self) -> str:
        return export.html(*self._wide)


@dataclass(frozen=True)
class SolverRow:
    """What the user's own solver said: how often it ran, how far the embedded one was off.

    `off_before` and `off_after` [%] are the largest differences of a pair's frequency, of the deck
    as it came and of the updated one, which the update corrects for; `left` is by how much that
    correction still changed in the end.
    """

    command: str
    runs: int
    seconds: float
    off_before: float
    off_after: float
    left: float


@dataclass(frozen=True, eq=False)
class WeightsTable(Noun):
    """Standard errors by which identified modes weigh: by test mode, by sensor."""

    frequency_std_percent: Floats
    shape_std_percent: Floats
    sensor_weights: Floats


@dataclass(frozen=True)
class InPlace:
    """Files of the deck that were changed where they stand, and their backups."""

    files: tuple[str, ...]
    backups: tuple[str, ...]


@dataclass(frozen=True, eq=False, kw_only=True)
class ChangingTables(RunTables):
    """What verbs answer that change a deck; `deck_file` lies below the run folder."""

    deck_file: str = field(metadata=key("deck"))
    input_deck: str
    test_files: tuple[str, ...] = field(metadata=key("test"))
    parameters: Table[ParameterRow]
    before: Compared
    after: Compared
    seconds: float
    warnings: tuple[str, ...]
    in_place: InPlace | None = field(default=None, metadata=OPTIONAL)

    @property
    def sources(self) -> tuple[str, tuple[str, ...]]:
        """The deck as it came and the files of the test."""
        return self.input_deck, self.test_files

    @property
    def states(self) -> tuple[Compared, ...]:
        """The correlations of the deck as it came and as changed."""
        return self.before, self.after


@dataclass(frozen=True, eq=False, kw_only=True)
class UpdateTables(ChangingTables):
    """What ``update`` answers.

    `starts` are the updates from elsewhere that were asked for; `posterior` is the correlation of
    the factors, None of less than two; `damping` are the ratios where that of the deck counts;
    `samples` and `draws` of the posterior and `evidence` for the prior where they are asked for.
    """

    verb = "update"
    history: Table[Iteration]
    weights: WeightsTable | None
    eigensolutions: int
    stopped: str
    starts: Table[StartRow] = field(default_factory=lambda: Table((), StartRow))
    posterior: LikenessTable | None = field(default=None, metadata=OPTIONAL)
    solver: SolverRow | None = field(default=None, metadata=OPTIONAL)
    damping: Table[DampingRow] | None = field(default=None, metadata=OPTIONAL)
    samples: Table[SampleRow] | None = field(default=None, metadata=OPTIONAL)
    draws: DrawsTable | None = field(default=None, metadata=OPTIONAL)
    evidence: Table[PriorWeighed] | None = field(default=None, metadata=OPTIONAL)

    @property
    def pairs(self) -> Table[PairRow]:
        """The pairs of the changed deck."""
        return self.after.pairs


def parameter_rows(
    parameters: Sequence[Parameter],
    done: Updated,
    written: Sequence[Sequence[float | None]],
    intervals: Floats | None = None,
) -> Table[ParameterRow]:
    """Return one row a parameter; `written` are the values of its fields as in the new deck.

    `intervals` (n_parameter, 2) are of the factors, NaN where a parameter has none.
    """
    error = [None if np.isnan(e) else e for e in done.standard_error.tolist()]
    return Table(
        ParameterRow(q.name, q.handle, q.deck_values, tuple(values), f, e, bound, None, interval)
        for q, f, e, bound, values, interval in zip(
            parameters,
            done.factors.tolist(),
            error,
            done.at_bound.tolist(),
            written,
            _ends(intervals, len(error)),
            strict=True,
        )
    )


def _ends(intervals: Floats | None, n: int) -> list[tuple[float | None, float | None] | None]:
    if intervals is None:
        return [None] * n
    return [
        None if np.isnan(low) else (finite(low), finite(high)) for low, high in intervals.tolist()
    ]


def start_rows(starts: Sequence[Start]) -> Table[StartRow]:
    """Return one row a start."""
    return Table(
        (
            StartRow(
                tuple(s.start.tolist()),
                tuple(finite(f) for f in s.factors.tolist()),
                finite(s.objective),
                s.same,
            )
            for s in starts
        ),
        StartRow,
    )


def damping_rows(done: Updated) -> Table[DampingRow] | None:
    """Return one row a pair; None where the model says nothing of its damping."""
    before, after = (_ratios(s.states[0].seen) for s in (done.before, done.after))
    if not after:
        return None
    return Table(
        DampingRow(test + 1, finite(100.0 * known), before.get(test, (None, None))[1], found)
        for test, (known, found) in after.items()
    )


def _ratios(seen: Seen) -> dict[int, tuple[float, float]]:
    """By test mode: its ratio, NaN unknown, and that of the analysis in percent."""
    pairs = seen.damped
    if pairs is None or not seen.model.damped:
        return {}
    found = 100.0 * ratios(pairs.model.poles(pairs.turned))
    known = np.full(len(found), np.nan) if pairs.measured is None else pairs.measured
    both = zip(known.tolist(), found.tolist(), strict=True)
    return {q.test: pair for q, pair in zip(seen.pairs, both, strict=True)}


_DRAWS = 1000
"""Samples that are told one by one, at most."""


def sample_rows(
    parameters: Sequence[Parameter], sampled: Sampled | None
) -> Table[SampleRow] | None:
    """Return one row a sampled parameter; None without samples."""
    if sampled is None:
        return None
    chains = sampled.chains
    x = chains.samples
    columns = (
        x.mean(axis=0),
        x.std(axis=0),
        *np.quantile(x, (0.025, 0.5, 0.975), axis=0),
        chains.effective,
        chains.spread,
    )
    return Table(
        SampleRow(parameters[k].name, *(float(c[i]) for c in columns))
        for i, k in enumerate(sampled.parameters)
    )


def drawn(parameters: Sequence[Parameter], sampled: Sampled | None) -> DrawsTable | None:
    """Return samples one by one; None without any."""
    if sampled is None:
        return None
    x = sampled.chains.samples
    at = np.linspace(0, len(x) - 1, min(len(x), _DRAWS)).astype(int)
    return DrawsTable(tuple(parameters[k].name for k in sampled.parameters), x[at])


def posterior_table(parameters: Sequence[Parameter], done: Updated) -> LikenessTable | None:
    """Return the correlation of the factors that have a standard error."""
    known = np.flatnonzero(np.isfinite(done.standard_error) & (done.standard_error > 0.0))
    if done.covariance is None or len(known) < 2:
        return None
    deviation = done.standard_error[known]
    values = done.covariance[np.ix_(known, known)] / np.outer(deviation, deviation)
    return LikenessTable(tuple(parameters[k].name for k in known), values)


def weights_table(errors: ModeErrors | None) -> WeightsTable | None:
    """Return what identified modes weigh by; None where nothing is known of their errors."""
    if errors is None:
        return None
    return WeightsTable(100.0 * errors.frequency, 100.0 * errors.length, errors.sensors)
