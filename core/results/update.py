"""The tables of an update."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Floats
from ..correlation.mode_errors import ModeErrors
from ..data.parameter import Parameter
from ..noun import OPTIONAL, Noun, key
from ..updating.update import Iteration, Updated
from .correlation import Compared, PairRow, RunTables
from .plain import Table


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
    """What ``update`` answers."""

    verb = "update"
    history: Table[Iteration]
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
    error = [None if np.isnan(e) else e for e in done.standard_error.tolist()]
    return Table(
        ParameterRow(q.name, q.handle, q.deck_values, tuple(values), f, e, bound)
        for q, f, e, bound, values in zip(
            parameters, done.factors.tolist(), error, done.at_bound.tolist(), written, strict=True
        )
    )


def weights_table(errors: ModeErrors | None) -> WeightsTable | None:
    """Return what identified modes weigh by; None where nothing is known of their errors."""
    if errors is None:
        return None
    return WeightsTable(100.0 * errors.frequency, 100.0 * errors.length, errors.sensors)
