"""A figure of shapes that move: data for the script, a still picture without it."""

import base64
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ....core.arrays import Numbers
from ..html.markup import esc, tag
from .film import Film
from .scene import still

_AMPLITUDE = 0.07  # of the structure's size


def moving_figure(film: Film, labels: Sequence[str], brief: Sequence[str]) -> str:
    """Return the figure that `viewer.js` moves; `labels` and `brief` name its frames.

    After the frames come those before turning, which have a label, too.
    """
    mesh, first = film.mesh, film.frames[0]
    moved = mesh.xyz + _AMPLITUDE * mesh.size * first.shape
    picture = still(
        replace(mesh, xyz=moved),
        f"Shape of {labels[0]}",
        0.6 * np.linalg.norm(first.shape, axis=1),
    )
    middle = (mesh.xyz.min(axis=0) + mesh.xyz.max(axis=0)) / 2.0
    unit = max(mesh.size, 1e-300) / 2.0
    turned = [k for k, f in enumerate(film.frames) if f.before is not None]
    before = {k: len(film.frames) + n for n, k in enumerate(turned)}
    frames = film.all_frames
    return tag(
        "figure",
        tag("div", picture, class_="stage"),
        class_="viewer",
        data_labels="|".join(labels),
        data_brief="|".join(brief),
        data_sides=" ".join(f.side for f in film.frames),
        data_before=" ".join(str(before.get(k, -1)) for k in range(len(film.frames))),
        data_amplitude=2.0 * _AMPLITUDE,
        data_xyz=_packed((mesh.xyz - middle) / unit, np.int16),
        data_shapes=_packed(np.array([f.shape for f in frames]), np.int8),
        data_faces=raw(mesh.faces, np.uint16),
        data_lines=raw(mesh.lines, np.uint16),
        data_sensors=_packed((film.sensors - middle) / unit / 2.0, np.int16),
        data_axes=_packed(film.axes, np.int8),
        data_places=_packed((film.places - middle) / unit / 2.0, np.int16),
        data_traced=raw(film.lines, np.uint16),
        data_model=_packed(np.array([f.model for f in frames]) / 2.0, np.int8),
        data_test=_packed(np.array([f.test for f in frames]) / 2.0, np.int8),
    )


def _packed(values: Numbers, kind: type[np.int16] | type[np.int8]) -> str:
    """Values of -1..1 as whole numbers of full range, clipped."""
    full = np.iinfo(kind).max
    return raw(np.clip(np.rint(values * full), -full, full), kind)


def raw(values: Numbers, kind: type[np.generic]) -> str:
    """Return numbers as base64 of little-endian ones of a kind."""
    order = np.dtype(kind).newbyteorder("<")
    return esc(base64.b64encode(np.ascontiguousarray(values, order).tobytes()).decode())
