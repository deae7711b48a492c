"""What every run folder holds."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from ..core.comparison import Comparison
from .console import emit_json, speaks, stderr, stdout
from .options import Output
from .runfolder import write_json
from .study import Study, study_toml
from .verbs.report import render


def default_folder(study: Study, verb: str) -> Path:
    """Return ``--out``, or DECK_VERB in the current folder, numbered if that is taken."""
    if study.out is not None:
        return study.out
    assert study.deck is not None
    return free_folder(f"{study.deck.stem}_{verb}")


def free_folder(name: str) -> Path:
    """Return a folder of this name in the current one, numbered if that is taken."""
    base = Path(name)
    path, number = base, 2
    while path.exists():
        path, number = Path(f"{base}_{number}"), number + 1
    return path


def fill_run_folder(
    work: Path,
    study: Study,
    result: dict[str, Any],
    before: Comparison,
    after: Comparison | None = None,
) -> None:
    """Write result.json, result.h5, study.toml and report.html into `work`.

    ``deck/`` and ``changes.diff`` are written by the verbs that change the deck, before this.
    """
    from ..adapters.store import write_store

    last = after or before
    modes = {"test": before.test, "analysis": before.analysis}
    if after is not None:
        modes["updated"] = after.analysis
    final = result.get("after", result)
    write_store(
        work / "result.h5",
        geometry=before.geometry,
        test_geometry=before.placed.test_geometry,
        modes=modes,
        pairs=final["pairs"],
        mac={"measured": final["mac"], "rotated": final["mac_rotated"]},
        matrices={
            "observation": last.observation.matrix,
            "transformation": last.correlation.transformation,
        },
        history=result.get("history", ()),
    )
    write_json(work / "result.json", result)
    absolute = replace(
        study,
        deck=study.deck.absolute() if study.deck else None,
        test=tuple(p.absolute() for p in study.test),
        modes=study.modes.absolute() if study.modes else None,
    )
    (work / "study.toml").write_text(study_toml(absolute), encoding="utf-8")
    (work / "report.html").write_text(render(work, result), encoding="utf-8")


def answer(result: dict[str, Any], output: Output, run: Path) -> None:
    """Give the result: JSON where asked, else the sentence and the tables; then the warnings."""
    emit_json(result, output)
    if speaks(output):
        from ..adapters.report import headline
        from .tables import result_tables

        console = stdout()
        console.print(headline(result), markup=False)
        for table in result_tables(result, console.width):
            console.print(table)
        console.print(f"run folder: {run}", markup=False)
        for file, backup in zip(*result.get("in_place", {}).values(), strict=True):
            console.print(f"changed in place: {file} (before: {backup})", markup=False)
    if not output.quiet:
        for warning in result.get("warnings", ()):
            stderr().print(f"warning: {warning}", markup=False)
