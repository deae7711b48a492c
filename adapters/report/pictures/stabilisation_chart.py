"""The stabilisation chart of an identification, the mode indicator function behind it."""

from itertools import pairwise

import numpy as np

from ....core.arrays import Bools, Floats
from ....core.identification.result import Identification
from ..html.markup import centred, esc, key, short, svg, svg_text, tag
from ..tables.number_formats import counted, fixed, general, hz, percent
from .axes import Plot, decades, spread, ticks

_SIZE = (1056, 520)
_DECADES = 7.0  # of the indicator that are shown at most
_CURVES = 4  # indicator curves that are shown at most
_MARKS = (
    ("new", "new", "h0"),
    ("frequency", "stays in frequency", "m-2.8 2.2h5.6l-2.8 -4.9z"),
    ("damping", "and damping", "m-2.4 0a2.4 2.4 0 1 0 4.8 0a2.4 2.4 0 1 0 -4.8 0"),
    ("shape", "and participation", "h0"),
)  # class, legend and path of each level of `Chart`
_OF_ONE = (*_MARKS[:2], ("shape", "and damping", "h0"))
"""One reference takes part in all poles alike."""


def stabilisation_chart(found: Identification) -> str:
    """Return a figure of the poles over model order and frequency, modes and CMIF on it.

    A pole is marked by what of it stayed from the order before: nothing, frequency, damping,
    participation. An upright line is an identified mode, dashed where it is marked as poor; a
    cross at the top is what was rejected, its reason under the pointer. Behind are the singular
    values of the response matrix (largest first) on the right-hand axis, logarithmic or linear.
    """
    f = found.cmif.frequencies_hz
    top = int(found.chart.order.max()) if len(found.chart.order) else 1
    left, above = 52.0, 48.0
    width, height = _SIZE[0] - left - 58.0, _SIZE[1] - above - 46.0
    x_low, x_high = float(f[0]), float(f[-1])
    orders = Plot(left, above, width, height, x_low, x_high, tuple(ticks(0, top)))
    marks = _MARKS if len(found.references) > 1 else _OF_ONE
    level = np.minimum(found.chart.level, len(marks) - 1)
    body = _indicator(found, orders, log=True) + _indicator(found, orders, log=False)
    body += orders.frame() + _frequencies(orders) + _edges(orders, found)
    body += _modes(orders, found)
    for k, (name, _, path) in enumerate(marks):
        body += _poles(orders, found, level == k, name, path)
    body += _hits(orders, found) + _rejected(orders, found)
    middle = above + height / 2
    body += centred(14, middle, "model order", "axis", transform=f"rotate(-90 14 {short(middle)})")
    told = (
        f"Stabilisation chart: {counted(len(found.modes), 'mode')} among "
        f"{counted(len(found.chart.order), 'pole')} up to order {top}."
    )
    keys = "".join(key(said, f"pole {name}") for name, said, _ in marks)
    keys += key("identified", "found") + key("with a remark", "found poor")
    keys += key("rejected", "cross") * bool(found.rejected) + key("mode indicator", "line")
    linear = tag("label", tag("input", type="checkbox", class_="linear"), " linear")
    caption = tag("figcaption", tag("b", "Stabilisation"), " pole: ", keys, linear)
    return tag("figure", caption, svg("stab", _SIZE, told, body))


def _frequencies(plot: Plot) -> str:
    body, bottom = "", plot.top + plot.height
    for v in ticks(plot.x_low, plot.x_high, 10):
        if plot.x_low <= v <= plot.x_high:
            body += centred(plot.x(v), bottom + 17, general(v))
            body += tag("path", class_="base", d=f"M{short(plot.x(v))} {short(bottom)}v4")
    body += centred(plot.left + plot.width / 2, bottom + 36, "frequency, Hz", "axis")
    return tag("g", body, class_="rules")


def _edges(plot: Plot, found: Identification) -> str:
    """Draw where one band ends and the next begins, and what between them takes no part."""
    body, bands = "", [b.band for b in found.bands]
    for below, above in pairwise(bands):
        x, end = plot.x(below.high), plot.x(above.low)
        if end - x > 1.0:
            body += tag("rect", class_="out", x=short(x), y=short(plot.top), width=short(end - x),
                        height=short(plot.height))  # fmt: skip
        body += tag("path", class_="edge", d=f"M{short(x)} {plot.top}v{plot.height}")
    return body


