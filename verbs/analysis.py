"""The analysis side of a verb, and both sides brought together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from ..core.arrays import Floats
from ..core.correlation.comparison import Comparison, Placed, compare, place_test
from ..core.data.geometry import Geometry
from ..core.data.modes import Modes
from ..core.data.parametric_model import Model
from ..core.errors import InputError, naming
from .files.sources import Measured, Source, file_or_pynastran, geometry_of, read_deck
from .studies.study import Study
from .studies.study_tables import value_at

if TYPE_CHECKING:
    from ..adapters.nastran import Deck, ParameterSpec
    from ..core.updating.residuals import Beside, Responses, Target


_ALONG = 0.99
"""Cosine from which on a sensor and a force at one node are along one direction."""


@dataclass(frozen=True, eq=False)
class Analysis:
    """The analysis side: the deck (None where a model was given), its model and its modes.

    `specs` are what the parameters of the model stand for in the deck; `given` is the deck as it
    came, before properties were split for parameters of some elements.
    """

    deck: Deck | None
    specs: tuple[ParameterSpec, ...]
    model: Model
    modes: Modes
    rigid_body_modes: int
    warnings: tuple[str, ...]
    given: Deck | None = None

    @property
    def geometry(self) -> Geometry:
        """Of the model, with the length unit that the deck declares."""
        return geometry_of(self.model, self.deck)


def read_analysis(
    source: Source, study: Study, fmax: float, modes: Source | None = None
) -> Analysis:
    """Assemble a deck and find its modes up to `fmax`, or take them from where they are.

    At least as many modes as the deck asks for are found.

    Parameters
    ----------
    source : path, Deck or Model
    study : Study
    fmax : float
    modes : path or Modes, optional
        Analysis modes of the user's own Nastran run.
    """
    from ..adapters.nastran import build_model, drawn_model, parse_parameter
    from ..adapters.nastran.assembly.wide_parameters import parameters_of
    from ..core.eigen import normal_modes

    deck = None if isinstance(source, Model) else read_deck(source)
    name = None if deck is None else deck.path
    given = deck
    unknown: tuple[str, ...] = ()
    with naming(name):
        if deck is None:
            specs = tuple(map(parse_parameter, study.parameters))
        else:
            deck, specs = parameters_of(deck, study.parameters)
        try:
            model = source if deck is None else build_model(deck, specs, study.damped)
        except InputError as error:
            if modes is None or deck is None or specs:
                raise
            model = drawn_model(deck)
            unknown = (f"grids and elements only are taken of the deck: {error}",)
    assert isinstance(model, Model)
    warnings = (*(deck.warnings if deck else ()), *model.warnings, *unknown)
    if modes is not None:
        known = analysis_modes(modes, deck)
        return Analysis(deck, specs, model, known, rigid_count(known), warnings, given)
    asked = deck.eigen.nd if deck and deck.eigen and deck.eigen.nd else 0
    with naming(name):
        solution = normal_modes.solve(model, fmax=fmax)
        if len(solution.eigenvalues) < asked:
            solution = normal_modes.solve(model, n_modes=asked)
    found = normal_modes.modes_of(model, solution)
    said = (*warnings, *solution.warnings)
    return Analysis(deck, specs, model, found, solution.rigid_body_modes, said, given)


def analysis_modes(source: Source, deck: Deck | None) -> Modes:
    """Return analysis modes of the user's own Nastran run, or those that a store holds."""
    from ..adapters.nastran import read_modes
    from ..adapters.store import is_store
    from .runs.solved import Solved

    if isinstance(source, Solved):
        return source.shapes
    if isinstance(source, Modes):
        return source
    path = file_or_pynastran(source, "modes")
    stored = isinstance(path, Path) and is_store(path)
    return _stored_modes(path, deck) if stored else read_modes(path, deck)


def _stored_modes(path: Path, deck: Deck | None) -> Modes:
    """Return the modes of a model that a store holds: those of the analysis, or the only ones."""
    from ..adapters.nastran import drawn_model
    from ..adapters.store import read_store

    held = read_store(path).modes
    chosen = [*held] if len(held) == 1 else [name for name in held if name == "analysis"]
    if not chosen:
        named = ", ".join(held) or "none"
        raise InputError(f"{path} holds no modes of an analysis (its modes: {named})", file=path)
    found = held[chosen[0]]
    there = found.dofs.node if deck is None else drawn_model(deck).dofs.node
    strange = np.setdiff1d(found.dofs.node, there)
    if len(strange):
        raise InputError(f"{path}: grid {strange[0]} is not in the deck", file=path)
    return found


def placed(model: Model, deck: Deck | None, modes: Modes, test: Measured, study: Study) -> Placed:
    """Return the test laid onto the model."""
    with naming(test.name):
        found = place_test(
            geometry_of(model, deck),
            modes,
            test.measurement,
            study.deck_length_unit,
            motion=model.expansion,
            seed=study.seed,
            node_map=dict(study.node_map),
        )
        there = len(found.test)
        for key in ("mode_weights", "mode_names"):
            named = max((m for m, _ in getattr(study, key)), default=0)
            if named > there:
                raise InputError(f"{key} names test mode {named}; the test has {there}")
        if not study.mode_weights:
            return found
        return replace(found, weights=study.weights.of(range(there)))


