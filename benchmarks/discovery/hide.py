"""Draw what is hidden: effects at random places, of sizes that a test would notice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .calculix import CalculixError, Modes
from .mesh import Floats, Ints, Mesh, Structure
from .truth import Absorber, Patchwork, Soft, Stand, Truth

Entry = dict[str, Any]


@dataclass(frozen=True, eq=False)
class Scene:
    """What an effect is drawn from: structure, truth mesh, modes of the unchanged truth."""

    structure: Structure
    mesh: Mesh
    modes: Modes
    rng: np.random.Generator

    @property
    def mass(self) -> float:
        """Return the mass of the unchanged structure [t]."""
        s, m = self.structure, self.mesh
        shell = (
            quad_areas(m)
            @ np.array([s.shells[int(g)] for g in m.quad_group] or [0.0])[: m.quads.shape[0]]
        )
        length = np.linalg.norm(np.diff(m.xyz[m.bars[:, :2]], axis=1)[:, 0], axis=1)
        bars = length @ np.array([s.bars[int(g)].area for g in m.bar_group])
        return float(s.material.density * (shell + bars))

    def directions(self) -> Floats:
        """Return a unit direction per node in which it moves: normal, or the livelier axis."""
        n = self.mesh.normals()
        a = np.sum(self.modes.shapes**2, axis=2)
        a[:, 2] *= 0.999
        axis = np.eye(3)[np.argmax(a, axis=1)]
        return np.where(np.linalg.norm(n, axis=1)[:, None] > 0.5, n, axis)

    def lively(self) -> Ints:
        """Return nodes, mid-side ones too, that move more than the median does, ascending."""
        m = self.mesh
        a = np.sum(self.modes.shapes**2, axis=(1, 2))
        free = np.setdiff1d(np.arange(a.size), m.clamped)
        return free[a[free] >= np.median(a[free])]


def quad_areas(m: Mesh) -> Floats:
    """Return the areas of the shells [mm²]."""
    p = m.xyz[m.quads[:, :4]]
    n = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
    return np.asarray(0.5 * np.linalg.norm(n, axis=1))


def _node(scene: Scene) -> int:
    return int(scene.rng.choice(scene.lively()))


def _xyz(scene: Scene, node: int) -> Entry:
    p = scene.mesh.xyz[node].tolist()
    return {"xyz": p, "truth_node_xyz": p}


def _component(scene: Scene, node: int) -> int:
    return int(np.argmax(np.abs(scene.directions()[node]))) + 1


def point_mass(scene: Scene) -> tuple[Truth, Entry]:
    """Hide 2 to 7 % of the structure's mass at one node; a quarter of them stand off and turn."""
    node, rng = _node(scene), scene.rng
    mass = scene.mass * float(rng.uniform(0.02, 0.07))
    entry = {"kind": "point_mass", **_xyz(scene, node), "mass": mass}
    if rng.random() > 0.25:
        return Truth(masses=((node, mass),)), entry
    out = scene.directions()[node]
    side = np.cross(out, rng.standard_normal(3))
    offset = out * scene.structure.size * float(rng.uniform(0.02, 0.09))
    arm = side / np.linalg.norm(side) * scene.structure.size * float(rng.uniform(0.01, 0.05))
    entry |= {"offset": offset.tolist(), "arm": arm.tolist()}
    return Truth(stands=(Stand(node, tuple(offset), tuple(arm), mass),)), entry


def twins(scene: Scene) -> list[tuple[Truth, Entry]]:
    """Hide two like masses at lively places that mirror each other across one of two axes."""
    m, rng = scene.mesh, scene.rng
    longest = np.argsort(-np.ptp(m.xyz, axis=0))[:2]
    axis = int(rng.choice(longest))
    mass = scene.mass * float(rng.uniform(0.015, 0.06))
    other = int(longest[longest != axis][0])
    pair = _mirrored(scene, axis) or _mirrored(scene, other)
    if pair is None:
        raise CalculixError("no two lively places mirror each other")
    return [
        (Truth(masses=((n, mass),)), {"kind": "point_mass", **_xyz(scene, n), "mass": mass})
        for n in pair
    ]


