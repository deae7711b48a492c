"""The stabilisation chart of an identification, the mode indicator function behind it."""

from collections.abc import Sequence

import numpy as np

from ...core.arrays import Bools, Floats, Ints
from ...core.identification import Identification
from .html.html_table import html_table
from .html.markup import centred, esc, key, short, svg, svg_text, tag
from .page import html_page, warned
from .pictures.axes import Plot, decades, spread, ticks
from .tables.number_formats import counted, fixed, general, hz, percent
from .tables.table import Cell, Table, left

_WIDTH, _HEIGHT = 1056, 500
_DECADES = 7.0  # of the indicator that are shown at most
_CURVES = 4  # indicator curves that are shown at most
_POOR = 0.9  # quality below which a figure is coloured


def stabilisation_page(
    found: Identification, title: str = "", warnings: Sequence[str] | None = None
) -> str:
    """Return the stabilisation chart and the modes as one HTML page that needs nothing else.

    Parameters
    ----------
    found : Identification
    title : str
        What was identified, such as the file's name.
    warnings : sequence of str, optional
        Default: those of `found`.
    """
    n = len(found.modes)
    said = found.warnings if warnings is None else warnings
    f = found.cmif.frequencies_hz
    heading = (
        f"{counted(n, 'mode') if n else 'No mode'} between {general(float(f[0]))} and "
        f"{general(float(f[-1]))} Hz from {counted(len(found.modes.dofs), 'response')} and "
        f"{counted(len(found.references), 'reference')}"
    )
    body = tag(
        "main",
        tag("p", esc(" · ".join(t for t in ("Identification", title) if t)), class_="kicker"),
        tag("h1", esc(heading)),
        warned(said),
        stabilisation_chart(found),
        html_table(modes_table(found)) if n else "",
        html_table(rejected_table(found)) if found.rejected else "",
        html_table(driving_table(found)) if n and found.driving_points else "",
        tag("footer", "trueup · trueup/identify/1"),
    )
    return html_page(title or "identification", body)


def stabilisation_chart(found: Identification) -> str:
    """Return a figure of the poles over model order and frequency, modes and CMIF on it.

    Poles that continue one of the next lower orders are large dots, others small; an upright
    line is an identified mode, dashed where it is marked as poor; grey curves are the singular
    values of the response matrix (largest first), logarithmic, on the right-hand axis.
    """
    f = found.cmif.frequencies_hz
    top = int(found.chart.order.max()) if len(found.chart.order) else 1
    left, above = 52.0, 34.0
    width, height = _WIDTH - left - 58.0, _HEIGHT - above - 46.0
    x_low, x_high = float(f[0]), float(f[-1])
    orders = Plot(left, above, width, height, x_low, x_high, tuple(ticks(0, top)))
    body = orders.frame() + _frequencies(orders) + _edges(orders, found)
    body += _indicator(found, orders)
    c = found.chart
    inside = (c.frequency_hz >= x_low) & (c.frequency_hz <= x_high)
    for name, chosen in (("loose", ~c.stable), ("stable", c.stable)):
        body += _dots(orders, c.frequency_hz, c.order, np.asarray(chosen & inside), name)
    body += _modes(orders, found)
    middle = above + height / 2
    turned = f"rotate(-90 14 {short(middle)})"
    body += centred(14, middle, "model order", "axis", transform=turned)
    told = (
        f"Stabilisation chart: {counted(len(found.modes), 'mode')} among "
        f"{counted(len(c.order), 'pole')} up to order {top}."
    )
    keys = key("stable pole", "stable") + key("other pole", "loose")
    keys += key("mode indicator (CMIF)", "line") + key("identified mode", "found")
    caption = tag("figcaption", tag("b", "Stabilisation"), keys)
    return tag("figure", caption, svg("stab", (_WIDTH, _HEIGHT), told, body))


def modes_table(found: Identification) -> Table:
    """Return the identified modes with their uncertainty and quality."""
    named = ("mode", "Hz", "± Hz", "damping %", "± %", "MPC %", "MPD °", "indicator", "quality",
             "modal mass")  # fmt: skip
    rows = []
    for k in range(len(found.modes)):
        notes = [found.remarks[k]] if found.remarks[k] else []
        notes += ["moves as a rigid body (suspension)"] if found.suspension[k] else []
        notes += ["a close pair may hide here"] if found.close_pair_possible[k] else []
        quality = float(found.quality[k])
        rows.append(
            (
                str(k + 1),
                hz(found.modes.frequencies_hz[k]),
                general(found.frequency_std[k], 2),
                fixed(100.0 * found.modes.damping[k], 3),
                general(100.0 * found.damping_std[k], 2),
                percent(found.mpc[k], 1),
                fixed(found.mpd[k], 1),
                fixed(found.mode_indicator[k], 3),
                Cell(fixed(quality, 4), "poor" if quality < _POOR else ""),
                general(found.real_modes.generalized_mass[k], 4),
                Cell("; ".join(notes), "poor" if found.remarks[k] else "muted"),
            )
        )
    note = (
        "± is one standard error. Quality is the squared correlation of measured and synthesised "
        "functions around the mode; the modal mass belongs to the real shape whose largest "
        "component is 1, and is known where a driving point was measured."
    )
    return Table.of("Identified modes", (*named, *left("remark")), rows, note)


