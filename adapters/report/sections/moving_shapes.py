"""The moving overlay of analysis and test."""

from ....core.results.correlation import PairRow, RunTables
from ..html.markup import key, tag
from ..pictures.moving_figure import moving_figure
from ..tables.number_formats import fixed, hz, percent
from .section import ReportedRun, Section


def _render(run: ReportedRun[RunTables]) -> str:
    overlay = run.shapes
    if overlay is None:
        return ""
    brief = [f"{p.test} · {hz(p.test_hz)}" for p in overlay.pairs]
    keys = key("where the model puts a sensor", "model")
    keys += key("where the test puts it, to the same scale", "measured")
    figure = moving_figure(overlay, [_label(p) for p in overlay.pairs], brief)
    told = " It moves along the direction that it measures, drawn as a thin line, and no other."
    return figure + tag("p", keys, told, class_="note")


def _label(pair: PairRow) -> str:
    return (
        f"test {pair.test} ({hz(pair.test_hz)} Hz) and analysis {pair.analysis} "
        f"({hz(pair.analysis_hz)} Hz), {fixed(pair.deviation_percent, 1)} %, "
        f"MAC {percent(pair.mac)} %{', ' * bool(pair.waves)}{pair.waves}"
    )


MOVING_SHAPES = Section("Shapes of the pairs", "shapes", RunTables, render=_render)
