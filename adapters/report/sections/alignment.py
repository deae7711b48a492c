"""Where the test sits on the model."""

import numpy as np

from ....core.results.correlation import RunTables
from ....core.results.discovery import DiscoverTables
from ..html.markup import esc, tag
from ..pictures.scene import scene
from ..tables.number_formats import fixed, general, placed
from . import marks_on_structure
from .section import ReportedRun, Section


def _render(run: ReportedRun[RunTables]) -> str:
    answer, geometry = run.tables, run.geometry
    found = answer.final.alignment
    unit = f" {found.length_unit or 'deck units'}"
    nodes = {s.node for s in found.sensors}
    turned = np.degrees(np.arccos(np.clip((np.trace(found.rotation) - 1.0) / 2.0, -1.0, 1.0)))
    facts = (
        ("sensors", f"{len(found.sensors)} at {len(nodes)} nodes"),
        ("farthest from the model",
         f"{general(max((s.distance for s in found.sensors), default=None), 3)}{unit}"),
        ("rms distance", f"{general(found.rms, 3)}{unit}"),
        ("scale, test to deck", general(found.scale, 6)),
        ("translation", placed(found.translation, found.length_unit)),
        ("rotation", f"{fixed(float(turned), 2)}°"),
    )  # fmt: skip
    strip = "".join(tag("div", tag("dt", esc(k)), tag("dd", esc(v))) for k, v in facts)
    body = tag("dl", strip, class_="figures facts")
    if geometry is None or (isinstance(answer, DiscoverTables) and answer.findings):
        return body
    marks = marks_on_structure.sensors(found.sensors, geometry)
    picture = scene(geometry, "Sensors on the model", marks=marks) if marks else ""
    return picture + body


ALIGNMENT = Section("Alignment and sensors", "alignment", RunTables, render=_render)
