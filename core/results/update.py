"""The tables of an update."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Floats
from ..correlation.mode_errors import ModeErrors
from ..data.parameter import Parameter
from ..noun import Noun
from ..updating.update import Iteration, Updated
from .correlation import Compared, PairRow, RunTables
from .plain import OPTIONAL, Table, key


@dataclass(frozen=True, eq=False)
class ParameterRow:
    """A parameter: values of its fields before and after, and the factor between them.

    `standard_error` of the factor is None where the test says nothing; `significant` is told by
    ``discover`` only.
    """

    name: str
    cards: tuple[str, ...]
    initial: tuple[float, ...]
    updated: tuple[float | None, ...]
    factor: float
    standard_error: float | None
    at_bound: bool
    significant: bool | None = field(default=None, metadata=OPTIONAL)


@dataclass(frozen=True, eq=False)
class IterationRow(Noun):
    """One iteration; `deviations_percent` (n_test,) is NaN for a test mode without partner."""

    iteration: int
    stage: int
    objective: float
    factors: Floats
    deviations_percent: Floats


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
    def final(self) -> Compared:
        """The correlation of the changed deck."""
        return self.after

    @property
    def initial(self) -> Compared | None:
        """The correlation of the deck as it came."""
        return self.before

    @property
    def all_warnings(self) -> tuple[str, ...]:
        """Its warnings and those of both correlations, each once."""
        every = (*self.warnings, *self.before.warnings, *self.after.warnings)
        return tuple(dict.fromkeys(every))


@dataclass(frozen=True, eq=False, kw_only=True)
class UpdateTables(ChangingTables):
    """What ``update`` answers."""

    verb = "update"
    history: Table[IterationRow]
    weights: WeightsTable | None
    eigensolutions: int
    stopped: str

    @property
    def pairs(self) -> Table[PairRow]:
        """The pairs of the changed deck."""
        return self.after.pairs


def parameter_rows(
    parameters: Sequence[Parameter], done: Updated, written: Sequence[Sequence[float | None]]
) -> Table[ParameterRow]:
    """Return one row a parameter; `written` are the values of its fields as in the new deck."""
    return Table(
        ParameterRow(
            q.name,
            q.handle,
            q.deck_values,
            tuple(values),
            float(factor),
            None if np.isnan(error) else float(error),
            bool(bound),
        )
        for q, factor, error, bound, values in zip(
            parameters, done.factors, done.standard_error, done.at_bound, written, strict=True
        )
    )


def iteration_rows(history: Sequence[Iteration]) -> Table[IterationRow]:
    """Return one row an iteration."""
    return Table(
        IterationRow(h.iteration, h.stage + 1, h.objective, h.factors, h.deviations_percent)
        for h in history
    )


def weights_table(errors: ModeErrors | None) -> WeightsTable | None:
    """Return what identified modes weigh by; None where nothing is known of their errors."""
    if errors is None:
        return None
    return WeightsTable(100.0 * errors.frequency, 100.0 * errors.length, errors.sensors)
