"""From the files a study names to neutral nouns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..core.comparison import Comparison, Placed, compare, place_test
from ..core.correlate import Criteria
from ..core.errors import InputError, TrueupError
from ..core.measurement import Measurement
from ..core.model import Model
from ..core.modes import Modes
from .study import Study


@dataclass(frozen=True, eq=False)
class Analysis:
    """The analysis side: the deck, its model and its modes."""

    deck: Any
    model: Model
    modes: Modes
    rigid_body_modes: int
    warnings: tuple[str, ...]


@contextmanager
def naming(path: Path) -> Iterator[None]:
    """Put the name of the file at fault before sentences that do not hold it."""
    try:
        yield
    except TrueupError as error:
        if path.name in str(error):
            raise
        raise type(error)(f"{path}: {error}") from error


def criteria_of(study: Study) -> Criteria:
    """Return the pairing criteria of a study."""
    return Criteria(study.mac_min, study.frequency_tolerance, study.cluster_width, study.rotate)


def read_measurement(study: Study) -> Measurement:
    """Read the test files of a study; modes are identified where it holds responses only."""
    from ..adapters.universal import read_test
    from .identifying import with_modes

    missing = [str(p) for p in study.test if not p.is_file()]
    if missing:
        raise InputError(f"{missing[0]} does not exist or is not a file")
    return with_modes(_own_systems(study.test, read_test(list(study.test))))


def _own_systems(files: Sequence[Path], measurement: Measurement) -> Measurement:
    """Return a test of several files with its responses along the axes of their own file.

    Of nodes that stand in several files with different displacement systems only the first are
    kept; responses that are whole in a file of their own, geometry included, are read from there.
    """
    from ..adapters.universal import read_test

    if len(files) < 2 or measurement.frfs is None:
        return measurement
    alone = []
    for file in files:
        with suppress(InputError):
            alone.append(read_test([file]))
    whole = [m.frfs for m in alone if m.frfs is not None]
    if len(whole) != 1 or len(whole[0].responses) < len(measurement.frfs.responses):
        return measurement
    if np.any(measurement.geometry.index_of(whole[0].responses.node) < 0):
        return measurement
    return replace(measurement, frfs=whole[0])


def read_analysis(study: Study, fmax: float) -> Analysis:
    """Read the deck, assemble it and find its modes up to `fmax`, or take them from a file.

    At least as many modes as the deck asks for are found.
    """
    from ..adapters.nastran import build_model, parse_parameter, read_deck
    from ..core import eigen

    assert study.deck is not None
    deck = read_deck(study.deck)
    specs = [parse_parameter(p) for p in study.parameters]
    with naming(study.deck):
        model = build_model(deck, specs)
    warnings = (*deck.warnings, *model.warnings)
    if study.modes is not None:
        modes = read_analysis_modes(study.modes, deck)
        return Analysis(deck, model, modes, _rigid(modes), warnings)
    asked = deck.eigen.nd if deck.eigen and deck.eigen.nd else 0
    with naming(study.deck):
        solution = eigen.solve(model, fmax=fmax)
        if len(solution.eigenvalues) < asked:
            solution = eigen.solve(model, n_modes=asked)
    modes = eigen.modes_of(model, solution)
    return Analysis(deck, model, modes, solution.rigid_body_modes, (*warnings, *solution.warnings))


def read_analysis_modes(path: Path, deck: Any) -> Modes:
    """Read analysis modes of the user's own Nastran run."""
    from ..adapters.nastran import read_modes

    return read_modes(path, deck)


def highest_frequency(measurement: Measurement, study: Study) -> float:
    """Return the frequency up to which analysis modes could pair with the test, Hz."""
    if measurement.modes is None or not len(measurement.modes):
        found = "" if measurement.frfs is None else " (none stands out of its responses)"
        raise InputError(f"{study.test[0]}: the test holds no modes{found}")
    if np.max(measurement.modes.frequencies_hz) == 0.0:
        raise InputError(f"{study.test[0]}: all modes are at 0 Hz or have no frequency in the file")
    return float(measurement.modes.frequencies_hz.max() * (1.0 + study.frequency_tolerance))


def correlated(study: Study) -> tuple[Analysis, Placed, Comparison]:
    """Read both sides of a study and correlate them."""
    measurement = read_measurement(study)
    analysis = read_analysis(study, highest_frequency(measurement, study))
    geometry = analysis.model.geometry
    if geometry.length_unit is None and analysis.deck.length_unit:
        geometry = replace(geometry, length_unit=analysis.deck.length_unit)
    with naming(study.test[0]):
        placed = place_test(
            geometry,
            analysis.modes,
            measurement,
            study.deck_length_unit,
            motion=analysis.model.expansion,
            seed=study.seed,
        )
    found = compare(geometry, analysis.modes, placed, criteria_of(study), analysis.rigid_body_modes)
    return (
        analysis,
        placed,
        replace(found, warnings=(*analysis.warnings, *found.warnings)),
    )


def _rigid(modes: Modes) -> int:
    """Count the leading modes that are rigid-body motions to the rounding of the file."""
    hz = modes.frequencies_hz
    if not len(hz):
        return 0
    leading = np.flatnonzero(hz > 1e-3 * np.max(hz))
    return int(leading[0]) if len(leading) else 0
