"""``trueup identify FRF...``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...core.errors import InputError, Place
from ...verbs.studies.study import Study, read_study
from ..answer import free_folder
from ..console import emit_json, speaks, stdout, tell, working
from ..options import (
    BandsOption,
    ExponentialWindowOption,
    FmaxOption,
    FminOption,
    ForceOption,
    JsonOption,
    MaxOrderOption,
    Output,
    QuietOption,
    RefuseOption,
    StudyOption,
    TakeOption,
    VerboseOption,
)

if TYPE_CHECKING:
    from ...verbs.runs.identified import Identified

_FILES = (".unv", ".uff", ".h5")


def identify(
    frf: Annotated[list[Path] | None, typer.Argument(metavar="FRF...")] = None,
    study: StudyOption = None,
    fmin: FminOption = None,
    fmax: FmaxOption = None,
    bands: BandsOption = None,
    max_order: MaxOrderOption = None,
    modes: Annotated[
        int | None, typer.Option("--modes", metavar="N", help="How many modes: the best founded.")
    ] = None,
    exponential_window: ExponentialWindowOption = None,
    take: TakeOption = None,
    refuse: RefuseOption = None,
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
    from ...adapters.run_folder.write_run import refuse_existing
    from ...verbs.identify import identify as find

    output = Output(json=json, force=force, quiet=quiet, verbose=verbose)
    filed = read_study(study) if study else Study()
    files = frf or list(filed.test)
    if not files:
        raise typer.BadParameter("give FRF, or a study file (--study) that names it as its test")
    out = out or filed.out
    target = out or free_folder(f"{files[0].stem}_identify")
    alone = out is not None and out.suffix.lower() in _FILES
    if alone:
        _refuse(target, files, force)
    else:
        refuse_existing(target, force)
    with working("reading", output) as say:
        found = find(
            files,
            fmin,
            fmax,
            max_order,
            take=take or (),
            refuse=refuse or (),
            exponential_window=exponential_window,
            bands=bands or (),
            modes=modes,
            study=filed,
            progress=say,
        )
    if alone:
        found.write(target)
    else:
        found.save(target, force)
    emit_json(found.to_dict(), output)
    if speaks(output):
        from ..terminal_tables import identify_table

        console = stdout()
        console.print(_headline(found), markup=False)
        if found.modes:
            console.print(identify_table(found.modes))
        console.print(f"{'modes' if alone else 'run folder'}: {target}", markup=False)
    if verbose:
        parts = (f"{b.low_hz:.5g} to {b.high_hz:.5g} Hz" for b in found.bands)
        tell(output, "band", parts)
        out_of = ((f"{r.frequency_hz:.2f} Hz", 100 * r.damping_ratio, r) for r in found.rejected)
        tell(output, "rejected", (f"{hz}, {z:.2f} %: {r.reason}" for hz, z, r in out_of))
        tell(output, "skipped", (f"{s.what} at line {s.line}: {s.why}" for s in found.skipped))
    marked = ((k, m) for k, m in enumerate(found.modes, 1) if m.remark)
    poor = (f"mode {k} ({m.frequency_hz:.2f} Hz): {m.remark}" for k, m in marked)
    tell(output, "warning", (*poor, *found.warnings))


def _refuse(target: Path, frf: list[Path], force: bool) -> None:
    if not target.parent.is_dir():
        raise InputError(f"--out {target}: the folder {target.parent} does not exist", file=target)
    if target.exists() and any(target.samefile(p) for p in frf if p.exists()):
        raise InputError(f"--out {target} is the input itself; give another name", file=target)
    if target.exists() and not force:
        raise Place(target).fault("exists; give --force to replace it or another --out")


def _headline(found: Identified) -> str:
    """Return an identification in one sentence."""
    from ...adapters.report.tables.number_formats import counted

    modes, (low, high) = found.modes, found.range_hz
    many = counted(len(modes), "mode") if modes else "No mode"
    of = f"{counted(len(found.responses), 'response')} and "
    of += counted(len(found.references), "reference")
    poor = sum(bool(m.remark) for m in modes)
    marked = f"; {poor} marked as poor" if poor else ""
    left = f"; {len(found.rejected)} more considered and rejected" if found.rejected else ""
    return f"{many} between {low:.4g} and {high:.4g} Hz from {of}{marked}{left}."
