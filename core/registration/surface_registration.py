"""Rigid moves that lay points on a surface: registration from many starts."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ..arrays import Floats, Ints
from ..sensors.closest_point import place
from ..sensors.outer_surface import LINE, TRIA, Surface, shape_functions
from .poses import Poses, centre_and_radius, jacobian, move
from .registration_numbers import ALIGN


@dataclass(frozen=True, eq=False)
class Cloud:
    """Points sampled on a surface with the directions in which it does not extend."""

    surface: Surface
    points: Floats
    direction: Floats
    kind: Ints
    tree: cKDTree
    spacing: float

    def rms(self, rotation: Floats, translation: Floats, points: Floats) -> Floats:
        """Return about the capped rms distance of each pose, (k,)."""
        moved = Poses(rotation, translation, np.zeros(len(rotation))).apply(points)
        distance = self.tree.query(moved.reshape(-1, 3))[0].reshape(moved.shape[:2])
        return capped_rms(distance, self.surface)


def cloud_of(surface: Surface) -> Cloud:
    """Sample a surface for a coarse search."""
    points, facets = surface.samples(ALIGN.cloud)
    kind = surface.kind[facets]
    half = np.full(len(kind), 0.5)
    direction = surface.directions(facets, *shape_functions(kind, half, half)[1:])
    tree = cKDTree(points)
    spacing = float(np.median(tree.query(points[:: ALIGN.every], k=2)[0][:, 1]))
    return Cloud(surface, points, direction, kind, tree, spacing)


def capped_rms(distance: Floats, surface: Surface) -> Floats:
    """Root mean square of distances (k, n) held to `cap` of the surface's size, (k,)."""
    return np.asarray(np.sqrt(np.mean(np.minimum(distance, ALIGN.cap * surface.size) ** 2, axis=1)))


def rms_of(surface: Surface, points: Floats, poses: Poses) -> Floats:
    """Return the capped rms distance of points (n, 3) moved by each pose, (k,)."""
    x = poses.apply(points)
    at = place(surface, x.reshape(-1, 3), reach=2 * ALIGN.cap * surface.size)
    return capped_rms(at.distance.reshape(x.shape[:2]), surface)


