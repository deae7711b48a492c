"""A structure as mapped patches and lines, and its meshes: the deck's and the truth's.

Both meshes come from the same maps, so the truth is finer on the same (curved) geometry.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MERGE = 1e-3
"""Points nearer than this [mm] are the same node."""


@dataclass(frozen=True)
class Patch:
    """A surface (u, v) in [0, 1]² → (..., 3) of nu × nv deck elements.

    `hole` says of (u, v) at the middle of a deck element whether there is none.
    """

    group: int
    point: Callable[[Floats, Floats], Floats]
    nu: int
    nv: int
    hole: Callable[[float, float], bool] = lambda u, v: False


@dataclass(frozen=True)
class Line:
    """A line t in [0, 1] → (..., 3) of n deck bars; `plane` is the vector of bending plane 1."""

    group: int
    point: Callable[[Floats], Floats]
    n: int
    plane: tuple[float, float, float]
    name: str = ""


@dataclass(frozen=True)
class Bar:
    """A rectangular section, `height` along bending plane 1 [mm]."""

    height: float
    width: float

    @property
    def area(self) -> float:
        """Return the area [mm²]."""
        return self.height * self.width

    @property
    def i1(self) -> float:
        """Return the second moment for bending in plane 1 [mm⁴]."""
        return self.width * self.height**3 / 12.0

    @property
    def i2(self) -> float:
        """Return the second moment for bending in plane 2 [mm⁴]."""
        return self.height * self.width**3 / 12.0

    @property
    def torsion(self) -> float:
        """St Venant constant with the warping ψ = c·y·z of one quadratic solid (mean with none)."""
        a, b = self.i1, self.i2
        return 0.5 * (a + b + 4.0 * a * b / (a + b))


@dataclass(frozen=True)
class Material:
    """Isotropic material in N/mm² and t/mm³."""

    young: float
    poisson: float
    density: float


@dataclass(frozen=True)
class Structure:
    """What is tested: geometry, properties and support.

    `clamped` says of points (n, 3) which are held; `axes` are the measured directions ("normal"
    to the surface, or letters of "xyz"); `wording` names the scalable properties
    for the truth file; `turned` where the places of the sensors tell how they
    are turned, so that the test may come in a frame of its own; `refine`
    is how many times finer the mesh of the truth is, its elements quadratic besides.
    """

    name: str
    title: str
    size: float
    material: Material
    shells: dict[int, float]
    bars: dict[int, Bar]
    patches: tuple[Patch, ...]
    lines: tuple[Line, ...]
    modes: int
    clamped: Callable[[Floats], NDArray[np.bool_]] | None = None
    axes: str = "normal"
    sensors: tuple[int, int] = (30, 50)
    turned: bool = False
    refine: int = 2
    wording: dict[int, str] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes [mm] and connectivity (0-based); quads (n, 4 or 8), bars (n, 2 or 3), mid node last."""

    xyz: Floats
    quads: Ints
    quad_group: Ints
    bars: Ints
    bar_group: Ints
    bar_line: Ints
    plane: Floats
    clamped: Ints

    @property
    def corners(self) -> Ints:
        """Nodes that are a corner of some element, ascending."""
        ends = self.bars[:, :2] if self.bars.size else self.bars
        return np.asarray(np.unique(np.concatenate([self.quads[:, :4].ravel(), ends.ravel()])))

    @property
    def used(self) -> Ints:
        """Nodes of any element, ascending."""
        return np.asarray(np.unique(np.concatenate([self.quads.ravel(), self.bars.ravel()])))

    def normals(self) -> Floats:
        """Mean unit normal at every node (zero where no shell is)."""
        p = self.xyz[self.quads[:, :4]]
        n = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
        out = np.zeros_like(self.xyz)
        np.add.at(out, self.quads.ravel(), np.repeat(n, self.quads.shape[1], axis=0))
        length = np.linalg.norm(out, axis=1)
        return np.divide(out, length[:, None], out=np.zeros_like(out), where=length[:, None] > 0)


def mesh(s: Structure, refine: int, quadratic: bool) -> Mesh:
    """Mesh a structure `refine` times as fine as its deck, with or without mid-side nodes."""
    points: list[Floats] = []
    quads, quad_group, bars, bar_group, bar_line, plane = [], [], [], [], [], []
    count = 0
    for patch in s.patches:
        nu, nv = patch.nu * refine, patch.nv * refine
        u, v = np.meshgrid(np.arange(2 * nu + 1), np.arange(2 * nv + 1), indexing="ij")
        points.append(patch.point(u / (2.0 * nu), v / (2.0 * nv)).reshape(-1, 3))
        i, j = (a.ravel() for a in np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij"))
        keep = np.array(
            [
                not patch.hole((a // refine + 0.5) / patch.nu, (b // refine + 0.5) / patch.nv)
                for a, b in zip(i, j, strict=True)
            ]
        )
        i, j = 2 * i[keep], 2 * j[keep]
        around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
        quads.append(count + np.stack([(i + a) * (2 * nv + 1) + j + b for a, b in around], axis=1))
        quad_group.append(np.full(i.size, patch.group))
        count += points[-1].shape[0]
    for k, line in enumerate(s.lines):
        n = line.n * refine
        points.append(line.point(np.arange(2 * n + 1) / (2.0 * n)))
        i = count + 2 * np.arange(n)
        bars.append(np.stack([i, i + 2, i + 1], axis=1))
        bar_group.append(np.full(n, line.group))
        bar_line.append(np.full(n, k))
        plane.append(np.tile(np.array(line.plane, dtype=float), (n, 1)))
        count += points[-1].shape[0]
    none = [np.zeros((0, 8), int)], [np.zeros((0, 3), int)], [np.zeros(0, int)]
    q, b = np.concatenate(quads or none[0]), np.concatenate(bars or none[1])
    if not quadratic:
        q, b = q[:, :4], b[:, :2]
    xyz = np.concatenate(points)
    key = np.round(xyz / MERGE).astype(np.int64)
    _, first, same = np.unique(key, axis=0, return_index=True, return_inverse=True)
    same = same.ravel()
    q, b = first[same[q]], first[same[b]]
    used = np.unique(np.concatenate([q.ravel(), b.ravel()]))
    number = np.full(xyz.shape[0], -1)
    number[used] = np.arange(used.size)
    nodes = xyz[used]
    held = s.clamped(nodes) if s.clamped is not None else np.zeros(used.size, bool)
    return Mesh(
        nodes,
        number[q],
        np.concatenate(quad_group or none[2]),
        number[b],
        np.concatenate(bar_group or none[2]),
        np.concatenate(bar_line or none[2]),
        np.concatenate(plane) if plane else np.zeros((0, 3)),
        np.flatnonzero(held),
    )
