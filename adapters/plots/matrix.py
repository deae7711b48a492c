"""The MAC matrix, shaded."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...core.late_imports import optional
from ...core.results.correlation import Compared
from .figure import FAINT, INK, figure

_ALIKE = 0.5
"""An analysis mode beyond the test's range is shown where its MAC is as large as this."""
_TOLD = 0.1
"""MAC from which a cell tells its percentage."""
_ROOM = 40
"""Modes of one side that leave room for numbers in the cells."""


def mac(found: Compared, rotated: bool, ramp: Sequence[str]) -> Any:
    """Return the MAC matrix as a figure: test modes down, analysis modes across, pairs framed.

    Parameters
    ----------
    found : Compared
    rotated : bool
        After rotation of close modes, else as measured.
    ramp : sequence of str
        Colours from 0 to 1.
    """
    table = found.mac_rotated if rotated else found.mac
    values, rows, columns = table.values, np.array(table.test), _kept(found, table.values)
    values, beyond = 100.0 * values[:, columns], values.shape[1] - len(columns)
    n, m = values.shape
    cell = min(0.36, 11.0 / max(m, 1))
    room = 0.9 * any(found.waves)
    made = figure(2.2 + cell * m + room, 1.4 + max(cell * n, 1.0) + room)
    axes = made.add_subplot()
    colours = optional("matplotlib.colors", "plot").LinearSegmentedColormap.from_list("mac", ramp)
    picture = axes.imshow(values, vmin=0.0, vmax=100.0, cmap=colours)
    axes.set_xticks(
        range(m), _named(columns + 1, found.analysis_hz[columns], found.waves[1]), rotation=90
    )
    axes.set_yticks(range(n), _named(rows, found.test_hz[rows - 1], found.waves[0]))
    axes.tick_params(labelsize=7, colors=INK, length=0)
    more = f"\n({beyond} more are like none of the test's)" if beyond else ""
    axes.set_xlabel(f"analysis mode, Hz{more}", color=INK)
    axes.set_ylabel("test mode, Hz", color=INK)
    axes.set_title("MAC" + " after rotation of close modes" * rotated, color=INK, fontsize=11)
    for side in axes.spines.values():
        side.set_color(FAINT)
    place = {int(c) + 1: k for k, c in enumerate(columns)}
    box = optional("matplotlib.patches", "plot").Rectangle
    for pair in found.pairs:
        corner = (place[pair.analysis] - 0.5, table.test.index(pair.test) - 0.5)
        axes.add_patch(box(corner, 1.0, 1.0, fill=False, edgecolor=INK, linewidth=1.2))
    told = np.nonzero(values >= 100.0 * _TOLD)
    for i, j in zip(*told, strict=True) if max(n, m) <= _ROOM else ():
        ink = "white" if values[i, j] >= 100.0 * _ALIKE else INK
        text = f"{values[i, j]:.0f}"
        axes.text(j, i, text, ha="center", va="center", color=ink, fontsize=6.5)
    bar = made.colorbar(picture, ax=axes, shrink=0.8, pad=0.02)
    bar.set_label("MAC, %", color=INK)
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=8, colors=INK)
    return made


def _kept(found: Compared, values: Any) -> Any:
    """Return the analysis modes (from 0) in the test's range, paired, or alike."""
    top = 1.02 * np.max(found.test_hz, initial=0.0)
    kept = (found.analysis_hz <= top) | (np.nan_to_num(values).max(axis=0, initial=0.0) >= _ALIKE)
    kept[[p.analysis - 1 for p in found.pairs]] = True
    first = np.argmax(found.analysis_hz > 1e-3 * top) if len(kept) else 0
    kept[:first] &= np.nan_to_num(values)[:, :first].max(axis=0, initial=0.0) >= _ALIKE
    return np.flatnonzero(kept)


def _named(modes: Any, hz: Any, waves: Mapping[int, str]) -> list[str]:
    """Return number, frequency and, of a body of revolution, the waves of each mode."""
    own = [f" · {waves[n]}" if n in waves else "" for n in map(int, modes)]
    return [f"{n} · {f:.4g}{w}" for n, f, w in zip(modes, hz, own, strict=True)]
