"""``trueup demo [NAME]``."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any

import typer

from ...core.errors import InputError
from ..console import stdout
from ..options import ForceOption, Output, QuietOption
from ..study import Study, read_study


@dataclass(frozen=True)
class Step:
    """One step of a demo: what is said, which study file, which verb, what differs."""

    says: str
    study: str
    verb: str
    folder: str
    changes: dict[str, Any]


_DUCT = (
    Step(
        "The deck as it is against the test, mode by mode",
        "frequencies.toml",
        "correlate",
        "1_as_it_is",
        {"rotate": "none"},
    ),
    Step(
        "The same after close analysis modes are rotated onto the test",
        "frequencies.toml",
        "correlate",
        "2_rotated",
        {},
    ),
    Step(
        "Strategy 1: the flange rings' inertias, by frequencies only",
        "frequencies.toml",
        "update",
        "3_frequencies",
        {},
    ),
    Step(
        "Strategy 2: rim densities by the shapes alone, then the flanges by frequencies",
        "masses_first.toml",
        "update",
        "4_masses_first",
        {},
    ),
    Step(
        "Strategy 3: frequencies and shapes together, rotated at every iteration",
        "both.toml",
        "update",
        "5_both",
        {},
    ),
    Step(
        "Discover: what the model lacks, put into the deck, flanges fitted along",
        "discover.toml",
        "discover",
        "6_discover",
        {},
    ),
)
_DEMOS = {"duct": _DUCT}


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
    for step in _DEMOS[name]:
        study = replace(
            read_study(folder / step.study), out=folder / "runs" / step.folder, **step.changes
        )
        result, run = _verbs()[step.verb](study, Output(quiet=quiet))
        rows.append((step, result))
        if not quiet:
            _show(console, step, result, run)
    console.print(_summary(rows))
    console.print(f"files, run folders and reports: {folder}", markup=False)


def _verbs() -> dict[str, Callable[[Study, Output], tuple[dict[str, Any], Path]]]:
    from .correlate import run_correlate
    from .discover import run_discover
    from .update import run_update

    return {"correlate": run_correlate, "update": run_update, "discover": run_discover}


def _copy(name: str, folder: Path, force: bool) -> None:
    if folder.exists() and not force:
        raise InputError(f"{folder} exists; give --force to replace it or another --out")
    if folder.exists() and not (folder / "frequencies.toml").is_file():
        raise InputError(f"{folder} exists and is not a demo; give another --out")
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


def _show(console: Any, step: Step, result: dict[str, Any], run: Path) -> None:
    from ..tables import findings_table, pairs_table, parameters_table

    console.rule(step.says)
    if "findings" in result:
        console.print(findings_table(result))
    if "parameters" in result:
        console.print(parameters_table(result))
    console.print(pairs_table(result.get("after", result)))
    console.print(f"{run / 'report.html'}\n", markup=False)


def _summary(rows: list[tuple[Step, dict[str, Any]]]) -> Any:
    from rich.table import Table

    table = Table(title="What each step brought", title_justify="left")
    table.add_column("step")
    for column in ("pairs", "mean |deviation| %", "worst %", "mean MAC %"):
        table.add_column(column, justify="right")
    for step, result in rows:
        gap = result.get("after", result)["summary"]
        table.add_row(
            step.says,
            str(gap["pairs"]),
            *(
                "-" if gap[k] is None else f"{scale * gap[k]:.1f}"
                for k, scale in (
                    ("mean_abs_deviation_percent", 1.0),
                    ("worst_deviation_percent", 1.0),
                    ("mean_mac", 100.0),
                )
            ),
        )
    return table
