"""The verb `write_fmu`, which ``convert`` does for .fmu, .npz and .mat."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Unpack

from ...core.data.geometry import Geometry
from ...core.errors import InputError, Place, path_of
from ...core.results.inspection import ConvertTables
from ...core.statespace.modal_plant import ModalPlant
from ...core.statespace.statespace_numbers import STATESPACE
from ..studies.options import Files, PlantOptions, Say, checked_call, unheard
from ..studies.values import converted
from .plant import plant_of
from .sources import Source


@dataclass(frozen=True, eq=False, kw_only=True)
class Converted(ConvertTables):
    """What `convert` wrote, and what it had to leave out."""


@checked_call
def write_fmu(
    source: Source,
    destination: Files,
    *,
    modes: int | None = None,
    fmax: float | None = None,
    from_: str | None = None,
    subcase: int | None = None,
    force: bool = False,
    progress: Say = unheard,
    **options: Unpack[PlantOptions],
) -> Converted:
    """Write a structure as a linear component for simulators: forces in, motions out.

    A Functional Mock-up Unit (FMI 2.0 or 3.0, model exchange and co-simulation) by the suffix
    .fmu; the same state space as arrays by .npz or .mat; its frequency responses as dataset 58 by
    .unv or .uff.

    Parameters
    ----------
    source : path, sequence of paths, or a noun
        A deck, a run folder, or modes (OP2, HDF5, universal file, with the deck that they belong
        to or without); a Deck, Model, Modes or what a verb gave.
    destination : path
    modes : int, optional
        How many, rigid-body ones included; default 30, or those up to one and a half times `fmax`.
    fmax : float, optional
        Upper end of the band that the plant is for, Hz.
    from_, subcase
        As for `convert`.
    force : bool
        Replace a destination that exists.
    progress : callable
        Told what is done, a few words at a time.
    **options
        `PlantOptions`.

    Returns
    -------
    Converted

    Raises
    ------
    InputError
        An input or output that the model does not have or that is fixed, names that collide, a
        length unit that nobody knows, an unstable mode; then no file is written.
    CheckError
        The eigensolution does not meet its own check.
    """
    path = path_of(destination, "the destination")
    writer = PLANTS.get(path.suffix.lower())
    if writer is None:
        raise Place(path).fault(f"is no file of a plant; known are {', '.join(PLANTS)}")
    if path.exists() and not force:
        raise Place(path).fault("exists; give force=True to replace it")
    who = Place(shown="write_fmu")
    asked: Any = dict(options)
    version = converted("fmi", asked.pop("fmi", 2), int, who)
    lines = converted("lines", asked.pop("lines", STATESPACE.written), int, who)
    for name in asked.keys() & {"residual", "rigid_body"}:
        asked[name] = converted(name, asked[name], bool, who)
    modes, fmax = (
        converted("modes", modes, int | None, who),
        converted("fmax", fmax, float | None, who),
    )
    for name, value in (("fmax", fmax), ("modes", modes), ("lines", lines)):
        if value is not None and not value > 0:
            raise InputError(f"{name} is {value!r}; it must be above 0")
    if version not in (2, 3):
        raise InputError(f"fmi={version} is no version of FMI that can be written; give 2 or 3")
    progress("solving")
    platforms = asked.pop("platforms", None) or ()
    platforms = platforms.split(",") if isinstance(platforms, str) else platforms
    inputs, outputs = asked.pop("inputs", ""), asked.pop("outputs", "")
    plant, places, notes = plant_of(
        source, inputs, outputs, modes=modes, fmax=fmax, from_=from_, subcase=subcase, **asked
    )
    progress("compiling and writing" if path.suffix.lower() == ".fmu" else "writing")
    way = _Way(version, tuple(str(p).strip() for p in platforms), lines, places)
    name, more = writer(path, plant, way)
    every = source if isinstance(source, list | tuple) else [source]
    return Converted(
        sources=tuple(str(s) for s in every if isinstance(s, str | os.PathLike)),
        destination=str(path),
        format=name,
        written={
            "modes": f"{len(plant) - plant.residual_modes}",
            "residual modes": f"{plant.residual_modes}",
            "inputs": ", ".join(c.name for c in plant.inputs),
            "outputs": ", ".join(c.name for c in plant.outputs),
        },
        lost=(),
        warnings=(*notes, *more),
    )


@dataclass(frozen=True)
class _Way:
    """How a plant is written."""

    version: int
    platforms: tuple[str, ...]
    lines: int
    places: Geometry | None


def _unit(path: Path, plant: ModalPlant, way: _Way) -> tuple[str, list[str]]:
    from ...adapters.fmu import write_unit
    from ...adapters.fmu.build_kernel import PLATFORMS

    version, platforms = way.version, way.platforms
    compiled = write_unit(path, plant, version, platforms)
    if compiled:
        lost = sorted(set(PLATFORMS if "all" in platforms else platforms) - set(compiled))
        said = f"no compiler at hand makes a binary for {', '.join(lost)}: pip install ziglang"
        return f"FMI {version}.0 unit for {', '.join(compiled)}", [said] if lost else []
    return f"FMI {version}.0 source unit", [
        "no C compiler is at hand, so the unit holds its sources only; install one, or "
        "pip install 'trueup[fmu]', or let the simulator compile it"
    ]


def _arrays(path: Path, plant: ModalPlant, _: _Way) -> tuple[str, list[str]]:
    from ...adapters.fmu import write_state_space

    write_state_space(path, plant)
    return "state space", []


def _functions(path: Path, plant: ModalPlant, way: _Way) -> tuple[str, list[str]]:
    from ...adapters.universal import write_universal

    units = "m" if plant.si else None
    write_universal(path, geometry=way.places, frfs=plant.frfs(way.lines), units=units)
    return "frequency responses", []


PLANTS: dict[str, Callable[[Path, ModalPlant, _Way], tuple[str, list[str]]]] = {
    ".fmu": _unit,
    ".npz": _arrays,
    ".mat": _arrays,
    ".unv": _functions,
    ".uff": _functions,
}
"""Writers of a plant by suffix."""
OTHERS = (".unv", ".uff")
"""Those that hold other things as well, where no inputs are given."""
