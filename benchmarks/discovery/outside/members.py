"""Members that the deck does not have, or that are otherwise there than it says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..hide import Scene
from ..mesh import Bar, Ints, Mesh
from ..truth import Truth
from .cause import Cause, Entry, nodes_of, size


def _others(m: Mesh, line: int) -> Ints:
    """Return the nodes of all elements but those of a line."""
    return np.unique(np.concatenate([m.quads.ravel(), m.bars[m.bar_line != line].ravel()]))


def _ends(scene: Scene, a: int, b: int) -> Entry:
    p, q = scene.mesh.xyz[a], scene.mesh.xyz[b]
    return {"truth_node_xyz": (0.5 * (p + q)).tolist(), "ends_xyz": [p.tolist(), q.tolist()]}


def brace(scene: Scene) -> Cause:
    """Join two places by a strut that the deck does not have."""
    m, rng, s = scene.mesh, scene.rng, scene.structure
    free = np.intersect1d(np.setdiff1d(m.corners, m.clamped), scene.lively())
    for _ in range(500):
        a, b = (int(i) for i in rng.choice(free, 2, replace=False))
        distance = float(np.linalg.norm(m.xyz[a] - m.xyz[b]))
        if 0.15 * s.size < distance < 0.6 * s.size:
            break
    area = size(scene, 0.3, 100.0)
    mass = 0.5 * area * distance * s.material.density
    truth = Truth(
        links=((a, b, area * s.material.young / distance),), masses=((a, mass), (b, mass))
    )
    entry = {"kind": "brace", "area": area, **_ends(scene, a, b)}
    return Cause(m, entry, truth, may=({**entry, "kind": "link_spring"},))


def stiffener(scene: Scene) -> Cause:
    """Put a stiffener along the mesh of a shell where the deck has none."""
    m, rng, s = scene.mesh, scene.rng, scene.structure
    q = m.quads
    edges = np.concatenate([q[:, [i, (i + 1) % 4, 4 + i]] for i in range(4)])
    taken = {tuple(sorted(row[:2])) for row in m.bars.tolist()}
    edges = np.array([e for e in edges.tolist() if tuple(sorted(e[:2])) not in taken])
    edges = np.concatenate([edges, edges[:, [1, 0, 2]]])
    chain = [edges[int(rng.integers(edges.shape[0]))]]
    reach, gone = s.size * float(rng.uniform(0.15, 0.7)), 0.0
    while gone < reach:
        a, b, _ = chain[-1]
        ahead = edges[edges[:, 0] == b]
        way = m.xyz[b] - m.xyz[a]
        on = m.xyz[ahead[:, 1]] - m.xyz[b]
        straight = on @ way / np.linalg.norm(on, axis=1) / np.linalg.norm(way)
        if straight.max() < 0.9:
            break
        chain.append(ahead[int(np.argmax(straight))])
        gone += float(np.linalg.norm(way))
    side = max(s.shells.values()) * size(scene, 0.7, 6.0)
    way = m.xyz[chain[0][1]] - m.xyz[chain[0][0]]
    plane = m.normals()[chain[0][2]]
    plane = plane if np.linalg.norm(np.cross(plane, way)) > 0 else np.roll(way, 1)
    group, n = 900, len(chain)
    mesh = replace(
        m,
        bars=np.concatenate([m.bars.reshape(-1, 3), np.array(chain)]),
        bar_group=np.concatenate([m.bar_group, np.full(n, group)]),
        bar_line=np.concatenate([m.bar_line, np.full(n, group)]),
        plane=np.concatenate([m.plane, np.tile(plane, (n, 1))]),
    )
    entry = {"kind": "stiffener", "side": side, "length": gone}
    return Cause(mesh, entry, sections={group: Bar(side, side)})


def missing_member(scene: Scene) -> Cause:
    """Leave out a member, or a stretch of a stiffener, that the deck has."""
    m, rng = scene.mesh, scene.rng
    line = int(rng.choice(np.unique(m.bar_line)))
    bars = np.flatnonzero(m.bar_line == line)
    if m.quads.size:
        count = max(1, int(bars.size * size(scene, 0.04, 0.6)))
        start = int(rng.integers(bars.size - count + 1))
        bars = bars[start : start + count]
    keep = np.setdiff1d(np.arange(m.bars.shape[0]), bars)
    nodes = m.xyz[m.bars[bars, :2]].reshape(-1, 3)
    entry = {
        "kind": "missing_member",
        "share": bars.size / int(np.sum(m.bar_line == line)),
        "box_lo": nodes.min(0).tolist(),
        "box_hi": nodes.max(0).tolist(),
    }
    mesh = _with(m, keep)
    return Cause(mesh, entry, may=({**entry, "kind": "local_stiffness"},))


def _with(m: Mesh, bars: Ints) -> Mesh:
    return replace(
        m,
        bars=m.bars[bars],
        bar_group=m.bar_group[bars],
        bar_line=m.bar_line[bars],
        plane=m.plane[bars],
    )


def detached(scene: Scene) -> Cause:
    """Let a stiffener hold at the ends of a stretch only."""
    m, rng = scene.mesh, scene.rng
    line = int(rng.choice(np.unique(m.bar_line)))
    rows = np.flatnonzero(m.bar_line == line)
    count = max(2, int(rows.size * size(scene, 0.08, 0.5)))
    start = int(rng.integers(rows.size - count + 1))
    rows = rows[start : start + count]
    bars, xyz = m.bars.copy(), m.xyz
    inner = np.unique(np.concatenate([bars[rows, 2], bars[rows[1:], 0]]))
    number = np.arange(xyz.shape[0] + inner.size)
    number[inner] = xyz.shape[0] + np.arange(inner.size)
    bars[rows] = number[bars[rows]]
    bars[rows[0], 0], bars[rows[-1], 1] = m.bars[rows[0], 0], m.bars[rows[-1], 1]
    mesh = replace(m, bars=bars, xyz=np.concatenate([xyz, xyz[inner]]))
    return Cause(mesh, {"kind": "detached", "share": count / int(np.sum(m.bar_line == line))})


def member_position(scene: Scene) -> Cause:
    """Attach a member, at one end or at both, to grids beside those of the deck."""
    m, rng = scene.mesh, scene.rng
    loose = []
    for k in np.unique(m.bar_line):
        own, others = nodes_of(m, int(k)), _others(m, int(k))
        if not np.isin(own[1:-1], others).any() and np.isin(own[[0, -1]], others).all():
            loose.append(int(k))
    line = int(rng.choice(loose))
    own, others = nodes_of(m, line), np.intersect1d(_others(m, line), m.corners)
    ends, xyz, bars = own[[0, -1]].copy(), m.xyz.copy(), m.bars.copy()
    reach = size(scene, 0.02, 0.2) * scene.structure.size
    both, moved = bool(rng.random() < 0.4), 0.0
    for e in (0, 1) if both else (int(rng.integers(2)),):
        gap = np.linalg.norm(xyz[others] - xyz[own[-e]], axis=1)
        beside = others[np.argsort(np.abs(gap - reach), kind="stable")]
        ends[e] = next(int(n) for n in beside if n not in own)
        moved = max(moved, float(np.linalg.norm(xyz[ends[e]] - xyz[own[-e]])))
    t = np.linspace(0.0, 1.0, own.size)[1:-1, None]
    xyz[own[1:-1]] = xyz[ends[0]] + t * (xyz[ends[1]] - xyz[ends[0]])
    rows = np.flatnonzero(m.bar_line == line)
    bars[rows[0], 0], bars[rows[-1], 1] = ends[0], ends[1]
    return Cause(replace(m, xyz=xyz, bars=bars), {"kind": "member_position", "moved": moved})


def stiffener_position(scene: Scene) -> Cause:
    """Put a straight stiffener of a flat shell some rows of the mesh aside."""
    m, rng = scene.mesh, scene.rng
    normals = m.normals()
    for _ in range(200):
        line = int(rng.choice(np.unique(m.bar_line)))
        own = nodes_of(m, line)
        along = m.xyz[own[-1]] - m.xyz[own[0]]
        aside = np.cross(along, normals[own[own.size // 2]])
        away = m.xyz[m.corners] - m.xyz[own[0]]
        step = size(scene, 0.01, 0.12) * scene.structure.size * rng.choice([-1.0, 1.0])
        by = away[np.argmin(np.linalg.norm(away - step * aside / np.linalg.norm(aside), axis=1))]
        gap = np.linalg.norm(m.xyz[:, None] - (m.xyz[own] + by)[None], axis=2)
        if gap.min(axis=0).max() < 1e-3 and np.linalg.norm(by) > 1e-3:
            number = np.arange(m.xyz.shape[0])
            number[own] = np.argmin(gap, axis=0)
            bars = m.bars.copy()
            mine = m.bar_line == line
            bars[mine] = number[bars[mine]]
            moved = float(np.linalg.norm(by))
            return Cause(replace(m, bars=bars), {"kind": "stiffener_position", "moved": moved})
    raise ValueError("no stiffener of this structure can be put aside")


def eccentric(scene: Scene) -> Cause:
    """Let stiffeners lie beside the plane of the shell, where the deck has them in it."""
    s, rng = scene.structure, scene.rng
    group = int(rng.choice(list(s.bars)))
    offset = size(scene, 0.03, 0.6)
    lines = {k: offset for k, line in enumerate(s.lines) if line.group == group}
    entry = {"kind": "eccentric", "group": s.wording[group], "offset": offset}
    return Cause(scene.mesh, entry, Truth(eccentric=lines))