def rejected_table(found: Identification) -> Table:
    """Return what was considered and is not among the modes."""
    rows = (
        (hz(r.frequency_hz), fixed(100.0 * r.damping_ratio, 3), r.reason) for r in found.rejected
    )
    return Table.of("Considered and rejected", ("Hz", "damping %", *left("reason")), rows)


def driving_table(found: Identification) -> Table:
    """Return how far driving points and reciprocity hold."""
    rows = [
        (d.function, percent(d.positive_share, 1), fixed(d.phase_deg, 1), "")
        for d in found.driving_points
    ]
    rows += [
        (f"{r.function}, {r.reciprocal}", "", "", percent(r.correlation, 1))
        for r in found.reciprocity
    ]
    note = (
        "Driving points take power (less what they give back, over both: 100 %), their residues "
        "have the phase of a normal mode (0°); functions between two are alike (100 %)."
    )
    named = ("power %", "phase °", "reciprocity %")
    return Table.of(
        "Driving points and reciprocity", (*left("response/reference"), *named), rows, note
    )


def _frequencies(plot: Plot) -> str:
    body, bottom = "", plot.top + plot.height
    for v in ticks(plot.x_low, plot.x_high, 10):
        if plot.x_low <= v <= plot.x_high:
            body += centred(plot.x(v), bottom + 17, general(v))
            body += tag("path", class_="base", d=f"M{short(plot.x(v))} {short(bottom)}v4")
    body += centred(plot.left + plot.width / 2, bottom + 36, "frequency, Hz", "axis")
    return tag("g", body, class_="rules")


def _edges(plot: Plot, found: Identification) -> str:
    """Draw where one band ends and the next begins."""
    return "".join(
        tag("path", class_="edge", d=f"M{short(plot.x(b.band.high))} {plot.top}v{plot.height}")
        for b in found.bands[:-1]
        if plot.x_low < b.band.high < plot.x_high
    )


def _indicator(found: Identification, orders: Plot) -> str:
    f, values = found.cmif.frequencies_hz, found.cmif.values[:, :_CURVES]
    known = values[np.isfinite(values) & (values > 0.0)]
    if not len(known):
        return ""
    high = float(known.max())
    low = max(float(known.min()), high * 10.0**-_DECADES)
    marks = decades(low, high)
    plot = Plot(orders.left, orders.top, orders.width, orders.height, orders.x_low, orders.x_high,
                tuple(marks), log=True)  # fmt: skip
    edge = plot.left + plot.width
    body = "".join(svg_text(edge + 7, plot.y(v) + 3.5, general(v)) for v in marks)
    body += svg_text(edge + 50, plot.top - 8, "CMIF", class_="axis", text_anchor="end")
    for k, column in enumerate(values.T):
        x, y = _thinned(f, np.maximum(np.nan_to_num(column), marks[0]), int(plot.width))
        points = (f"{short(plot.x(a))} {short(plot.y(b))}" for a, b in zip(x, y, strict=True))
        body += tag("path", class_="curve rest" if k else "curve", d="M" + "L".join(points))
    return tag("g", body)


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


def _dots(plot: Plot, frequency: Floats, order: Ints, chosen: Bools, name: str) -> str:
    d = "".join(
        f"M{short(plot.x(a))} {short(plot.y(b))}h0"
        for a, b in zip(frequency[chosen].tolist(), order[chosen].tolist(), strict=True)
    )
    return tag("path", class_=f"dots {name}", d=d) if d else ""


def _modes(plot: Plot, found: Identification) -> str:
    frequencies = found.modes.frequencies_hz
    at = [plot.x(float(v)) for v in frequencies]
    gap = min(17.0, plot.width / max(len(at), 1))
    labels = spread(at, gap, plot.left, plot.left + plot.width)
    body = ""
    for k, (x, label) in enumerate(zip(at, labels, strict=True)):
        told = (
            f"mode {k + 1}: {hz(frequencies[k])} ± {general(found.frequency_std[k], 2)} Hz\n"
            f"damping {fixed(100.0 * found.modes.damping[k], 3)} ± "
            f"{general(100.0 * found.damping_std[k], 2)} %\n"
            f"MPC {percent(found.mpc[k], 1)} %, quality {fixed(found.quality[k], 4)}"
        )
        told += f"\n{found.remarks[k]}" if found.remarks[k] else ""
        top = short(plot.top)
        d = f"M{short(label)} {short(plot.top - 9)}L{short(x)} {top}v{short(plot.height)}"
        hit = tag("rect", class_="hit", x=short(x - 3), y=top, width=6, height=short(plot.height))
        name = centred(label, plot.top - 13, k + 1, "n")
        kind = "mode poor" if found.remarks[k] else "mode"
        body += tag("g", tag("title", esc(told)), hit, tag("path", d=d), name, class_=kind)
    return body
