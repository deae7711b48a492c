"""Frequency deviations and MAC by test mode."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...core.results.correlation import Compared
from .figure import FAINT, INK, figure, quiet


def frequencies(states: Sequence[tuple[str, Compared]], colours: Sequence[str]) -> Any:
    """Return the frequency deviation of each test mode and its MAC as a figure of two panels.

    Parameters
    ----------
    states : sequence of (str, Compared)
        ``before`` and ``after``, or one with an empty name.
    colours : sequence of str
        One a state.
    """
    last = states[-1][1]
    modes = sorted({p.test for _, c in states for p in c.pairs} | set(last.unpaired_test))
    made = figure(min(max(4.5, 1.5 + 0.42 * len(modes)), 14.0), 4.6)
    upper, lower = made.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    width = 0.8 / len(states)
    for k, (state, found) in enumerate(states):
        pairs = {p.test: p for p in found.pairs}
        at = np.arange(len(modes)) + width * (k - (len(states) - 1) / 2)
        here = [n in pairs for n in modes]
        for axes, value in (
            (upper, [p.deviation_percent for n in modes if (p := pairs.get(n))]),
            (lower, [100.0 * p.mac for n in modes if (p := pairs.get(n))]),
        ):
            axes.bar(at[here], value, 0.92 * width, color=colours[k], label=state or None)
        if k == len(states) - 1:
            for x in np.flatnonzero(~np.array(here, bool)):
                lower.text(x, 3.0, "no partner", rotation=90, ha="center", color=FAINT, fontsize=6)
    upper.axhline(0.0, color=INK, linewidth=0.8)
    upper.set_ylabel("100·(analysis − test)/test, %", color=INK, fontsize=9)
    lower.axhline(100.0 * last.criteria.mac_min, color=FAINT, linewidth=0.8, linestyle="--")
    lower.set_ylabel("MAC, %", color=INK, fontsize=9)
    lower.set_ylim(0.0, 100.0)
    waves = {n: "\n" + w.partition(",")[0] for n, w in last.waves[0].items()}
    named = [f"{n}\n{last.test_hz[n - 1]:.4g}{waves.get(n, '')}" for n in modes]
    lower.set_xticks(range(len(modes)), named)
    lower.set_xlabel("test mode, Hz", color=INK, fontsize=9)
    upper.set_title("Frequencies and shapes of each test mode", color=INK, fontsize=11)
    for axes in (upper, lower):
        quiet(axes)
    lower.tick_params(axis="x", labelsize=7)
    if len(states) > 1:
        upper.legend(frameon=False, fontsize=8, ncols=len(states), loc="best")
    return made
