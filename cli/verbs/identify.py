"""``trueup identify FRF...``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...core.errors import InputError
from ..console import emit_json, speaks, stderr, stdout, working
from ..options import ForceOption, JsonOption, Output, QuietOption, VerboseOption

if TYPE_CHECKING:
    from ...adapters.universal import UniversalContent
    from ...core.identification import Identification

_FILES = (".unv", ".uff", ".h5")
_MOST_NAMED = 20


def identify(
    frf: Annotated[list[Path], typer.Argument(metavar="FRF...")],
    fmin: Annotated[float | None, typer.Option("--fmin", help="Use lines from here [Hz].")] = None,
    fmax: Annotated[float | None, typer.Option("--fmax", help="Use lines up to here [Hz].")] = None,
    max_order: Annotated[
        int | None, typer.Option("--max-order", help="Highest model order in a band.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="FILE|DIR",
            help="Only the modes, as .unv (real shapes) or .h5; or the run folder to write.",
        ),
    ] = None,
    json: JsonOption = None,
    force: ForceOption = False,
    quiet: QuietOption = False,
    verbose: VerboseOption = False,
) -> None:
    """Find modes in measured frequency responses, close pairs included."""
    from ...core.identification import identify as find
    from ..identifying import identify_headline, identify_tables, read_responses
    from ..runfolder import refuse_existing
    from ..writing import free_folder

    output = Output(json=json, force=force, quiet=quiet, verbose=verbose)
    target = out or free_folder(f"{frf[0].stem}_identify")
    alone = out is not None and out.suffix.lower() in _FILES
    if alone:
        _refuse(target, frf, force)
    else:
        refuse_existing(target, force)
    with working("reading", output):
        content = read_responses(frf)
    assert content.frfs is not None
    with working("identifying", output):
        found = find(
            content.frfs, fmin=fmin, fmax=fmax, max_order=max_order, geometry=content.geometry
        )
    result: dict[str, Any] = {
        "schema": "trueup/identify/1",
        "frf": [str(p) for p in frf],
        **identify_tables(found),
        "warnings": [
            *content.warnings,
            *_lost(content.skipped),
            *found.warnings,
        ],
    }
    if alone:
        if not len(found.modes):
            raise InputError(f"{target} is not written: no mode stands out of the noise")
        _write_modes(target, content, found)
    else:
        _write_folder(target, content, found, result, output)
    emit_json(result, output)
    if speaks(output):
        from ..tables import identify_table

        console = stdout()
        console.print(identify_headline(result), markup=False)
        if result["modes"]:
            console.print(identify_table(result))
        console.print(f"{'modes' if alone else 'run folder'}: {target}", markup=False)
    if not quiet:
        _tell(result, content, verbose)


def _lost(skipped: Sequence[Any]) -> list[str]:
    """Name the responses that could not be used, the first few one by one."""
    lost = [str(s) for s in skipped if s.harm == "lost"]
    more = len(lost) - _MOST_NAMED
    told = f"{more} further functions were not read; trueup inspect lists them"
    return [*lost[:_MOST_NAMED], *([told] if more > 0 else [])]


def _refuse(target: Path, frf: list[Path], force: bool) -> None:
    if not target.parent.is_dir():
        raise InputError(f"--out {target}: the folder {target.parent} does not exist")
    if target.exists() and any(target.samefile(p) for p in frf if p.exists()):
        raise InputError(f"--out {target} is the input itself; give another name")
    if target.exists() and not force:
        raise InputError(f"{target} exists; give --force to replace it or another --out")


def _write_folder(
    target: Path,
    content: UniversalContent,
    found: Identification,
    result: dict[str, Any],
    output: Output,
) -> None:
    from ...adapters.report.stabilisation import stabilisation_page
    from ..runfolder import run_folder, write_json

    name = ", ".join(Path(p).name for p in result["frf"])
    page = stabilisation_page(found, name, result["warnings"])
    with run_folder(target, output.force) as work:
        if len(found.modes):
            _write_modes(work / "modes.unv", content, found)
            _write_modes(work / "modes_complex.unv", content, found, complex_shapes=True)
        _write_modes(work / "result.h5", content, found)
        write_json(work / "result.json", result)
        (work / "stabilisation.html").write_text(page, encoding="utf-8")


def _write_modes(
    path: Path,
    content: UniversalContent,
    found: Identification,
    complex_shapes: bool = False,
) -> None:
    """Write modes by the suffix of `path`; the store holds both kinds and the shapes' errors."""
    if path.suffix.lower() == ".h5":
        from ...adapters.store import write_store

        write_store(
            path,
            geometry=content.geometry,
            modes={"test": found.real_modes, "test_complex": found.modes},
            matrices={"shape_std": found.shape_std},
        )
        return
    from ...adapters.universal import write_universal

    write_universal(
        path,
        geometry=content.geometry,
        modes=found.modes if complex_shapes else found.real_modes,
        units=content.units,
        description="complex shapes" if complex_shapes else "normalised real shapes",
    )


def _tell(result: dict[str, Any], content: UniversalContent, verbose: bool) -> None:
    console = stderr()
    if verbose:
        for band in result["bands"]:
            console.print(f"band: {band['low_hz']:.5g} to {band['high_hz']:.5g} Hz", markup=False)
        for s in content.skipped:
            console.print(f"skipped: {s.what} at line {s.line}: {s.why}", markup=False)
    for k, mode in enumerate(result["modes"]):
        if mode["remark"]:
            told = f"mode {k + 1} ({mode['frequency_hz']:.2f} Hz): {mode['remark']}"
            console.print(f"warning: {told}", markup=False)
    for warning in result["warnings"]:
        console.print(f"warning: {warning}", markup=False)
