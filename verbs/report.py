"""The report of a run folder."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.errors import InputError, Place, path_of
from ..core.results.correlation import CorrelateTables, RunTables
from ..core.results.discovery import DiscoverTables
from ..core.results.modes import IdentifyTables
from ..core.results.update import UpdateTables
from .open_run import read_content, read_diff, read_result

if TYPE_CHECKING:
    from ..adapters.report import Overlay
    from ..adapters.store import StoreContent


def report(run: Path | str) -> Path:
    """Make the report of a run folder again; return the path of the page.

    Raises
    ------
    InputError
        No run folder, or that of an identification.
    """
    from ..adapters.run_folder.write_run import write_text

    run = path_of(run, "a run folder")
    result = read_result(run)
    if result["schema"] == IdentifyTables.schema:
        raise Place(run).fault(
            "is the run folder of an identification; its page is stabilisation.html, which "
            "identify makes again"
        )
    try:
        answer = answer_of(result)
    except InputError as error:
        raise Place(run / "result.json").fault(str(error)) from error
    write_text(run / "report.html", render(answer, read_content(run), read_diff(run)))
    return run / "report.html"


def render(answer: RunTables, content: StoreContent | None, diff: str | None) -> str:
    """Return the report page of a run.

    Parameters
    ----------
    answer : RunTables
        What the verb answered.
    content : StoreContent or None
        Of result.h5, for pictures and moving shapes.
    diff : str or None
        Of the deck.
    """
    from ..adapters.report import make_report

    geometry = content.geometry if content else None
    return make_report(answer, diff, geometry=geometry, shapes=paired_shapes(answer, content))


def paired_shapes(answer: RunTables, content: StoreContent | None) -> Overlay | None:
    """Return the final pairs of a run as shapes; None where it has none, or no modes."""
    from ..adapters.report import overlay

    if not content or not content.geometry or not {"analysis", "test"} <= set(content.modes):
        return None
    return overlay(
        answer.final,
        content.geometry,
        content.modes.get("updated", content.modes["analysis"]),
        content.modes["test"],
        content.matrices.get("observation"),
        content.matrices.get("transformation"),
    )


def answer_of(result: Mapping[str, Any]) -> RunTables:
    """Return result.json as typed tables.

    Raises
    ------
    InputError
        It is none of a verb that compares, or a key is missing or odd.
    """
    kinds = {kind.schema: kind for kind in (CorrelateTables, UpdateTables, DiscoverTables)}
    schema = str(result.get("schema"))
    if schema not in kinds:
        raise InputError(f"result.json has schema '{schema}'; known are {', '.join(kinds)}")
    return kinds[schema].from_dict(result)
