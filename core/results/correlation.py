"""The tables of a correlation; mode numbers count from 1 in their own files."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import Floats
from ..correlation.comparison import Comparison
from ..correlation.criteria import Criteria
from ..correlation.harmonics import Harmonic
from ..correlation.mode_pairing import Correlation
from ..correlation.revolution import Revolution, revolution
from ..localisation.sensor_agreement import sensor_agreement
from ..noun import OPTIONAL, Noun, key
from . import export
from .agreement import AgreementRow, AutoMacTable, agreement_table
from .doubts import doubts
from .made import MadeTables, ModeNameRow, WeightRow
from .orthogonality import OrthogonalityTables
from .plain import Matrix, Table, Tables, finite
from .response_agreement import ResponseTables

_SHOWN = 12
"""Modes of either side of a MAC matrix on a page."""


@dataclass(frozen=True)
class PairRow:
    """One test mode with one analysis mode; `deviation_percent` is 100·(analysis − test)/test.

    Damping is a fraction of critical, `test_mpc` the modal phase collinearity, 0..1; None unknown.
    Of a body of revolution: the harmonic, its number of waves round the axis, and where a crest of
    radial motion is, from 0 up to half a wave, from the basic axis that follows the axis in turn.
    """

    test: int
    analysis: int
    test_hz: float
    analysis_hz: float
    deviation_percent: float
    mac: float
    cluster: int | None
    rotation_deg: float | None
    test_damping: float | None = None
    analysis_damping: float | None = None
    test_mpc: float | None = None
    test_harmonic: int | None = None
    test_orientation_deg: float | None = None
    analysis_harmonic: int | None = None
    analysis_orientation_deg: float | None = None

    @property
    def waves(self) -> str:
        """The harmonics in words, the test's first: ``n = 3, 17.4° / 17.9°``; empty without any."""
        both = (self.test_harmonic, self.analysis_harmonic)
        if self.test_harmonic is None:
            return ""
        number = both[:1] if both[0] == both[1] else both
        return _in_words(number, (self.test_orientation_deg, self.analysis_orientation_deg))

    @property
    def waves_by_side(self) -> tuple[str, str]:
        """The same of the test mode and of the analysis mode: ``n = 3, 17.4°``."""
        sides = (
            (self.test_harmonic, self.test_orientation_deg),
            (self.analysis_harmonic, self.analysis_orientation_deg),
        )
        test, analysis = ("" if n is None else _in_words((n,), (at,)) for n, at in sides)
        return test, analysis


def _in_words(numbers: Sequence[int | None], degrees: Sequence[float | None]) -> str:
    said = [f"n = {' / '.join('?' if n is None else str(n) for n in numbers)}"]
    at = " / ".join(f"{x:.1f}°" for x in degrees if x is not None)
    return ", ".join([*said, at] if at else said)


@dataclass(frozen=True)
class ClusterRow:
    """Close modes of both sides that are treated as one subspace.

    `harmonic` is the number of waves that all of its test modes have round the axis.
    """

    id: int
    analysis: tuple[int, ...]
    test: tuple[int, ...]
    harmonic: int | None = None


@dataclass(frozen=True, eq=False)
class AxisRow:
    """The axis that the sensors stand round, in the analysis frame, deck length unit.

    `highest` harmonic that the sensors tell from lower ones.
    """

    origin: Floats
    direction: Floats
    highest: int


@dataclass(frozen=True, eq=False)
class MacTable(Matrix):
    """MAC `values` (n_test, n_analysis), 0..1, of the modes whose numbers stand beside."""

    test: tuple[int, ...]
    analysis: tuple[int, ...]
    values: Floats

    def __len__(self) -> int:
        return len(self.test)

    @property
    def _wide(self) -> tuple[list[export.Column], list[dict[str, object]]]:
        names = ["test mode", *(f"analysis mode {a}" for a in self.analysis)]
        rows = zip(self.test, self.values.tolist(), strict=True)
        records = [dict(zip(names, (t, *row), strict=True)) for t, row in rows]
        return [export.Column(name) for name in names], records

    def _repr_html_(self) -> str:
        rows, columns = len(self.test), len(self.analysis)
        if max(rows, columns) <= _SHOWN:
            return super()._repr_html_()
        part = MacTable(self.test[:_SHOWN], self.analysis[:_SHOWN], self.values[:_SHOWN, :_SHOWN])
        return (
            f"{part._repr_html_()}<p>… the first of {rows} test modes and {columns} analysis "
            "modes</p>"
        )


@dataclass(frozen=True)
class Gap:
    """How far apart model and test are, in four figures; None without pairs."""

    pairs: int
    mean_abs_deviation_percent: float | None
    worst_deviation_percent: float | None
    mean_mac: float | None