def _mirrored(scene: Scene, axis: int) -> tuple[int, int] | None:
    """Return two lively nodes far apart that mirror each other across an axis."""
    m, lively = scene.mesh, scene.lively()
    ends = m.xyz[:, axis].min() + m.xyz[:, axis].max()
    for _ in range(200):
        node = _node(scene)
        place = m.xyz[node].copy()
        place[axis] = ends - place[axis]
        twin = int(np.argmin(np.linalg.norm(m.xyz - place, axis=1)))
        apart = np.linalg.norm(m.xyz[twin] - m.xyz[node]) > 0.25 * scene.structure.size
        if apart and np.isin(twin, lively):
            return node, twin
    return None


def link_spring(scene: Scene) -> tuple[Truth, Entry]:
    """Join two places by a spring along the line between them."""
    m, s, rng = scene.mesh, scene.structure, scene.rng
    nodes = np.intersect1d(m.corners, scene.lively())
    for _ in range(500):
        a, b = (int(n) for n in rng.choice(nodes, 2, replace=False))
        if 0.15 * s.size < np.linalg.norm(m.xyz[a] - m.xyz[b]) < 0.6 * s.size:
            break
    k = scene.mass * (2.0 * np.pi * scene.modes.hz[2]) ** 2 * float(rng.uniform(0.1, 1.0))
    ends = [m.xyz[a].tolist(), m.xyz[b].tolist()]
    entry = {
        "kind": "link_spring",
        "truth_node_xyz": (0.5 * (m.xyz[a] + m.xyz[b])).tolist(),
        "ends_xyz": ends,
        "stiffness": k,
    }
    return Truth(links=((a, b, k),)), entry


def _patch(scene: Scene) -> tuple[Ints, Entry]:
    """Return shells of one group within a box of a fifth to a third of the structure."""
    s, m, rng = scene.structure, scene.mesh, scene.rng
    centre = m.xyz[m.quads[:, :4]].mean(axis=1)
    least, most = 0.012, 0.12
    area = quad_areas(m)
    for _ in range(500):
        q = int(rng.integers(m.quads.shape[0]))
        half = s.size * rng.uniform(0.07, 0.13, 3)
        inside = np.all(np.abs(centre - centre[q]) <= half, axis=1)
        inside &= m.quad_group == m.quad_group[q]
        if least <= area[inside].sum() / area.sum() <= most:
            break
    chosen = np.flatnonzero(inside)
    nodes = m.xyz[m.quads[chosen, :4]].reshape(-1, 3)
    return chosen, {"box_lo": (nodes.min(0) - 1).tolist(), "box_hi": (nodes.max(0) + 1).tolist()}


def distributed_mass(scene: Scene) -> tuple[Truth, Entry]:
    """Hide 5 to 12 % of the structure's mass, spread evenly over a patch."""
    quads, box = _patch(scene)
    mass = scene.mass * float(scene.rng.uniform(0.05, 0.12))
    per_area = mass / float(quad_areas(scene.mesh)[quads].sum())
    none = np.zeros(0, dtype=int)
    entry = {"kind": "distributed_mass", **box, "mass": mass, "mass_per_area": per_area}
    return Truth(patches=(Patchwork(quads, none, 1.0, per_area),)), entry


def local_stiffness(scene: Scene) -> tuple[Truth, Entry]:
    """Change the modulus over a patch of shells, or of one member of a frame."""
    m, rng = scene.mesh, scene.rng
    none = np.zeros(0, dtype=int)
    factor = float(rng.uniform(0.3, 0.5) if rng.random() < 0.7 else rng.uniform(1.8, 2.5))
    if m.quads.size:
        quads, box = _patch(scene)
        entry = {"kind": "local_stiffness", **box, "factor": factor, "truth_elements": quads.size}
        return Truth(patches=(Patchwork(quads, none, factor),)), entry
    line = int(rng.integers(m.bar_line.max() + 1))
    bars = np.flatnonzero(m.bar_line == line)
    nodes = m.xyz[m.bars[bars, :2]].reshape(-1, 3)
    entry = {
        "kind": "local_stiffness",
        "member": scene.structure.lines[line].name,
        "box_lo": nodes.min(0).tolist(),
        "box_hi": nodes.max(0).tolist(),
        "factor": factor,
    }
    return Truth(patches=(Patchwork(none, bars, factor),)), entry


