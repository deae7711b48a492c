"""The tables of what may be moved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from ..arrays import Floats
from ..noun import key
from . import export
from .made import MadeTables
from .plain import Matrix, Table


@dataclass(frozen=True)
class PropertyRow:
    """A card with values that may move; `elements` have it, through a property if a material."""

    card: str
    id: int
    elements: int
    values: dict[str, float]


@dataclass(frozen=True)
class CandidateRow:
    """A parameter as it could be named, and what is known of it before anything moves.

    `sensitivity` is the largest |d ln f / d ln p| of the modes. Standard errors are of the factor,
    `error_alone` with the others held, `error_together` with all moving: None where the modes say
    nothing. `group` numbers those that are not told apart. `recommended` counts from 1;
    `explained` is the share of the misfit that it and those before explain to first order, None
    without a test.
    """

    name: str
    cards: tuple[str, ...]
    values: tuple[float, ...]
    sensitivity: float
    error_alone: float | None
    error_together: float | None
    group: int
    recommended: int | None
    explained: float | None


@dataclass(frozen=True)
class CombinationRow:
    """A combination of parameters and how well the modes see it, best first.

    `weights` are those of the parameters with a part in it, by name; `standard_error` of a move
    along it is None where it is not seen.
    """

    singular_value: float
    standard_error: float | None
    weights: dict[str, float]


@dataclass(frozen=True, eq=False)
class SensitivityTable(Matrix):
    """`values` (n_mode, n_parameter): d ln f / d ln p of each mode, by name of the parameter."""

    modes: tuple[int, ...]
    hz: Floats
    parameters: tuple[str, ...]
    values: Floats

    def __len__(self) -> int:
        return len(self.modes)

    @property
    def _wide(self) -> tuple[list[export.Column], list[dict[str, object]]]:
        columns = [export.Column("mode"), export.Column("frequency", "Hz")]
        names = ["mode", "frequency", *self.parameters]
        rows = zip(self.modes, self.hz.tolist(), self.values.tolist(), strict=True)
        records = [dict(zip(names, (m, f, *row), strict=True)) for m, f, row in rows]
        return [*columns, *map(export.Column, self.parameters)], records


@dataclass(frozen=True, eq=False)
class LikenessTable(Matrix):
    """`values` (n, n): cosines of what two parameters do to the modes, by name."""

    parameters: tuple[str, ...]
    values: Floats

    def __len__(self) -> int:
        return len(self.parameters)

    @property
    def _wide(self) -> tuple[list[export.Column], list[dict[str, object]]]:
        names = ["parameter", *self.parameters]
        rows = zip(self.parameters, self.values.tolist(), strict=True)
        records = [dict(zip(names, (name, *row), strict=True)) for name, row in rows]
        return [export.Column(name) for name in names], records


@dataclass(frozen=True, eq=False, kw_only=True)
class ParametersTables(MadeTables):
    """What ``parameters`` answers.

    `recommended` are parameters as ``update -p`` takes them. `sensitivities` rows are test modes
    where there is a test (those that pair), else elastic analysis modes.
    """

    verb = "parameters"
    deck_file: str = field(metadata=key("deck"))
    test_files: tuple[str, ...] = field(metadata=key("test"))
    properties: Table[PropertyRow]
    candidates: Table[CandidateRow]
    combinations: Table[CombinationRow]
    sensitivities: SensitivityTable | None
    likeness: LikenessTable | None
    recommended: tuple[str, ...]
    warnings: tuple[str, ...]


def weights_of(direction: Floats, names: Sequence[str], least: float) -> dict[str, float]:
    """Return the parameters with a part in a direction (n,), the largest first."""
    order = sorted(range(len(names)), key=lambda k: -abs(direction[k]))
    return {names[k]: float(direction[k]) for k in order if abs(direction[k]) >= least}
