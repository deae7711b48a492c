"""Modes of two models, or of two meshes of one structure, compared where both have a grid."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..arrays import Floats, Ints
from ..data.geometry import Geometry
from ..data.modes import Modes
from ..errors import InputError
from .correlation_numbers import CORRELATION
from .criteria import Criteria
from .mac import realised
from .mode_pairing import Correlation, correlate


def common_places(a: Geometry, b: Geometry) -> tuple[Ints, Ints]:
    """Return rows of grids that are in one place, nearest ones by pairs, at most so many.

    Of several in one place the one of the same number is taken.

    Raises
    ------
    InputError
        Hardly any are.
    """
    distance, nearest = cKDTree(b.xyz).query(a.xyz)
    own = b.index_of(a.ids)
    same = (own >= 0) & (np.linalg.norm(b.xyz[own] - a.xyz, axis=1) <= distance)
    nearest = np.where(same, own, nearest)
    reach = CORRELATION.one_place * min(a.size, b.size)
    rows = np.flatnonzero(distance <= reach)
    if len(rows) < CORRELATION.places[0]:
        raise InputError(
            f"the two have {len(rows)} places in common, of {len(a.ids)} and {len(b.ids)} grids "
            f"that span {a.size:.4g} and {b.size:.4g}: compare what is in one frame and one unit "
            "of length, or correlate them"
        )
    step = max(1, len(rows) // CORRELATION.places[1])
    rows = rows[::step]
    return rows, nearest[rows]


def correlate_models(
    a: tuple[Geometry, Modes], b: tuple[Geometry, Modes], criteria: Criteria | None = None
) -> Correlation:
    """Correlate the modes of two models by their translations in common places.

    The modes of `a` stand where a test does; rigid-body modes of both take no part.
    """
    rows = common_places(a[0], b[0])
    shapes = []
    for (geometry, modes), own in zip((a, b), rows, strict=True):
        shapes.append(_translations(modes, geometry.ids[own]))
    seen = np.isfinite(shapes[0]).all(axis=1) & np.isfinite(shapes[1]).all(axis=1)
    if not seen.any():
        raise InputError("no direction is in the modes of both")
    hz = [m.frequencies_hz for _, m in (a, b)]
    rigid = [int(np.sum(f < CORRELATION.at_rest * f.max(initial=0.0))) for f in hz]
    first = np.where(np.arange(len(hz[0])) < rigid[0], 0.0, hz[0])
    return correlate(hz[1], shapes[1][seen], first, shapes[0][seen], criteria, rigid[1])


def _translations(modes: Modes, nodes: Ints) -> Floats:
    """Shapes along the basic axes at nodes, (3 n, n_mode); NaN where there is no row."""
    dofs, shapes = modes.dofs, realised(modes.shapes)
    at = {int(n): k for k, n in enumerate(nodes)}
    found = np.full((len(nodes), 3, shapes.shape[1]), np.nan)
    rows = np.flatnonzero(np.isin(dofs.node, nodes) & (dofs.component <= 3))
    along = np.argmax(np.abs(dofs.axis[rows]), axis=1)
    sign = np.take_along_axis(dofs.axis[rows], along[:, None], axis=1)
    basic = np.abs(sign[:, 0]) > CORRELATION.along
    where = np.array([at[int(n)] for n in dofs.node[rows]], np.int64)
    found[where[basic], along[basic]] = (sign * shapes[rows])[basic]
    return found.reshape(3 * len(nodes), -1)
