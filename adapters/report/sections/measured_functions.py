"""Measured frequency responses with those of the model over them."""

from ....core.results.correlation import RunTables
from ..html.markup import tag
from ..pictures.function_overlay import function_overlay
from .section import ReportedRun, Section

_NOTE = (
    "The model's are those of its modes alone, at their own frequencies, with the damping of the "
    "test modes that they pair with; one common factor is taken out. Marked are the test modes."
)


def _render(run: ReportedRun[RunTables]) -> str:
    if run.curves is None:
        return ""
    return function_overlay(run.curves) + tag("p", _NOTE, class_="note")


MEASURED_FUNCTIONS = Section("Functions", "functions", RunTables, render=_render)
