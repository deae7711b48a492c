"""The verb `convert`."""

from __future__ import annotations

import os
from collections import Counter
from pathlib import Path
from typing import Unpack

from ..core.errors import InputError, Place, path_of
from .files.copy_deck import SUFFIXES, copy_deck
from .files.delivery import is_empty, losses, target_of
from .files.exchange import KINDS, Boundary, Cargo, cargo_of, load
from .files.read import DECK, kind_of_file
from .files.sources import Source, existing
from .files.write_fmu import OTHERS, PLANTS, Converted, write_fmu
from .studies.options import Files, PlantOptions, Say, checked_call, unheard
from .studies.values import converted

_MOST, _LONGEST, _MODES = 4, 200, 20


@checked_call
def convert(
    sources: Source,
    destination: Files,
    *,
    from_: str | None = None,
    to: str | None = None,
    subcase: int | None = None,
    boundary: str | None = None,
    modes: int | None = None,
    fmax: float | None = None,
    lossy: bool = False,
    merge: bool = False,
    force: bool = False,
    progress: Say = unheard,
    **plant: Unpack[PlantOptions],
) -> Converted:
    """Write what one or several sources hold in another format.

    Results, matrices, universal files and stores go into universal files (.unv, .uff), stores
    (.h5), OP4 (.op4) and DMIG (.pch). A deck alone is assembled; beside results or matrices it
    gives them geometry and axes. A unit for simulators (.fmu), the same state space as arrays
    (.npz, .mat) and, with ``inputs``, its frequency responses (.unv, .uff) are made of modes: see
    `write_fmu`. A deck goes with its INCLUDE files, byte for byte, into a folder.

    Parameters
    ----------
    sources : path, sequence of paths, or a noun
        A noun is a Deck, Measurement, Modes, Frfs, Geometry, StoreContent or what a verb gave.
    destination : path
    from_, to : str, optional
        Kind of the sources and format of the destination; default: told by the contents and by
        the suffix.
    subcase : int, optional
        Whose modes are meant.
    boundary : str, optional
        Reduce a deck (Craig-Bampton) to these grids, ``"11, 20-25, 31:123"``, and component modes;
        a note says how far the reduced model's frequencies are off.
    modes, fmax : int, float, optional
        How many component modes (default 20), and up to which frequency [Hz]; of a plant as for
        `write_fmu`.
    lossy : bool
        Leave out what the destination cannot hold.
    merge : bool
        Write a deck and its INCLUDE files as one file (.bdf, .dat).
    force : bool
        Replace a destination that exists.
    progress : callable
        Told what is done, a few words at a time.
    **plant
        `PlantOptions`, of a .fmu, .npz or .mat, and of frequency responses, alone.

    Returns
    -------
    Converted

    Raises
    ------
    InputError
        A source that cannot be read, a format that is not known, content that the destination
        cannot hold.
    """
    path = path_of(destination, "the destination")
    to = converted("to", to, str | None, Place(shown="convert"))
    subcase = converted("subcase", subcase, int | None, Place(shown="convert"))
    suffix = path.suffix.lower()
    if to is None and suffix in PLANTS and (plant or suffix not in OTHERS):
        if boundary is not None:
            raise InputError("a plant has no boundary; what it has are inputs and outputs")
        return write_fmu(
            sources, path, modes=modes, fmax=fmax, from_=from_, subcase=subcase, force=force,
            progress=progress, **plant,
        )  # fmt: skip
    if plant:
        raise InputError(f"convert: '{next(iter(plant))}' is of {', '.join(PLANTS)} alone")
    files = _files(sources)
    if to is None and boundary is None and _is_copy(files, path, merge):
        _check(files, path, from_, force or path.is_dir())
        return copy_deck(files[0], path, merge)
    target = target_of(path, to)
    reduced = _boundary(boundary, modes, fmax)
    _check(files, path, from_, force)
    progress("reading")
    cargo = load(files, from_, subcase, reduced) if files else cargo_of(sources, reduced)
    if reduced and not cargo.from_deck:
        raise InputError("boundary= reduces a deck alone; there is none among the sources")
    names = ", ".join(p.name for p in files) or type(sources).__name__
    if is_empty(cargo, target):
        nothing = f"{names}: nothing that {_with_article(target.name)} can hold ({_told(cargo)})"
        nothing += f"; {cargo.no_matrices}" * bool(cargo.no_matrices)
        raise InputError(nothing, file=files[0] if files else None)
    lost = losses(cargo, target)
    if lost and not lossy:
        more = f" and {len(lost) - _MOST} more" if len(lost) > _MOST else ""
        raise Place(path).error(
            f"{_with_article(target.name)} cannot hold {'; '.join(lost[:_MOST])}{more}; give "
            "lossy=True to leave that out"
        )
    progress("writing")
    target.write(path, cargo)
    return Converted(
        sources=tuple(map(str, files)),
        destination=str(path),
        format=target.name,
        written=_written(cargo, target.holds),
        lost=tuple(lost),
        warnings=tuple(dict.fromkeys(cargo.notes)),
    )


