"""A figure of shapes that move: data for the script, a still picture without it."""

import base64
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ....core.arrays import Numbers
from ....core.results.paired_shapes import Overlay
from ..html.markup import esc, tag
from .scene import still

_AMPLITUDE = 0.07  # of the structure's size


def moving_figure(overlay: Overlay, labels: Sequence[str], brief: Sequence[str]) -> str:
    """Return the figure that `viewer.js` moves; `labels` and `brief` name its shapes."""
    mesh = overlay.mesh
    moved = mesh.xyz + _AMPLITUDE * mesh.size * overlay.shapes[0]
    picture = still(
        replace(mesh, xyz=moved),
        f"Shape of {labels[0]}",
        0.6 * np.linalg.norm(overlay.shapes[0], axis=1),
    )
    middle = (mesh.xyz.min(axis=0) + mesh.xyz.max(axis=0)) / 2.0
    unit = max(mesh.size, 1e-300) / 2.0
    return tag(
        "figure",
        tag("div", picture, class_="stage"),
        class_="viewer",
        data_labels="|".join(labels),
        data_brief="|".join(brief),
        data_amplitude=2.0 * _AMPLITUDE,
        data_xyz=_packed((mesh.xyz - middle) / unit, np.int16),
        data_shapes=_packed(overlay.shapes, np.int8),
        data_faces=raw(mesh.faces, np.uint16),
        data_lines=raw(mesh.lines, np.uint16),
        data_sensors=_packed((overlay.sensors - middle) / unit / 2.0, np.int16),
        data_axes=_packed(overlay.axes, np.int8),
        data_model=_packed(overlay.model / 2.0, np.int8),
        data_test=_packed(overlay.test / 2.0, np.int8),
    )


def _packed(values: Numbers, kind: type[np.int16] | type[np.int8]) -> str:
    """Values of -1..1 as whole numbers of full range, clipped."""
    full = np.iinfo(kind).max
    return raw(np.clip(np.rint(values * full), -full, full), kind)


def raw(values: Numbers, kind: type[np.generic]) -> str:
    """Return numbers as base64 of little-endian ones of a kind."""
    order = np.dtype(kind).newbyteorder("<")
    return esc(base64.b64encode(np.ascontiguousarray(values, order).tobytes()).decode())
