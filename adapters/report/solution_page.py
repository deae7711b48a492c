"""The page of a solution: modes, their shapes moving, and which elements have which property."""

from collections.abc import Mapping, Sequence
from pathlib import PurePath

import numpy as np

from ...core.data.geometry import Geometry
from ...core.data.modes import Modes
from ...core.results.modes import SolveTables
from .html.html_table import html_table
from .html.markup import tag
from .imprint import Imprint
from .page import Fact, sections, sheet, titled
from .pictures.film import one_side
from .pictures.moving_figure import moving_figure
from .pictures.scene import scene
from .pictures.shape_overlay import model_shapes
from .tables.number_formats import counted, general, hz, placed, weighed
from .tables.table import Cell, Table, left

_SHOWN = 40
"""Shapes that move on the page, at most, the lowest ones that deform."""
_NOTE = "Dark: what touches a grid of the elements that have the property."
_PARTS = 12
"""Properties that are shown on the structure."""


def solution_page(
    found: SolveTables,
    geometry: Geometry,
    shapes: Modes,
    parts: Mapping[str, Sequence[int]],
    imprint: Imprint | None = None,
) -> str:
    """Return normal modes as one HTML page that needs nothing else.

    Parameters
    ----------
    found : SolveTables
    geometry, shapes : Geometry, Modes
    parts : mapping of str to sequence of int
        Grids of the elements of each property, by what the page calls it.
    imprint : Imprint, optional
        Whose page it is.
    """
    n, rigid = len(found.modes), found.rigid_body_modes
    last = found.modes[-1].frequency_hz if n else 0.0
    heading = f"{counted(n, 'normal mode')} up to {hz(last)} Hz"
    heading += f", {rigid} of them of a rigid body" if rigid else ""
    name = PurePath(found.deck_file).name
    pictures = "".join(_part(geometry, what, grids) for what, grids in [*parts.items()][:_PARTS])
    more = len(parts) - _PARTS
    note = tag("p", _NOTE + f" {more} more are not shown." * (more > 0), class_="note")
    return sheet(
        found,
        ("solution", name),
        titled("Solution", name, heading, found.warnings, *_facts(found)),
        sections(
            ("Modes", html_table(modes_table(found))),
            ("Shapes", _moving(geometry, shapes, rigid)),
            ("Properties", tag("div", pictures, class_="maps") + note if pictures else ""),
        ),
        imprint=imprint,
        scripts=["viewer.js"],
    )


def _facts(found: SolveTables) -> list[Fact]:
    facts: list[Fact] = []
    if found.mass is not None:
        facts.append(("mass", weighed(found.mass, found.kilograms), ""))
    if found.centre_of_gravity is not None:
        facts.append(("centre of gravity", placed(found.centre_of_gravity, found.length_unit), ""))
    return [*facts, ("degrees of freedom", str(found.degrees_of_freedom), "")]


def modes_table(found: SolveTables) -> Table:
    """Return the modes; rigid-body ones are marked."""
    rows = []
    for k, mode in enumerate(found.modes):
        still = Cell("rigid body", "muted") if k < found.rigid_body_modes else ""
        shown = f"{mode.frequency_hz:.1e}" if still and mode.frequency_hz else hz(mode.frequency_hz)
        rows.append((str(k + 1), shown, general(mode.generalized_mass, 5), still))
    return Table.of("Normal modes", ("mode", "Hz", "generalised mass", *left("")), rows)


def _moving(geometry: Geometry, shapes: Modes, rigid: int) -> str:
    few = np.arange(rigid, len(shapes))[:_SHOWN]
    overlay = model_shapes(geometry, shapes.take(few)) if len(few) else None
    if overlay is None:
        return ""
    named = [(int(k) + 1, hz(float(shapes.frequencies_hz[k]))) for k in few]
    return moving_figure(
        one_side(overlay),
        [f"mode {k} at {f} Hz" for k, f in named],
        [f"{k} · {f}" for k, f in named],
    )


def _part(geometry: Geometry, what: str, grids: Sequence[int]) -> str:
    values = np.full(len(geometry.ids), np.nan)
    rows = geometry.index_of(np.asarray(grids, np.int64))
    values[rows[rows >= 0]] = 0.6
    return scene(geometry, what, values=values, width=400, height=340, most=900)
