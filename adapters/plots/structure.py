"""The structure in space: paired shapes, and where they differ."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...core.arrays import Floats
from ...core.late_imports import optional
from ...core.results.correlation import PairRow
from ...core.results.paired_shapes import DrawnMesh, Overlay
from .figure import FAINT, INK, MESH, figure

_REACH = 0.12
"""Largest displacement drawn, as a share of the structure's diagonal."""
_ACROSS = 4
"""Shapes beside each other."""
_NAMED = 5
"""Sensors of the largest misfit that are named."""


def shapes(
    drawn: Overlay, pairs: Sequence[PairRow], colours: Sequence[str], left_out: Sequence[int]
) -> Any:
    """Return the paired shapes as a figure: the model deformed, the sensors where the test says.

    Parameters
    ----------
    drawn : Overlay
        The pairs of a run, in its order.
    pairs : sequence of PairRow
        The same pairs, for the headings.
    colours : sequence of str
        Of the model and of the test.
    left_out : sequence of int
        Test modes without a partner.
    """
    across = min(_ACROSS, max(len(pairs), 1))
    down = -(-len(pairs) // across)
    made = figure(2.7 * across, 2.6 * down + 0.5)
    scale = _REACH * np.linalg.norm(np.ptp(drawn.mesh.xyz, axis=0))
    for k, pair in enumerate(pairs):
        axes = made.add_subplot(down, across, k + 1, projection="3d")
        deformed = drawn.mesh.xyz + scale * drawn.shapes[k]
        _wires(axes, drawn.mesh, deformed, colours[0], 0.4)
        ends = drawn.sensors + scale * drawn.test[k][:, None] * drawn.axes
        model = drawn.sensors + scale * drawn.model[k][:, None] * drawn.axes
        axes.add_collection3d(_lines(np.stack([model, ends], axis=1), colours[1], 1.2))
        axes.scatter(*ends.T, s=8, color=colours[1], depthshade=False)
        _frame(axes, np.vstack([drawn.mesh.xyz, deformed, ends, model]))
        axes.set_title(
            f"test {pair.test}: {pair.test_hz:.4g} Hz\nanalysis {pair.analysis}: "
            f"{pair.analysis_hz:.4g} Hz, MAC {100 * pair.mac:.0f} %"
            f"{chr(10) * bool(pair.waves)}{pair.waves}",
            fontsize=8, color=INK, pad=0,
        )  # fmt: skip
    lost = f"\ntest modes without a partner: {', '.join(map(str, left_out))}" if left_out else ""
    made.suptitle(
        f"Model (mesh) and test (points, each joined to where the model puts its sensor){lost}",
        fontsize=11,
        color=INK,
    )
    return made


def misfit(drawn: Overlay, names: Sequence[str], ramp: Sequence[str]) -> Any:
    """Return where model and test differ as a figure: rms over the pairs at each sensor.

    Parameters
    ----------
    drawn : Overlay
    names : sequence of str
        Of the sensors, ``NODE:DIRECTION``.
    ramp : sequence of str
        Colours from nothing to the largest.
    """
    off = 100.0 * np.sqrt(np.mean((drawn.model - drawn.test) ** 2, axis=0))
    made = figure(7.6, 5.6)
    axes = made.add_subplot(projection="3d")
    _wires(axes, drawn.mesh, drawn.mesh.xyz, MESH, 0.5)
    colours = optional("matplotlib.colors", "plot").LinearSegmentedColormap.from_list("off", ramp)
    order = np.argsort(off)
    points = axes.scatter(
        *drawn.sensors[order].T, c=off[order], s=45, cmap=colours, vmin=0.0, edgecolors=INK,
        linewidths=0.5, depthshade=False,
    )  # fmt: skip
    for k in order[::-1][:_NAMED]:
        axes.text(*drawn.sensors[k], f"  {names[k]}", fontsize=8, color=INK)
    _frame(axes, drawn.mesh.xyz)
    bar = made.colorbar(points, ax=axes, shrink=0.7, pad=0.02)
    bar.set_label("rms difference over the pairs, % of each shape's largest", color=INK, fontsize=9)
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=8, colors=INK)
    axes.set_title(f"Where model and test differ, {len(drawn.test)} pairs", fontsize=11, color=INK)
    return made


def _wires(axes: Any, mesh: DrawnMesh, xyz: Floats, colour: str, width: float) -> None:
    edges = [mesh.lines, *(mesh.faces[:, [k, (k + 1) % 4]] for k in range(4))]
    ends = np.unique(np.sort(np.vstack(edges), axis=1), axis=0)
    axes.add_collection3d(_lines(xyz[ends[ends[:, 0] != ends[:, 1]]], colour, width))


def _lines(segments: Floats, colour: str, width: float) -> Any:
    lines = optional("mpl_toolkits.mplot3d.art3d", "plot").Line3DCollection
    return lines(segments, colors=colour, linewidths=width)


def _frame(axes: Any, xyz: Floats) -> None:
    """Show the structure in true proportions, with nothing around it but three directions."""
    low, high = xyz.min(axis=0), xyz.max(axis=0)
    reach = np.maximum(high - low, 0.05 * np.linalg.norm(high - low))
    middle, half = (low + high) / 2.0, reach / 2.0
    limits = zip("xyz", middle - half, middle + half, strict=True)
    axes.set(**{f"{d}lim": (a, b) for d, a, b in limits})
    axes.set_box_aspect(tuple(reach), zoom=1.0)
    axes.set_axis_off()
    arm = 0.15 * reach.max()
    for k, name in enumerate("xyz"):
        tip = low.copy()
        tip[k] += arm
        axes.plot(*np.stack([low, tip], axis=1), color=FAINT, linewidth=1.0)
        axes.text(*(low + 1.35 * (tip - low)), name, fontsize=7, color=FAINT, ha="center")
