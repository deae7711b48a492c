"""``trueup demo [NAME]``: steps run two at a time, the last first, since it takes longest."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib import import_module
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

from ...core.errors import InputError, Place
from ...verbs.runs.open_run import open_run
from ...verbs.studies.study import read_study
from ..console import stdout, working
from ..options import ForceOption, Output, QuietOption

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from ...verbs.runs.run import Run


@dataclass(frozen=True)
class Step:
    """One step of a demo: what is said, the study file, the verb, where to, the side to rotate."""

    says: str
    study: str
    verb: str
    folder: str
    rotate: str = "analysis"


_DUCT = (
    Step("The deck as it is against the test, mode by mode",
         "frequencies.toml", "correlate", "1_as_it_is", "none"),
    Step("The same after close analysis modes are rotated onto the test",
         "frequencies.toml", "correlate", "2_rotated"),
    Step("Strategy 1: the flange rings' inertias, by frequencies only",
         "frequencies.toml", "update", "3_frequencies"),
    Step("Strategy 2: rim densities by the shapes alone, then the flanges by frequencies",
         "masses_first.toml", "update", "4_masses_first"),
    Step("Strategy 3: frequencies and shapes together, rotated at every iteration",
         "both.toml", "update", "5_both"),
    Step("Discover: what the model lacks, put into the deck, flanges fitted along",
         "discover.toml", "discover", "6_discover"),
)  # fmt: skip
_PORTS = (
    Step("The deck as it is against the test, mode by mode",
         "frequencies.toml", "correlate", "1_as_it_is", "none"),
    Step("The same after close analysis modes are rotated onto the test",
         "frequencies.toml", "correlate", "2_rotated"),
    Step("Strategy 1: the flanges, by frequencies only",
         "frequencies.toml", "update", "3_frequencies"),
    Step("Strategy 2: rim densities by the shapes alone, none rotated, then the flanges",
         "masses_first.toml", "update", "4_masses_first", "none"),
    Step("Strategy 3: frequencies and shapes together, rotated at every iteration",
         "both.toml", "update", "5_both"),
)  # fmt: skip
_DEMOS = {"duct": _DUCT, "ports": _PORTS}


def demo(
    name: Annotated[str, typer.Argument(metavar="[NAME]")] = "duct",
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="[default: trueup-demo-NAME]")
    ] = None,
    force: ForceOption = False,
    quiet: QuietOption = False,
) -> None:
    """Copy an example study beside you and run it from end to end."""
    if name not in _DEMOS:
        raise InputError(f"there is no demo '{name}'; there are: {', '.join(_DEMOS)}")
    folder = out or Path(f"trueup-demo-{name}")
    _copy(name, folder, force)
    console = stdout()
    rows = []
    steps = _DEMOS[name]
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        begun = {step: pool.submit(_ran, folder, step) for step in reversed(steps)}
        for step in steps:
            with working(step.says, Output(quiet=quiet)):
                run = begun[step].result()
            found = cast("Run", open_run(run))
            rows.append((step, found))
            if not quiet:
                _show(console, step, found, run)
    console.print(_summary(rows))
    console.print(f"files, run folders and reports: {folder}", markup=False)


def _ran(folder: Path, step: Step) -> Path:
    """Run a step and return its run folder."""
    study = replace(read_study(folder / step.study), rotate=step.rotate)
    verb: Callable[..., Run] = getattr(
        import_module(f"...verbs.{step.verb}", __package__), step.verb
    )
    return verb(study=study).save(folder / "runs" / step.folder)


def _copy(name: str, folder: Path, force: bool) -> None:
    if folder.exists() and not force:
        raise Place(folder).fault("exists; give --force to replace it or another --out")
    if folder.exists() and not (folder / "frequencies.toml").is_file():
        raise Place(folder).fault("exists and is not a demo; give another --out")
    source = files("trueup.fixtures") / name
    folder.absolute().parent.mkdir(parents=True, exist_ok=True)
    work = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", dir=folder.absolute().parent))
    try:
        for entry in source.iterdir():
            if entry.is_file() and not entry.name.endswith(".py"):
                (work / entry.name).write_bytes(entry.read_bytes())
        work.chmod(0o755)
        if folder.exists():
            shutil.rmtree(folder)
        work.rename(folder)
    finally:
        shutil.rmtree(work, ignore_errors=True)


def _show(console: Console, step: Step, found: Run, run: Path) -> None:
    from ..terminal_tables import brief_tables

    console.rule(step.says)
    for table in brief_tables(found):
        console.print(table)
    console.print(f"{run / 'report.html'}\n", markup=False)


def _summary(rows: list[tuple[Step, Run]]) -> Table:
    from rich.table import Table

    table = Table(title="What each step brought", title_justify="left")
    table.add_column("step")
    for column in ("pairs", "mean |deviation| %", "worst %", "mean MAC %"):
        table.add_column(column, justify="right")
    for step, found in rows:
        gap = found.final.summary
        percent = None if gap.mean_mac is None else 100.0 * gap.mean_mac
        figures = (gap.mean_abs_deviation_percent, gap.worst_deviation_percent, percent)
        shown = ("-" if f is None else f"{f:.1f}" for f in figures)
        table.add_row(step.says, str(gap.pairs), *shown)
    return table