def ground_spring(scene: Scene) -> tuple[Truth, Entry]:
    """Hide a spring to ground that would carry the structure at 0.3 to 0.7 of its first mode."""
    node = _node(scene)
    c = _component(scene, node)
    first = (2.0 * np.pi * scene.modes.hz[0]) ** 2
    k = float(scene.rng.uniform(0.1, 0.5) * scene.mass * first)
    entry = {"kind": "ground_spring", **_xyz(scene, node), "components": [c], "stiffness": k}
    return Truth(springs=((node, c, k),)), entry


def support_flexibility(scene: Scene) -> tuple[Truth, Entry]:
    """Let a clamped foot turn or sink, or a stretch of a clamped edge move out of plane.

    In half of the cases that stretch also turns freely about the edge.
    """
    s, m, rng = scene.structure, scene.mesh, scene.rng
    if not m.quads.size:
        node = int(rng.choice(m.clamped))
        row = int(np.flatnonzero(np.any(m.bars[:, :2] == node, axis=1))[0])
        bar, e = s.bars[int(m.bar_group[row])], s.material.young
        line = s.lines[int(m.bar_line[row])]
        length = float(np.linalg.norm(np.diff(line.point(np.array([0.0, 1.0])), axis=0)))
        place = _xyz(scene, node)
        if rng.random() < 0.5:
            k = float(rng.uniform(0.02, 0.15) * 4.0 * e * bar.i1 / length)
            entry = {
                "kind": "support_flexibility",
                **place,
                "components": [4, 5, 6],
                "stiffness": k,
            }
            return Truth(soft=(Soft(node, int(m.bar_line[row]), k, ground=True),)), entry
        k = float(rng.uniform(0.005, 0.05) * e * bar.area / length)
        entry = {"kind": "support_flexibility", **place, "components": [3], "stiffness": k}
        return Truth(springs=((node, 3, k),), freed=((node, 3),)), entry
    p = m.xyz[m.clamped]
    axis = int(np.argmax(np.ptp(p, axis=0)))
    normal = scene.mesh.normals()[m.clamped]
    c = int(np.argmax(np.abs(normal).mean(axis=0))) + 1
    level = p[:, c - 1] < p[:, c - 1].min() + 1e-6
    middle = float(rng.uniform(p[:, axis].min(), p[:, axis].max()))
    half = 0.2 * float(np.ptp(p[:, axis]))
    near = m.clamped[level & (np.abs(p[:, axis] - middle) <= half)]
    first = (2.0 * np.pi * scene.modes.hz[1]) ** 2
    k = float(rng.uniform(0.03, 0.3) * scene.mass * first)
    box = {"box_lo": m.xyz[near].min(0).tolist(), "box_hi": m.xyz[near].max(0).tolist()}
    loose = [c] if rng.random() < 0.5 else [c, axis + 4]
    entry = {
        "kind": "support_flexibility",
        **box,
        "components": [c],
        "stiffness": k,
        "hinged": len(loose) == 2,
    }
    springs = tuple((int(n), c, k / near.size) for n in near)
    return Truth(springs=springs, freed=tuple((int(n), d) for n in near for d in loose)), entry


def joint_flexibility(scene: Scene) -> tuple[Truth, Entry]:
    """Join the end of a member by a rotational spring of 1 to 6 % of its own stiffness."""
    s, m, rng = scene.structure, scene.mesh, scene.rng
    for _ in range(500):
        line = int(rng.integers(len(s.lines)))
        end = int(rng.integers(2))
        ends = s.lines[line].point(np.array([0.0, 1.0]))
        node = int(np.argmin(np.linalg.norm(m.xyz - ends[end], axis=1)))
        others = np.unique(m.bar_line[np.any(m.bars[:, :2] == node, axis=1)])
        if node not in m.clamped and others.size > 1:
            break
    bar = s.bars[s.lines[line].group]
    own = 4.0 * s.material.young * bar.i1 / float(np.linalg.norm(ends[1] - ends[0]))
    k = float(rng.uniform(0.01, 0.06)) * own
    entry = {
        "kind": "joint_flexibility",
        "member": s.lines[line].name,
        "end": "AB"[end],
        "components": [4, 5, 6],
        "stiffness": k,
        **_xyz(scene, node),
    }
    return Truth(soft=(Soft(node, line, k),)), entry


