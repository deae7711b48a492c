"""What the test itself brings: its suspension, its sensors, its clamp."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..hide import Scene
from ..truth import Truth
from .cause import Cause, size


def clamp_reach(scene: Scene) -> Cause:
    """Let the clamp reach further in than drawn."""
    m = scene.mesh
    reach = size(scene, 0.012, 0.12) * scene.structure.size
    held = m.xyz[m.clamped]
    gap = np.array([np.min(np.linalg.norm(held - p, axis=1)) for p in m.xyz])
    return Cause(
        replace(m, clamped=np.flatnonzero(gap <= reach)), {"kind": "clamp_reach", "reach": reach}
    )


def suspension(scene: Scene) -> Cause:
    """Hang a free structure on three or four springs, soft or not so soft."""
    m, rng = scene.mesh, scene.rng
    count = int(rng.integers(3, 5))
    share = size(scene, 0.02, 0.45)
    nodes = [int(rng.choice(m.corners))]
    while len(nodes) < count:
        gap = np.linalg.norm(m.xyz[m.corners, None] - m.xyz[nodes][None], axis=2).min(axis=1)
        nodes.append(int(m.corners[int(np.argmax(gap * rng.uniform(0.5, 1.0, gap.size)))]))
    total = scene.mass * (2.0 * np.pi * share * scene.modes.hz[0]) ** 2
    springs = tuple((n, c, total / count) for n in nodes for c in (1, 2, 3))
    at = [{"kind": "ground_spring", "truth_node_xyz": m.xyz[n].tolist()} for n in nodes]
    entry = {"kind": "suspension", "frequency_share": share, "points": len(nodes)}
    return Cause(m, entry, Truth(springs=springs, suspended=True), may=tuple(at))


def roving_sensors(scene: Scene) -> Cause:
    """Measure in runs, with the mass of the roving sensors elsewhere in each."""
    mass = scene.mass * size(scene, 0.001, 0.04)
    runs = int(scene.rng.integers(3, 6))
    entry = {"kind": "roving_sensors", "mass": mass, "runs": runs}
    return Cause(scene.mesh, entry, runs=runs, sensor_mass=mass)