def _indicator(found: Identification, orders: Plot, *, log: bool) -> str:
    f, values = found.cmif.frequencies_hz, found.cmif.values[:, :_CURVES]
    known = values[np.isfinite(values) & (values > 0.0)]
    if not len(known):
        return ""
    high = float(known.max())
    low = max(float(known.min()), high * 10.0**-_DECADES)
    marks = decades(low, high) if log else ticks(0.0, high)
    plot = Plot(orders.left, orders.top, orders.width, orders.height, orders.x_low, orders.x_high,
                tuple(marks), log=log)  # fmt: skip
    edge = plot.left + plot.width
    body = "".join(svg_text(edge + 7, plot.y(v) + 3.5, general(v)) for v in marks)
    body += svg_text(edge + 50, plot.top - 12, "CMIF", class_="axis", text_anchor="end")
    floor = short(plot.top + plot.height)
    for k, column in enumerate(values.T):
        x, y = _thinned(f, np.maximum(np.nan_to_num(column), marks[0]), int(plot.width))
        points = [(short(plot.x(a)), short(plot.y(b))) for a, b in zip(x, y, strict=True)]
        line = "L".join(" ".join(p) for p in points)
        if not k:
            area = f"M{points[0][0]} {floor}L{line}L{points[-1][0]} {floor}z"
            body += tag("path", class_="under", d=area)
        body += tag("path", class_="curve rest" if k else "curve", d=f"M{line}")
    return tag("g", body, class_="log" if log else "linear")


def _thinned(x: Floats, y: Floats, pixels: int) -> tuple[list[float], list[float]]:
    """Keep the lowest and the highest value of every pixel, in order."""
    if len(x) <= 2 * pixels:
        return x.tolist(), y.tolist()
    column = np.minimum(((x - x[0]) / (x[-1] - x[0]) * pixels).astype(int), pixels - 1)
    by_value = np.lexsort((y, column))
    ends = np.flatnonzero(np.diff(column[by_value])) + 1
    first, last = np.append(0, ends), np.append(ends, len(x)) - 1
    kept = np.unique(np.concatenate([by_value[first], by_value[last]]))
    return x[kept].tolist(), y[kept].tolist()


def _poles(plot: Plot, found: Identification, chosen: Bools, name: str, path: str) -> str:
    c = found.chart
    chosen = chosen & (c.frequency_hz >= plot.x_low) & (c.frequency_hz <= plot.x_high)
    d = "".join(
        f"M{short(plot.x(a))} {short(plot.y(b))}{path}"
        for a, b in zip(c.frequency_hz[chosen].tolist(), c.order[chosen].tolist(), strict=True)
    )
    return tag("path", class_=f"pole {name}", d=d) if d else ""


def _modes(plot: Plot, found: Identification) -> str:
    """Draw an upright line and a number for each mode."""
    frequencies = found.modes.frequencies_hz
    at = [plot.x(float(v)) for v in frequencies]
    gap = min(17.0, plot.width / max(len(at), 1))
    labels = spread(at, gap, plot.left, plot.left + plot.width)
    body, height = "", short(plot.height)
    for k, (x, label) in enumerate(zip(at, labels, strict=True)):
        top = short(plot.top)
        d = f"M{short(label)} {short(plot.top - 23)}L{short(x)} {short(plot.top - 14)}L"
        d += f"{short(x)} {top}v{height}"
        kind = "mode poor" if found.remarks[k] else "mode"
        name = centred(label, plot.top - 27, k + 1, "n")
        body += tag("g", tag("path", d=d), name, class_=kind)
    return body


def _hits(plot: Plot, found: Identification) -> str:
    """Return what is told of a mode where the pointer is on its line."""
    body = ""
    for k, f in enumerate(found.modes.frequencies_hz):
        told = (
            f"mode {k + 1}: {hz(f)} ± {general(found.frequency_std[k], 2)} Hz\n"
            f"damping {fixed(100.0 * found.modes.damping[k], 3)} ± "
            f"{general(100.0 * found.damping_std[k], 2)} %\n"
            f"MPC {percent(found.mpc[k], 1)} %, quality {fixed(found.quality[k], 4)}"
        )
        told += f"\n{found.remarks[k]}" if found.remarks[k] else ""
        hit = tag("rect", x=short(plot.x(float(f)) - 3), y=short(plot.top), width=6,
                  height=short(plot.height))  # fmt: skip
        body += tag("g", tag("title", esc(told)), hit, class_="hot hit")
    return body


def _rejected(plot: Plot, found: Identification) -> str:
    """Draw a cross above the plot for each root rejected, its reason under the pointer."""
    body, y = "", plot.top - 7
    for r in found.rejected:
        if not plot.x_low <= r.frequency_hz <= plot.x_high:
            continue
        x = plot.x(r.frequency_hz)
        told = f"rejected: {hz(r.frequency_hz)} Hz, damping {fixed(100.0 * r.damping_ratio, 3)} %"
        cross = tag("path", d=f"M{short(x - 3)} {y - 3}l6 6m0 -6l-6 6")
        hit = tag("rect", x=short(x - 4), y=y - 6, width=8, height=12)
        body += tag("g", tag("title", esc(f"{told}\n{r.reason}")), hit, cross, class_="hot reject")
    return body
