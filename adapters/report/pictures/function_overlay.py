"""Measured functions and what the modes make of them: data for the script, the first without it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ....core.arrays import Bools, Floats, Ints, Numbers
from ....core.data.frfs import Frfs
from ....core.identification.result import Identification
from ..html.markup import centred, esc, key, short, svg, svg_text, tag
from ..tables.number_formats import counted, general, percent
from .axes import Plot, decades, ticks
from .moving_figure import raw

_BYTES = 320_000  # of all curves together
_LINES = (200, 800)  # of a function, at least and at most
_DECADES = 6.0  # of magnitude below the largest that are shown
_SIZE = (1056, 446)
_AMPLITUDE = (34.0, 230.0)  # top and height
_PHASE = (306.0, 98.0)


@dataclass(frozen=True, eq=False)
class Curves:
    """Measured functions and what stands over them.

    Parameters
    ----------
    measured : Frfs
    made : callable
        ``made(lines)``: the others at some lines, (n_response, n_reference, n_line).
    frac : (n_response, n_reference) float
        Assurance, NaN where nothing was measured.
    roots : (n,) complex
        rad/s, about which lines are drawn closest.
    marks : (n,) float
        Frequencies that are marked, Hz.
    said : str
        What the others are made of.
    """

    measured: Frfs
    made: Callable[[Ints], Numbers]
    frac: Floats
    roots: Numbers
    marks: Floats
    said: str = "made of the modes"


def identified_curves(found: Identification) -> Curves:
    """Return the functions of an identification and what its modes make of them."""
    f = found.measured.frequencies_hz
    roots = np.concatenate([found.poles, *(b.poles for b in found.bands)])
    marks = found.modes.frequencies_hz
    return Curves(
        found.measured, lambda lines: found.synthesised(f[lines]).values, found.frac, roots, marks
    )


def function_overlay(found: Curves) -> str:
    """Return a figure of magnitude and phase, of the function that its menu names."""
    rows, columns = np.nonzero(np.isfinite(found.frac))
    f = found.measured.frequencies_hz
    most = int(np.clip(_BYTES // (4 * max(len(rows), 1)), *_LINES))
    drawn = np.arange(min(len(rows), _BYTES // (4 * _LINES[0])))
    left_out = len(rows) - len(drawn)
    if left_out:
        drawn = np.sort(np.argsort(found.frac[rows, columns], kind="stable")[: len(drawn)])
    rows, columns = rows[drawn], columns[drawn]
    lines = _chosen(f, found, most)
    both = np.stack(
        [found.measured.values[rows, columns][:, lines],
         found.made(lines)[rows, columns]], axis=1
    )  # fmt: skip
    size = np.abs(both)
    high = float(np.log10(size.max()))
    low = max(float(np.log10(size[size > 0.0].min())), high - _DECADES)
    marks = decades(10.0**low, 10.0**high)
    low, high = np.log10(marks[0]), np.log10(marks[-1])
    with np.errstate(divide="ignore"):
        level = np.clip((np.log10(size) - low) / (high - low), 0.0, 1.0)
    codes = np.rint(255 * level).astype(np.uint8)
    turned = np.rint(127 * np.angle(both) / np.pi).astype(np.int8)
    amplitude = Plot(62.0, _AMPLITUDE[0], _SIZE[0] - 76.0, _AMPLITUDE[1], float(f[0]),
                     float(f[-1]), tuple(marks), log=True)  # fmt: skip
    phase = Plot(62.0, _PHASE[0], amplitude.width, _PHASE[1], float(f[0]), float(f[-1]),
                 (-180.0, -90.0, 0.0, 90.0, 180.0))  # fmt: skip
    x = [amplitude.x(float(v)) for v in f[lines]]
    gaps = np.flatnonzero(_gap(f)[lines[1:]]) + 1
    body = amplitude.frame() + phase.frame() + _modes(amplitude, phase, found)
    body += _axis(phase, found.measured.quantity)
    for k, kind in enumerate(("measured", "made")):
        y = amplitude.top + amplitude.height * (1.0 - codes[0, k] / 255.0)
        body += tag("path", class_=f"{kind} size", d=_path(x, y, gaps, np.inf))
        y = phase.top + phase.height * 0.5 * (1.0 - turned[0, k] / 127.0)
        body += tag("path", class_=f"{kind} angle", d=_path(x, y, gaps, 0.5 * phase.height))
    body += tag("path", class_="cursor", hidden=True,
                d=f"M0 {amplitude.top}V{short(phase.top + phase.height)}")  # fmt: skip
    responses, references = found.measured.responses.labels, found.measured.references.labels
    names = [f"{responses[o]} / {references[i]}" for o, i in zip(rows, columns, strict=True)]
    assured = [f"FRAC {percent(v, 1)} %" for v in found.frac[rows, columns]]
    options = "".join(
        tag("option", esc(f"{name} · {said}"), value=k)
        for k, (name, said) in enumerate(zip(names, assured, strict=True))
    )
    menu = tag("label", tag("b", "Function "), tag("select", options))
    keys = key("measured", "measured") + key(found.said, "made")
    picture = svg("functions", _SIZE, f"Magnitude and phase of {names[0]}, {assured[0]}.", body)
    note = _note(len(f), len(lines), left_out)
    return tag(
        "figure",
        tag("figcaption", menu, keys),
        picture,
        tag("p", note, class_="note"),
        class_="overlaid",
        data_size=raw(codes, np.uint8),
        data_angle=raw(turned, np.int8),
        data_x=" ".join(map(short, x)),
        data_f=" ".join(general(float(v), 6) for v in f[lines]),
        data_gaps=" ".join(map(str, gaps)),
        data_decades=f"{low:g} {high:g}",
        data_panels=f"{short(amplitude.top)} {short(amplitude.height)} "
        f"{short(phase.top)} {short(phase.height)}",
        data_names="|".join(names),
        data_made=found.said,
    )


def _note(of: int, shown: int, left_out: int) -> str:
    said = f"All {of} lines are drawn."
    if shown < of:
        said = (
            f"Drawn are {shown} of {of} lines, closest about the modes, magnitudes in 255 steps; "
            "the assurance counts all lines."
        )
    if left_out:
        said += f" {counted(left_out, 'function')} with the best assurance are left out here."
    return esc(said)


def _chosen(f: Floats, found: Curves, most: int) -> Ints:
    """Lines to draw, closer the nearer a root of the fit stands in its own half-power widths."""
    if len(f) <= most:
        return np.arange(len(f))
    roots = found.roots / (2.0 * np.pi)
    hz, half = np.abs(roots), np.maximum(-roots.real, np.median(np.diff(f)))
    near = (half / (np.abs(f[:, None] - hz) + half)).max(axis=1, initial=0.0)
    weight = np.cumsum(near + 0.06)
    even = np.searchsorted(weight, np.linspace(weight[0], weight[-1], most))
    at_modes = np.searchsorted(f, hz).clip(0, len(f) - 1)
    ends = np.flatnonzero(_gap(f))
    every = np.concatenate([even.clip(0, len(f) - 1), at_modes, ends, ends - 1])
    return np.asarray(np.unique(every), np.int64)


def _gap(f: Floats) -> Bools:
    """Tell the lines before which some are left out."""
    step = np.diff(f, prepend=f[0])
    return np.asarray(step > 4.0 * np.median(step))


def _path(x: list[float], y: Numbers, gaps: Ints, jump: float) -> str:
    cut = {0, *gaps.tolist(), *(np.flatnonzero(np.abs(np.diff(y)) > jump) + 1).tolist()}
    return "".join(
        f"{'M' if k in cut else 'L'}{short(a)} {short(float(b))}"
        for k, (a, b) in enumerate(zip(x, y, strict=True))
    )


def _modes(amplitude: Plot, phase: Plot, found: Curves) -> str:
    bottom = short(phase.top + phase.height)
    d = "".join(
        f"M{short(amplitude.x(float(v)))} {short(amplitude.top)}V{bottom}" for v in found.marks
    )
    return tag("path", class_="at", d=d) if d else ""


def _axis(phase: Plot, quantity: str) -> str:
    body, bottom = "", phase.top + phase.height
    for v in ticks(phase.x_low, phase.x_high, 10):
        if phase.x_low <= v <= phase.x_high:
            body += centred(phase.x(v), bottom + 17, general(v))
            body += tag("path", class_="base", d=f"M{short(phase.x(v))} {short(bottom)}v4")
    body += centred(phase.left + phase.width / 2, bottom + 36, "frequency, Hz", "axis")
    body += svg_text(0, _AMPLITUDE[0] - 14, f"{quantity} per force", class_="axis")
    body += svg_text(0, phase.top - 16, "phase, °", class_="axis")
    return tag("g", body, class_="rules")
