"""The moving shapes: pairs, analysis over test or beside it, and modes without a partner."""

from collections.abc import Mapping

from ....core.results.correlation import PairRow, RunTables
from ..html.markup import key, tag
from ..pictures.film import Frame
from ..pictures.moving_figure import moving_figure
from ..tables.number_formats import fixed, hz, percent
from .section import ReportedRun, Section


def _render(run: ReportedRun[RunTables]) -> str:
    film = run.shapes
    if film is None:
        return ""
    names = run.tables.named
    labels = [_label(f, names) for f in film.frames]
    labels += [f"{_label(f, names)}, before turning" for f in film.all_frames[len(film.frames) :]]
    figure = moving_figure(film, labels, [_brief(f) for f in film.frames])
    keys = key("where the model puts a sensor", "model")
    keys += key("where the test puts it, to the same scale.", "measured")
    told = (
        " Thin lines are the directions measured; in others a sensor follows the model, or rests "
        "where the test is alone."
    )
    if not film.drawn:
        told += " The test holds no lines: neighbours are joined for the eye."
    return figure + tag("p", keys, told, class_="note")


def _label(frame: Frame, names: Mapping[int, str]) -> str:
    name = "" if frame.side == "analysis" else names.get(frame.mode, "")
    called = f", {name}".replace("|", "/") if name else ""
    if frame.pair is None:
        return f"{frame.side} {frame.mode} ({hz(frame.hz)} Hz), no partner{called}"
    return _paired(frame.pair) + called


def _brief(frame: Frame) -> str:
    alone = {"test": "T", "analysis": "A"}.get(frame.side, "")
    return f"{alone}{frame.mode} · {hz(frame.hz)}"


def _paired(pair: PairRow) -> str:
    return (
        f"test {pair.test} ({hz(pair.test_hz)} Hz) and analysis {pair.analysis} "
        f"({hz(pair.analysis_hz)} Hz), {fixed(pair.deviation_percent, 1)} %, "
        f"MAC {percent(pair.mac)} %{', ' * bool(pair.waves)}{pair.waves}"
    )


MOVING_SHAPES = Section("Shapes", "shapes", RunTables, render=_render)
