"""Where points lie on a model: the nearest facet and the foot on it."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, Ints
from ..noun import Noun
from .outer_surface import LINE, POINT, QUAD, TRIA, Surface, shape_functions
from .placement_numbers import PLACEMENT


@dataclass(frozen=True, eq=False)
class Placement(Noun):
    """The foot of each point on a surface.

    Parameters
    ----------
    points : (n, 3) float
        What was placed.
    facet : (n,) int
        Row of the surface's facets.
    kind : (n,) int
        Shape of that facet.
    corners : (n, 4) int
        Its corner grids, rows of the surface's `xyz`, the last repeated.
    s, t : (n,) float
        Natural coordinates of the foot in 0..1 (see `shape_functions`).
    foot : (n, 3) float
        Nearest point of the facet.
    normal : (n, 3) float
        Unit normal of a face at the foot, unit direction of a line, zero for a point.
    distance : (n,) float
        From the point to its foot.
    """

    points: Floats
    facet: Ints
    kind: Ints
    corners: Ints
    s: Floats
    t: Floats
    foot: Floats
    normal: Floats
    distance: Floats

    def __len__(self) -> int:
        return len(self.facet)


def place(
    surface: Surface, points: Floats, reach: float | None = None, own: Ints | None = None
) -> Placement:
    """Find the nearest point of the surface for every point.

    The search is exact within `reach`: all facets that could hold a nearer point than the
    nearest grid are looked at, by the radius of their enclosing sphere. A point farther from the
    surface than `reach` gets a facet of its nearest grid's neighbourhood, which need not be the
    nearest one, with the true distance to it.

    Parameters
    ----------
    surface : Surface
        From `surface_of`.
    points : (n, 3) float
        In the frame and unit of the surface.
    reach : float, optional
        Default: a tenth of the size of the surface.
    own : (n,) int, optional
        Row of the grid that is meant where facets of several are as near, -1 for none.
    """
    points = np.asarray(points, np.float64).reshape(-1, 3)
    reach = PLACEMENT.reach * surface.size if reach is None else reach
    bound = surface.nearest_grid(points)[1]
    rows, facets = _candidates(surface, points, bound, reach)
    s, t, distance = _feet(surface, points[rows], facets)
    step = PLACEMENT.tied * surface.size if surface.size > 0 else 1.0
    tied = np.round(distance / step)  # so that a face wins over the line on its edge
    own = np.full(len(points), -1) if own is None else own
    meant = (surface.corners[facets] == own[rows, None]).any(axis=1)
    order = np.lexsort((-surface.kind[facets], ~meant, tied, rows))
    first = order[np.unique(rows[order], return_index=True)[1]]
    facets, s, t = facets[first], s[first], t[first]
    s, t = _on_warped_quads(surface, points, facets, s, t)
    kind, corners = surface.kind[facets], surface.corners[facets]
    N, Ns, Nt = shape_functions(kind, s, t)
    p = surface.xyz[corners]
    foot = np.einsum("nc,ncx->nx", N, p)
    normal = surface.directions(facets, Ns, Nt)
    away = np.linalg.norm(points - foot, axis=1)
    return Placement(points, facets, kind, corners, s, t, foot, normal, away)


def _candidates(surface: Surface, points: Floats, bound: Floats, reach: float) -> tuple[Ints, Ints]:
    """Pairs of point and facet that may hold the foot; at least one facet a point."""
    rows, facets = [], []
    share, beside = PLACEMENT.wider
    near = np.minimum(bound, reach) * (1 + share) + beside * surface.size
    for tree, of_level, radius in surface.levels:
        closest = tree.query(points)[1]
        rows.append(np.arange(len(points)))
        facets.append(of_level[closest])
        found = tree.query_ball_point(points, near + radius, return_sorted=False)
        count = np.fromiter(map(len, found), np.int64, len(points))
        rows.append(np.repeat(np.arange(len(points)), count))
        facets.append(of_level[np.concatenate([*found, []]).astype(np.int64)])
    return np.concatenate(rows), np.concatenate(facets)


def _feet(surface: Surface, points: Floats, facets: Ints) -> tuple[Floats, Floats, Floats]:
    """Natural coordinates and distance of the nearest point of each facet, quads as two trias."""
    n = len(facets)
    s, t, distance = np.zeros(n), np.zeros(n), np.empty(n)
    kind = surface.kind[facets]
    p = surface.xyz[surface.corners[facets]]
    q = kind == POINT
    distance[q] = np.linalg.norm(points[q] - p[q, 0], axis=1)
    q = kind == LINE
    s[q], distance[q] = _on_segment(points[q], p[q, 0], p[q, 1])
    q = kind == TRIA
    s[q], t[q], distance[q] = _on_triangle(points[q], p[q, 0], p[q, 1], p[q, 2])
    q = np.flatnonzero(kind == QUAD)
    a, b, d = _on_triangle(points[q], p[q, 0], p[q, 1], p[q, 2])
    e, f, g = _on_triangle(points[q], p[q, 0], p[q, 2], p[q, 3])
    lower = d <= g
    s[q] = np.where(lower, a + b, e)
    t[q] = np.where(lower, b, e + f)
    distance[q] = np.minimum(d, g)
    return s, t, distance


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray(np.einsum("...x,...x->...", a, b))


def _ratio(a: Floats, b: Floats) -> Floats:
    return np.divide(a, b, out=np.zeros_like(a), where=np.abs(b) > 0)


def _on_segment(points: Floats, a: Floats, b: Floats) -> tuple[Floats, Floats]:
    d = b - a
    s = np.clip(_ratio(_dot(points - a, d), _dot(d, d)), 0.0, 1.0)
    return s, np.linalg.norm(a + s[..., None] * d - points, axis=-1)


def _on_triangle(points: Floats, a: Floats, b: Floats, c: Floats) -> tuple[Floats, Floats, Floats]:
    """Nearest point a + s (b-a) + t (c-a): inside, or else the best of the three edges."""
    u, v, w = b - a, c - a, points - a
    uu, uv, vv, wu, wv = _dot(u, u), _dot(u, v), _dot(v, v), _dot(w, u), _dot(w, v)
    det = uu * vv - uv * uv
    sound = det > PLACEMENT.slender * uu * vv
    s = _ratio(vv * wu - uv * wv, np.where(sound, det, 0.0))
    t = _ratio(uu * wv - uv * wu, np.where(sound, det, 0.0))
    inside = sound & (s >= 0) & (t >= 0) & (s + t <= 1)
    e1, d1 = _on_segment(points, a, b)
    e2, d2 = _on_segment(points, a, c)
    e3, d3 = _on_segment(points, b, c)
    best = np.argmin(np.stack([d1, d2, d3]), axis=0)
    zero = np.zeros_like(e1)
    s = np.where(inside, s, np.choose(best, [e1, zero, 1 - e3]))
    t = np.where(inside, t, np.choose(best, [zero, e2, e3]))
    foot = a + s[..., None] * u + t[..., None] * v
    return s, t, np.linalg.norm(foot - points, axis=-1)


def _on_warped_quads(
    surface: Surface, points: Floats, facets: Ints, s: Floats, t: Floats
) -> tuple[Floats, Floats]:
    """Move the feet on quads from the two trias to the bilinear surface.

    Gauss-Newton steps held to the quad, or where they do not help, the exact minimum along s and
    then along t (the surface is ruled both ways); a step is taken only where it comes nearer.
    """
    quads = np.flatnonzero(surface.kind[facets] == QUAD)
    a, b, c, d = np.moveaxis(surface.xyz[surface.corners[facets[quads]]], 1, 0)
    skew = a - b + c - d  # zero for a parallelogram, which is its two trias: nothing to do
    warped = _dot(skew, skew) > PLACEMENT.warped * _dot(c - a, c - a)
    quads, a, b, c, d = quads[warped], a[warped], b[warped], c[warped], d[warped]
    if not len(quads):
        return s, t
    p = points[quads]
    x, y = s[quads], t[quads]
    away = np.linalg.norm(p - _bilinear(a, b, c, d, x, y), axis=1)
    for _ in range(PLACEMENT.rounds):
        for start in (_gauss_newton(p, a, b, c, d, x, y), y):
            u = _on_segment(p, *_ruling(a, b, c, d, start))[0]
            v, distance = _on_segment(p, *_ruling(a, d, c, b, u))
            better = distance < away
            x, y = np.where(better, u, x), np.where(better, v, y)
            away = np.where(better, distance, away)
    s, t = s.copy(), t.copy()
    s[quads], t[quads] = x, y
    return s, t


def _gauss_newton(
    p: Floats, a: Floats, b: Floats, c: Floats, d: Floats, x: Floats, y: Floats
) -> Floats:
    """Return t after one step of least squares for the foot of p, held to 0..1."""
    gs: Floats = b - a + (a - b + c - d) * y[:, None]
    gt: Floats = d - a + (a - b + c - d) * x[:, None]
    r = p - _bilinear(a, b, c, d, x, y)
    ss, st, tt, rs, rt = _dot(gs, gs), _dot(gs, gt), _dot(gt, gt), _dot(r, gs), _dot(r, gt)
    det = ss * tt - st * st
    det = np.where(det > PLACEMENT.slender * ss * tt, det, 0.0)
    return np.clip(y + _ratio(ss * rt - st * rs, det), 0.0, 1.0)


def _bilinear(a: Floats, b: Floats, c: Floats, d: Floats, x: Floats, y: Floats) -> Floats:
    low, high = _ruling(a, b, c, d, y)
    return low + x[:, None] * (high - low)


def _ruling(a: Floats, b: Floats, c: Floats, d: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Both ends of the line of the surface at y: from side a-d to side b-c."""
    y = y[:, None]
    return a * (1 - y) + d * y, b * (1 - y) + c * y
