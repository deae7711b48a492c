"""Test nodes whose grids the user names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..arrays import Floats
from ..data.geometry import Geometry
from ..errors import InputError
from ..sensors.placement_numbers import PLACEMENT
from ..sensors.rigid_transform import Transform
from .alignment import Alignment
from .registration_numbers import ALIGN


def positions(geometry: Geometry, nodes: list[int], what: str) -> Floats:
    """Return where nodes are, (n, 3).

    Raises
    ------
    InputError
        One is not there; `what` they are.
    """
    rows = geometry.index_of(np.array(nodes, np.int64))
    if np.any(rows < 0):
        raise InputError(f"node_map names {what} {nodes[int(np.argmin(rows))]}, which is not there")
    return np.asarray(geometry.xyz[rows])


def aligned_by(
    geometry: Geometry, test_geometry: Geometry, grids: Mapping[int, int]
) -> Alignment | None:
    """Return the rigid move that brings test nodes nearest to their grids, by least squares.

    Both in one length unit. None where fewer than three nodes are named, or all on one line.

    References
    ----------
    Kabsch (1976), A solution for the best rotation to relate two sets of vectors.
    """
    to = positions(geometry, list(grids.values()), "grid")
    points = positions(test_geometry, list(grids), "test node")
    x, y = (p - p.mean(axis=0) for p in (points, to))
    spread = np.linalg.svd(x, compute_uv=False)
    if len(x) < 3 or spread[1] < ALIGN.free * max(spread[0], geometry.size):
        return None
    u, _, vt = np.linalg.svd(x.T @ y)
    turn = np.diag([1.0, 1.0, np.sign(np.linalg.det(vt.T @ u.T))])
    R = vt.T @ turn @ u.T
    off = np.linalg.norm(x @ R.T - y, axis=1)
    far = int(np.argmax(off))
    said: tuple[str, ...] = ()
    if off[far] > PLACEMENT.off[1] * geometry.size:
        node, grid = list(grids.items())[far]
        said = (f"test node {node} lies {off[far]:.3g} from grid {grid}, where it was put by hand",)
    shift = to.mean(axis=0) - points.mean(axis=0) @ R.T
    rms = float(np.sqrt(np.mean(off**2)))
    return Alignment(R, shift, 1.0, rms, "by hand", warnings=said)


def put_on_grids(
    geometry: Geometry, test_geometry: Geometry, grids: Mapping[int, int], move: Transform
) -> Geometry:
    """Return the test's geometry with its nodes where `move` brings them onto their grids."""
    to = positions(geometry, list(grids.values()), "grid")
    xyz = np.array(test_geometry.xyz)
    rows = test_geometry.index_of(np.array(list(grids), np.int64))
    xyz[rows] = (to - move.translation) @ move.rotation / move.scale
    return replace(test_geometry, xyz=xyz)
