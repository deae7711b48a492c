"""Results as tables for the terminal: the same content as the report's."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from ..adapters.report.pictures.colour import STEPS, ramp
from ..adapters.report.tables.number_formats import (
    MISSING,
    few,
    fixed,
    general,
    hz,
    percent,
    placed,
    weighed,
)

if TYPE_CHECKING:
    from ..adapters.report.tables import table as report_table
    from ..core.results.correlation import Compared, RunTables
    from ..core.results.inspection import FileRow
    from ..core.results.modes import IdentifiedRow, SolveTables
    from ..core.results.parameters import ParametersTables
    from ..core.results.together import TogetherTables

_TONES = {"muted": "dim", "good": "green", "poor": "red"}
_BOTH = 98  # columns that pairs before and after need side by side
_MORE = 6  # and for each thing that is known of damping
_WAVES = 24  # and for the harmonics of a body of revolution
_BRIEF = {
    "damping %": "damp.\n%",
    "MPC %": "MPC\n%",
    "deviation %": "dev.\n%",
    "rotation °": "turned\n°",
    "standard error": "std. error",
}


def sentences(answer: RunTables | TogetherTables) -> list[str]:
    """Return the result in sentences, the most important first."""
    from ..adapters.report.tables.headline import story
    from ..adapters.report.together_page import headline
    from ..core.results.together import TogetherTables

    return [headline(answer)] if isinstance(answer, TogetherTables) else story(answer)


def result_tables(answer: RunTables | TogetherTables, width: int = 110) -> Iterator[RenderableType]:
    """Yield what a correlation, an update or a discovery has to show, section by section.

    Parameters
    ----------
    answer : RunTables or TogetherTables
        What the verb answered.
    width : int
        Columns of the terminal; a MAC matrix that does not fit is left out.
    """
    from ..adapters.report.sections.known_sections import SECTIONS
    from ..adapters.report.sections.mac_matrices import MAC_MATRICES
    from ..adapters.report.sections.pairs import PAIRS
    from ..adapters.report.together_page import together_tables
    from ..core.results.together import TogetherTables

    if isinstance(answer, TogetherTables):
        for made in together_tables(answer):
            yield Padding(_rich(made), (1, 0, 0, 0), expand=False)
        return
    for section in SECTIONS:
        shown: Sequence[RenderableType | None]
        if section is PAIRS:
            shown = pairs_tables(answer, width)
        elif section is MAC_MATRICES:
            shown = [mac_table(answer.final, width)]
        else:
            shown = [_rich(table) for table in section.tables_of(answer)]
        yield from (Padding(t, (1, 0, 0, 0), expand=False) for t in shown if t is not None)


def brief_tables(answer: RunTables) -> Iterator[Table]:
    """Yield what was found, what was moved, and the final pairs."""
    from ..adapters.report.sections.findings import FINDINGS
    from ..adapters.report.sections.pairs import pairs_table
    from ..adapters.report.sections.parameters import PARAMETERS

    shown = (
        *FINDINGS.tables_of(answer),
        *PARAMETERS.tables_of(answer)[:1],
        pairs_table([("", answer.final)], answer.named),
    )
    yield from (_rich(table) for table in shown if table is not None)


def pairs_tables(answer: RunTables, width: int = 110) -> list[Table]:
    """Return the test modes with their partners, before and after one below the other if narrow."""
    from ..adapters.report.sections.pairs import PAIRS, pairs_table

    tables = PAIRS.tables_of(answer)
    more = sum(c.heading in ("damping %", "MPC %") for table in tables for c in table.columns)
    waves = sum(c.heading == "waves" for table in tables for c in table.columns)
    if answer.initial is None or width >= _BOTH + _MORE * more + _WAVES * waves:
        return [_rich(table) for table in tables]
    states = ((answer.initial, "before"), (answer.final, "after"))
    made = [(pairs_table([("", c)], answer.named), state) for c, state in states]
    return [_rich(table, state) for table, state in made if table is not None]


def mac_table(found: Compared, width: int = 110) -> RenderableType | None:
    """Return the rotated MAC matrix, shaded, in percent.

    Where it is wider than `width`, analysis modes that resemble no test mode are left out first;
    None where that does not help.
    """
    matrix = found.mac_rotated
    if not matrix.values.size:
        return None
    left = 13
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
        line.append(f"{hz(found.test_hz[n - 1]):>8} ", style="dim")
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


def solve_table(answer: SolveTables) -> RenderableType:
    """Return the modes of ``trueup solve`` with mass and centre of gravity."""
    table = titled("Normal modes", ("mode", "Hz", "generalised mass", ""))
    for k, mode in enumerate(answer.modes):
        rigid = k < answer.rigid_body_modes
        what = Text("rigid body", style="dim") if rigid else ""
        mass = general(mode.generalized_mass, 5)
        table.add_row(str(k + 1), _solved_hz(mode.frequency_hz, rigid), mass, what)
    facts = []
    if answer.mass is not None:
        facts.append(f"mass {weighed(answer.mass, answer.kilograms)}")
    if answer.centre_of_gravity is not None:
        facts.append(f"centre of gravity {placed(answer.centre_of_gravity, answer.length_unit)}")
    said = "; ".join(facts)
    if answer.length_unit is None:
        said = said.replace(" (deck units)", "") + " (deck units)"
    return Group(table, Text(f"{said}\n"))


def _solved_hz(f: float, rigid: bool) -> str:
    return f"{f:.1e}" if rigid and f else f"{f:.4f}" if abs(f) < 1e5 else general(f, 9)


def identify_table(modes: Sequence[IdentifiedRow]) -> Table:
    """Return the modes of ``trueup identify`` with their uncertainty and quality."""
    headings = ("mode", "Hz", "±", "damping %", "±", "MPC %", "MPD °", "quality", "")
    table = titled("Identified modes", headings)
    for k, mode in enumerate(modes):
        notes = [mode.remark] if mode.remark else []
        notes += ["moves as a rigid body (suspension)"] if mode.suspension else []
        notes += ["a close pair may hide here"] if mode.close_pair_possible else []
        table.add_row(
            str(k + 1),
            hz(mode.frequency_hz),
            general(mode.frequency_std, 2),
            percent(mode.damping_ratio, 3),
            general(100.0 * mode.damping_std, 2),
            percent(mode.mpc, 1),
            fixed(mode.mpd, 1),
            general(mode.quality, 3),
            "; ".join(notes),
        )
    return table


def properties_table(answer: ParametersTables, most: int | None = None) -> Table:
    """Return the cards with values that may move, the first `most` of them."""
    table = titled("Properties", ("card", "number", "elements"))
    table.add_column("values", overflow="fold")
    for row in answer.properties[:most]:
        values = ", ".join(f"{name} {general(v, 5)}" for name, v in row.values.items() if v)
        table.add_row(row.card, str(row.id), str(row.elements), values)
    left = len(answer.properties) - (most or len(answer.properties))
    table.caption = Text(f"{left} more with --verbose", style="dim") if left > 0 else None
    table.caption_justify = "left"
    return table


def candidates_table(answer: ParametersTables) -> Table:
    """Return what could be moved, those recommended first, then by sensitivity."""
    headings = ("value", "%/%", "± alone", "± all", "group", "rank", "explained %")
    table = titled("What the modes say of them")
    table.add_column("parameter", overflow="fold")
    for heading in headings:
        table.add_column(heading, justify="right", no_wrap=True)
    last = len(answer.candidates) + 1
    for row in sorted(answer.candidates, key=lambda r: (r.recommended or last, -r.sensitivity)):
        table.add_row(
            row.name,
            few([general(v, 5) for v in row.values]),
            general(row.sensitivity, 2),
            general(row.error_alone, 2),
            general(row.error_together, 2),
            str(row.group),
            str(row.recommended or ""),
            "" if row.explained is None else percent(row.explained, 1),
        )
    note = (
        "%/%: largest change of a frequency per per cent of the value. ±: standard error of the "
        "factor, moved alone or all together. One group: not told apart."
    )
    table.caption = Text(note, style="dim")
    table.caption_justify = "left"
    return table


def inspect_table(file: FileRow) -> Table:
    """Return what ``trueup inspect`` found in one file."""
    table = titled(" · ".join(t for t in (file.path, file.format) if t))
    table.add_column("what")
    table.add_column("holds", overflow="fold")
    for what, said in _contents(file.contents):
        table.add_row(Text(what), Text(said))
    for s in file.skipped:
        line = f" (line {s.line})" if s.line is not None else ""
        table.add_row(Text("skipped", style="yellow"), Text(f"{s.what}{line}: {s.why}"))
    for warning in file.warnings or ():
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
        between = "\n" if any(isinstance(v, str) and ": " in v for v in value) else between
        return between.join(_told(v) for v in value) if value else "none"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return general(value, 6) if isinstance(value, float) else str(value)


def titled(title: str, headings: Sequence[str] = ()) -> Table:
    """Return an empty table; columns are of numbers where they have a heading."""
    table = Table(title=Text(title, style="bold"), title_justify="left", box=None, pad_edge=False,
                  header_style="dim", padding=(0, 2, 0, 0))  # fmt: skip
    for heading in headings:
        table.add_column(heading, justify="right" if heading else "left")
    return table


def _rich(table: report_table.Table, state: str = "") -> Table:
    shown = titled(f"{table.title}, {state}" if state else table.title)
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
