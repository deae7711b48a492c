"""The verb `plan`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ..core.arrays import Bools
from ..core.correlation.mac import mac
from ..core.data.dofs import Dofs
from ..core.data.geometry import Geometry
from ..core.errors import InputError, Place, path_of
from ..core.noun import BESIDE
from ..core.results.plain import Table
from ..core.results.plan import PlannedExciter, PlannedMode, PlannedSensor, PlanTables
from ..core.sensors.sensor_choice import drive_points, effective_independence, least_off_diagonal
from .files.sources import Source
from .runs.folder import Folder
from .solve import solve
from .studies.options import Say, checked_call, unheard
from .studies.taking_part import READERS

METHODS = {"independence": effective_independence, "mac": least_off_diagonal}


@dataclass(frozen=True, eq=False, kw_only=True)
class Planned(PlanTables, Folder):
    """What `plan` chose: the tables of result.json as fields.

    Parameters
    ----------
    geometry : Geometry
        The nodes of the sensors.
    """

    geometry: Geometry = field(metadata=BESIDE)

    def write(self, path: Path | str) -> Path:
        """Write the nodes of the sensors as a universal file, for the test system.

        Raises
        ------
        InputError
            It cannot be written.
        """
        from ..adapters.universal import write_universal

        path = path_of(path, "the file")
        write_universal(path, geometry=self.geometry)
        return path

    def fill(self, work: Path) -> None:
        """Write everything that the run folder of a plan holds."""
        super().fill(work)
        self.write(work / "sensors.unv")


@checked_call
def plan(
    deck: Source,
    sensors: int | None = None,
    *,
    modes: int | str | Sequence[int | str] | None = None,
    fmax: float | None = None,
    exciters: int = 2,
    method: str = "independence",
    directions: str = "XYZ",
    grids: int | str | Sequence[int | str] | None = None,
    wanted: int | str | Sequence[int | str] = (),
    exclude: int | str | Sequence[int | str] = (),
    progress: Say = unheard,
) -> Planned:
    """Choose where to put sensors and exciters for a modal test of a deck.

    Parameters
    ----------
    deck : path, Deck or Model
    sensors : int, optional
        How many directions are measured; default: twice as many as modes.
    modes : int or str, optional
        Modes that the test is for, by their numbers in the deck ("7:14"); default: the elastic ones
        of those that the deck asks for, or of ten, or up to `fmax`.
    fmax : float, optional
        All modes up to here, Hz.
    exciters : int
        How many places are driven.
    method : {"independence", "mac"}
        By effective independence, or by the least MAC of different modes at the sensors.
    directions : str
        Axes along which sensors measure, of XYZ.
    grids : int or str, optional
        Grids that can carry a sensor ("1:100, 205"); default: all that move.
    wanted, exclude : str
        Sensors that are there in any case, and places that are not: "40" (all its directions) or
        "40:Z".
    progress : callable
        Told what is done, a few words at a time.

    Returns
    -------
    Planned

    Raises
    ------
    InputError
        Modes, grids or sensors that are not there; fewer sensors than modes.
    """
    who = Place(shown="plan")
    if method not in METHODS:
        raise InputError(f"method is '{method}'; give one of {', '.join(METHODS)}")
    if not directions or set(directions.upper()) - set("XYZ"):
        raise InputError(f"directions is '{directions}'; give some of XYZ")
    asked = () if modes is None else READERS["exclude_test"]("modes", modes, who)
    found = solve(deck, max(asked) if asked else None, fmax, progress=progress)
    targets = asked or tuple(range(found.rigid_body_modes + 1, len(found.modes) + 1))
    if not targets or max(targets) > len(found.modes) or min(targets) <= found.rigid_body_modes:
        raise InputError(f"modes: the deck has elastic modes {found.rigid_body_modes + 1} to "
                         f"{len(found.modes)}; ask for some of them")  # fmt: skip
    progress("choosing")
    columns = np.array(targets) - 1
    dofs, shapes = found.shapes.dofs, found.shapes.shapes[:, columns]
    held = [d in directions.upper() for d in dofs.directions]
    rows = np.array(held) & (np.abs(shapes).max(axis=1) > 0.0) & (dofs.component <= 3)
    if grids is not None:
        rows &= np.isin(dofs.node, READERS["exclude_test"]("grids", grids, who))
    rows &= ~_named(dofs, READERS["exclude_sensors"]("exclude", exclude, who))
    first = READERS["exclude_sensors"]("wanted", wanted, who)
    candidates = np.flatnonzero(rows)
    own = np.flatnonzero(_named(dofs.take(candidates), first, required=True))
    count = 2 * len(targets) if sensors is None else sensors
    if len(candidates) < count:
        raise InputError(f"{len(candidates)} places can carry the {count} sensors; allow more")
    chosen = candidates[METHODS[method](shapes[candidates], count, own.tolist())]
    hz = found.shapes.frequencies_hz[columns]
    driven, share = drive_points(shapes[candidates], hz, exciters)
    seen = mac(shapes[chosen], shapes[chosen])
    beside = seen - np.eye(len(targets))
    geometry, at = found.geometry, dofs.take(chosen)
    xyz = geometry.xyz[geometry.index_of(at.node)]
    by = dofs.take(candidates[driven])
    nodes = np.unique(at.node)
    return Planned(
        deck_file=found.deck_file,
        method=method,
        sensors=Table(
            (PlannedSensor(int(n), d, tuple(x.tolist()))
             for n, d, x in zip(at.node, at.directions, xyz, strict=True)), PlannedSensor
        ),
        exciters=Table(
            (PlannedExciter(int(n), d, float(s.min()), targets[int(np.argmin(s))])
             for n, d, s in zip(by.node, by.directions, share, strict=True)), PlannedExciter
        ),
        modes=Table(
            PlannedMode(
                t, float(hz[k]), float(beside[k].max()),
                targets[int(np.argmax(beside[k]))] if len(targets) > 1 else None,
                float(share[:, k].max(initial=0.0)),
            )
            for k, t in enumerate(targets)
        ),
        largest_off_diagonal=float(beside.max(initial=0.0)),
        auto_mac=seen,
        warnings=found.warnings,
        geometry=replace(
            Geometry(nodes, geometry.xyz[geometry.index_of(nodes)]),
            length_unit=geometry.length_unit,
        ),
    )  # fmt: skip


def _named(dofs: Dofs, names: Sequence[str], required: bool = False) -> Bools:
    """Which rows are named as ``40`` or ``40:Z``."""
    found = np.zeros(len(dofs), bool)
    for name in names:
        node, _, direction = name.partition(":")
        rows = dofs.node == int(node)
        if direction:
            rows &= np.array([d == direction for d in dofs.directions], bool)
        if required and not rows.any():
            raise InputError(f"wanted: no sensor can be at {name}")
        found |= rows
    return found
