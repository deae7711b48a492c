"""The report of a run folder."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.data.modes import Modes
from ...core.errors import InputError, Place, naming, path_of
from ...core.results.correlation import CorrelateTables, RunTables
from ...core.results.discovery import DiscoverTables
from ...core.results.modes import IdentifyTables, SolveTables
from ...core.results.together import TogetherTables
from ...core.results.update import UpdateTables
from ..studies.imprint import imprint_of
from ..studies.study import read_study
from .open_run import read_content, read_diff, read_result

if TYPE_CHECKING:
    from ...adapters.report import Curves, Film, Imprint, Overlay
    from ...adapters.store import StoreContent


_OWN_PAGES = {IdentifyTables.schema: "stabilisation.html", SolveTables.schema: "report.html"}


def report(run: Path | str) -> Path:
    """Make the report of a run folder again; return the path of the page.

    Raises
    ------
    InputError
        No run folder, or that of an identification.
    """
    from ...adapters.run_folder.write_run import write_text

    run = path_of(run, "a run folder")
    result = read_result(run)
    if page := _OWN_PAGES.get(str(result["schema"])):
        verb = str(result["schema"]).split("/")[1]
        raise Place(run).fault(f"is the run folder of {verb}, which makes its page itself: {page}")
    if result["schema"] == TogetherTables.schema:
        return _together(run, result)
    try:
        answer = answer_of(result)
    except InputError as error:
        raise Place(run / "result.json").fault(str(error)) from error
    asked = run / "study.toml"
    imprint = imprint_of(read_study(asked)) if asked.is_file() else None
    page = render(answer, read_content(run), read_diff(run), imprint)
    write_text(run / "report.html", page)
    return run / "report.html"


def _together(run: Path, result: Mapping[str, Any]) -> Path:
    from ...adapters.report.together_page import together_page
    from ...adapters.run_folder.write_run import write_text

    with naming(run / "result.json"):
        found = TogetherTables.from_dict(result)
    for one in found.configurations:
        report(run / one.folder)
    asked = run / "study.toml"
    imprint = imprint_of(read_study(asked)) if asked.is_file() else None
    write_text(run / "report.html", together_page(found, imprint))
    return run / "report.html"


def render(
    answer: RunTables,
    content: StoreContent | None,
    diff: str | None,
    imprint: Imprint | None = None,
) -> str:
    """Return the report page of a run.

    Parameters
    ----------
    answer : RunTables
        What the verb answered.
    content : StoreContent or None
        Of result.h5, for pictures and moving shapes.
    diff : str or None
        Of the deck.
    imprint : Imprint, optional
        Title, author, company, date and logo.
    """
    from ...adapters.report import make_report

    geometry = content.geometry if content else None
    shapes = _film(answer, content)
    return make_report(
        answer, diff, geometry=geometry, shapes=shapes, imprint=imprint, curves=_curves(content)
    )


def paired_shapes(answer: RunTables, content: StoreContent | None) -> Overlay | None:
    """Return the final pairs of a run as shapes; None where it has none, or no modes."""
    from ...adapters.report import overlay

    held = _shown_modes(content)
    if content is None or content.geometry is None or held is None:
        return None
    observation, transformation = map(content.matrices.get, ("observation", "transformation"))
    return overlay(answer.final, content.geometry, *held, observation, transformation)


def _curves(content: StoreContent | None) -> Curves | None:
    """Return the measured frequency responses of a run and those of its model."""
    from ...adapters.report import Curves

    if content is None or not {"measured", "model"} <= set(content.frfs):
        return None
    measured, model = content.frfs["measured"], content.frfs["model"]
    hz = content.modes["test"].frequencies_hz
    frac = np.asarray(content.matrices["frac"])
    return Curves(measured, lambda lines: model.values[..., lines], frac, 2j * np.pi * hz, hz,
                  "the model")  # fmt: skip


def _film(answer: RunTables, content: StoreContent | None) -> Film | None:
    from ...adapters.report import paired_film

    held = _shown_modes(content)
    if content is None or content.geometry is None or held is None:
        return None
    observation, transformation = map(content.matrices.get, ("observation", "transformation"))
    return paired_film(
        answer.final, content.geometry, *held, observation, transformation, content.test_geometry
    )


def _shown_modes(content: StoreContent | None) -> tuple[Modes, Modes] | None:
    """Return the final modes of the analysis and those of the test; None where one is missing."""
    if not content or not content.geometry or not {"analysis", "test"} <= set(content.modes):
        return None
    return content.modes.get("updated", content.modes["analysis"]), content.modes["test"]


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
