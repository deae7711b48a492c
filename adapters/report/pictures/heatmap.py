"""MAC matrices as heat maps: one path per colour class, values for the pointer and the reader."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from ....core.arrays import Floats
from ....core.results.correlation import MacTable
from ..html.markup import centred, esc, short, svg, svg_text, tag
from ..tables.number_formats import hz
from .colour import STEPS

_DIGITS = "0123456789abcdefghijklmnopqrstuvwxyz"
_LEFT, _BOTTOM, _PAD = 84, 88, 8
_ACROSS, _DOWN = 56, 60
"""Modes of one picture, at most: numbers stay readable, and it fits on a sheet of paper."""


def heatmap(
    matrix: MacTable,
    title: str,
    *,
    test_hz: Floats,
    analysis_hz: Floats,
    pairs: Iterable[tuple[int, int]] = (),
    clusters: Iterable[tuple[Sequence[int], Sequence[int]]] = (),
    sides: tuple[str, str] = ("test", "analysis"),
    waves: tuple[Mapping[int, str], Mapping[int, str]] = ({}, {}),
    width: int = 1040,
) -> str:
    """Return a figure of one MAC matrix.

    Parameters
    ----------
    matrix : MacTable
    title : str
        Caption, plain text.
    test_hz, analysis_hz : (n_test,) and (n_analysis,) float
        Frequencies of all modes, for the labels.
    pairs : iterable of (test, analysis)
        Cells to be ringed.
    clusters : iterable of (test modes, analysis modes)
        Blocks to be framed.
    sides : (str, str)
        Whose modes stand down and across.
    waves : (mapping, mapping)
        Of a body of revolution what modes are, by their number, for the labels.
    width : int
        Width to fill, pixels.
    """
    rows, cols = matrix.values.shape
    cell = int(np.clip((width - _LEFT - _PAD) / cols, 7, 28))
    w, h = cols * cell, rows * cell
    rings = "".join(
        tag("rect", x=c * cell + 0.75, y=r * cell + 0.75, width=cell - 1.5, height=cell - 1.5)
        for t, a in pairs
        for r, c in _position(matrix, [t], [a])
    )
    frames = "".join(tag("path", d=_outline(_position(matrix, t, a), cell)) for t, a in clusters)
    body = [
        tag("rect", class_="field", width=w, height=h),
        *_cells(matrix.values, cell),
        tag("path", class_="grid", d=_grid(rows, cols, cell)),
        tag("g", _numbers(matrix.values, cell), class_="values") if cell >= 17 else "",
        tag("g", frames, class_="clusters") if frames else "",
        tag("g", rings, class_="rings") if rings else "",
        *_labels(matrix, test_hz, analysis_hz, cell, sides),
        tag("rect", class_="cursor", width=cell, height=cell, hidden=True),
    ]
    labels = [
        [f"{m} ({', '.join([f'{hz(f[m - 1])} Hz', *([w[m]] if m in w else [])])})" for m in modes]
        for modes, f, w in (
            (matrix.test, test_hz, waves[0]),
            (matrix.analysis, analysis_hz, waves[1]),
        )
    ]
    picture = svg(
        "heat",
        (w + _LEFT + _PAD, h + _BOTTOM + _PAD),
        _description(matrix, title, sides),
        tag("g", *body, transform=f"translate({_LEFT} {_PAD})"),
        tabindex="0",
        data_cell=cell,
        data_rows="|".join(labels[0]),
        data_cols="|".join(labels[1]),
        data_v=_packed(matrix.values),
        data_sides="|".join(sides),
    )
    caption = tag("figcaption", tag("b", esc(title)))
    return tag("figure", caption, picture, _values_table(matrix, sides), class_="mac")


def readable(matrix: MacTable) -> Iterator[tuple[MacTable, str]]:
    """Yield a matrix in parts alike whose cells have room for numbers, each with what it holds."""
    rows, cols = matrix.values.shape
    whole = rows <= _DOWN and cols <= _ACROSS
    down, across = _alike(rows, _DOWN), _alike(cols, _ACROSS)
    for r in range(0, rows, down):
        for c in range(0, cols, across):
            test, analysis = matrix.test[r : r + down], matrix.analysis[c : c + across]
            said = f", modes {test[0]} to {test[-1]} and {analysis[0]} to {analysis[-1]}"
            values = matrix.values[r : r + down, c : c + across]
            yield MacTable(test, analysis, values), "" if whole else said


def _alike(count: int, most: int) -> int:
    """Return the size of parts alike, none larger than `most`."""
    parts = -(-count // most)
    return -(-count // max(parts, 1)) or 1


def legend(what: str = "MAC %") -> str:
    """Return the scale of the ramp, 0 to 100."""
    step, left = 14, 12 + 6.6 * len(what)
    boxes = "".join(
        tag("rect", class_=f"c{k}", x=k * step, width=step, height=12) for k in range(STEPS)
    )
    ticks = "".join(centred(p / 100 * STEPS * step, 25, p) for p in (0, 25, 50, 75, 100))
    bar = tag("g", boxes, ticks, transform=f"translate({short(left)} 2)")
    return tag(
        "svg",
        svg_text(0, 12, what),
        bar,
        class_="scale",
        width=short(left + STEPS * step + 14),
        height=30,
        role="img",
        aria_label=f"Colour scale: {what}, 0 to 100",
    )


def _position(
    matrix: MacTable, test: Sequence[int], analysis: Sequence[int]
) -> list[tuple[int, int]]:
    return [
        (matrix.test.index(t), matrix.analysis.index(a))
        for t in test
        for a in analysis
        if t in matrix.test and a in matrix.analysis
    ]


def _cells(values: Floats, cell: int) -> list[str]:
    steps = np.clip(np.nan_to_num(values, nan=-1.0) * STEPS, -1, STEPS - 1).astype(int)
    classes = np.where(np.isnan(values), -1, steps)
    paths = []
    for k in [-1, *range(1, STEPS)]:
        where = np.argwhere(classes == k)
        if len(where):
            d = "".join(f"M{c * cell} {r * cell}h{cell}v{cell}h-{cell}z" for r, c in where)
            paths.append(tag("path", class_=f"c{k}" if k >= 0 else "unknown", d=d))
    return paths


def _grid(rows: int, cols: int, cell: int) -> str:
    across = "".join(f"M0 {r * cell}h{cols * cell}" for r in range(rows + 1))
    return across + "".join(f"M{c * cell} 0v{rows * cell}" for c in range(cols + 1))


def _numbers(values: Floats, cell: int) -> str:
    drawn = {"lo": "", "hi": ""}
    for r, c in np.argwhere(np.nan_to_num(values) >= 0.195):
        percent = round(100 * float(values[r, c]))
        x, y = short((c + 0.5) * cell), short((r + 0.5) * cell + 3.4)
        drawn["hi" if values[r, c] >= 0.55 else "lo"] += f'<text x="{x}" y="{y}">{percent}</text>'
    return "".join(tag("g", text, class_=name) for name, text in drawn.items() if text)


def _labels(
    matrix: MacTable, test_hz: Floats, analysis_hz: Floats, cell: int, sides: tuple[str, str]
) -> list[str]:
    rows, cols = len(matrix.test), len(matrix.analysis)
    every = 1 if cell >= 11 else 2
    left = "".join(
        svg_text(-6, (k + 0.5) * cell + 3.5, n, text_anchor="end", class_="n")
        + svg_text(-26, (k + 0.5) * cell + 3.5, hz(test_hz[n - 1]), text_anchor="end")
        for k, n in [*enumerate(matrix.test)][::every]
    )
    below = "".join(
        _upright((k + 0.5) * cell + 3.5, rows * cell, n, analysis_hz[n - 1])
        for k, n in [*enumerate(matrix.analysis)][::every]
    )
    middle = rows * cell / 2
    turned = f"translate(-73 {short(middle)}) rotate(-90)"
    return [
        tag("g", left, below, class_="ticks"),
        centred(0, 0, f"{sides[0]} mode, Hz", "axis", transform=turned),
        centred(cols * cell / 2, rows * cell + 82, f"{sides[1]} mode, Hz", "axis"),
    ]


def _upright(x: float, y: float, mode: int, frequency: float) -> str:
    name = tag("tspan", str(mode), class_="n")
    turn = f"translate({short(x)} {y + 6}) rotate(-90)"
    return tag("text", f"{hz(frequency)} ", name, text_anchor="end", transform=turn)


def _outline(cells: Sequence[tuple[int, int]], cell: int) -> str:
    """Edges between cells that belong to a block and cells that do not."""
    inside, d = set(cells), ""
    for r, c in cells:
        x, y = c * cell, r * cell
        d += "" if (r - 1, c) in inside else f"M{x} {y}h{cell}"
        d += "" if (r + 1, c) in inside else f"M{x} {y + cell}h{cell}"
        d += "" if (r, c - 1) in inside else f"M{x} {y}v{cell}"
        d += "" if (r, c + 1) in inside else f"M{x + cell} {y}v{cell}"
    return d


def _packed(values: Floats) -> str:
    """Two base-36 digits a value, in thousandths; ``--`` where unknown."""
    thousandths = np.clip(np.nan_to_num(values), 0.0, 1.2)
    codes = np.rint(1000.0 * thousandths).astype(int)
    return "".join(
        "--" if unknown else _DIGITS[code // 36] + _DIGITS[code % 36]
        for code, unknown in zip(codes.ravel(), np.isnan(values).ravel(), strict=True)
    )


def _description(matrix: MacTable, title: str, sides: tuple[str, str]) -> str:
    high = int(np.count_nonzero(np.nan_to_num(matrix.values) >= 0.7))
    return (
        f"{title}: MAC of {len(matrix.test)} {sides[0]} modes with {len(matrix.analysis)} "
        f"{sides[1]} modes, {high} of them at or above 70 percent. "
        "Arrow keys move through the values."
    )


def _values_table(matrix: MacTable, sides: tuple[str, str]) -> str:
    head = f"<th>{sides[0]} \\ {sides[1]}</th>" + "".join(f"<th>{n}</th>" for n in matrix.analysis)
    rows = "".join(
        f"<tr><th>{n}</th>{_row(values.tolist())}</tr>"
        for n, values in zip(matrix.test, matrix.values, strict=True)
    )
    table = f'<div class="wide"><table class="dense"><tr>{head}</tr>{rows}</table></div>'
    return tag("details", tag("summary", "values in %"), table)


def _row(values: list[float]) -> str:
    """Cells without end tags, which HTML leaves optional: a third of the bytes."""
    return "".join("<td>–" if math.isnan(v) else f"<td>{round(100 * v)}" for v in values)