@dataclass(frozen=True)
class SensorRow:
    """A sensor on the model: axis and position in the analysis frame, deck length unit."""

    node: int
    direction: str
    axis: tuple[float, ...]
    xyz: tuple[float, ...]
    nearest_grid: int
    distance: float


@dataclass(frozen=True, eq=False)
class AlignmentTable(Noun):
    """How the test was laid onto the model: x_analysis = rotation · (scale · x_test) + translation.

    Shapes: `rotation` (3, 3), `translation` (3,) and `rms` in the deck length unit, which is
    `length_unit` as stated or taken; None where nothing tells it.
    """

    rotation: Floats
    translation: Floats
    scale: float
    rms: float
    sensors: Table[SensorRow]
    length_unit: str | None = field(default=None, metadata=OPTIONAL)


@dataclass(frozen=True, eq=False, kw_only=True)
class Compared(Tables):
    """A model and a test, correlated.

    `mac` is as measured, `mac_rotated` after rotation; `test_hz` (n_test,) and `analysis_hz`
    (n_analysis,) are the frequencies of all modes. `test_damping`, `analysis_damping` (fractions
    of critical) and `test_mpc` (modal phase collinearity of the test's complex shapes) likewise,
    NaN where unknown. `agreement` is of the sensors, `auto_mac_test` and `auto_mac_analysis` of
    the modes of one side among themselves at the sensors.
    """

    pairs: Table[PairRow]
    unpaired_test: tuple[int, ...]
    unpaired_analysis: tuple[int, ...]
    clusters: Table[ClusterRow]
    mac: MacTable
    mac_rotated: MacTable
    test_hz: Floats
    analysis_hz: Floats
    summary: Gap
    criteria: Criteria
    alignment: AlignmentTable
    warnings: tuple[str, ...] = ()
    test_damping: Floats = field(default_factory=lambda: np.empty(0))
    analysis_damping: Floats = field(default_factory=lambda: np.empty(0))
    test_mpc: Floats = field(default_factory=lambda: np.empty(0))
    agreement: Table[AgreementRow] = field(default_factory=lambda: Table((), AgreementRow))
    auto_mac_test: AutoMacTable | None = field(default=None, metadata=OPTIONAL)
    auto_mac_analysis: AutoMacTable | None = field(default=None, metadata=OPTIONAL)
    axis_of_revolution: AxisRow | None = field(default=None, metadata=OPTIONAL)

    @property
    def waves(self) -> tuple[dict[int, str], dict[int, str]]:
        """What waves paired modes are, in words, by test mode and by analysis mode."""
        both = [(p.test, p.analysis, *p.waves_by_side) for p in self.pairs]
        return {t: w for t, _, w, _ in both if w}, {a: w for _, a, _, w in both if w}

    @property
    def test_modes(self) -> tuple[int, ...]:
        """Numbers of the test modes that took part."""
        return tuple(sorted((*(p.test for p in self.pairs), *self.unpaired_test)))


@dataclass(frozen=True, eq=False, kw_only=True)
class RunTables(MadeTables):
    """Base of what a verb that compares answers.

    `weight` of the decks, as they came and changed; `mode_names` that the user gave test modes.
    """

    weight: Table[WeightRow] = field(default_factory=lambda: Table((), WeightRow))
    mode_names: Table[ModeNameRow] = field(default_factory=lambda: Table((), ModeNameRow))

    if TYPE_CHECKING:
        warnings: tuple[str, ...]

    @property
    def sources(self) -> tuple[str, tuple[str, ...]]:
        """The deck as it came and the files of the test that were compared."""
        raise NotImplementedError

    @property
    def states(self) -> tuple[Compared, ...]:
        """The correlations in turn: of the deck as it came, and as changed where it was."""
        raise NotImplementedError

    @property
    def named(self) -> dict[int, str]:
        """Names of test modes by their numbers."""
        return {row.test: row.name for row in self.mode_names}

    @property
    def final(self) -> Compared:
        """The correlation that counts: of the changed deck where there is one."""
        return self.states[-1]

    @property
    def initial(self) -> Compared | None:
        """The correlation of the deck as it came, where the verb changed it."""
        return self.states[0] if len(self.states) > 1 else None

    @property
    def all_warnings(self) -> tuple[str, ...]:
        """Warnings of the run and of its correlations, each once."""
        return tuple(dict.fromkeys([*self.warnings, *(w for s in self.states for w in s.warnings)]))


@dataclass(frozen=True, eq=False, kw_only=True)
class CorrelateTables(Compared, RunTables):
    """What ``correlate`` answers."""

    verb = "correlate"
    deck_file: str = field(metadata=key("deck"))
    test_files: tuple[str, ...] = field(metadata=key("test"))
    orthogonality: OrthogonalityTables | None = field(default=None, metadata=OPTIONAL)
    responses: ResponseTables | None = field(default=None, metadata=OPTIONAL)

    @property
    def sources(self) -> tuple[str, tuple[str, ...]]:
        """The deck and the files of the test."""
        return self.deck_file, self.test_files

    @property
    def states(self) -> tuple[Compared, ...]:
        """The correlation itself."""
        return (self,)


