"""``trueup convert SRC... DST``."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Annotated, Any

import typer

from ...core.errors import InputError
from ..console import emit_json, speaks, stderr, stdout, working
from ..delivery import TARGETS, is_empty, losses, target_of
from ..exchange import KINDS, Cargo, load
from ..options import JsonOption, Output, QuietOption

_MOST, _LONGEST = 4, 200


def convert(
    files: Annotated[list[Path], typer.Argument(metavar="SRC... DST", show_default=False)],
    source_format: Annotated[
        str | None,
        typer.Option("--from", metavar="|".join(KINDS), help="Read SRC as this. [default: told "
                     "by the contents]"),
    ] = None,
    target_format: Annotated[
        str | None,
        typer.Option("--to", metavar="|".join(TARGETS), help="Write DST as this. [default: by "
                     "its suffix]"),
    ] = None,
    subcase: Annotated[
        int | None, typer.Option("--subcase", help="Subcase whose modes are meant.")
    ] = None,
    lossy: Annotated[
        bool, typer.Option("--lossy", help="Leave out what DST cannot hold.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace DST if it exists.")] = False,
    json: JsonOption = None,
    quiet: QuietOption = False,
) -> None:  # fmt: skip
    """Write what one or several files hold in another format.

    Results, matrices, universal files and stores go into universal files (.unv, .uff), stores
    (.h5), OP4 (.op4) and DMIG (.pch). A deck alone is assembled; beside results or matrices it
    gives them geometry and axes.
    """
    output = Output(json=json, force=force, quiet=quiet)
    if len(files) < 2:
        raise InputError("give at least one source and the destination: convert SRC... DST")
    *sources, destination = files
    target = target_of(destination, target_format)
    _check(sources, destination, source_format, force)
    with working("reading", output):
        cargo = load(sources, source_format, subcase)
    names = ", ".join(p.name for p in sources)
    if is_empty(cargo, target):
        raise InputError(f"{names}: nothing that a {target.name} can hold ({_told(cargo)})")
    lost = losses(cargo, target)
    if lost and not lossy:
        more = f" and {len(lost) - _MOST} more" if len(lost) > _MOST else ""
        raise InputError(
            f"{destination}: a {target.name} cannot hold {'; '.join(lost[:_MOST])}{more}; give "
            "--lossy to leave that out"
        )
    with working("writing", output):
        target.write(destination, cargo)
    result: dict[str, Any] = {
        "schema": "trueup/convert/1",
        "sources": [str(p) for p in sources],
        "destination": str(destination),
        "format": target.name,
        "written": _written(cargo, target.holds),
        "lost": lost,
        "warnings": list(dict.fromkeys(cargo.notes)),
    }
    emit_json(result, output)
    if speaks(output):
        told = "; ".join(f"{k} {v}" for k, v in result["written"].items())
        stdout().print(f"{destination} ({target.name}): {told}", markup=False, soft_wrap=True)
    if not quiet:
        for left in lost:
            stderr().print(f"left out: {left}", markup=False, soft_wrap=True)
        for note in result["warnings"]:
            stderr().print(f"note: {note}", markup=False, soft_wrap=True)


def _check(sources: list[Path], destination: Path, kind: str | None, force: bool) -> None:
    if kind is not None and kind not in KINDS:
        raise InputError(f"--from {kind} is not known; give one of {', '.join(KINDS)}")
    missing = [p for p in sources if not p.is_file()]
    if missing:
        raise InputError(f"{missing[0]} does not exist or is not a file")
    if any(destination.exists() and destination.samefile(p) for p in sources):
        raise InputError(f"{destination} is a source as well; give the destination another name")
    if destination.exists() and not force:
        raise InputError(f"{destination} exists; give --force to replace it")


def _written(cargo: Cargo, holds: frozenset[str]) -> dict[str, str]:
    said: dict[str, str] = {}
    if cargo.geometry is not None and "geometry" in holds:
        said["geometry"] = f"{len(cargo.geometry.ids)} nodes"
    if cargo.modes and "modes" in holds:
        said["modes"] = ", ".join(f"{k} {len(m)}" for k, m in cargo.modes.items())
    if cargo.frfs and "frfs" in holds:
        said["frequency responses"] = ", ".join(
            f"{k} {len(f.responses)} x {len(f.references)} x {len(f.frequencies_hz)}"
            for k, f in cargo.frfs.items()
        )
    if cargo.functions and "functions" in holds:
        kinds = Counter(f.kind for f in cargo.functions.values())
        said["functions"] = ", ".join(f"{n} x {kind}" for kind, n in kinds.items())
    if cargo.matrices and "matrices" in holds:
        said["matrices"] = ", ".join(
            f"{k} {m.matrix.shape[0]} x {m.matrix.shape[1]}" for k, m in cargo.matrices.items()
        )
    return said


def _told(cargo: Cargo) -> str:
    every = frozenset({"geometry", "modes", "frfs", "matrices", "functions"})
    told = "; ".join([*(f"{k} {v}" for k, v in _written(cargo, every).items()), *cargo.rest[:3]])
    return told[:_LONGEST] + "..." * (len(told) > _LONGEST) or "no content at all"
