"""Modes of bodies of revolution by Fourier: the harmonic round the axis, and where it lies.

Schedlinski, Staples: the source paper's route for circumferential sensors, equally spaced or not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats, Ints, Numbers, frozen
from ..noun import Noun
from .correlation_numbers import CORRELATION
from .mac import realised


@dataclass(frozen=True, eq=False)
class Rings(Noun):
    """Sensors that stand round an axis.

    Parameters
    ----------
    origin, direction : (3,) float
        The axis; the largest component of its direction is positive.
    angle : (n_sensor,) float
        Round the axis by the right hand [rad], from the basic axis that follows in turn: of an
        axis along x from y, along y from z, along z from x.
    group : (n_sensor,) int
        Sensors of one ring that look in one way, radially, tangentially or along the axis; -1
        what stands on none or looks askew.
    tangential : (n_sensor,) bool
    sign : (n_sensor,) float
        -1 where a sensor looks inwards, or against angle or axis.
    """

    origin: Floats
    direction: Floats
    angle: Floats
    group: Ints
    tangential: Bools
    sign: Floats


@dataclass(frozen=True)
class Harmonic:
    """What a shape is round the axis.

    `number` waves; `orientation_deg` of a crest of the motion (radial and axial), from 0 up to
    half a wave, None of harmonic 0; `share` of this harmonic in the power round the axis;
    `highest` harmonic that the sensors tell from others: those above look like lower ones.
    """

    number: int
    orientation_deg: float | None
    share: float
    highest: int

    def __str__(self) -> str:
        where = "" if self.orientation_deg is None else f", {self.orientation_deg:.1f}°"
        return f"n = {self.number}{where}"


def find_rings(cloud: Floats, xyz: Floats, axes: Floats) -> Rings | None:
    """Find the axis that sensors stand round, if most of them do.

    Parameters
    ----------
    cloud : (n_grid, 3) float
        Positions of the model, whose principal axes are tried besides the basic ones.
    xyz, axes : (n_sensor, 3) float
        Where the sensors are and where they look, in the same frame.
    """
    if not len(xyz) or not len(cloud):
        return None
    centred = cloud - cloud.mean(axis=0)
    own = np.linalg.svd(centred.T @ centred)[2]
    found = [_rings_about(d, cloud, xyz, axes) for d in (*np.eye(3), *own)]
    best = max(found, key=lambda r: -1 if r is None else int(np.count_nonzero(r.group >= 0)))
    if best is None or np.mean(best.group >= 0) < CORRELATION.in_rings:
        return None
    return best


def _rings_about(direction: Floats, cloud: Floats, xyz: Floats, axes: Floats) -> Rings | None:
    main = int(np.argmax(np.abs(direction)))
    d = direction * np.sign(direction[main])
    first = np.eye(3)[(main + 1) % 3]
    first = first - d * (d @ first)
    first /= np.linalg.norm(first)
    second = np.cross(d, first)
    size = float(np.linalg.norm(np.ptp(xyz, axis=0))) or 1.0
    near = CORRELATION.ring * size
    station = _clustered(xyz @ d, near)
    plane = np.column_stack([first, second])
    flat = xyz @ plane
    centre = _centre([flat[station == k] for k in range(station.max(initial=-1) + 1)], near)
    centre = _middle(cloud @ plane) if centre is None else centre
    if centre is None:
        return None
    out = flat - centre
    radius, angle = np.hypot(*out.T), np.arctan2(out[:, 1], out[:, 0])
    ring = _numbered(np.column_stack([station, _clustered(radius, near)]))
    radial = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * second
    ways = np.stack([radial, np.cross(d, radial), np.broadcast_to(d, radial.shape)])
    along = np.einsum("wsx,sx->sw", ways, axes)
    way = np.argmax(np.abs(along), axis=1)
    group = _numbered(np.column_stack([ring, way]))
    own = along[np.arange(len(way)), way]
    many = np.array([_distinct(angle[rows]) for rows in _members(group)])
    kept = (
        (np.abs(own) >= CORRELATION.straight)
        & (radius > near)
        & (many[group] >= CORRELATION.ring_points)
    )
    origin = centre[0] * first + centre[1] * second
    kept_group = np.where(kept, group, -1)
    return Rings(frozen(origin), frozen(d), frozen(angle), kept_group, way == 1, np.sign(own))


def harmonics(rings: Rings, shapes: Numbers) -> tuple[Harmonic | None, ...]:
    """Say of each shape which harmonic it is, None where none has most of its power.

    Waves of each number are fitted to all groups of sensors by least squares, each with an
    amplitude and a phase of its own: for equal spacing the discrete Fourier transform, else the
    periodogram of Lomb (1976, Astrophys. Space Sci. 39, 447).

    Parameters
    ----------
    rings : Rings
    shapes : (n_sensor, n_mode) float or complex
    """
    values = realised(shapes) * rings.sign[:, None]
    groups = [rows for rows in _members(rings.group) if rings.group[rows[0]] >= 0]
    whole = np.sum(values[rings.group >= 0] ** 2, axis=0)
    bases = _told_apart([rings.angle[rows] for rows in groups])
    power = np.array(
        [
            sum(
                np.sum((b.T @ values[rows]) ** 2, axis=0)
                for b, rows in zip(of, groups, strict=True)
            )
            for of in bases
        ]
    )
    share = np.divide(power, whole, out=np.zeros_like(power), where=whole > 0.0)
    found: list[Harmonic | None] = []
    for k, n in enumerate(np.argmax(share, axis=0)):
        named = share[n, k] >= CORRELATION.harmonic
        crest = _crest(rings, groups, values[:, k], int(n)) if named and n else None
        said = Harmonic(int(n), crest, float(share[n, k]), len(bases) - 1)
        found.append(said if named else None)
    return tuple(found)


def _told_apart(angles: list[Floats]) -> list[list[Floats]]:
    """Orthonormal waves of each number in each group, up to the first that looks like a lower."""
    known: list[list[Floats]] = []
    most = max((_distinct(a) for a in angles), default=0)
    for n in range(min(most, CORRELATION.harmonics + 1)):
        of = [_orthonormal(_waves(n, a)) for a in angles]
        if n and all(b.shape[1] == 1 for b in of):
            break
        for lower in known:
            cosines = sum(float(np.sum((a.T @ b) ** 2)) for a, b in zip(of, lower, strict=True))
            if cosines > CORRELATION.told_apart * sum(b.shape[1] for b in lower):
                return known
        known.append(of)
    return known


def _waves(n: int, angle: Floats) -> Floats:
    columns = [np.cos(n * angle), np.sin(n * angle)] if n else [np.ones_like(angle)]
    return np.column_stack(columns)


def _orthonormal(columns: Floats) -> Floats:
    u, s, _ = np.linalg.svd(columns, full_matrices=False)
    return np.asarray(u[:, s > CORRELATION.dependent * s[0]])


def _crest(rings: Rings, groups: list[Ints], values: Floats, n: int) -> float:
    """Where a crest is [degrees]; groups count by their power."""
    total = 0.0 + 0.0j
    for rows in groups:
        a, b = np.linalg.lstsq(_waves(n, rings.angle[rows]), values[rows], rcond=None)[0]
        c = complex(a, -b) * (1j if rings.tangential[rows[0]] else 1.0)
        total += c**2 * len(rows)
    crest = np.round(-0.5 * np.angle(total) / n, CORRELATION.angle_digits)
    return float(np.degrees(crest % (np.pi / n)))


def _centre(stations: list[Floats], near: float) -> Floats | None:
    """Return the middle of the circles on which sensors of each station stand, if they do."""
    many = [
        p for p in stations if len(np.unique(np.round(p / near), axis=0)) >= CORRELATION.ring_points
    ]
    circles = [_circle(p) for p in many]
    round_ = [c[:2] for c in circles if c[2] <= near]
    return np.median(round_, axis=0) if round_ else None


def _middle(flat: Floats) -> Floats | None:
    """Return the middle of a model that is round, seen along the axis."""
    middle = (flat.min(axis=0) + flat.max(axis=0)) / 2.0
    out = flat - middle
    radius, angle = np.hypot(*out.T), np.arctan2(out[:, 1], out[:, 0])
    sector = np.floor((angle / np.pi + 1.0) * CORRELATION.sectors / 2.0).astype(int)
    rim = [radius[sector == k].max(initial=0.0) for k in range(CORRELATION.sectors)]
    return middle if min(rim) >= CORRELATION.round * max(rim) else None


def _circle(points: Floats) -> tuple[float, float, float]:
    """Centre of the circle through points (n, 2), and how far the worst is off it (Kåsa 1976)."""
    A = np.column_stack([2.0 * points, np.ones(len(points))])
    x, y, c = np.linalg.lstsq(A, np.sum(points**2, axis=1), rcond=None)[0]
    radius = np.sqrt(max(c + x**2 + y**2, 0.0))
    off = np.abs(np.hypot(points[:, 0] - x, points[:, 1] - y) - radius)
    return float(x), float(y), float(off.max())


def _distinct(angle: Floats) -> int:
    """How many different directions there are."""
    return len(np.unique(np.round(np.exp(1j * angle), CORRELATION.angle_digits)))


def _clustered(values: Floats, near: float) -> Ints:
    """Return numbers of clusters of values that are more than `near` apart, (n,)."""
    order = np.argsort(values, kind="stable")
    number = np.concatenate([[0], np.cumsum(np.diff(values[order]) > near)])[: len(values)]
    out = np.empty(len(values), np.int64)
    out[order] = number
    return out


def _members(group: Ints) -> list[Ints]:
    """Return the rows of each group, by rising number."""
    order = np.argsort(group, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(group[order])) + 1) if len(group) else []


def _numbered(rows: Ints) -> Ints:
    return np.asarray(np.unique(rows, axis=0, return_inverse=True)[1], np.int64).reshape(-1)
