"""``trueup solve DECK``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from ...core.errors import InputError
from ..console import emit_json, speaks, stderr, stdout, working
from ..options import JsonOption, Output, QuietOption, VerboseOption


def solve(
    deck: Annotated[Path, typer.Argument(metavar="DECK")],
    number: Annotated[
        int | None, typer.Option("-n", "--number", help="Modes, rigid-body ones included.")
    ] = None,
    fmax: Annotated[float | None, typer.Option("--fmax", help="All modes up to here [Hz].")] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="Modes as .h5 or .unv.")
    ] = None,
    json: JsonOption = None,
    quiet: QuietOption = False,
    verbose: VerboseOption = False,
) -> None:
    """Find the normal modes with the embedded solver."""
    from ...adapters.nastran import build_model, read_deck, weight
    from ...core import eigen
    from ..pipeline import naming

    output = Output(json=json, quiet=quiet, verbose=verbose)
    _check(number, fmax, out)
    with working(f"reading {deck.name}", output), naming(deck):
        read = read_deck(deck)
        model = build_model(read)
    wanted = number if number or fmax else ((read.eigen.nd if read.eigen else None) or 10)
    with working("solving", output), naming(deck):
        solution = eigen.solve(model, n_modes=wanted, fmax=fmax)
    modes = eigen.modes_of(model, solution)
    mass = weight(read)
    result: dict[str, Any] = {
        "schema": "trueup/solve/1",
        "deck": str(deck),
        "modes": [
            {"frequency_hz": float(f), "generalized_mass": float(m)}
            for f, m in zip(modes.frequencies_hz, modes.generalized_mass, strict=True)
        ],
        "rigid_body_modes": solution.rigid_body_modes,
        "mass": mass.mass,
        "centre_of_gravity": mass.centre_of_gravity,
        "checks": solution.checks,
        "degrees_of_freedom": model.n_free,
        "backend": solution.backend,
        "seconds": solution.seconds,
        "warnings": [*read.warnings, *model.warnings, *solution.warnings],
    }
    if out:
        write_modes(out, model.geometry, modes)
    emit_json(result, output)
    if speaks(output):
        from ..tables import solve_table

        stdout().print(solve_table(result))
    if not quiet:
        for warning in result["warnings"]:
            stderr().print(f"warning: {warning}", markup=False)


def write_modes(path: Path, geometry: Any, modes: Any) -> None:
    """Write modes by the suffix of `path`: neutral store or universal file."""
    if path.suffix == ".h5":
        from ...adapters.store import write_store

        write_store(path, geometry=geometry, modes={"analysis": modes})
    else:
        from ...adapters.universal import write_universal

        write_universal(path, geometry=geometry, modes=modes)


def _check(number: int | None, fmax: float | None, out: Path | None) -> None:
    if number is not None and number < 1:
        raise typer.BadParameter(f"-n is {number}; ask for at least one mode")
    if fmax is not None and not fmax > 0.0:
        raise typer.BadParameter(f"--fmax is {fmax}; give a frequency above 0 Hz")
    if out is not None and out.suffix not in {".h5", ".unv", ".uff"}:
        raise typer.BadParameter(f"--out {out}: modes are written as .h5 or .unv")
    if out is not None and not out.parent.is_dir():
        raise InputError(f"--out {out}: the folder {out.parent} does not exist")