def search(cloud: Cloud, points: Floats, seed: int = 0, keep: int = ALIGN.keep) -> Poses:
    """Find the poses that lay points (n, 3) on a surface, best first; `keep` of them are polished.

    Starts: the principal axes of points and surface in their 24 right-handed orders, and
    uniformly random rotations, each with the points' centre at the surface's centre, its box's
    centre and random places on it. A coarse iterated fit to sampled points (Chen and Medioni,
    1992, with weights that ignore outliers) thins them out, `polish` finishes.
    """
    few = points[farthest_points(points, ALIGN.points)]
    R, t = _starts(cloud, points, np.random.default_rng(seed))
    rounds = [(len(R) // part, softness) for part, softness in ALIGN.coarser]
    for count, softness in (*rounds, (keep, ALIGN.softest)):
        if count < len(R):
            order = np.argsort(cloud.rms(R, t, few), kind="stable")
            if count == keep:
                order = _apart_first(cloud.surface, Poses(R, t, np.zeros(len(R))), few, order)
            best = order[: max(count, keep)]
            R, t = R[best], t[best]
        for _ in range(ALIGN.coarse_steps):
            R, t = _coarse_step(cloud, R, t, few, softness)
    poses = polish(cloud.surface, points, R, t)
    return poses.take(np.argsort(poses.rms, kind="stable"))


def _apart_first(surface: Surface, poses: Poses, points: Floats, order: Ints) -> Ints:
    """Put those of `order`, best first, that lay points (n, 3) where a better one does last.

    Many starts end in one position, and a symmetric structure has others that fit as well: by a
    hair on the few points and the samples that thin them out, and shapes would tell them apart.
    """
    x = poses.take(order).apply(points)
    near = ALIGN.free * surface.size
    first = np.ones(len(x), bool)
    for k in range(len(x)):
        if first[k]:
            away = np.sqrt(np.mean(np.sum((x[k + 1 :] - x[k]) ** 2, axis=2), axis=1))
            first[k + 1 :] &= away > near
    return np.concatenate([order[first], order[~first]])


def _starts(cloud: Cloud, points: Floats, rng: np.random.Generator) -> tuple[Floats, Floats]:
    cube = Rotation.create_group("O").as_matrix()
    base = principal_axes(cloud.points) @ cube @ principal_axes(points).T
    state = np.random.RandomState(rng.integers(2**31))
    random = Rotation.random(ALIGN.starts, random_state=state)
    R = np.concatenate([base, random.as_matrix()])
    box, middle = cloud.surface.extent.mean(axis=0), (points.min(axis=0) + points.max(axis=0)) / 2
    where = cloud.points[rng.integers(len(cloud.points), size=len(R))]
    anchors = np.stack(
        [np.broadcast_to(a, where.shape) for a in (cloud.points.mean(axis=0), box, where)]
    )
    centres = np.stack([points.mean(axis=0), middle, points.mean(axis=0)])
    t = anchors - np.einsum("kij,mj->mki", R, centres)
    return np.tile(R, (3, 1, 1)), t.reshape(-1, 3)


def principal_axes(points: Floats) -> Floats:
    """Right-handed principal axes of a cloud of points as columns, (3, 3); any of a single one."""
    if len(points) < 2:
        return np.eye(3)
    axes = np.linalg.eigh(np.cov(points, rowvar=False))[1]
    axes[:, 2] *= np.linalg.det(axes)
    return np.asarray(axes)


def farthest_points(points: Floats, count: int) -> Ints:
    """Rows of `count` points spread as far as can be (Gonzalez, 1985)."""
    if len(points) <= count:
        return np.arange(len(points))
    chosen = [int(np.argmax(np.linalg.norm(points - points.mean(axis=0), axis=1)))]
    distance = np.linalg.norm(points - points[chosen[0]], axis=1)
    while len(chosen) < count:
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return np.array(chosen)


def _coarse_step(
    cloud: Cloud, R: Floats, t: Floats, points: Floats, softness: float
) -> tuple[Floats, Floats]:
    x = np.einsum("kij,nj->kni", R, points) + t[:, None]
    distance, found = cloud.tree.query(x.reshape(-1, 3))
    found = found.reshape(x.shape[:2])
    W = normal_space(
        x - cloud.points[found], cloud.direction[found], cloud.kind[found], cloud.spacing
    )
    W = W + softness * np.eye(3)
    weight = robust_weights(distance.reshape(x.shape[:2]), cloud.spacing)
    return _moved(R, t, x, x - cloud.points[found], W * weight[..., None, None])


def normal_space(r: Floats, direction: Floats, kind: Ints, slack: float) -> Floats:
    """Projectors on the directions that a foot constrains, (..., 3, 3).

    `r` (..., 3) leads from the foot to the point. A face constrains its normal, or beyond its
    border everything but the way along the border; a line everything but its own direction; a
    point everything. `slack` is the distance along the surface that does not count as beyond.
    """
    outer = direction[..., :, None] * direction[..., None, :]
    face = (kind >= TRIA)[..., None, None]
    normal = np.einsum("...x,...x->...", r, direction)[..., None] * direction
    across = r - normal
    beyond = np.linalg.norm(across, axis=-1)
    beyond_face = beyond > np.maximum(slack, ALIGN.beyond * np.linalg.norm(r, axis=-1))
    border = np.cross(direction, across)
    border = border / np.where(beyond > 0, beyond, 1.0)[..., None]
    past_end = np.abs(np.einsum("...x,...x->...", r, direction)) > slack
    along_border = border[..., :, None] * border[..., None, :]
    on_face = np.where(beyond_face[..., None, None], np.eye(3) - along_border, outer)
    open_line = ((kind == LINE) & ~past_end)[..., None, None]
    return np.asarray(np.where(face, on_face, np.eye(3) - np.where(open_line, outer, 0.0)))


def robust_weights(distance: Floats, floor: Floats | float) -> Floats:
    """Geman-McClure weights of distances (k, n), scaled by some times each row's median.

    `floor` is the least scale. Where most points lie on one plane the median is rounding: the
    few that fix the slide along it must not be outliers for that.
    """
    median = np.median(distance, axis=1, keepdims=True)
    scale = np.maximum(ALIGN.outlier * median, floor)
    return np.asarray((1.0 / (1.0 + (distance / scale) ** 2)) ** 2)


def _moved(R: Floats, t: Floats, x: Floats, r: Floats, W: Floats) -> tuple[Floats, Floats]:
    """One damped Gauss-Newton step that shrinks sum r.W.r."""
    centre, radius = centre_and_radius(x)
    J = jacobian(x, centre, radius)
    JW = np.einsum("knxi,knxy->kniy", J, W)
    H = np.einsum("kniy,knyj->kij", JW, J)
    g = np.einsum("kniy,kny->ki", JW, r)
    damping = ALIGN.damping * np.trace(H, axis1=1, axis2=2) / 6 + 1e-300
    step = -np.linalg.solve(H + damping[:, None, None] * np.eye(6), g[..., None])[..., 0]
    return move(R, t, centre, step[:, :3] / radius[:, None], step[:, 3:])


def polish(
    surface: Surface, points: Floats, R: Floats, t: Floats, rounds: int = ALIGN.polish
) -> Poses:
    """Fit poses to the facets themselves until they rest; a step is kept only where it helps."""
    R, t = R.copy(), t.copy()
    best = Poses(R, t, np.full(len(R), np.inf))
    cost = np.full(len(R), np.inf)
    active = np.arange(len(R))
    share, least = ALIGN.gain
    for _ in range(rounds):
        x = Poses(R[active], t[active], cost[active]).apply(points)
        at = place(surface, x.reshape(-1, 3), reach=2 * ALIGN.cap * surface.size)
        shape = x.shape[:2]
        distance = at.distance.reshape(shape)
        rms = capped_rms(distance, surface)
        gain = cost[active] - rms > share * rms + least * surface.size
        cost[active] = np.minimum(cost[active], rms)
        better = active[gain]
        best.rotation[better], best.translation[better] = R[better], t[better]
        best.rms[better] = rms[gain]
        active = active[gain]
        if not len(active):
            break
        x, distance = x[gain], distance[gain]
        r = x - at.foot.reshape(*shape, 3)[gain]
        normal, kind = at.normal.reshape(*shape, 3)[gain], at.kind.reshape(shape)[gain]
        W = normal_space(r, normal, kind, ALIGN.foot * surface.size)
        weight = robust_weights(distance, np.maximum(rms[gain], ALIGN.near * surface.size)[:, None])
        R[active], t[active] = _moved(R[active], t[active], x, r, W * weight[..., None, None])
    return best
