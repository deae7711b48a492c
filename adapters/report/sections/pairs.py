"""The paper's table of pairs, with what is known of damping, and deviations and MAC by mode."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from ....core.results.correlation import Compared, PairRow, RunTables
from ....core.results.plain import finite
from ..html.html_table import html_table
from ..pictures import charts
from ..tables.number_formats import fixed, hz, percent, signed
from ..tables.table import Cell, Column, Heading, Table, left
from .section import ReportedRun, Section

_PAIR = (
    "analysis mode",
    "Hz",
    "damping %",
    "deviation %",
    "MAC %",
    "rotation °",
    "cluster",
    "waves",
)


def pairs_table(
    states: Sequence[tuple[str, Compared]], names: Mapping[int, str] | None = None
) -> Table | None:
    """Return every test mode with its partner, one group of columns a state; None without any.

    `names` of test modes, where the user gave some.
    """
    last = states[-1][1]
    if not last.test_modes:
        return None
    partners = [{p.test: p for p in c.pairs} for _, c in states]
    every = [p for of in partners for p in of.values()]
    keep = [0, 1] + [2] * any(p.analysis_damping is not None for p in every) + [3, 4]
    keep += [5] * any(p.rotation_deg is not None for p in every)
    keep += [6] * any(p.cluster is not None for p in every)
    keep += [7] * any(p.test_harmonic is not None for p in every)
    known = {
        heading: (of_test, digits)
        for heading, of_test, digits in (
            ("damping %", last.test_damping, 2),
            ("MPC %", last.test_mpc, 1),
        )
        if np.isfinite(of_test).any()
    }
    names = names or {}
    columns: list[Heading] = ["test mode", *left(*["name"] * bool(names)), "Hz", *known]
    columns += [Column(_PAIR[k], group) for group, _ in states for k in keep]
    rows = []
    for n in last.test_modes:
        row: list[Cell | str] = [str(n), *[names.get(n, "")] * bool(names), hz(last.test_hz[n - 1])]
        row += [percent(finite(of_test[n - 1]), digits) for of_test, digits in known.values()]
        for of in partners:
            cells = _cells(of.get(n))
            row += [cells[k] for k in keep]
        rows.append(row)
    note = "Deviation is 100·(analysis − test)/test."
    if 5 in keep:
        note += (
            " Rotation is how far the analysis mode was turned within its cluster of close modes."
        )
    if 7 in keep:
        note += (
            " Waves: the harmonic round the axis and where a crest is, of the test mode and of the "
            "analysis mode."
        )
    return Table.of("Test modes and their partners", columns, rows, note)


def _cells(pair: PairRow | None) -> list[Cell | str]:
    if pair is None:
        return [Cell("none", "muted"), *[""] * 7]
    return [
        str(pair.analysis),
        hz(pair.analysis_hz),
        percent(pair.analysis_damping, 2),
        signed(pair.deviation_percent, 2),
        Cell(percent(pair.mac, 1), bar=pair.mac),
        "" if pair.rotation_deg is None else fixed(pair.rotation_deg, 1),
        "" if pair.cluster is None else str(pair.cluster),
        pair.waves,
    ]


def _states(answer: RunTables) -> list[tuple[str, Compared]]:
    if answer.initial is None:
        return [("", answer.final)]
    return [("before", answer.initial), ("after", answer.final)]


def _tables(answer: RunTables) -> Sequence[Table]:
    table = pairs_table(_states(answer), answer.named)
    return [] if table is None else [table]


def _render(run: ReportedRun[RunTables]) -> str:
    answer = run.tables
    body = "".join(map(html_table, _tables(answer)))
    return body + _bars(
        answer, "Frequency deviation of each test mode", lambda p: p.deviation_percent, 240
    ) + _bars(
        answer, "MAC of each test mode with its partner", lambda p: 100.0 * p.mac, 200,
        (0.0, 100.0), 100.0 * answer.final.criteria.mac_min,
    ) if body else ""  # fmt: skip


def _bars(
    answer: RunTables,
    title: str,
    value: Callable[[PairRow], float],
    height: int,
    limits: tuple[float, float] | None = None,
    mark: float | None = None,
) -> str:
    modes, frequency = answer.final.test_modes, answer.final.test_hz
    values = {}
    for state, c in _states(answer):
        known = {p.test: value(p) for p in c.pairs}
        values[state] = [known.get(n) for n in modes]
    labels = [(str(n), _tick_hz(frequency[n - 1])) for n in modes]
    return charts.bars(title, labels, values, unit="%", limits=limits, mark=mark, height=height)


def _tick_hz(value: float) -> str:
    return f"{value:.1f}" if 100.0 <= value < 10000.0 else hz(value)


PAIRS = Section("Pairs", "pairs", RunTables, _tables, _render)
