"""Which places of a structure are each other's images, by the symmetry that it has.

Engines, tip masses and feet come in twos, threes and fours, and a structure shows where: it is
its own image in a plane, or turned about an axis. Planes and turns are looked for through the
middle of its box, along the basic axes and along its principal ones; of the real structure's own
symmetry small parts may be exempt.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...arrays import Floats, Ints, skew
from .symmetry_numbers import SYMMETRY


@dataclass(frozen=True, eq=False)
class Symmetry:
    """Maps of a structure onto itself.

    Parameters
    ----------
    maps : (m, 3, 3) float
        Orthogonal, without the identity.
    centre : (3,) float
        What they leave where it is.
    towards : (3,) float
        Of places that are each other's images, the one that lies farthest along it stands for all.
    """

    maps: Floats
    centre: Floats
    towards: Floats

    def images(self, xyz: Floats) -> Floats:
        """Return the images of places (n, 3), (m, n, 3)."""
        return np.asarray((xyz - self.centre) @ self.maps.transpose(0, 2, 1) + self.centre)


def symmetries(xyz: Floats, size: float, held: Floats) -> tuple[Symmetry, ...]:
    """Return the planes, pairs of planes and turns by which grids (n, 3) are their own images.

    So are those that are `held` (m, 3): at a clamp and at the free end opposite nothing is alike.
    `size` is that of the structure.
    """
    from scipy.spatial import cKDTree

    trees = [(own, cKDTree(own)) for own in (xyz, held) if len(own)]

    def holds(s: Symmetry) -> bool:
        near = SYMMETRY.image_off * size
        off = [tree.query(s.images(own), distance_upper_bound=near)[0] for own, tree in trees]
        share = min(np.isfinite(away).mean(axis=1).min() for away in off)
        return bool(share > SYMMETRY.image_share)

    planes = (Symmetry((np.eye(3) - 2.0 * np.outer(n, n))[None], c, n) for n, c in _lines(xyz))
    found = [s for s in planes if holds(s)]
    mirrors = [s for k, s in enumerate(found) if not any(_same(s, t, size) for t in found[:k])]
    turns: list[Symmetry] = []
    for axis, centre in _lines(xyz):
        rings = [_ring(axis, centre, n) for n in SYMMETRY.rings]
        own = [s for s in rings if holds(s)]
        if own and len(own[-1].maps) > 1 and not any(_same(own[-1], s, size) for s in turns):
            turns += own
    pairs = (_pair(s, t) for k, s in enumerate(mirrors) for t in mirrors[:k] if not turns)
    return (*mirrors, *(s for s in pairs if s is not None and holds(s)), *turns)


def images_of(s: Symmetry, xyz: Floats, size: float) -> Ints:
    """Return rows of places (n, 3) that are each other's images, (n_set, m + 1), the first leading.

    `size` is that of the structure.
    """
    from scipy.spatial import cKDTree

    near = SYMMETRY.image_off * size
    images = s.images(xyz)
    away, there = cKDTree(xyz).query(images, distance_upper_bound=near)
    lead = np.flatnonzero(np.isfinite(away).all(axis=0))
    sets = np.column_stack([lead, there[:, lead].T])
    along = (xyz[sets] - s.centre) @ s.towards
    first = along[:, 0] >= along.max(axis=1) - SYMMETRY.image_skew * near
    gap = np.linalg.norm(xyz[sets][:, :, None] - xyz[sets][:, None], axis=3)
    gap[:, np.arange(sets.shape[1]), np.arange(sets.shape[1])] = np.inf
    sets = sets[first & (gap.min(axis=(1, 2)) > SYMMETRY.twins_apart * size)]
    _, kept = np.unique(np.sort(sets, axis=1), axis=0, return_index=True)
    return np.asarray(sets[np.sort(kept)])


def _lines(xyz: Floats) -> Iterator[tuple[Floats, Floats]]:
    """Directions, and points on them, of what may be an axis or stand upright on a plane.

    Basic axes and principal ones that no other equals, through the middle of the box along these
    axes and that of the grids.
    """
    middle = xyz.mean(axis=0)
    off = np.vstack([xyz - middle, np.zeros((3, 3))])
    _, extent, principal = np.linalg.svd(off, full_matrices=False)
    gap = np.abs(np.subtract.outer(extent, extent)) + np.diag(np.full(3, np.inf))
    own = gap.min(axis=1) > SYMMETRY.image_round * extent.max()
    for frame, wanted in ((np.eye(3), np.ones(3, bool)), (principal, own)):
        along = xyz @ frame.T
        box = 0.5 * (along.min(axis=0) + along.max(axis=0)) @ frame
        for axis in frame[wanted]:
            yield axis, box
            yield axis, middle


def _pair(s: Symmetry, t: Symmetry) -> Symmetry | None:
    """Return two planes and the turn that both make, None where they are not perpendicular."""
    if abs(s.towards @ t.towards) > SYMMETRY.image_skew:
        return None
    maps = np.stack([s.maps[0], t.maps[0], s.maps[0] @ t.maps[0]])
    centre = s.centre + ((t.centre - s.centre) @ t.towards) * t.towards
    return Symmetry(maps, centre, s.towards + t.towards)


def _ring(axis: Floats, centre: Floats, n: int) -> Symmetry:
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    angles = 2.0 * np.pi * np.arange(1, n) / n
    return Symmetry(np.stack([_turn(axis, a) for a in angles]), centre, across)


def _turn(axis: Floats, angle: float) -> Floats:
    """Rodrigues' rotation about a unit axis."""
    W = skew(axis)
    return np.asarray(np.eye(3) + np.sin(angle) * W + (1.0 - np.cos(angle)) * W @ W)


def _same(s: Symmetry, t: Symmetry, size: float) -> bool:
    """Whether two symmetries take a few points of the size of the structure to the same places."""
    if len(s.maps) != len(t.maps):
        return False
    points = s.centre + size * np.vstack([np.zeros(3), np.eye(3)])
    gap = np.linalg.norm(s.images(points)[:, None] - t.images(points)[None], axis=3).max(axis=2)
    return bool((gap.min(axis=1) < 2.0 * SYMMETRY.image_off * size).all())
