"""The paper's tables as plain content, rendered alike on the page and in the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from . import reading
from .formats import MISSING, counted, fixed, general, hz, percent, signed
from .reading import Result


@dataclass(frozen=True)
class Cell:
    """A cell: its text, how it reads (``good``, ``poor``, ``muted`` or plain), a bar of 0..1."""

    text: str
    tone: str = ""
    bar: float | None = None


@dataclass(frozen=True)
class Column:
    """A column: heading, what it stands under, whether its cells are numbers."""

    heading: str
    group: str = ""
    numeric: bool = True


@dataclass(frozen=True)
class Table:
    """A titled table; `note` is what has to be known to read it."""

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""


_UNSURE = " One above half the factor: the data hardly identify the parameter."
_PAIR = ("analysis mode", "Hz", "deviation %", "MAC %", "rotation °", "cluster")


def pairs(result: Result) -> Table | None:
    """Return every test mode with its partner, before and after side by side where both are held.

    Returns None when the run holds no correlation or no test modes.
    """
    after, before = reading.final(result), reading.initial(result)
    states = [("before", before), ("after", after)] if before else [("", after)]
    modes = reading.test_modes(*(c for _, c in states))
    if not modes:
        return None
    frequency = reading.mode_hz(before, "test") | reading.mode_hz(after, "test")
    partners = [reading.pair_by_test(c) for _, c in states]
    keep = _used_columns([p for of in partners for p in of.values()])
    columns = [Column("test mode"), Column("Hz")]
    columns += [Column(_PAIR[k], group) for group, _ in states for k in keep]
    rows = []
    for n in modes:
        row = [Cell(str(n)), Cell(hz(frequency.get(n)))]
        for of in partners:
            cells = _pair_cells(of.get(n))
            row += [cells[k] for k in keep]
        rows.append(tuple(row))
    note = "Deviation is 100·(analysis − test)/test."
    if 4 in keep:
        note += (
            " Rotation is how far the analysis mode was turned within its cluster of close modes."
        )
    return Table("Test modes and their partners", tuple(columns), tuple(rows), note)


def _used_columns(found: Sequence[Result]) -> list[int]:
    turned = any(p.get("rotation_deg") is not None for p in found)
    clustered = any(p.get("cluster") is not None for p in found)
    return [0, 1, 2, 3] + [4] * turned + [5] * clustered


def _pair_cells(pair: Result | None) -> list[Cell]:
    if pair is None:
        return [Cell("none", "muted")] + [Cell("")] * 5
    mac = reading.number(pair.get("mac"))
    cluster = pair.get("cluster")
    return [
        Cell(general(pair.get("analysis"))),
        Cell(hz(pair.get("analysis_hz"))),
        Cell(signed(pair.get("deviation_percent"), 2)),
        Cell(percent(mac, 1), bar=mac),
        Cell("" if pair.get("rotation_deg") is None else fixed(pair["rotation_deg"], 1)),
        Cell("" if cluster is None else str(cluster)),
    ]


def unpaired(result: Result) -> Table | None:
    """Return the modes of both sides without a partner, each with its closest look-alike by MAC.

    Analysis modes above the test's range are only counted.
    """
    found = reading.final(result)
    matrix = reading.mac_matrix(found, "mac_rotated") or reading.mac_matrix(found, "mac")
    top = max(reading.mode_hz(found, "test").values(), default=None)
    rows, beyond = [], 0
    for side, other in (("test", "analysis"), ("analysis", "test")):
        for n, f in reading.unpaired(found, side):
            if side == "analysis" and top is not None and f is not None and f > 1.02 * top:
                beyond += 1
                continue
            best, value = _closest(matrix, side, n)
            like = MISSING if best is None else f"{other} {best}"
            cells = (Cell(side), Cell(str(n)), Cell(hz(f)), Cell(like), Cell(percent(value, 1)))
            rows.append(cells)
    note = f"Above the test's range: {counted(beyond, 'analysis mode')}." if beyond else ""
    if not rows:
        return None
    columns = (
        Column("side", numeric=False),
        Column("mode"),
        Column("Hz"),
        Column("most alike"),
        Column("MAC %"),
    )
    return Table("Modes without a partner", columns, tuple(rows), note)


def only(table: Table, first: str) -> Table:
    """Return the rows whose first cell reads `first`, without that column and the note."""
    rows = tuple(r[1:] for r in table.rows if r[0].text == first)
    name = Column(f"{first} {table.columns[1].heading}", numeric=table.columns[1].numeric)
    return Table(f"{table.title}: {first}", (name, *table.columns[2:]), rows)


def _closest(
    matrix: reading.MacMatrix | None, side: str, mode: int
) -> tuple[int | None, float | None]:
    if matrix is None:
        return None, None
    own, others, values = (
        (matrix.test, matrix.analysis, matrix.values)
        if side == "test"
        else (matrix.analysis, matrix.test, matrix.values.T)
    )
    if mode not in own:
        return None, None
    row = values[own.index(mode)]
    if not np.isfinite(row).any():
        return None, None
    k = int(np.nanargmax(row))
    return others[k], float(row[k])


_LEFT = "The deck was left as it was; the factors are those of the best explanation. "


def parameters(result: Result) -> Table | None:
    """Return what was moved: cards, values before and after, factor, standard error, bounds."""
    found = reading.records(result, "parameters")
    if not found:
        return None
    rows, unsure = [], False
    for p in found:
        name, cards = str(p.get("name", "")), _joined(p.get("cards"))
        factor, error = (reading.number(p.get(k)) for k in ("factor", "standard_error"))
        loose = factor is not None and error is not None and error > 0.5 * abs(factor)
        unsure = unsure or loose
        rows.append(
            (
                Cell(name),
                Cell("" if cards == name else cards, "muted"),
                Cell(_joined(p.get("initial"))),
                Cell(_joined(p.get("updated"))),
                Cell(fixed(p.get("factor"), 4)),
                Cell(MISSING if error is None else f"± {fixed(error, 4)}", "poor" if loose else ""),
                Cell("at bound" if p.get("at_bound") else "", "poor"),
            )
        )
    columns = (
        Column("parameter", numeric=False),
        Column("cards", numeric=False),
        Column("initial"),
        Column("updated"),
        Column("factor"),
        Column("std. error"),
        Column("", numeric=False),
    )
    used = [k for k in range(len(columns)) if any(r[k].text for r in rows)]
    left = "" if reading.adopted(result) else _LEFT
    return Table(
        "Parameters",
        tuple(columns[k] for k in used),
        tuple(tuple(r[k] for k in used) for r in rows),
        left + "The standard error is that of the factor." + _UNSURE * unsure,
    )


def _joined(value: object) -> str:
    if isinstance(value, (list, tuple)):
        return ", ".join(v if isinstance(v, str) else general(v, 6) for v in value)
    return value if isinstance(value, str) else general(value, 6)


def history(result: Result) -> Table | None:
    """Return the iterations: objective, mean and worst deviation, factors."""
    found = reading.records(result, "history")
    if not found:
        return None
    names = [str(p.get("name", k + 1)) for k, p in enumerate(reading.records(result, "parameters"))]
    most = max(len(by_name(h.get("factors"))) for h in found)
    names += [f"factor {k + 1}" for k in range(len(names), most)]
    rows = []
    for h in found:
        deviations = list(by_name(h.get("deviations_percent")).values())
        factors = list(by_name(h.get("factors")).values())
        factors += [None] * (len(names) - len(factors))
        rows.append(
            (
                Cell(general(h.get("iteration"))),
                Cell(general(h.get("objective"))),
                Cell(fixed(reading.mean_abs(deviations), 2)),
                Cell(fixed(reading.largest(deviations), 2)),
                *[Cell(fixed(f, 4)) for f in factors[: len(names)]],
            )
        )
    columns = (
        Column("iteration"),
        Column("objective"),
        Column("mean |dev.| %"),
        Column("worst |dev.| %"),
        *[Column(n, "factors") for n in names],
    )
    stopped = result.get("stopped")
    return Table("Iterations", columns, tuple(rows), f"Ended: {stopped}." if stopped else "")


def by_name(value: object) -> dict[str, float | None]:
    """Return numbers by name; a plain sequence is named 1, 2, ..."""
    if isinstance(value, dict):
        return {str(k): reading.number(v) for k, v in value.items()}
    return {str(k + 1): v for k, v in enumerate(reading.numbers(value))}
