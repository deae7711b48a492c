"""The MAC as measured, after rotation, after updating."""

from ....core.results.correlation import MacTable, RunTables
from ....core.results.discovery import DiscoverTables
from ..html.markup import key, tag
from ..pictures import heatmap
from .section import ReportedRun, Section


def _render(run: ReportedRun[RunTables]) -> str:
    answer = run.tables
    first, last = answer.initial or answer.final, answer.final
    shown = [
        (first, first.mac, "As measured"),
        (first, first.mac_rotated, "After rotation of close modes"),
    ]
    if answer.initial is not None:
        discovered = isinstance(answer, DiscoverTables)
        changed = "completing the model" if discovered else "updating"
        shown.append((last, last.mac_rotated, f"After {changed}"))
    if not all(m.values.size for _, m, _ in shown):
        return ""
    narrow = max(len(m.analysis) for _, m, _ in shown) <= 13
    figures = [
        heatmap.heatmap(
            part,
            title + which,
            test_hz=c.test_hz,
            analysis_hz=c.analysis_hz,
            pairs=[(p.test, p.analysis) for p in c.pairs] if matrix is c.mac_rotated else [],
            clusters=[(k.test, k.analysis) for k in c.clusters],
            waves=c.waves,
            width=500 if narrow else 1050 if not which else 92 + 19 * len(part.analysis),
        )
        for c, matrix, title in shown
        for part, which in heatmap.readable(matrix)
    ]
    figures += [
        heatmap.heatmap(
            part,
            f"AutoMAC of the {side} modes at the sensors{which}",
            test_hz=hz,
            analysis_hz=hz,
            sides=(side, side),
            width=max(500, 92 + 19 * len(part.analysis)),
        )
        for side, table, hz in (
            ("test", first.auto_mac_test, first.test_hz),
            ("analysis", first.auto_mac_analysis, first.analysis_hz),
        )
        if table is not None
        for part, which in heatmap.readable(MacTable(table.modes, table.modes, table.values))
    ]
    keys = key("pair", "ring") + key("cluster of close modes", "frame")
    top = tag("div", heatmap.legend(), tag("span", keys, class_="note"), class_="row")
    return top + tag("div", *figures, class_="row")


MAC_MATRICES = Section("MAC matrices", "mac", RunTables, render=_render)
