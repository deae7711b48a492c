"""``trueup report RUN``."""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path
from typing import Annotated, Any

import typer

from ...core.errors import InputError
from ..options import QuietOption


def report(
    run: Annotated[Path, typer.Argument(metavar="RUN")],
    quiet: QuietOption = False,
) -> None:
    """Make the report of a run folder again."""
    result = read_result(run)
    if result["schema"].startswith("trueup/identify/"):
        raise InputError(
            f"{run} is the run folder of an identification; its page is stabilisation.html, which "
            "identify makes again"
        )
    page = render(run, result)
    handle, name = tempfile.mkstemp(prefix=".report.", dir=run)
    with os.fdopen(handle, "w", encoding="utf-8") as stream:
        stream.write(page)
    Path(name).chmod(0o644)
    os.replace(name, run / "report.html")
    if not quiet:
        typer.echo(str(run / "report.html"))


def read_result(run: Path) -> dict[str, Any]:
    """Read result.json of a run folder."""
    path = run / "result.json"
    if not path.is_file():
        raise InputError(f"{run} is not a run folder: it has no result.json")
    try:
        result = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, OSError) as error:
        raise InputError(f"{path} cannot be read: {error}") from error
    if not isinstance(result, dict) or not str(result.get("schema", "")).startswith("trueup/"):
        raise InputError(f"{path} is not a result of trueup: it has no schema 'trueup/VERB/1'")
    return result


def render(run: Path, result: dict[str, Any]) -> str:
    """Return the report page of a run folder whose result.h5 and changes.diff are in place."""
    from ...adapters.report import make_report, overlay
    from ...adapters.store import read_store

    diff = run / "changes.diff"
    store = run / "result.h5"
    content = read_store(store) if store.is_file() else None
    shapes = None
    if content and content.geometry and {"analysis", "test"} <= set(content.modes):
        shapes = overlay(
            result,
            content.geometry,
            content.modes.get("updated", content.modes["analysis"]),
            content.modes["test"],
            content.matrices.get("observation"),
            content.matrices.get("transformation"),
        )
    return make_report(
        result,
        diff.read_text(encoding="utf-8") if diff.is_file() else None,
        geometry=content.geometry if content else None,
        shapes=shapes,
    )
