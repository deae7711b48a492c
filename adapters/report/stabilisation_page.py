"""The page of an identification: stabilisation chart, modes, their shapes, the functions."""

from collections.abc import Sequence

import numpy as np

from ...core.data.geometry import Geometry
from ...core.identification.result import Identification
from ...core.results.made import MadeTables
from .html.html_table import html_table
from .html.markup import esc, key, tag
from .imprint import Imprint
from .page import sections, sheet, titled
from .pictures.film import one_side
from .pictures.function_overlay import function_overlay, identified_curves
from .pictures.moving_figure import moving_figure
from .pictures.sensor_shapes import sensor_shapes
from .pictures.stabilisation_chart import stabilisation_chart
from .tables.number_formats import counted, fixed, general, hz, percent
from .tables.table import Cell, Table, left

_POOR = 0.9  # quality and assurance below which a figure is coloured
_WORST = 24  # functions of least assurance that are listed


def stabilisation_page(
    found: Identification,
    title: str = "",
    warnings: Sequence[str] | None = None,
    geometry: Geometry | None = None,
    made: MadeTables | None = None,
    imprint: Imprint | None = None,
) -> str:
    """Return what an identification found as one HTML page that needs nothing else.

    Parameters
    ----------
    found : Identification
    title : str
        What was identified, such as the file's name.
    warnings : sequence of str, optional
        Default: those of `found`.
    geometry : Geometry, optional
        Of the test, on which its shapes move.
    made : MadeTables, optional
        The answer of the verb, which the foot of the page tells of.
    imprint : Imprint, optional
        Whose page it is.
    """
    n = len(found.modes)
    said = found.warnings if warnings is None else warnings
    f = found.cmif.frequencies_hz
    heading = (
        f"{counted(n, 'mode') if n else 'No mode'} between {general(float(f[0]))} and "
        f"{general(float(f[-1]))} Hz from {counted(len(found.modes.dofs), 'response')} and "
        f"{counted(len(found.references), 'reference')}"
    )
    drivers = n and found.driving_points
    shown = (
        ("Modes", html_table(modes_table(found)) if n else ""),
        ("Shapes", _shapes(found, geometry)),
        ("Functions", function_overlay(identified_curves(found)) + _assurance(found)),
        ("Rejected", html_table(rejected_table(found)) if found.rejected else ""),
        ("Driving points and reciprocity", html_table(driving_table(found)) if drivers else ""),
    )
    return sheet(
        made or _Unmade(),
        ("identification", title),
        titled("Identification", title, heading, said),
        stabilisation_chart(found),
        sections(*shown),
        imprint=imprint,
        scripts=["viewer.js", "functions.js"],
    )


class _Unmade(MadeTables):
    """An identification of which no more is known."""

    verb = "identify"


def _shapes(found: Identification, geometry: Geometry | None) -> str:
    moving = sensor_shapes(geometry, found.real_modes)
    if moving is None:
        return ""
    each = list(zip(found.modes.frequencies_hz, found.modes.damping, found.mpc, strict=True))
    labels = [
        f"mode {k} at {hz(f)} Hz, damping {fixed(100.0 * z, 2)} %, MPC {percent(mpc, 1)} %"
        for k, (f, z, mpc) in enumerate(each, 1)
    ]
    brief = [f"{k} · {hz(f)}" for k, (f, _, _) in enumerate(each, 1)]
    keys = key("where a sensor rests", "model") + key("where it moves to", "measured")
    note = "A place moves in the directions that were measured there and in no other."
    if not geometry or not geometry.elements:
        note += " The file holds no lines: neighbours are joined for the eye."
    legend = tag("p", keys, class_="note") + tag("p", note, class_="note")
    return moving_figure(one_side(moving), labels, brief) + legend


def _assurance(found: Identification) -> str:
    """Return the functions of least assurance, each a button that shows it."""
    of, by = found.measured.responses.labels, found.measured.references.labels
    listed = sorted((v, o, i) for (o, i), v in np.ndenumerate(found.frac) if np.isfinite(v))
    items = ""
    for v, o, i in listed[:_WORST]:
        name = f"{of[o]} / {by[i]}"
        button = tag("button", esc(name), type="button", data_function=name)
        share = tag("span", f"{percent(float(v), 1)} %", class_="poor" if v < _POOR else None)
        items += tag("li", button, " ", share)
    values = [float(v) for v, _, _ in listed]
    said = (
        f"Frequency response assurance (FRAC): {percent(float(np.median(values)), 1)} % in the "
        f"median of {counted(len(listed), 'function')}, "
        f"{sum(v < _POOR for v in values)} below {percent(_POOR)} %. "
    )
    least = f"The {_WORST} of least assurance:" if len(listed) > _WORST else "Least first:"
    return tag("p", esc(said + least), class_="note") + tag("ol", items, class_="assured")


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