def tuned_absorber(scene: Scene) -> tuple[Truth, Entry]:
    """Hang 1.5 to 4 % of the mass on a spring tuned to a mode that moves there."""
    node = _node(scene)
    c = _component(scene, node)
    y = scene.modes.shapes[node, c - 1]
    likely = np.argsort(-np.abs(y[1:10]))[:3] + 1
    hz = float(scene.modes.hz[int(scene.rng.choice(likely))] * scene.rng.uniform(0.96, 1.04))
    mass = scene.mass * float(scene.rng.uniform(0.015, 0.04))
    entry = {
        "kind": "tuned_absorber",
        **_xyz(scene, node),
        "components": [c],
        "mass": mass,
        "frequency_hz": hz,
    }
    return Truth(absorbers=(Absorber(node, c, mass, mass * (2.0 * np.pi * hz) ** 2),)), entry


def local_damper(scene: Scene) -> tuple[Truth, Entry]:
    """Hide a dashpot to ground that gives its best mode 3 to 7 % of critical damping."""
    node = _node(scene)
    c = _component(scene, node)
    y, w = scene.modes.shapes[node, c - 1], 2.0 * np.pi * scene.modes.hz
    target = float(scene.rng.uniform(0.03, 0.07))
    damping = target / float(np.max(y**2 / (2.0 * w)))
    entry = {"kind": "local_damper", **_xyz(scene, node), "components": [c], "damping": damping}
    return Truth(dampers=((node, c, damping),)), entry


KINDS: dict[str, Callable[[Scene], tuple[Truth, Entry]]] = {
    f.__name__: f
    for f in (
        point_mass,
        distributed_mass,
        local_stiffness,
        ground_spring,
        support_flexibility,
        joint_flexibility,
        tuned_absorber,
        local_damper,
        link_spring,
    )
}


SELDOM, RARE = ("tuned_absorber", "local_damper", "link_spring"), 0.4
"""Kinds that are hidden less often than the others, and how often beside them."""


def possible(s: Structure) -> list[str]:
    """Return the kinds that this structure can have."""
    never = set()
    if s.clamped is None:
        never.add("support_flexibility")
    never |= {"link_spring"} if s.name in ("panel", "plate", "wheel") else set()
    never |= {"distributed_mass"} if s.lines and not s.patches else {"joint_flexibility"}
    return [k for k in KINDS if k not in never]


def scatter(scene: Scene) -> dict[int, float]:
    """Return factors of one or two known properties: thickness ±3–7 %, bar modulus ±8–25 %."""
    s, rng = scene.structure, scene.rng
    groups = [*s.shells, *s.bars]
    out: dict[int, float] = {}
    for g in rng.choice(groups, size=min(len(groups), int(rng.integers(1, 3))), replace=False):
        low, high = (0.03, 0.07) if int(g) in s.shells else (0.08, 0.22)
        change = float(rng.uniform(low, high)) * (1 if rng.random() < 0.5 else -1)
        out[int(g)] = round(1.0 + change, 4)
    return out


def joined(truths: list[Truth], factors: dict[int, float]) -> Truth:
    """Return all changes together."""

    def every(name: str) -> Any:
        return tuple(p for t in truths for p in getattr(t, name))

    lists = ("patches", "masses", "springs", "absorbers", "soft", "dampers", "freed")
    return Truth(
        factors=factors,
        eccentric={k: v for t in truths for k, v in t.eccentric.items()},
        preload=next((t.preload for t in truths if t.preload), None),
        suspended=any(t.suspended for t in truths),
        **{name: every(name) for name in (*lists, "fields", "stands", "links")},
    )
