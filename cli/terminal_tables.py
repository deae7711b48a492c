"""Results as tables for the terminal: the same content as the report's.

Every function takes the content of a ``result.json`` and is pure; it returns None where the
result has nothing for it. `result_tables` gives all of a result in reading order.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from ..adapters.report import discovery, reading, tables
from ..adapters.report.colour import STEPS, ramp
from ..adapters.report.formats import MISSING, fixed, general, hz, percent

Result = Mapping[str, Any]

_TONES = {"muted": "dim", "good": "green", "poor": "red"}
_BOTH = 98  # columns that pairs before and after need side by side
_BRIEF = {
    "deviation %": "dev.\n%",
    "rotation °": "turned\n°",
    "standard error": "std. error",
}


def result_tables(result: Result, width: int = 110) -> Iterator[RenderableType]:
    """Yield what a correlation, an update or a discovery has to show, in reading order.

    Parameters
    ----------
    result : mapping
        Content of result.json.
    width : int
        Columns of the terminal; a MAC matrix that does not fit is left out.
    """
    compared = reading.initial(result) if width < _BOTH else {}
    shown = (
        findings_table(result),
        _rich(discovery.would_decide(result)),
        alternatives_table(result),
        gap_table(result),
        _rich(discovery.damping(result)),
        _rich(discovery.responses(result)),
        *(
            [
                _rich(tables.pairs(c), state)
                for c, state in ((compared, "before"), (reading.final(result), "after"))
            ]
            if compared
            else [pairs_table(result)]
        ),
        unpaired_table(result),
        mac_table(result, width),
        parameters_table(result),
        history_table(result),
    )
    yield from (Padding(t, (1, 0, 0, 0), expand=False) for t in shown if t is not None)


def pairs_table(result: Result) -> Table | None:
    """Return the test modes with their partners, before and after where the result has both."""
    return _rich(tables.pairs(result))


def unpaired_table(result: Result) -> Table | None:
    """Return the modes of both sides without a partner."""
    return _rich(tables.unpaired(result))


def parameters_table(result: Result) -> Table | None:
    """Return what was moved, from where to where, and how surely."""
    return _rich(tables.parameters(result))


def history_table(result: Result) -> Table | None:
    """Return the iterations of an update."""
    return _rich(tables.history(result))


def findings_table(result: Result) -> Table | None:
    """Return what a discovery found."""
    return _rich(discovery.findings(result))


def alternatives_table(result: Result) -> Table | None:
    """Return what a discovery considered besides."""
    return _rich(discovery.alternatives(result))


def gap_table(result: Result) -> Table | None:
    """Return the gap before and after."""
    return _rich(discovery.gap(result))


def mac_table(result: Result, width: int = 110) -> RenderableType | None:
    """Return the final MAC matrix, shaded, in percent.

    Where it is wider than `width`, analysis modes that resemble no test mode are left out first;
    None where that does not help.
    """
    found = reading.final(result)
    matrix = reading.mac_matrix(found, "mac_rotated") or reading.mac_matrix(found, "mac")
    if matrix is None:
        return None
    frequency = reading.mode_hz(found, "test")
    left = 4 + (9 if frequency else 0)
    best = np.nan_to_num(matrix.values).max(axis=0)
    cell = 4 if max(matrix.analysis) > 99 else 3
    room = (width - left) // cell
    kept = np.sort(np.argsort(-best, kind="stable")[: max(room, 0)])
    dropped = best[np.setdiff1d(np.arange(len(best)), kept)]
    if dropped.max(initial=0.0) >= 0.5:
        return None
    values, analysis = matrix.values[:, kept], [matrix.analysis[k] for k in kept]
    note = "  test modes down, analysis modes across"
    if len(dropped):
        note += f"; {len(dropped)} below {int(100 * dropped.max()) + 1} % left out"
    shades = ramp(dark=False)
    lines = [Text.assemble(("MAC %", "bold"), note)]
    header = Text(" " * left, style="dim")
    header.append("".join(f"{n:>{cell - 1}} " for n in analysis))
    lines.append(header)
    for n, row in zip(matrix.test, values, strict=True):
        line = Text(f"{n:>3} ")
        if frequency:
            line.append(f"{hz(frequency.get(n)):>8} ", style="dim")
        for value in row:
            line.append(*_shaded(float(value), cell, shades))
        lines.append(line)
    return Group(*lines)


def _shaded(value: float, cell: int, shades: list[str]) -> tuple[str, str]:
    if not np.isfinite(value):
        return f"{MISSING:>{cell - 1}} ", "dim"
    if value < 0.05:
        return f"{'·':>{cell - 1}} ", "dim"
    shown = round(100 * value)
    text = f"{min(shown, 99) if cell == 3 else shown:>{cell - 1}} "
    step = min(int(value * STEPS), STEPS - 1)
    return text, f"{'#ffffff' if value >= 0.5 else '#000000'} on {shades[step]}"


def solve_table(result: Result) -> RenderableType:
    """Return the modes of ``trueup solve`` with mass and centre of gravity."""
    modes = reading.records(result, "modes")
    rigid = int(reading.number(result.get("rigid_body_modes")) or 0)
    table = _titled("Normal modes")
    for heading in ("mode", "Hz", "generalised mass", ""):
        table.add_column(heading, justify="left" if not heading else "right")
    for k, mode in enumerate(modes):
        what = Text("rigid body", style="dim") if k < rigid else ""
        mass = general(mode.get("generalized_mass"), 5)
        table.add_row(str(k + 1), _solved_hz(mode.get("frequency_hz"), k < rigid), mass, what)
    facts = [f"mass {general(result.get('mass'), 6)}"]
    centre = reading.numbers(result.get("centre_of_gravity"))
    if centre:
        facts.append(f"centre of gravity {', '.join(general(c, 6) for c in centre)}")
    return Group(table, Text(f"{'; '.join(facts)} (deck units)\n"))


def _solved_hz(value: object, rigid: bool) -> str:
    f = reading.number(value)
    if f is None:
        return MISSING
    return f"{f:.1e}" if rigid and f else f"{f:.4f}" if abs(f) < 1e5 else general(f, 9)


def identify_table(result: Result) -> Table:
    """Return the modes of ``trueup identify`` with their uncertainty and quality."""
    table = _titled("Identified modes")
    for heading in ("mode", "Hz", "±", "damping %", "±", "MPC %", "MPD °", "quality", ""):
        table.add_column(heading, justify="left" if not heading else "right")
    for k, mode in enumerate(reading.records(result, "modes")):
        damping, spread = (reading.number(mode.get(f"damping_{x}")) for x in ("ratio", "std"))
        quality = mode.get("quality")
        table.add_row(
            str(k + 1),
            hz(mode.get("frequency_hz")),
            general(mode.get("frequency_std"), 2),
            MISSING if damping is None else fixed(100.0 * damping, 3),
            MISSING if spread is None else general(100.0 * spread, 2),
            percent(mode.get("mpc"), 1),
            fixed(mode.get("mpd"), 1),
            general(quality, 3),
            _identified(mode),
        )
    return table


def _identified(mode: Mapping[str, Any]) -> str:
    notes = [str(mode["remark"])] if mode.get("remark") else []
    notes += ["moves as a rigid body (suspension)"] if mode.get("suspension") else []
    notes += ["a close pair may hide here"] if mode.get("close_pair_possible") else []
    return "; ".join(notes)


def inspect_table(entry: Result) -> Table:
    """Return what ``trueup inspect`` found in one file."""
    named = [str(entry[k]) for k in ("path", "format") if entry.get(k)]
    table = _titled(" · ".join(named))
    table.add_column("what")
    table.add_column("holds", overflow="fold")
    for what, said in _contents(entry.get("contents")):
        table.add_row(Text(what), Text(said))
    for skipped in reading.records(entry, "skipped"):
        line = f" (line {skipped['line']})" if skipped.get("line") is not None else ""
        what = f"{skipped.get('what', 'something')}{line}"
        table.add_row(Text("skipped", style="yellow"), Text(f"{what}: {skipped.get('why', '')}"))
    for warning in reading.texts(entry, "warnings"):
        table.add_row(Text("warning", style="yellow"), Text(warning))
    return table


def _contents(contents: object) -> Iterator[tuple[str, str]]:
    if isinstance(contents, Mapping):
        for key, value in contents.items():
            yield str(key).replace("_", " "), _told(value)
    elif isinstance(contents, list | tuple):
        for item in contents:
            if isinstance(item, Mapping):
                rest = {k: v for k, v in item.items() if k != "what" and v not in (None, "", {})}
                yield str(item.get("what", "")), _told(rest)
            else:
                yield "", _told(item)
    elif contents is not None:
        yield "", str(contents)


def _told(value: object, between: str = ", ") -> str:
    if isinstance(value, Mapping):
        inner = {k: v for k, v in value.items() if v is not None}
        return ", ".join(
            f"{str(k).replace('_', ' ')} {_told(v, ' × ' if k == 'shape' else ', ')}"
            for k, v in inner.items()
        )
    if isinstance(value, list | tuple):
        return between.join(_told(v) for v in value) if value else "none"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return general(value, 6) if isinstance(value, float) else str(value)


def _titled(title: str) -> Table:
    return Table(title=Text(title, style="bold"), title_justify="left", box=None, pad_edge=False,
                 header_style="dim", padding=(0, 2, 0, 0))  # fmt: skip


def _rich(table: tables.Table | None, state: str = "") -> Table | None:
    if table is None:
        return None
    shown = _titled(f"{table.title}, {state}" if state else table.title)
    grouped = any(c.group for c in table.columns)
    if grouped:
        shown.padding = (0, 1, 0, 0)
    group = ""
    for c in table.columns:
        heading = _BRIEF.get(c.heading, c.heading)
        if grouped:
            above = c.group if c.group != group else ""
            heading, group = f"{above}\n{heading.replace(' ', chr(10), 1)}", c.group
        shown.add_column(
            Text(heading),
            justify="right" if c.numeric else "left",
            overflow="fold",
            no_wrap=c.numeric,
        )
    for row in table.rows:
        shown.add_row(*[Text(cell.text, style=_TONES.get(cell.tone, "")) for cell in row])
    shown.caption = Text(table.note, style="dim") if table.note else None
    shown.caption_justify = "left"
    return shown
