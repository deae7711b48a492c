"""A matrix of shares, rows and columns by name: colour for the size, numbers where they fit."""

from collections.abc import Sequence

import numpy as np

from ....core.arrays import Floats
from ..html.markup import esc, short, svg, svg_text, tag
from .colour import STEPS

_CELL, _LETTER, _LONGEST, _TOLD = 26, 6.4, 34, 0.2


def named_matrix(
    values: Floats, rows: Sequence[str], columns: Sequence[str], title: str, note: str = ""
) -> str:
    """Return a figure of a matrix.

    Parameters
    ----------
    values : (n_row, n_column) float
        From -1 to 1: the colour is of the magnitude, the number tells the sign, in percent.
    rows, columns : sequence of str
    title, note : str
        Caption, plain text.
    """
    side = 12.0 + _LETTER * max(len(_short(r)) for r in rows)
    below = 12.0 + _LETTER * max(len(_short(c)) for c in columns)
    n, m = values.shape
    step = np.minimum((np.abs(np.nan_to_num(values)) * STEPS).astype(int), STEPS - 1)
    cells = [
        tag("rect", class_=f"c{step[i, j]}", x=j * _CELL, y=i * _CELL, width=_CELL, height=_CELL)
        for i, j in np.ndindex(n, m)
    ]
    told = {"lo": "", "hi": ""}
    for i, j in np.argwhere(np.abs(np.nan_to_num(values)) >= _TOLD):
        dark = "hi" if step[i, j] > STEPS // 2 else "lo"
        text = f"{100.0 * values[i, j]:.0f}".replace("-", "−")
        told[dark] += svg_text((j + 0.5) * _CELL, (i + 0.5) * _CELL + 4.0, text)
    labels = [
        svg_text(-6, (i + 0.5) * _CELL + 4.0, _short(r), text_anchor="end")
        for i, r in enumerate(rows)
    ]
    labels += [
        svg_text(0, 4, _short(c), text_anchor="end",
                 transform=f"translate({short((j + 0.5) * _CELL)} {n * _CELL + 8}) rotate(-90)")
        for j, c in enumerate(columns)
    ]  # fmt: skip
    body = [*cells, *labels, tag("g", *_both(told), class_="values")]
    picture = svg(
        "heat",
        (side + m * _CELL + 8.0, n * _CELL + below + 12.0),
        f"{title}: {n} rows, {m} columns",
        tag("g", *body, transform=f"translate({short(side)} 4)"),
    )
    said = tag("p", esc(note), class_="note") if note else ""
    return tag("figure", tag("figcaption", tag("b", esc(title))), picture, said, class_="mac")


def _both(told: dict[str, str]) -> list[str]:
    return [tag("g", text, class_=name) for name, text in told.items() if text]


def _short(name: str) -> str:
    return name if len(name) <= _LONGEST else f"{name[: _LONGEST - 1]}…"