def correlated(analysis: Analysis, test: Measured, study: Study) -> Comparison:
    """Return both sides correlated."""
    on_model = placed(analysis.model, analysis.deck, analysis.modes, test, study)
    found = compare(
        analysis.geometry, analysis.modes, on_model, study.criteria, analysis.rigid_body_modes
    )
    return replace(found, warnings=(*analysis.warnings, *found.warnings))


def target_of(model: Model, placed: Placed, study: Study) -> Target:
    """Return what residuals compare the model with; of its modes those that take part.

    Raises
    ------
    InputError
        The test has no mode that takes part; the model has no place of a load or a reading.
    """
    from ..core.updating.residuals import Target

    wanted, count = study.test_modes, len(placed.test)
    if wanted and max(wanted) > count:
        raise InputError(f"test_modes names mode {max(wanted)}; the test has {count} modes")
    part = study.criteria.test_modes(placed.test.frequencies_hz)
    left = [m - 1 for m in wanted or range(1, count + 1) if part[m - 1]]
    if not left:
        raise InputError("all of test_modes are excluded or outside of the bands")
    chosen = tuple(left) if len(left) < count else None
    errors = placed.errors
    return Target(
        placed.test.frequencies_hz,
        placed.weighted(placed.test.shapes),
        placed.weighted(placed.observation.matrix @ model.expansion),
        chosen,
        None if errors is None else errors.frequency,
        None if errors is None else errors.length,
        _beside(model, study),
        placed.test.damping,
        placed.damping_std,
        _responses(model, placed) if study.hears else None,
    )


def _responses(model: Model, placed: Placed) -> Responses | None:
    """Return the frequency responses of a test on the free degrees of freedom of a model."""
    from ..core.discovery.likelihood.frf_evidence import place_responses
    from ..core.updating.residuals import Responses

    found, why = place_responses(placed.frfs, placed, model.geometry, model.dofs, model.expansion)
    if why:
        raise InputError("; ".join(why))
    if found is None:
        return None
    frfs, points = found.frfs, []
    for by in range(len(frfs.references)):
        same = frfs.responses.node == frfs.references.node[by]
        along = np.abs(frfs.responses.axis @ frfs.references.axis[by]) > _ALONG
        of_kind = (frfs.responses.component > 3) == (frfs.references.component[by] > 3)
        points += [(int(out), by) for out in np.flatnonzero(same & along & of_kind)]
    onto = model.expansion
    rows = (found.observed @ onto).tocsr(), (found.driven @ onto).tocsr()
    return Responses(frfs.frequencies_hz, frfs.values, frfs.order, *rows, tuple(points))


def _beside(model: Model, study: Study) -> Beside:
    from ..core.statespace.channels import read_channels, rows_of
    from ..core.updating.residuals import Beside, LoadCase
    from .studies.relations import read_relation

    def rows(told: Sequence[str]) -> tuple[sp.csr_matrix, Floats]:
        places, values = zip(*(value_at(text) for text in told), strict=True)
        channels = read_channels(places, "input")
        at = sp.csr_matrix(rows_of(channels, model.dofs, "the deck")) @ model.expansion
        return at.tocsr(), np.array(values)

    cases = []
    for case in study.load_cases:
        loaded, forces = rows(case.loads)
        cases.append(LoadCase(np.asarray(loaded.T @ forces), *rows(case.readings)))
    centre = study.measured_centre_of_gravity
    known = tuple(read_relation(text, model.parameters) for text in study.relations)
    return Beside(study.measured_mass, np.array(centre) if centre else None, tuple(cases), known)


def both_given(deck: Source | None, test: Source | None, study: Study) -> tuple[Source, Source]:
    """Return the deck and the test: as given, else as the study names them.

    Raises
    ------
    InputError
        One is in neither.
    """
    from .studies.imprint import imprint_of

    require_one(study)
    deck = study.deck if deck is None else deck
    test = study.test or None if test is None else test
    if deck is None or test is None:
        raise InputError("give a deck and a test, or a study that names both")
    _require_order(deck, test)
    imprint_of(study)
    return deck, test


def require_one(study: Study) -> None:
    """Refuse a study of several configurations."""
    if study.configurations:
        raise InputError(
            "the study names configurations, which update moves together; this looks at one "
            "configuration: give its deck and test"
        )


def _require_order(deck: Source, test: Source) -> None:
    """Refuse a test that was given as the deck and a deck as the test."""
    from .files.read import DECK, UNIVERSAL, kind_of_file

    last = test[0] if isinstance(test, list | tuple) and len(test) == 1 else test
    if isinstance(deck, str | Path) and isinstance(last, str | Path):
        paths = Path(deck), Path(last)
        if all(p.is_file() for p in paths):
            kinds = [kind_of_file(p) for p in paths]
            if kinds == [UNIVERSAL, DECK]:
                raise InputError(
                    f"{deck} is a universal file and {last} a deck: give the deck first, then the "
                    "test"
                )


def named(study: Study, deck: Deck | None, test: Measured, modes: Source | None) -> Study:
    """Return the study with the files that took part, so that it runs again."""
    from_file = modes if isinstance(modes, str | Path) else None
    return replace(
        study,
        deck=deck.path if deck and deck.on_disk else None,
        test=test.files,
        modes=None if from_file is None else Path(from_file),
    )


def rigid_count(modes: Modes) -> int:
    """Count the leading modes that are rigid-body motions to the rounding of the file."""
    hz = modes.frequencies_hz
    return int(np.argmax(hz > 1e-3 * np.max(hz))) if len(hz) else 0
