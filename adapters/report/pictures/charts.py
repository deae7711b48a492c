"""Line charts over the iterations and bars over the modes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..html.markup import centred, esc, key, short, svg, svg_text, tag
from ..tables.number_formats import general
from .axes import Plot, decades, spread, ticks
from .colour import STEPS

_NAMED = 10  # lines that are all named at their ends; more get a key above


@dataclass(frozen=True)
class Series:
    """A named line; None where there is no value. `brief` names it where there is little room."""

    name: str
    values: tuple[float | None, ...]
    brief: str = ""


def lines(
    title: str,
    x: Sequence[float],
    series: Sequence[Series],
    *,
    unit: str = "",
    reference: float | None = None,
    ordered: bool = False,
    log: bool = False,
    breaks: Sequence[tuple[float, str]] = (),
    width: int = 510,
    height: int = 270,
) -> str:
    """Return a figure of lines over `x`, each named at its end, values on hover.

    Parameters
    ----------
    title : str
    x : sequence of float
        Iteration numbers.
    series : sequence of Series
        Lines as long as `x`.
    unit : str
        Written after the values.
    reference : float, optional
        A value that the axis includes and that stands out (1 for factors, 0 for deviations).
    ordered : bool
        Colour by the order of the series (modes by frequency) instead of by name.
    log : bool
        Logarithmic values; all must be above zero.
    breaks : sequence of (x, label)
        Where something new begins, such as a stage: a thin upright line with its label.
    """
    drawn = [s for s in series if any(v is not None for v in s.values)]
    known = [v for s in drawn for v in s.values if v is not None]
    if len(x) < 2 or not known:
        return ""
    known += [] if reference is None else [reference]
    low, high = min(known), max(known)
    y_ticks = decades(low, high) if log else ticks(low, high if high > low else low + 1.0)
    room = min(150, 14 + 6.2 * max(len(s.name) for s in drawn)) if len(drawn) > 1 else 14
    plot = Plot(48, 8, width - 48 - room, height - 50, min(x), max(x), tuple(y_ticks), log)
    body = plot.frame(emphasised=reference) + _iterations(plot, x)
    for where, label in breaks:
        d = f"M{short(plot.x(where))} {plot.top}v{short(plot.height)}"
        body += tag("path", class_="break", d=d)
        body += svg_text(plot.x(where) + 4, plot.top + 9, label)
    colours = [_colour(k, len(drawn), ordered) for k in range(len(drawn))]
    for k, s in enumerate(drawn):
        body += _line(plot, x, s, k, colours[k], len(drawn), ordered)
    crowded = len(drawn) > _NAMED
    if len(drawn) > 1:
        body += _names(plot, drawn, colours, alone=crowded)
    body += tag("path", class_="cursor", d=f"M0 {plot.top}v{short(plot.height)}", hidden=True)
    told = f"{title}: {len(drawn)} lines over {len(x)} iterations."
    picture = svg(
        "lines",
        (width, height),
        told,
        body,
        tabindex="0",
        data_x=" ".join(general(v) for v in x),
        data_px=" ".join(short(plot.x(v)) for v in x),
        data_names="|".join(s.name for s in drawn),
        data_v="|".join(" ".join(_plain(v) for v in s.values) for s in drawn),
        data_unit=unit,
    )
    keys = ""
    if crowded:
        marks = zip(drawn, colours, strict=True)
        keys = "".join(key(s.brief or s.name, style=f"background:{c}") for s, c in marks)
    return _figure(title, unit, keys, picture)


def _figure(title: str, unit: str, keys: str, picture: str) -> str:
    heading = tag("figcaption", tag("b", esc(title)), f" {esc(unit)}" if unit else "", keys)
    return tag("figure", heading, picture)


def _names(plot: Plot, drawn: Sequence[Series], colours: Sequence[str], *, alone: bool) -> str:
    """Names at the ends of the lines; with `alone` only where no other line ends close by."""
    at = [plot.y(next(v for v in reversed(s.values) if v is not None)) for s in drawn]
    shown = list(range(len(drawn)))
    if alone:
        order = sorted(at)
        near = [min(abs(y - o) for o in [*order, 1e9] if o != y) for y in at]
        shown = [k for k in shown if near[k] >= 9.0 and order.count(at[k]) == 1]
    top, bottom = plot.top - 6, plot.top + plot.height + 6
    places = spread([at[k] for k in shown], 12.5, top, bottom)
    edge, body = plot.left + plot.width, ""
    for k, y in zip(shown, places, strict=True):
        d = f"M{short(edge + 2)} {short(at[k])}L{short(edge + 9)} {short(y)}"
        body += tag("path", class_="leader", d=d, style=f"stroke:{colours[k]}")
        name = drawn[k].name
        name = name if len(name) <= 22 else name[:21] + "…"
        body += svg_text(edge + 11, y + 3.5, name, class_="name", style=f"fill:{colours[k]}")
    return body


def _line(
    plot: Plot, x: Sequence[float], s: Series, k: int, colour: str, count: int, ordered: bool
) -> str:
    d, dots, pen = "", "", "M"
    for at, v in zip(x, s.values, strict=False):
        if v is None:
            pen = "M"
            continue
        here = short(plot.x(at)), short(plot.y(v))
        d += pen + " ".join(here)
        dots += tag("circle", cx=here[0], cy=here[1], r=2.3)
        pen = "L"
    dashes = None if ordered or k < 8 else ("5 3", "2 2", "8 3 2 3")[(k // 8 - 1) % 3]
    dot = tag("g", dots, fill=colour, stroke="none") if dots and count <= 12 else ""
    line = tag("path", d=d, stroke=colour, stroke_dasharray=dashes)
    return tag("g", line, dot, class_="series", data_k=k)


def _iterations(plot: Plot, x: Sequence[float]) -> str:
    every = max(1, round(len(x) / 12))
    y = plot.top + plot.height + 17
    marks = "".join(centred(plot.x(v), y, general(v)) for v in x[::every])
    return marks + centred(plot.left + plot.width / 2, y + 17, "iteration", "axis")


def _colour(k: int, count: int, ordered: bool) -> str:
    if not ordered:
        return f"var(--s{k % 8})"
    return f"var(--c{round(6 + (STEPS - 7) * (k / (count - 1) if count > 1 else 1.0))})"


def _plain(value: float | None) -> str:
    return "" if value is None else f"{value:.5g}"


def bars(
    title: str,
    labels: Sequence[tuple[str, str]],
    states: Mapping[str, Sequence[float | None]],
    *,
    unit: str,
    limits: tuple[float, float] | None = None,
    mark: float | None = None,
    width: int = 1056,
    height: int = 240,
) -> str:
    """Return a figure of bars over the modes, one bar a state (``before``, ``after``).

    Parameters
    ----------
    title : str
    labels : sequence of (mode, frequency)
        One a position.
    states : mapping of str to sequence
        Values by state; None where the mode has no partner, drawn as an open mark.
    unit : str
    limits : (low, high), optional
        The axis; default: what the values need, zero included.
    mark : float, optional
        A value ruled across, such as the MAC that a pair needs.
    """
    known = [v for values in states.values() for v in values if v is not None]
    if not known:
        return ""
    low, high = limits or (min(0.0, *known), max(0.0, *known))
    y_ticks = ticks(low, high if high > low else low + 1.0, 5)
    plot = Plot(44, 6, width - 52, height - 64, 0.0, float(len(labels)), tuple(y_ticks))
    body = plot.frame(emphasised=0.0)
    if mark is not None:
        body += tag("path", class_="mark", d=f"M{plot.left} {short(plot.y(mark))}h{plot.width}")
    wide = min(0.78 / len(states), 26 * len(labels) / plot.width)
    for k, (name, frequency) in enumerate(labels):
        group, told = "", []
        for j, (state, values) in enumerate(states.items()):
            v = values[k]
            centre = plot.x(k + 0.5 + (j - (len(states) - 1) / 2) * wide)
            group += _bar(plot, centre, wide * plot.width / len(labels), v, _role(state, states))
            said = "no partner" if v is None else f"{general(v, 3)} {unit}"
            told.append(f"{state}: {said}" if state else said)
        where = f"test mode {name}" + (f", {frequency} Hz" if frequency else "")
        x = plot.x(k)
        area = tag("rect", class_="hit", x=short(x), y=plot.top, height=short(plot.height),
                   width=short(plot.width / len(labels)))  # fmt: skip
        note = tag("title", esc(f"{where}\n" + "\n".join(told)))
        body += tag("g", note, area, group, class_="hot")
        middle, bottom = plot.x(k + 0.5), plot.top + plot.height
        body += centred(middle, bottom + 15, name, "n")
        if frequency and len(labels) <= 30:
            body += centred(middle, bottom + 28, frequency)
    body += centred(plot.left + plot.width / 2, height - 4, "test mode, Hz", "axis")
    keys = "".join(key(s, _role(s, states)) for s in states) if len(states) > 1 else ""
    if any(v is None for values in states.values() for v in values):
        keys += key("no partner", "none")
    picture = svg("bars", (width, height), f"{title}, {len(labels)} test modes.", body)
    return _figure(title, unit, keys, picture)


def _role(state: str, states: Mapping[str, Sequence[float | None]]) -> str:
    return "now" if state == list(states)[-1] else "then"


def _bar(plot: Plot, x: float, wide: float, value: float | None, role: str) -> str:
    if value is None:
        return tag("circle", class_="none", cx=short(x), cy=short(plot.y(0.0) - 4), r=2.2)
    top, bottom = sorted((plot.y(value), plot.y(0.0)))
    return tag("rect", class_=role, x=short(x - wide / 2 + 0.5), y=short(top),
               width=short(max(wide - 1, 1)), height=short(max(bottom - top, 0.8)))  # fmt: skip
