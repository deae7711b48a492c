"""Ways in which a structure's shape is not the one drawn.

Displacements of its nodes that are polynomials of the position along its own axes: of the first
degree it is longer, leaning or, in a round section, oval; of the second bowed, dished, twisted,
tapered, or of three lobes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...arrays import Floats
from ..reduction.own_axes import own_axes
from .model_error_numbers import MODEL_ERROR

_TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True, eq=False)
class Shape:
    """One way.

    Parameters
    ----------
    name, reverse : str
        What a structure is that is off by it, as ``bowed along x``, and by its reverse.
    family : str
        Those of one are one way in several directions.
    by : (n, 3) float
        Displacement of each node by an amplitude of 1, basic axes.
    """

    name: str
    reverse: str
    family: str
    by: Floats


@dataclass(frozen=True, eq=False)
class _Places:
    """Positions along the own axes: from -1 to 1, as they are; axes that have a width, a length."""

    axes: Floats
    unit: Floats
    x: Floats
    wide: tuple[int, ...]
    long: tuple[int, ...]

    def along(self, axis: int, how_far: Floats) -> Floats:
        """Return a displacement along one axis, (n, 3)."""
        return np.asarray(np.outer(how_far, self.axes[axis]))

    def across(self, p: int, q: int, a: Floats, b: Floats) -> Floats:
        """Return a displacement in the plane of two axes, 1 where it is largest."""
        u = self.along(p, a) + self.along(q, b)
        return u / max(float(np.linalg.norm(u, axis=1).max()), _TINY)

    def word(self, axis: int) -> str:
        """Return what an axis is called."""
        a = self.axes[axis]
        k = int(np.argmax(np.abs(a)))
        if abs(a[k]) > MODEL_ERROR.basic:
            return "xyz"[k]
        return f"({', '.join(f'{x:.1f}' for x in np.round(a, 1) + 0.0)})"


def shapes_of(xyz: Floats) -> tuple[Shape, ...]:
    """Return the ways in which nodes (n, 3) may be elsewhere."""
    axes = own_axes(xyz)
    x = xyz @ axes.T
    x = x - 0.5 * (x.min(axis=0) + x.max(axis=0))
    half = np.abs(x).max(axis=0)
    wide = half > MODEL_ERROR.flat * half.max()
    x, half = np.where(wide, x, 0.0), np.where(wide, half, 1.0)
    long = wide & (half > MODEL_ERROR.short * half.max())
    unit, round_ = x / half, _round_about(x)
    about, x = (None, x) if round_ is None else round_
    at = _Places(axes, unit, x, *(tuple(np.flatnonzero(k).tolist()) for k in (wide, long)))
    every = _straight(at) if about is None else _round(at, about)
    return tuple(s for s in every if _deforms(xyz, s.by))


def _deforms(xyz: Floats, by: Floats) -> bool:
    """Whether nodes (n, 3) do not move as a whole."""
    away = xyz - xyz.mean(axis=0)
    away = away / (np.abs(away).max() or 1.0)
    motions = [np.tile(e, (len(xyz), 1)) for e in np.eye(3)] + [
        np.cross(e, away) for e in np.eye(3)
    ]
    rigid = np.array([u.ravel() for u in motions]).T
    left = by.ravel() - rigid @ np.linalg.lstsq(rigid, by.ravel(), rcond=None)[0]
    return bool(np.linalg.norm(left) > MODEL_ERROR.flat * np.linalg.norm(by))


def _straight(at: _Places) -> Iterator[Shape]:
    """Give what a structure may be that is round about no axis."""
    s, x = at.unit, at.x
    for i in at.wide:
        yield _longer(at, i)
        others = [k for k in at.wide if k != i]
        for j in (k for k in others if k > i):
            plane = at.word(i) + at.word(j)
            for name, u in (
                (f"leaning in the plane {plane}", at.along(j, 0.5 * s[:, i])),
                (f"out of round in the plane {plane}", at.across(i, j, x[:, i], -x[:, j])),
            ):
                yield Shape(name, name, f"in the plane {plane}", u)
        if i in at.long:
            for j in (k for k in range(3) if k != i):
                yield _bowed(at, i, j)
            yield from _along(at, i, others)
    flat = [k for k in range(3) if k not in at.wide]
    if len(flat) == 1:
        i, j = at.wide
        dished = (1.0 - s[:, i] ** 2) * (1.0 - s[:, j] ** 2)
        yield Shape("twisted", "twisted", "twisted", at.along(flat[0], s[:, i] * s[:, j]))
        yield Shape("dished", "dished", "dished", at.along(flat[0], dished))


def _longer(at: _Places, i: int) -> Shape:
    name, reverse = (f"{word} along {at.word(i)}" for word in ("longer", "shorter"))
    return Shape(name, reverse, name, at.along(i, 0.5 * at.unit[:, i]))


def _bowed(at: _Places, i: int, j: int) -> Shape:
    name = f"bowed along {at.word(i)}"
    return Shape(name, name, name, at.along(j, at.unit[:, i] ** 2))


def _along(at: _Places, i: int, others: list[int]) -> Iterator[Shape]:
    """Give what a structure may be along one axis: narrower, or turned, more and more."""
    s, x = 0.5 * at.unit[:, [i]], at.x
    tapered, twisted = f"tapered along {at.word(i)}", f"twisted about {at.word(i)}"
    if len(others) == 1:
        (p,) = others
        yield Shape(tapered, tapered, tapered, s * at.along(p, at.unit[:, p]))
    elif others:
        p, q = others
        yield Shape(tapered, tapered, tapered, s * at.across(p, q, x[:, p], x[:, q]))
        yield Shape(twisted, twisted, twisted, s * at.across(p, q, -x[:, q], x[:, p]))


def _round(at: _Places, about: int) -> Iterator[Shape]:
    """Give what a structure may be that is round about an axis."""
    p, q = (k for k in range(3) if k != about)
    s, x, y = at.unit[:, [about]], at.x[:, p], at.x[:, q]
    oval = at.across(p, q, x, -y), at.across(p, q, y, x)
    lobes = at.across(p, q, x**2 - y**2, -2.0 * x * y), at.across(p, q, 2.0 * x * y, x**2 - y**2)
    r2 = (x**2 + y**2) / np.max(x**2 + y**2)
    yield Shape("wider", "narrower", "wider", at.across(p, q, x, y))
    yield Shape("dished", "dished", "dished", at.along(about, r2))
    turning: list[tuple[str, tuple[Floats, ...]]] = [
        ("out of round", oval),
        ("out of round by three lobes", lobes),
    ]
    if about in at.wide:
        turning.append(("out of round at its ends", (s * oval[0], s * oval[1])))
        turning.append(("leaning", tuple(at.along(k, 0.5 * s[:, 0]) for k in (p, q))))
        yield _longer(at, about)
        yield from (_bowed(at, about, k) for k in (p, q))
        yield from _along(at, about, [p, q])
    else:
        saddles = x**2 - y**2, 2.0 * x * y
        turning.append(("warped", tuple(at.along(about, u / np.abs(u).max()) for u in saddles)))
    for name, both in turning:
        yield from (Shape(name, name, name, u) for u in both)


def _round_about(x: Floats) -> tuple[int, Floats] | None:
    """Return the own axis about which nodes are round and their positions from it, None without.

    Their moments of second and fourth order across it are those of a circle, or they lie on an arc.
    """
    for k in range(3):
        across = [j for j in range(3) if j != k]
        if np.any(np.ptp(x[:, across], axis=0) == 0.0):
            continue
        second = (x[:, across[0]] + 1j * x[:, across[1]]) ** 2
        moments = second, second**2
        apart = (abs(np.sum(w)) / max(float(np.sum(np.abs(w))), _TINY) for w in moments)
        if max(apart) < MODEL_ERROR.round:
            return k, x
        centre = _centre(x[:, across])
        if centre is not None:
            from_it = x.copy()
            from_it[:, across] -= centre
            return k, from_it
    return None


def _centre(xy: Floats) -> Floats | None:
    """Return the centre of the arc that points (n, 2) lie on all along, None where on none."""
    sides = np.column_stack([2.0 * xy, np.ones(len(xy))])
    centre = np.asarray(np.linalg.lstsq(sides, np.sum(xy**2, axis=1), rcond=None)[0][:2])
    z = (xy - centre) @ np.array([1.0, 1j])
    radius = float(np.abs(z).mean())
    gaps = np.sort(np.diff(np.sort(np.angle(z)), append=np.angle(z).min() + 2.0 * np.pi))
    on_it = np.ptp(np.abs(z)) < MODEL_ERROR.round * radius and radius < np.ptp(xy, axis=0).max()
    return centre if on_it and gaps[-2] < MODEL_ERROR.arc_gap else None
