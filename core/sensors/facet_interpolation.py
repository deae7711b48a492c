"""Displacement and rotation of a placed point from those of the corner grids of its facet."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, Ints, Numbers, skew
from ..noun import Noun
from .closest_point import Placement
from .outer_surface import LINE, POINT, QUAD, TRIA, Surface, shape_functions
from .placement_numbers import PLACEMENT


@dataclass(frozen=True, eq=False)
class Interpolation(Noun):
    """Linear maps from corner motions to the motion of the points.

    With u_i, theta_i the displacement and rotation of corner i, the point moves by
    ``u = sum_i uu[:, i] @ u_i + ut[:, i] @ theta_i`` and turns by
    ``theta = sum_i tu[:, i] @ u_i + tt[:, i] @ theta_i``; all four are (n, 4, 3, 3).
    """

    uu: Floats
    ut: Floats
    tu: Floats
    tt: Floats


def interpolate(surface: Surface, placement: Placement, rotating: Numbers) -> Interpolation:
    """Make the maps from corner motions to the motions of placed points.

    Faces: bilinear shape functions, and where the grids carry rotations the linked
    interpolation of plates, w = sum N_i w_i + sum over edges of a bubble times
    l/2 (w'_i - w'_j) (Zienkiewicz, Xu, Zeng, Samuelsson, Wiberg, 1993; Auricchio and Taylor,
    1994), which is exact for constant curvature: a sensor at the middle of a coarse element
    loses nothing. It is made of slopes' differences only, so transverse shear does not spoil
    it. Lines: Hermite cubics. Faces of solids: bilinear.

    A point off its facet by r moves by theta x r in addition. On shells theta comes from the
    grids' rotations, except about the normal, where it is half the curl of the membrane motion;
    without rotations all of theta comes from the displacements of the facet. Every rigid-body
    motion is reproduced exactly (on a line or a point without rotations, all but the turn that
    its displacements do not show).

    Parameters
    ----------
    surface : Surface
    placement : Placement
        Of n points.
    rotating : (n_grid,) bool
        Grids whose rotations can be used.
    """
    xyz = surface.xyz[placement.corners]
    real = np.arange(4) < placement.kind[:, None]
    turning = ((rotating[placement.corners] | ~real).all(axis=1)) & ~surface.solid[placement.facet]
    N, Ns, Nt = shape_functions(placement.kind, placement.s, placement.t)
    tu, tt = _turns(placement, xyz, N, Ns, Nt, turning)
    lever = -skew(placement.points - placement.foot)[:, None]
    uu = N[:, :, None, None] * np.eye(3) + lever @ tu
    ut = lever @ tt
    _add_faces(placement, xyz, turning, ut)
    _add_lines(placement, xyz, turning, uu, ut)
    return Interpolation(uu, ut, tu, tt)


def _outer(a: Floats, b: Floats) -> Floats:
    return a[..., :, None] * b[..., None, :]


def _turns(
    at: Placement, xyz: Floats, N: Floats, Ns: Floats, Nt: Floats, turning: Numbers
) -> tuple[Floats, Floats]:
    """Rotation of the facet at the foot: maps from displacements and from rotations."""
    n = at.normal[:, None]
    tu = np.zeros((len(at), 4, 3, 3))
    tt = np.zeros((len(at), 4, 3, 3))
    own = turning[:, None, None, None] * N[:, :, None, None] * np.eye(3)
    face, line, point = at.kind >= TRIA, at.kind == LINE, at.kind == POINT
    # Faces: half the curl about the normal; the slopes of n.u about the tangents without rotations.
    D = _surface_gradients(xyz, Ns, Nt, at.kind)
    curl = 0.5 * _outer(np.broadcast_to(n, D.shape), np.cross(n, D))
    slope = _outer(np.cross(D, n), np.broadcast_to(n, D.shape))
    flat = np.eye(3) - _outer(n, n)
    tu[face] = curl[face] + np.where(turning[face, None, None, None], 0.0, slope[face])
    tt[face] = (flat @ own)[face]
    # Lines: the grids' rotations, or the turn of the line itself.
    d = xyz[:, 1] - xyz[:, 0]
    length2 = np.einsum("nx,nx->n", d, d)
    turn = skew(np.divide(d, length2[:, None], out=np.zeros_like(d), where=length2[:, None] > 0))
    bare = line & ~turning
    tu[bare, 0], tu[bare, 1] = -turn[bare], turn[bare]
    tt[line | point] = own[line | point]
    return tu, tt


def _surface_gradients(xyz: Floats, Ns: Floats, Nt: Floats, kind: Ints) -> Floats:
    """Gradients of the shape functions along the surface, (n, 4, 3); zero on lines and points."""
    gs = np.einsum("nc,ncx->nx", Ns, xyz)
    gt = np.einsum("nc,ncx->nx", Nt, xyz)
    ss, st, tt = (np.einsum("nx,nx->n", a, b) for a, b in ((gs, gs), (gs, gt), (gt, gt)))
    det = ss * tt - st * st
    sound = (kind >= TRIA) & (det > PLACEMENT.slender * ss * tt) & (det > 0)
    inverse = np.divide(1.0, det, out=np.zeros_like(det), where=sound)
    dual_s = (tt[:, None] * gs - st[:, None] * gt) * inverse[:, None]
    dual_t = (ss[:, None] * gt - st[:, None] * gs) * inverse[:, None]
    return np.asarray(Ns[:, :, None] * dual_s[:, None] + Nt[:, :, None] * dual_t[:, None])


def _add_faces(at: Placement, xyz: Floats, turning: Numbers, ut: Floats) -> None:
    """Add the edge bubbles of linked interpolation to `ut`."""
    s, t = at.s, at.t
    bubbles = {
        QUAD: (s * (1 - s) * (1 - t), t * (1 - t) * s, s * (1 - s) * t, t * (1 - t) * (1 - s)),
        TRIA: ((1 - s - t) * s, s * t, t * (1 - s - t)),
    }
    for kind, weights in bubbles.items():
        rows = np.flatnonzero((at.kind == kind) & turning)
        n = at.normal[rows]
        for i, weight in enumerate(weights):
            j = (i + 1) % kind
            side = np.cross(xyz[rows, j] - xyz[rows, i], n)
            term = 0.5 * weight[rows, None, None] * _outer(n, side)
            ut[rows, i] += term
            ut[rows, j] -= term


def _add_lines(at: Placement, xyz: Floats, turning: Numbers, uu: Floats, ut: Floats) -> None:
    """Add what makes a line's linear interpolation a Hermite cubic to `uu` and `ut`."""
    rows = np.flatnonzero((at.kind == LINE) & turning)
    s = at.s[rows, None, None]
    e = at.normal[rows]
    across = np.eye(3) - _outer(e, e)
    slope = -skew(xyz[rows, 1] - xyz[rows, 0])
    ut[rows, 0] += s * (1 - s) ** 2 * slope
    ut[rows, 1] -= s**2 * (1 - s) * slope
    odd = s * (1 - s) * (1 - 2 * s) * across
    uu[rows, 0] += odd
    uu[rows, 1] -= odd