def _is_copy(files: list[Path], path: Path, merge: bool) -> bool:
    """Whether a deck is to be copied; a folder or the suffix of a deck says so, or `merge`."""
    placed = path.is_dir() or path.suffix.lower() in ("", *SUFFIXES)
    one = len(files) == 1 and files[0].is_file() and kind_of_file(files[0]) is DECK
    if merge and not one:
        raise InputError("merge=True makes one file of one deck: give a deck as the only source")
    return one and (placed or merge)


def _boundary(grids: str | None, modes: int | None, fmax: float | None) -> Boundary | None:
    who = Place(shown="convert")
    grids = converted("boundary", grids, str | None, who)
    modes = converted("modes", _MODES if modes is None else modes, int, who)
    fmax = converted("fmax", fmax, float | None, who)
    if modes < 1:
        raise InputError(f"modes={modes}: give 1 or more")
    return Boundary(grids, modes, fmax) if grids is not None else None


def _files(sources: Source) -> list[Path]:
    every = sources if isinstance(sources, list | tuple) else [sources]
    if not every:
        raise InputError("give at least one source to convert")
    files = [path_of(s, "a source") for s in every if isinstance(s, str | os.PathLike)]
    if files and len(files) < len(every):
        raise InputError("the sources are files and objects; convert them one by one")
    return [p / "result.h5" if (p / "result.h5").is_file() else p for p in files]


def _check(sources: list[Path], destination: Path, kind: str | None, force: bool) -> None:
    if kind is not None and kind not in KINDS:
        raise InputError(f"from_={kind!r} is not known; give one of {', '.join(KINDS)}")
    existing(sources)
    if any(destination.exists() and destination.samefile(p) for p in sources):
        raise Place(destination).fault("is a source as well; give the destination another name")
    if destination.exists() and not force:
        raise Place(destination).fault("exists; give force=True to replace it")


def _written(cargo: Cargo, holds: frozenset[str]) -> dict[str, str]:
    kinds = Counter(f.kind for f in cargo.functions.values())
    responses = (
        f"{k} {len(f.responses)} x {len(f.references)} x {len(f.frequencies_hz)}"
        for k, f in cargo.frfs.items()
    )
    sizes = ((k, m.matrix.shape) for k, m in cargo.matrices.items())
    said = {
        "geometry": [f"{len(cargo.geometry.ids)} nodes"] if cargo.geometry is not None else [],
        "modes": [f"{k} {len(m)}" for k, m in cargo.modes.items()],
        "frfs": list(responses),
        "functions": [f"{n} x {kind}" for kind, n in kinds.items()],
        "matrices": [f"{k} {rows} x {columns}" for k, (rows, columns) in sizes],
    }
    names = {"frfs": "frequency responses"}
    return {names.get(k, k): ", ".join(v) for k, v in said.items() if v and k in holds}


def _told(cargo: Cargo) -> str:
    every = frozenset({"geometry", "modes", "frfs", "matrices", "functions"})
    told = "; ".join([*(f"{k} {v}" for k, v in _written(cargo, every).items()), *cargo.rest[:3]])
    return told[:_LONGEST] + "..." * (len(told) > _LONGEST) or "no content at all"


def _with_article(name: str) -> str:
    return name if name.endswith("OP4") else f"a {name}"
