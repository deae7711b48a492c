"""The moving overlay of analysis and test: data for the script, a still picture without it."""

import base64
from dataclasses import replace

import numpy as np

from ....core.arrays import Numbers
from ....core.results.correlation import PairRow, RunTables
from ..html.markup import esc, key, tag
from ..pictures.scene import still
from ..tables.number_formats import fixed, hz, percent
from .section import ReportedRun, Section

_AMPLITUDE = 0.07  # of the structure's size


def _render(run: ReportedRun[RunTables]) -> str:
    overlay = run.shapes
    if overlay is None:
        return ""
    mesh, labels = overlay.mesh, [_label(p) for p in overlay.pairs]
    moved = mesh.xyz + _AMPLITUDE * mesh.size * overlay.shapes[0]
    picture = still(
        replace(mesh, xyz=moved),
        f"Shape of {labels[0]}",
        0.6 * np.linalg.norm(overlay.shapes[0], axis=1),
    )
    middle = (mesh.xyz.min(axis=0) + mesh.xyz.max(axis=0)) / 2.0
    unit = max(mesh.size, 1e-300) / 2.0
    figure = tag(
        "figure",
        tag("div", picture, class_="stage"),
        class_="viewer",
        data_labels="|".join(labels),
        data_brief="|".join(f"{p.test} · {hz(p.test_hz)}" for p in overlay.pairs),
        data_amplitude=2.0 * _AMPLITUDE,
        data_xyz=_packed((mesh.xyz - middle) / unit, np.int16),
        data_shapes=_packed(overlay.shapes, np.int8),
        data_faces=_raw(mesh.faces, np.uint16),
        data_lines=_raw(mesh.lines, np.uint16),
        data_sensors=_packed((overlay.sensors - middle) / unit / 2.0, np.int16),
        data_axes=_packed(overlay.axes, np.int8),
        data_model=_packed(overlay.model / 2.0, np.int8),
        data_test=_packed(overlay.test / 2.0, np.int8),
    )
    keys = key("where the model puts a sensor", "model")
    keys += key("where the test puts it, to the same scale", "measured")
    return figure + tag("p", keys, class_="note")


def _label(pair: PairRow) -> str:
    return (
        f"test {pair.test} ({hz(pair.test_hz)} Hz) and analysis {pair.analysis} "
        f"({hz(pair.analysis_hz)} Hz), {fixed(pair.deviation_percent, 1)} %, "
        f"MAC {percent(pair.mac)} %"
    )


def _packed(values: Numbers, kind: type[np.int16] | type[np.int8]) -> str:
    """Values of -1..1 as whole numbers of full range, clipped."""
    full = np.iinfo(kind).max
    return _raw(np.clip(np.rint(values * full), -full, full), kind)


def _raw(values: Numbers, kind: type[np.generic]) -> str:
    order = np.dtype(kind).newbyteorder("<")
    return esc(base64.b64encode(np.ascontiguousarray(values, order).tobytes()).decode())


MOVING_SHAPES = Section("Shapes of the pairs", "shapes", RunTables, render=_render)
