"""The tables of what a discovery stands on: damping, frequency responses, maps of the misfit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats
from ..correlation.comparison import Comparison
from ..discovery.findings import Discovery, ResponseGap
from ..discovery.likelihood.complex_modes import of_pairs
from ..discovery.screening.completed_model import SolvedModel
from ..localisation.error_localisation import Disagreement
from ..noun import Noun
from .plain import Table


@dataclass(frozen=True)
class DampingRow:
    """Damping ratio of a test mode beside those foretold; None without a partner."""

    test: int
    measured: float
    before: float | None
    after: float | None


@dataclass(frozen=True)
class BeforeAfter:
    """A figure of the deck as it was and as completed."""

    before: float | None
    after: float | None


@dataclass(frozen=True)
class DampingTable:
    """Measured and foretold damping; `typical_factor` is exp of the mean |ln foretold/measured|."""

    modes: Table[DampingRow]
    typical_factor: BeforeAfter


@dataclass(frozen=True)
class ResponseRow:
    """Frequency response assurance of a sensor before and after."""

    sensor: str
    before: float
    after: float


@dataclass(frozen=True)
class LogMisfit:
    """Rms log ratio of magnitudes, also with only the known parameters moved."""

    before: float
    parameters: float
    after: float


@dataclass(frozen=True)
class ResponseTable:
    """How well measured frequency responses are met."""

    responses: Table[ResponseRow]
    references: tuple[str, ...]
    mean_frac: BeforeAfter
    log_misfit: LogMisfit
    lines: int
    independent_lines: float


@dataclass(frozen=True)
class PeakRow:
    """Where a map is largest, and the share of the misfit that it explains there."""

    of: str
    grid: int
    xyz: tuple[float, ...]
    explained: float


@dataclass(frozen=True)
class ModeMisfit:
    """Misfit of a pair in standard deviations."""

    test: int
    analysis: int
    shape: float
    frequency: float


@dataclass(frozen=True)
class SensorMisfit:
    """Misfit of a sensor in standard deviations, and its COMAC."""

    sensor: str
    misfit: float
    comac: float


@dataclass(frozen=True, eq=False)
class MisfitTable(Noun):
    """Maps of the misfit at `grids` (n_place,): see `Disagreement`."""

    grids: tuple[int, ...]
    values: Floats
    mass: Floats
    stiffness: Floats
    ground: Floats
    peaks: Table[PeakRow]
    modes: Table[ModeMisfit]
    sensors: Table[SensorMisfit]


def damping_table(
    found: Discovery, measured: Floats, elastic: Bools, before: SolvedModel, after: SolvedModel
) -> DampingTable | None:
    """Return damping ratios `measured` (n_test,) beside those foretold before and after.

    None where no dashpot is about; `elastic` (n_test,) are the modes that were weighed.
    """
    if found.damping is None or (before.damping is None and after.damping is None):
        return None
    foretold = []
    levels = (found.damping.without, found.damping.beside)
    for side, level in zip((before, after), levels, strict=True):
        phi, D = side.solution.vectors, side.damping
        own = np.zeros((phi.shape[1],) * 2) if D is None else np.asarray(phi.T @ (D @ phi))
        pairs = [(p.test, p.analysis) for p in side.compared.correlation.pairs if elastic[p.test]]
        of_all = np.zeros(len(measured))
        of_all[elastic] = level
        foretold.append(of_pairs(side.solution.eigenvalues, own, of_all, pairs))
    rows = Table(
        DampingRow(j + 1, float(z), foretold[0].get(j), foretold[1].get(j))
        for j, z in enumerate(measured)
        if np.isfinite(z) and z > 0.0
    )
    sides = ([(r.before, r.measured) for r in rows], [(r.after, r.measured) for r in rows])
    return DampingTable(rows, BeforeAfter(*map(_typical, sides)))


def _typical(ratios: Sequence[tuple[float | None, float]]) -> float | None:
    off = [abs(np.log(foretold / measured)) for foretold, measured in ratios if foretold]
    return float(np.exp(np.mean(off))) if off else None


def response_table(found: ResponseGap | None) -> ResponseTable | None:
    """Return how well measured frequency responses are met."""
    if found is None:
        return None
    return ResponseTable(
        Table(map(ResponseRow, found.sensors, found.before, found.after)),
        found.references,
        BeforeAfter(float(np.mean(found.before)), float(np.mean(found.after))),
        LogMisfit(*found.log_misfit),
        found.lines,
        found.independent,
    )


def misfit_table(c: Comparison, found: Disagreement) -> MisfitTable:
    """Return the maps of a misfit: at grids, by mode and by sensor."""
    ids, xyz = c.geometry.ids[found.places], c.geometry.xyz[found.places]
    maps = {"mass": found.mass, "stiffness": found.stiffness, "ground": found.ground}
    told, labels = found.misfit, c.observation.sensors.labels
    return MisfitTable(
        tuple(ids.tolist()),
        found.motion,
        **maps,
        peaks=Table(
            PeakRow(name, int(ids[k]), tuple(xyz[k].tolist()), float(values[k]))
            for name, values in maps.items()
            for k in [int(np.argmax(values))]
        ),
        modes=Table(
            ModeMisfit(p.test + 1, p.analysis + 1, float(s), float(f))
            for p, s, f in zip(c.correlation.pairs, told.by_mode, told.frequency, strict=True)
        ),
        sensors=Table(
            SensorMisfit(label, float(m), float(k))
            for label, m, k in zip(labels, told.by_sensor, told.comac, strict=True)
        ),
    )
