"""The structure has another shape than the drawing: round, flat, straight are none of them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..hide import Scene
from ..mesh import Floats, Mesh
from .cause import Cause, size


@dataclass(frozen=True, eq=False)
class Frame:
    """The structure in its own directions: nodes along them (0 to 1), longest first."""

    xyz: Floats
    order: tuple[int, int, int] = field(default=(0, 1, 2))

    @property
    def span(self) -> Floats:
        """Return the extents [mm], longest first."""
        return np.asarray(np.ptp(self.xyz, axis=0)[list(self.order)])

    @property
    def xi(self) -> Floats:
        """Return the coordinates (n, 3) from 0 to 1, longest first."""
        low, span = self.xyz.min(axis=0), np.maximum(np.ptp(self.xyz, axis=0), 1e-9)
        return np.asarray(((self.xyz - low) / span)[:, list(self.order)])


def _frame(m: Mesh) -> Frame:
    order = np.argsort(-np.ptp(m.xyz, axis=0), kind="stable")
    return Frame(m.xyz, (int(order[0]), int(order[1]), int(order[2])))


def _moved(scene: Scene, by: Floats, **entry: Any) -> Cause:
    m = scene.mesh
    return Cause(replace(m, xyz=m.xyz + by), entry)


def out_of_round(scene: Scene) -> Cause:
    """Make what is round about z oval or three-cornered, evenly or growing along it."""
    m, rng = scene.mesh, scene.rng
    lobes, phase = int(rng.choice([2, 2, 3])), float(rng.uniform(0.0, 2.0 * np.pi))
    height = scene.structure.size * size(scene, 1e-4, 1e-2)
    angle = np.arctan2(m.xyz[:, 1], m.xyz[:, 0])
    r = np.linalg.norm(m.xyz[:, :2], axis=1)
    grown = height * np.cos(lobes * (angle - phase)) * r / r.max()
    if rng.random() < 0.4:
        z = m.xyz[:, 2] - m.xyz[:, 2].min()
        grown = grown * (1.0 if z.max() == 0.0 else z / z.max())
    by = np.zeros_like(m.xyz)
    by[:, 0], by[:, 1] = grown * np.cos(angle), grown * np.sin(angle)
    return _moved(scene, by, kind="out_of_round", height=height, lobes=lobes)


def bow(scene: Scene) -> Cause:
    """Bend the structure sideways along its length, and across it in half of the cases."""
    f, rng = _frame(scene.mesh), scene.rng
    height = scene.structure.size * size(scene, 2e-4, 2e-2)
    shape = np.sin(np.pi * f.xi[:, 0])
    if rng.random() < 0.5:
        shape = shape * np.sin(np.pi * f.xi[:, 1])
    by = np.zeros_like(f.xyz)
    by[:, f.order[2]] = height * shape
    return _moved(scene, by, kind="bow", height=height)


def twist(scene: Scene) -> Cause:
    """Turn the cross-sections about the longest direction, more and more along it."""
    f = _frame(scene.mesh)
    angle = size(scene, 1e-3, 0.12)
    a = angle * f.xi[:, 0]
    middle = 0.5 * (f.xyz.min(axis=0) + f.xyz.max(axis=0))
    p, q = f.order[1], f.order[2]
    y, z = f.xyz[:, p] - middle[p], f.xyz[:, q] - middle[q]
    by = np.zeros_like(f.xyz)
    by[:, p] = y * (np.cos(a) - 1.0) - z * np.sin(a)
    by[:, q] = y * np.sin(a) + z * (np.cos(a) - 1.0)
    return _moved(scene, by, kind="twist", angle_rad=angle)


def taper(scene: Scene) -> Cause:
    """Make the structure wider at one end and narrower at the other."""
    f = _frame(scene.mesh)
    change = size(scene, 2e-3, 0.12) * scene.rng.choice([-1.0, 1.0])
    middle = 0.5 * (f.xyz.min(axis=0) + f.xyz.max(axis=0))
    by = change * (f.xi[:, :1] - 0.5) * (f.xyz - middle)
    by[:, f.order[0]] = 0.0
    return _moved(scene, by, kind="taper", change=change)


def lean(scene: Scene) -> Cause:
    """Let right angles be none."""
    f = _frame(scene.mesh)
    angle = size(scene, 1e-3, 0.12) * scene.rng.choice([-1.0, 1.0])
    high, side = f.order[0], f.order[int(scene.rng.integers(1, 3))]
    by = np.zeros_like(f.xyz)
    by[:, side] = np.tan(angle) * (f.xyz[:, high] - f.xyz[:, high].min())
    return _moved(scene, by, kind="lean", angle_rad=angle)


def length(scene: Scene) -> Cause:
    """Make a part of the structure longer or shorter than drawn."""
    f, rng = _frame(scene.mesh), scene.rng
    axis = f.order[int(rng.integers(0, 2))]
    change = size(scene, 1e-3, 0.06) * rng.choice([-1.0, 1.0])
    x = f.xyz[:, axis] - f.xyz[:, axis].min()
    start, stop = sorted(rng.uniform(0.0, x.max(), 2))
    by = np.zeros_like(f.xyz)
    by[:, axis] = change * x.max() * np.clip((x - start) / max(stop - start, 0.2 * x.max()), 0, 1)
    return _moved(scene, by, kind="length", change=change)


def warp(scene: Scene) -> Cause:
    """Add waves of random direction and length, out of plane of flat structures."""
    f, rng = _frame(scene.mesh), scene.rng
    height = scene.structure.size * size(scene, 2e-4, 1e-2)
    waves = sum(
        rng.standard_normal()
        * np.cos(np.pi * (i * f.xi[:, 0] + j * f.xi[:, 1]) + rng.uniform(0, 6))
        for i in range(4)
        for j in range(4)
        if i + j > 1
    )
    by = np.zeros_like(f.xyz)
    by[:, f.order[2]] = height * waves / np.max(np.abs(waves))
    return _moved(scene, by, kind="warp", height=height)
