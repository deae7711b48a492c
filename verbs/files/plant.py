"""The source of a plant as it is given: a deck, a run folder, modes; and the plant made of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp

from ...core.arrays import Floats
from ...core.data.dofs import Dofs
from ...core.data.geometry import Geometry
from ...core.data.length_units import METRES
from ...core.data.modes import Modes
from ...core.data.parametric_model import Model
from ...core.errors import InputError, naming
from ...core.noun import Noun
from ...core.results.discovery import DiscoverTables
from ...core.statespace.build_plant import ModalBasis, basis_of_model, basis_of_modes
from ...core.statespace.channels import Channel, check_names, read_channels, rows_of
from ...core.statespace.damping_choice import Asked, choose_damping, read_damping
from ...core.statespace.modal_plant import ModalPlant
from ..runs.open_run import open_run
from ..runs.run import Changing, Run
from .exchange import cargo_of, load
from .read import DECK, kind_of_file
from .sources import Source, is_changed, read_deck

if TYPE_CHECKING:
    from ...adapters.nastran import Deck

_CONSISTENT = {"m": 1.0, "mm": 1e3, "in": 175.12683699, "ft": 14.59390294}
"""Kilograms in the mass that goes with a length, a force and seconds: kg, t, lbf s²/in, slug."""
_SAME = 1e-3
"""Of a frequency: how far the modes of a run may be from those solved again."""
UNITS = ("si", "deck")


@dataclass(frozen=True, eq=False)
class PlantSource(Noun):
    """What a plant is made of: a model (with the deck it came of), or modes alone.

    `sensors` are those of a test with the map that reads them of all degrees of freedom, `test`
    the pairs of a run: frequencies of the analysis and damping ratios of the test.
    """

    model: Model | None = None
    deck: Deck | None = None
    modes: Modes | None = None
    geometry: Geometry | None = None
    length_unit: str | None = None
    sensors: tuple[Dofs, sp.csr_matrix] | None = None
    test: tuple[Floats, Floats] | None = None
    notes: tuple[str, ...] = field(default=())

    def places(self, channels: Sequence[Channel], metres: float | None) -> Geometry | None:
        """Return the grids of channels, in metres where it is known how many the unit is."""
        if self.geometry is None:
            return None
        nodes, ids = [c.node for c in channels if not c.sensor], self.geometry.ids
        at = np.flatnonzero(np.isin(ids, nodes))
        unit = self.length_unit if metres is None else "m"
        return Geometry(ids[at], self.geometry.xyz[at] * (metres or 1.0), unit)

    @property
    def dofs(self) -> Dofs:
        """All degrees of freedom."""
        owner = self.modes if self.model is None else self.model
        assert owner is not None
        return owner.dofs


def plant_of(
    source: Source,
    inputs: str | Sequence[str],
    outputs: str | Sequence[str],
    *,
    fmax: float | None = None,
    modes: int | None = None,
    damping: Asked = None,
    residual: bool = True,
    rigid_body: bool = True,
    units: str = "si",
    deck_length_unit: str | None = None,
    from_: str | None = None,
    subcase: int | None = None,
) -> tuple[ModalPlant, Geometry | None, tuple[str, ...]]:
    """Return a plant, where its grids are, and what was assumed; see `write_fmu`."""
    into, out = read_channels(inputs, "input"), read_channels(outputs, "output")
    check_names((*into, *out))
    choice = read_damping(damping)
    if units not in UNITS:
        raise InputError(f"units={units!r} is not known; give 'si' or 'deck'")
    found, name = source_of(source, from_, subcase)
    with naming(name):
        metres, kilograms, said = _units(found, deck_length_unit) if units == "si" else (1, 1, [])
        rows_in = rows_of(into, found.dofs, "the model")
        rows_out = _rows(out, found)
        if found.model is not None:
            basis = basis_of_model(
                found.model, into, out, rows_in, rows_out,
                fmax=fmax, n_modes=modes, residual=residual, rigid=rigid_body,
            )  # fmt: skip
        else:
            assert found.modes is not None
            basis = basis_of_modes(
                found.modes, into, out, rows_in, rows_out,
                fmax=fmax, n_modes=modes, rigid=rigid_body,
            )  # fmt: skip
        ratios, notes = choose_damping(choice, _known(found, basis), basis.frequencies_hz)
        plant = basis.plant(ratios, into, out)
    if units == "si":
        plant = plant.in_si(metres, kilograms)
    places = found.places((*into, *out), metres if units == "si" else None)
    assumed = dict.fromkeys([*found.notes, *basis.notes, *notes, *said, *_error(plant)])
    return plant, places, tuple(assumed)


def source_of(
    source: Source, from_: str | None = None, subcase: int | None = None
) -> tuple[PlantSource, Path | None]:
    """Return what a plant is made of and the file to name in messages.

    Raises
    ------
    InputError
        A source that cannot be read, or holds neither a deck nor modes.
    """
    every = source if isinstance(source, list | tuple) else [source]
    paths = [Path(s) for s in every if isinstance(s, str | Path)]
    if len(every) == 1 and paths:
        if paths[0].is_dir():
            return _of_object(open_run(paths[0])), paths[0]
        if from_ in (None, DECK.name) and kind_of_file(paths[0]) == DECK:
            return _of_object(read_deck(paths[0])), paths[0]
    if paths:
        return _of_cargo(load(paths, from_, subcase)), paths[0]
    return _of_object(source), None


def _of_object(source: Any) -> PlantSource:
    from ...adapters.nastran import Deck, build_model

    if isinstance(source, Model):
        return PlantSource(source, None, None, source.geometry, source.geometry.length_unit)
    if isinstance(source, Deck) or is_changed(source):
        deck = read_deck(source)
        model = build_model(deck)
        unit = model.geometry.length_unit or deck.length_unit
        notes = (*deck.warnings, *model.warnings)
        return PlantSource(model, deck, None, model.geometry, unit, notes=notes)
    if isinstance(source, Run):
        return _of_run(source)
    return _of_cargo(cargo_of(source))


def _of_run(run: Run) -> PlantSource:
    """Return the deck of a run (its changed one where there is one), else its modes."""
    content = run.content
    deck = run.deck if isinstance(run, Changing) else run.study.deck
    held = content.modes.get("updated") or content.modes["analysis"]
    if deck is not None and not (isinstance(deck, Path) and not deck.is_file()):
        found = _of_object(read_deck(deck))
    else:
        unit = content.geometry.length_unit if content.geometry else None
        found = PlantSource(modes=held, geometry=content.geometry, length_unit=unit)
    pairs = [p for p in run.final.pairs if p.test_damping is not None]
    test = (
        np.array([p.analysis_hz for p in pairs]),
        np.array([p.test_damping for p in pairs], dtype=float),
    )
    seen, sensors = content.matrices.get("observation"), None
    if seen is not None and seen.shape[1] == len(found.dofs):
        sensors = (content.modes["test"].dofs, sp.csr_matrix(seen))
    unit, notes = found.length_unit or run.study.deck_length_unit, found.notes
    if isinstance(run, DiscoverTables) and run.verdict == "undecided" and not run.adopted:
        notes = (*notes, "the run is undecided: its deck is the one given to it, nothing added")
    return replace(found, length_unit=unit, sensors=sensors, test=test, notes=notes)


def _of_cargo(cargo: Any) -> PlantSource:
    if not cargo.modes:
        raise InputError(
            "the source holds neither a deck nor modes; give a deck, a run folder, or results with "
            "modes (OP2, HDF5, universal file)"
        )
    normal = {name: m for name, m in cargo.modes.items() if not m.is_complex} or cargo.modes
    if len(normal) > 1:
        names = ", ".join(normal)
        raise InputError(f"the source holds several sets of modes ({names}); give one of them")
    unit = cargo.geometry.length_unit if cargo.geometry is not None else None
    ((kind, modes),) = normal.items()
    modes, said = _weighed(modes) if kind == "analysis" else (modes, ())
    notes = (*cargo.notes, *said)
    return PlantSource(modes=modes, geometry=cargo.geometry, length_unit=unit, notes=notes)


def _weighed(modes: Modes) -> tuple[Modes, tuple[str, ...]]:
    """Take analysis modes of which no mass is told as Nastran normalises them by default."""
    largest = np.abs(modes.shapes).max(axis=0, initial=0.0)
    if not np.isnan(modes.generalized_mass).all() or np.allclose(largest, 1.0, atol=_SAME):
        return modes, ()
    note = f"{modes.source} says no generalised masses: its modes are taken to be of unit mass"
    return replace(modes, generalized_mass=np.ones(len(modes))), (note,)


def _rows(outputs: Sequence[Channel], found: PlantSource) -> sp.csr_matrix:
    grids = [k for k, c in enumerate(outputs) if not c.sensor]
    rows = sp.lil_matrix((len(outputs), len(found.dofs)))
    if grids:
        rows[grids] = rows_of([outputs[k] for k in grids], found.dofs, "the model")
    for k, c in enumerate(outputs):
        if not c.sensor:
            continue
        if found.sensors is None:
            raise InputError(f"output {c.said}: sensors of a test are known of run folders only")
        dofs, seen = found.sensors
        at = np.flatnonzero((dofs.node == c.node) & (dofs.component == c.component))
        if not len(at):
            raise InputError(f"output {c.said}: the test has no such sensor on the model")
        rows[k] = c.sign * seen[at[0]]
    return sp.csr_matrix(rows)


def _known(found: PlantSource, basis: ModalBasis) -> dict[str, Floats]:
    """Return the damping ratios that the test and the deck know, NaN elsewhere."""
    hz = basis.frequencies_hz
    known: dict[str, Floats] = {}
    if found.test is not None:
        known["test"] = _of_pairs(*found.test, hz[: len(hz) - basis.residual], len(hz))
    elif basis.damping is not None:
        known["test"] = basis.damping
    if found.deck is not None and found.model is not None and basis.vectors is not None:
        from ...adapters.nastran.assembly.deck_damping import modal_ratios

        said = modal_ratios(found.deck, found.model, hz, basis.vectors)
        if said is not None:
            known["deck"] = said
    return known


def _of_pairs(analysis_hz: Floats, ratios: Floats, hz: Floats, n: int) -> Floats:
    out = np.full(n, np.nan)
    for f, ratio in zip(analysis_hz, ratios, strict=True):
        free = np.flatnonzero(np.isnan(out[: len(hz)]) & (np.abs(hz - f) <= _SAME * f))
        if len(free):
            out[free[np.argmin(np.abs(hz[free] - f))]] = ratio
    return out


def _units(found: PlantSource, given: str | None) -> tuple[float, float, list[str]]:
    """Return metres and kilograms in the units of the deck, and what was assumed."""
    from ...adapters.nastran.properties.mass_unit import mass_unit

    unit = given or found.length_unit
    if unit is None:
        raise InputError(
            "the length unit is not known, so that nothing can be said in SI units; give "
            "deck_length_unit (m, mm, in or ft), or units='deck'"
        )
    if unit not in METRES:
        raise InputError(f"the length unit '{unit}' is not known; use m, mm, in or ft")
    told = None if found.deck is None else mass_unit(found.deck, unit).kilograms
    if told is not None:
        return METRES[unit], told, []
    note = f"masses are taken to be in the unit of {_CONSISTENT[unit]:.6g} kg that goes with {unit}"
    return METRES[unit], _CONSISTENT[unit], [f"{note} and seconds"]


def _error(plant: ModalPlant) -> list[str]:
    if plant.error is None or plant.band_hz is None:
        return []
    return [
        f"up to {plant.band_hz:.4g} Hz what is left out is about {100 * plant.error:.2g} % of "
        "the median of a receptance in the band"
    ]
