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
    at = _Places(axes, x / half, x, *(tuple(np.flatnonzero(k).tolist()) for k in (wide, long)))
    about = _round_about(x)
    return tuple(_straight(at) if about is None else _round(at, about))


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


def _round_about(x: Floats) -> int | None:
    """Return the own axis about which nodes are round, None where there is none.

    Their moments of second and fourth order across it are then those of a circle.
    """
    for k in range(3):
        z = x[:, (k + 1) % 3] + 1j * x[:, (k + 2) % 3]
        apart = (abs(np.sum(z**n)) / max(float(np.sum(abs(z) ** n)), _TINY) for n in (2, 4))
        if np.ptp(z.real) > 0.0 and np.ptp(z.imag) > 0.0 and max(apart) < MODEL_ERROR.round:
            return k
    return None