def compared(c: Comparison) -> Compared:
    """Return the tables of a comparison."""
    found, mpc, round_axis = c.correlation, _collinearity(c), revolution(c)
    analysis = np.asarray(c.observation.matrix @ c.analysis.shapes)
    agree = sensor_agreement(found, analysis, c.test.shapes)
    return Compared(
        pairs=_pair_rows(found, c.test.damping, c.analysis.damping, mpc, round_axis),
        unpaired_test=tuple(t + 1 for t in found.unpaired_test),
        unpaired_analysis=tuple(a + 1 for a in found.unpaired_analysis),
        clusters=Table(
            ClusterRow(
                k,
                tuple(a + 1 for a in g.analysis),
                tuple(t + 1 for t in g.test),
                _common_harmonic(round_axis, g.test),
            )
            for k, g in enumerate(found.clusters, 1)
        ),
        mac=_mac(found.mac),
        mac_rotated=_mac(found.mac_rotated),
        test_hz=c.test.frequencies_hz,
        analysis_hz=c.analysis.frequencies_hz,
        summary=gap(found),
        criteria=found.criteria,
        alignment=_alignment(c),
        warnings=(*c.warnings, *doubts(c, agree)),
        test_damping=c.test.damping,
        analysis_damping=c.analysis.damping,
        test_mpc=mpc,
        agreement=agreement_table(agree, c.observation.sensors.labels),
        auto_mac_test=AutoMacTable.of(c.test.shapes),
        auto_mac_analysis=AutoMacTable.of(analysis),
        axis_of_revolution=_axis(round_axis),
    )


def _axis(found: Revolution | None) -> AxisRow | None:
    if found is None:
        return None
    known = [h.highest for h in (*found.test, *found.analysis) if h is not None]
    return AxisRow(found.origin, found.direction, max(known, default=0))


def _common_harmonic(found: Revolution | None, test: Collection[int]) -> int | None:
    of = {h.number if h else None for h in (found.test[t] for t in test)} if found else set()
    return of.pop() if len(of) == 1 else None


def _waves(found: Harmonic | None) -> tuple[int | None, float | None]:
    return (None, None) if found is None else (found.number, found.orientation_deg)


def _collinearity(c: Comparison) -> Floats:
    if c.placed.mpc is not None:
        return c.placed.mpc
    if not c.test.is_complex:
        return np.full(len(c.test), np.nan)
    from ..identification.quality import phase_collinearity

    return phase_collinearity(c.test.shapes)


def _pair_rows(
    found: Correlation,
    damping: Floats,
    of_analysis: Floats,
    mpc: Floats,
    round_axis: Revolution | None,
) -> Table[PairRow]:
    return Table(
        PairRow(
            p.test + 1,
            p.analysis + 1,
            p.test_hz,
            p.analysis_hz,
            p.deviation_percent,
            p.mac,
            None if p.cluster is None else p.cluster + 1,
            p.rotation_deg,
            finite(damping[p.test]),
            finite(of_analysis[p.analysis]),
            finite(mpc[p.test]),
            *_waves(round_axis.test[p.test] if round_axis else None),
            *_waves(round_axis.analysis[p.analysis] if round_axis else None),
        )
        for p in found.pairs
    )


def gap(found: Correlation, among: Collection[int] | None = None) -> Gap:
    """Return how far apart model and test are, over all test modes or those of some numbers."""
    kept = tuple(p for p in found.pairs if among is None or p.test + 1 in among)
    found = replace(found, pairs=kept)
    return Gap(
        len(kept), found.mean_abs_deviation_percent, found.worst_deviation_percent, found.mean_mac
    )


def _mac(values: Floats) -> MacTable:
    n_test, n_analysis = values.shape
    return MacTable(tuple(range(1, n_test + 1)), tuple(range(1, n_analysis + 1)), values)


def _alignment(c: Comparison) -> AlignmentTable:
    move, seen = c.alignment, c.observation
    at = seen.sensors
    columns = (at.node, at.directions, at.axis, seen.xyz, seen.nearest_grid, seen.distance)
    sensors = Table(
        SensorRow(int(node), way, tuple(axis.tolist()), tuple(xyz.tolist()), int(grid), float(off))
        for node, way, axis, xyz, grid, off in zip(*columns, strict=True)
    )
    scale = c.placed.length_factor
    unit = c.placed.test_geometry.length_unit
    return AlignmentTable(move.rotation, move.translation, scale, move.rms, sensors, unit)
