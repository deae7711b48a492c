"""The verb `parameters`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np

from ..core.arrays import Floats
from ..core.data.geometry import Geometry
from ..core.data.parametric_model import Model
from ..core.eigen import normal_modes
from ..core.eigen.eigen_numbers import EIGEN
from ..core.errors import InputError, naming
from ..core.noun import BESIDE
from ..core.reduction.eigenpair_derivatives import sensitivities
from ..core.reduction.full_or_reduced import FullOrder
from ..core.results.parameters import (
    CandidateRow,
    CombinationRow,
    LikenessTable,
    ParametersTables,
    SensitivityTable,
    weights_of,
)
from ..core.results.plain import Table, finite
from ..core.updating.identifiability import Identifiability, identifiability
from ..core.updating.objective import Objective
from ..core.updating.parameter_choice import Choice, forward_selection, indistinct
from ..core.updating.residuals import residuals_named
from ..core.updating.residuals.frequencies import FREQUENCIES
from ..core.updating.updating_numbers import UPDATING
from .analysis import placed, require_one, target_of
from .files.made_of import made_of_files
from .files.sources import Measured, Source, measured, read_deck
from .runs.folder import Folder
from .studies.design_variables import optimised, with_design_variables
from .studies.heard import require_heard
from .studies.options import Files, ParametersOptions, Say, said_to, study_of, unheard
from .studies.study import Study
from .studies.study_text import write_study
from .studies.taking_part import refuse_idle

if TYPE_CHECKING:
    from ..adapters.nastran import Deck
    from ..adapters.nastran.editing.changed_deck import ChangedDeck

_MOST = 200
"""Candidates that are looked at where none is named."""


@dataclass(frozen=True, eq=False, kw_only=True)
class MovableParameters(ParametersTables, Folder):
    """What `parameters` found: the tables of result.json as fields.

    `geometry` is of the deck; `places` are the grids that each parameter moves something at;
    `sol200` is the deck as one of SOL 200 whose design variables are the parameters that were
    named, or else those that are recommended, and whose objective is the test's frequencies; None
    without a test.
    """

    geometry: Geometry = field(metadata=BESIDE)
    places: dict[str, tuple[int, ...]] = field(metadata=BESIDE)
    study: Study = field(metadata=BESIDE)
    sol200: ChangedDeck | None = field(default=None, metadata=BESIDE)

    def fill(self, work: Path) -> None:
        """Write everything that a run folder holds into an empty folder."""
        from ..adapters.report.parameters_page import parameters_page
        from .studies.imprint import imprint_of

        super().fill(work)
        page = parameters_page(self, self.geometry, self.places, imprint_of(self.study))
        write_study(work, self.study)
        (work / "report.html").write_text(page, encoding="utf-8")
        if self.sol200 is not None:
            self.sol200.write(work / "sol200")


@dataclass(frozen=True, eq=False)
class _Seen:
    """Derivatives by the parameters: of ln f, and of residuals over their standard deviations.

    `misfit` (n_residual,) are the residuals, None without a test; `analysis_modes` are those that
    pair with its `modes`.
    """

    modes: tuple[int, ...]
    hz: Floats
    slopes: Floats
    gradient: Floats
    misfit: Floats | None = None
    warnings: tuple[str, ...] = ()
    analysis_modes: tuple[int, ...] = ()


def parameters(
    deck: Source | None = None,
    test: Source | None = None,
    parameters: str | Sequence[str] | None = None,
    *,
    study: Study | Files | None = None,
    progress: Say = unheard,
    **options: Unpack[ParametersOptions],
) -> MovableParameters:
    """Say what of a deck may be moved, and what its modes or a test can tell of it.

    Nothing moves. Standard errors are those of the residuals' standard deviations
    (``frequency_sigma``, ``shape_sigma``), to first order at the deck.

    Parameters
    ----------
    deck : path or Deck
        Default: the deck of `study`.
    test : path, sequence of paths or Measurement, optional
        Sensitivities are then of the modes that pair with it; default: the test of `study`, or the
        elastic modes of the deck.
    parameters : str or sequence of str
        Candidates, as for `update`. Default: those of `study`, or the design variables of the deck,
        or each modulus, density, thickness, area, inertia, spring and mass by itself.
    study : path or Study, optional
        A study file; keyword arguments win.
    progress : callable
        Told what is done, a few words at a time.
    **options
        See `ParametersOptions` and `CompareOptions`.

    Returns
    -------
    MovableParameters

    Raises
    ------
    InputError
        A file, an object or an option that is at fault: which, and what to do; no test mode pairs
        with the model.
    CheckError
        The eigensolution does not meet its own check.
    """
    from ..adapters.nastran import ParameterSpec, build_model
    from ..adapters.nastran.assembly.candidate_parameters import candidates, properties_of
    from ..adapters.nastran.assembly.wide_parameters import parameters_of

    accepted = {**ParametersOptions.__annotations__, "parameters": None, "modes": None}
    asked = study_of("parameters", study, {**options, "parameters": parameters}, accepted)
    require_heard(asked)
    said_to(progress)
    require_one(asked)
    deck = asked.deck if deck is None else deck
    test = (asked.test or None) if test is None else test
    spoken = [key for key, value in options.items() if value is not None]
    refuse_idle("parameters", spoken, test is not None)
    if deck is None:
        raise InputError("give a deck, or a study that names one")
    if isinstance(deck, Model):
        raise InputError("parameters looks at the cards of a deck, and a model has none")
    given = read_deck(deck)
    asked, remarks = with_design_variables(asked, given)
    with naming(given.path):
        rows = properties_of(given)
        read, specs = parameters_of(given, asked.parameters)
        more = 0
        if not specs:
            specs, more = candidates(given, _MOST)
        model = build_model(read, specs, asked.damped)
    progress("solving")
    side = None if test is None else measured(test, asked)
    seen = _of_test(given, model, side, asked) if side else _of_deck(given, model, asked)
    progress("weighing")
    said = identifiability(seen.gradient, 1.0, UPDATING.unsure)
    names = tuple(q.name for q in model.parameters)
    choice = Choice(said.determined, ())
    if seen.misfit is not None:
        choice = forward_selection(seen.gradient, seen.misfit, UPDATING.unsure)
    sol200: ChangedDeck | None = None
    if seen.analysis_modes:
        both = list(zip(specs, model.parameters, strict=True))
        if not asked.parameters:  # whose bounds are none
            chosen = (both[k] for k in choice.chosen)
            both = [(ParameterSpec(s.name, s.fields), p) for s, p in chosen]
        aims = list(zip(seen.analysis_modes, seen.hz.tolist(), strict=True))
        sol200, why = optimised(given, read, both, aims, asked)
        remarks += why
    left = (f"{more} more values are in the deck: name those to look at with -p",) if more else ()
    own = [*given.files] if given.on_disk else []
    return MovableParameters(
        **made_of_files([*own, *(side.files if side else ())]),
        deck_file=given.told,
        test_files=tuple(map(str, side.files)) if side else (),
        properties=Table(rows),
        candidates=Table(_candidates(model, seen, said, choice), CandidateRow),
        combinations=Table(_combinations(said, names), CombinationRow),
        sensitivities=SensitivityTable(seen.modes, seen.hz, names, seen.slopes),
        likeness=LikenessTable(names, said.correlation),
        recommended=tuple((asked.parameters or names)[k] for k in choice.chosen),
        warnings=(*given.warnings, *model.warnings, *seen.warnings, *left, *remarks),
        geometry=model.geometry,
        places=_places(model),
        study=replace(
            asked,
            deck=given.path if given.on_disk else None,
            test=side.files if side else (),
        ),
        sol200=sol200,
    )


def _places(model: Model) -> dict[str, tuple[int, ...]]:
    """Return the grids of the degrees of freedom whose stiffness or mass each parameter moves."""
    there, p = abs(model.expansion), model.deck_point
    found = {}
    for k, q in enumerate(model.parameters):
        moved = [np.abs(d.diagonal()) for d in (model.dK(k, p), model.dM(k, p))]
        rows = np.flatnonzero(there @ np.sum([m > 0.0 for m in moved], axis=0))
        found[q.name] = tuple(np.unique(model.dofs.node[rows]).tolist())
    return found


def _of_deck(deck: Deck, model: Model, asked: Study) -> _Seen:
    """Return what the elastic modes of the deck say: as many as it asks for, or ten, or to fmax."""
    with naming(deck.path):
        count = (deck.eigen.nd if deck.eigen else None) or 0
        solution = normal_modes.solve(model, fmax=asked.fmax) if asked.fmax else None
        if solution is None:
            wanted = count or EIGEN.modes
            solution = normal_modes.solve(model, n_modes=min(wanted + 6, model.n_free))
    modes = np.arange(solution.rigid_body_modes, len(solution.eigenvalues))
    if not len(modes):
        raise InputError("the deck has no elastic mode there; ask for a higher --fmax")
    found = sensitivities(model, model.deck_point, solution, modes, range(len(model.parameters)))
    slopes = found.slopes / (2.0 * found.values[:, None])
    hz = solution.frequencies_hz[modes]
    sigma = asked.weights.sigma(FREQUENCIES)
    return _Seen(tuple((modes + 1).tolist()), hz, slopes, slopes / sigma, None, solution.warnings)


def _of_test(deck: Deck, model: Model, side: Measured, asked: Study) -> _Seen:
    """Return what the test says through the pairs of modes."""
    with naming(deck.path):
        solution = normal_modes.solve(model, fmax=side.highest(asked))
    modes = normal_modes.modes_of(model, solution)
    on_model = placed(model, deck, modes, side, asked)
    target = target_of(model, on_model, asked)
    full = FullOrder(model, target.sensors, len(solution.eigenvalues))
    objective = Objective(target, asked.criteria, asked.weights)
    residuals = residuals_named(asked.residuals)
    state = objective.at(full, model.deck_point, residuals)
    if not state.seen.pairs:
        raise InputError("no test mode pairs with the model: look at correlate first")
    active = range(len(model.parameters))
    all_residuals = objective.linearise(full, state, active, residuals)
    frequencies = all_residuals
    if residuals != (FREQUENCIES,):
        frequencies = objective.linearise(full, state, active, (FREQUENCIES,))
    sigma = objective.sigma(FREQUENCIES, state.seen)  # of what is relative to the test's λ
    own = np.asarray(sigma * state.seen.test_eigenvalues / state.seen.eigenvalues)
    return _Seen(
        tuple(q.test + 1 for q in state.seen.pairs),
        np.array([q.test_hz for q in state.seen.pairs]),
        frequencies.gradient * own[:, None],
        all_residuals.gradient,
        all_residuals.values,
        (*solution.warnings, *on_model.warnings),
        tuple(q.analysis + 1 for q in state.seen.pairs),
    )


def _candidates(
    model: Model, seen: _Seen, said: Identifiability, choice: Choice
) -> list[CandidateRow]:
    group = indistinct(said.correlation)
    rank = {k: n for n, k in enumerate(choice.chosen)}
    rows = [
        CandidateRow(
            name=q.name,
            cards=q.handle,
            values=q.deck_values,
            sensitivity=float(np.abs(seen.slopes[:, k]).max(initial=0.0)),
            error_alone=finite(said.alone[k]),
            error_together=finite(said.standard_error[k]),
            group=int(group[k]) + 1,
            recommended=rank[k] + 1 if k in rank else None,
            explained=choice.explained[rank[k]] if k in rank and choice.explained else None,
        )
        for k, q in enumerate(model.parameters)
    ]
    order = {g: n for n, g in enumerate(dict.fromkeys(r.group for r in rows), 1)}
    return [replace(r, group=order[r.group]) for r in rows]


def _combinations(said: Identifiability, names: Sequence[str]) -> list[CombinationRow]:
    seen = [
        CombinationRow(float(s), 1.0 / float(s) if s > 0.0 else None, weights_of(v, names, 0.1))
        for s, v in zip(said.singular_values, said.directions, strict=True)
    ]
    extra = (
        said.unseen[len(seen) + len(said.unseen) - len(names) :] if len(seen) < len(names) else ()
    )
    return [*seen, *(CombinationRow(0.0, None, weights_of(v, names, 0.1)) for v in extra)]
