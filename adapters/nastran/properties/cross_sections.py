"""Constants of the standard cross sections of PBARL and PBEAML from their dimensions.

Areas and inertias are exact for the shapes drawn in the Quick Reference Guide. Torsion constants
are the usual thin-walled ones (sum of b t**3 / 3 where open, Bredt where closed; Roark for solid
rectangles) and shear factors the web's share of the area, 5/6 for rectangles, 0.9 for rods and
0.5 for tubes, as the NX Nastran Element Library Reference gives them.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from ....core.errors import Place
from ..deck.field_values import Fields, take


class Section(NamedTuple):
    """Constants of a cross section about its centroid.

    ``I1`` bends in plane 1 (the integral of y**2), ``I2`` in plane 2; ``shear_y``, ``shear_z`` is
    the centroid's position seen from the shear centre.
    """

    A: float
    I1: float
    I2: float
    I12: float
    J: float
    K1: float
    K2: float
    shear_y: float = 0.0
    shear_z: float = 0.0


Dims = Sequence[float]
Rectangle = tuple[float, float, float, float]
"""Width along z, height along y, centre z, centre y."""


_NOT_MADE = {"DBOX": 10}
"""Sections that have no constants here, and how many dimensions they have."""


def dimension_count(shape: str) -> int:
    """Return how many dimensions a standard section has; 0 where it is not known."""
    return SHAPES[shape][0] if shape in SHAPES else _NOT_MADE.get(shape, 0)


def dimensions(fields: Fields, at: int, shape: str) -> tuple[float, ...]:
    """Read DIM1, DIM2, ... of a section from a field on; all that follow where it is not known.

    Raises
    ------
    FieldError
        A dimension that is missing or no number.
    """
    count = dimension_count(shape) or max(len(fields) - at, 0)
    return tuple(take(fields, at + k, f"DIM{k + 1}:r!") for k in range(count))


def section(shape: str, dimensions: Dims, place: Place) -> Section:
    """Return the constants of a standard section.

    Parameters
    ----------
    shape : str
        TYPE of the card.
    dimensions : sequence of float
        DIM1, DIM2, ...
    place : Place
        The card with file and line, for messages.

    Raises
    ------
    InputError
        An unknown shape, or dimensions that do not fit together.
    """
    if shape not in SHAPES:
        raise place.error(f"the section {shape} is not supported")
    count, make = SHAPES[shape]
    if len(dimensions) < count:
        raise place.error(f"the section {shape} needs {count} dimensions")
    if any(not d >= 0.0 for d in dimensions[:count]):
        raise place.error(f"the dimensions of the section {shape} must be positive")
    try:
        found = make(*dimensions[:count])
        _require(found.A > 0.0, found.I1 > 0.0, found.I2 > 0.0)
    except (_Misfit, ZeroDivisionError):
        raise place.error(f"the dimensions of the section {shape} do not fit together") from None
    return found


class _Misfit(Exception):
    """Dimensions that do not fit together."""


def _require(*fits: bool) -> None:
    if not all(fits):
        raise _Misfit


def _turned(s: Section) -> Section:
    """Swap y and z."""
    return s._replace(I1=s.I2, I2=s.I1, K1=s.K2, K2=s.K1, shear_y=s.shear_z, shear_z=s.shear_y)


def _left_and_right(w: float, h: float, z: float, y: float) -> tuple[Rectangle, Rectangle]:
    return (w, h, z, y), (w, h, -z, y)


def _compose(
    parts: Sequence[Rectangle], J: float, K: tuple[float, float], shear: tuple[float, float] | None
) -> Section:
    """Sum rectangles; `shear` is the shear centre (y, z), None: the centroid."""
    A = sum(w * h for w, h, _, _ in parts)
    zc = sum(w * h * z for w, h, z, _ in parts) / A
    yc = sum(w * h * y for w, h, _, y in parts) / A
    I1 = sum(w * h**3 / 12.0 + w * h * (y - yc) ** 2 for w, h, _, y in parts)
    I2 = sum(w**3 * h / 12.0 + w * h * (z - zc) ** 2 for w, h, z, _ in parts)
    I12 = sum(w * h * (y - yc) * (z - zc) for w, h, z, y in parts)
    I12 = 0.0 if abs(I12) < 1e-12 * (I1 + I2) else I12
    y_from, z_from = (0.0, 0.0) if shear is None else (yc - shear[0], zc - shear[1])
    return Section(A, I1, I2, I12, J, K[0] / A, K[1] / A, y_from, z_from)


def _round(outer: float, inner: float, shear: float) -> Section:
    _require(outer > inner >= 0.0)
    A = math.pi * (outer**2 - inner**2)
    quarter = 0.25 * math.pi * (outer**4 - inner**4)
    return Section(A, quarter, quarter, 0.0, 2.0 * quarter, shear, shear)


def _bar(w: float, h: float) -> Section:
    b, t = max(w, h), min(w, h)
    J = b * t**3 * (1.0 / 3.0 - 0.21 * t / b * (1.0 - t**4 / (12.0 * b**4)))
    return _compose([(w, h, 0.0, 0.0)], J, (5.0 / 6.0 * w * h, 5.0 / 6.0 * w * h), None)


def _box(b: float, h: float, t1: float, t2: float) -> Section:
    inner_b, inner_h = b - 2.0 * t2, h - 2.0 * t1
    _require(inner_b > 0.0, inner_h > 0.0)
    J = 2.0 * t1 * t2 * (b - t2) ** 2 * (h - t1) ** 2 / (b * t2 + h * t1 - t2**2 - t1**2)
    A = b * h - inner_b * inner_h
    I1 = (b * h**3 - inner_b * inner_h**3) / 12.0
    I2 = (h * b**3 - inner_h * inner_b**3) / 12.0
    return Section(A, I1, I2, 0.0, J, 2.0 * t2 * inner_h / A, 2.0 * t1 * inner_b / A)


def _box1(b: float, h: float, top: float, bottom: float, left: float, right: float) -> Section:
    inner_b, inner_h = b - left - right, h - top - bottom
    _require(inner_b > 0.0, inner_h > 0.0)
    width, height = b - 0.5 * (left + right), h - 0.5 * (top + bottom)
    J = (
        4.0
        * (width * height) ** 2
        / (height * (1.0 / left + 1.0 / right) + width * (1.0 / top + 1.0 / bottom))
    )
    parts = [
        (b, top, 0.5 * b, h - 0.5 * top),
        (b, bottom, 0.5 * b, 0.5 * bottom),
        (left, inner_h, 0.5 * left, bottom + 0.5 * inner_h),
        (right, inner_h, b - 0.5 * right, bottom + 0.5 * inner_h),
    ]
    return _compose(parts, J, ((left + right) * inner_h, (top + bottom) * inner_b), None)


def _i(h: float, a: float, b: float, tw: float, ta: float, tb: float) -> Section:
    hw, hf = h - ta - tb, h - 0.5 * (ta + tb)
    _require(hw > 0.0, tw <= min(a, b))
    J = (tb**3 * b + ta**3 * a + tw**3 * hf) / 3.0
    parts = [(a, ta, 0.0, 0.5 * ta), (tw, hw, 0.0, ta + 0.5 * hw), (b, tb, 0.0, h - 0.5 * tb)]
    shear_y = 0.5 * ta + tb * hf * b**3 / (tb * b**3 + ta * a**3)
    return _compose(parts, J, (tw * hw, 5.0 / 6.0 * (ta * a + tb * b)), (shear_y, 0.0))


def _i1(overhang: float, tw: float, inner: float, h: float) -> Section:
    t = 0.5 * (h - inner)
    _require(t > 0.0)
    return _i(h, overhang + tw, overhang + tw, tw, t, t)


def _channel(b: float, h: float, tw: float, tf: float) -> Section:
    """Web on the left along y, flanges to the right."""
    bf, hw = b - tw, h - 2.0 * tf
    _require(bf > 0.0, hw > 0.0)
    width, height = b - 0.5 * tw, h - tf
    J = (2.0 * width * tf**3 + height * tw**3) / 3.0
    parts = [
        (tw, h, 0.5 * tw, 0.5 * h),
        (bf, tf, tw + 0.5 * bf, 0.5 * tf),
        (bf, tf, tw + 0.5 * bf, h - 0.5 * tf),
    ]
    out = width**2 * tf / (2.0 * width * tf + height * tw / 3.0)
    return _compose(parts, J, (tw * hw, 2.0 * tf * bf), (0.5 * h, 0.5 * tw - out))


def _chan1(bf: float, tw: float, inner: float, h: float) -> Section:
    _require(h > inner)
    return _channel(bf + tw, h, tw, 0.5 * (h - inner))


def _tee(b: float, h: float, tf: float, tw: float) -> Section:
    """Flange on top, web below."""
    hw = h - tf
    _require(hw > 0.0, tw <= b)
    J = (tf**3 * b + tw**3 * (h - 0.5 * tf)) / 3.0
    parts = [(b, tf, 0.0, h - 0.5 * tf), (tw, hw, 0.0, 0.5 * hw)]
    return _compose(parts, J, (tw * hw, tf * b), (h - 0.5 * tf, 0.0))


def _t2(b: float, h: float, tf: float, tw: float) -> Section:
    up = _tee(b, h, tf, tw)
    return up._replace(shear_y=-up.shear_y)


def _cross(arms: float, tv: float, h: float, th: float) -> Section:
    _require(th <= h)
    J = (h * tv**3 + arms * th**3) / 3.0
    half = 0.5 * arms
    parts = [
        (tv, h, 0.0, 0.0),
        *_left_and_right(half, th, 0.5 * (tv + half), 0.0),
    ]
    return _compose(parts, J, (5.0 / 6.0 * h * tv, 5.0 / 6.0 * (arms + tv) * th), None)


def _h(inner: float, flanges: float, h: float, tw: float) -> Section:
    t = 0.5 * flanges
    _require(tw <= h)
    J = (2.0 * h * t**3 + inner * tw**3) / 3.0
    parts = [*_left_and_right(t, h, 0.5 * (inner + t), 0.0), (inner, tw, 0.0, 0.0)]
    return _compose(parts, J, (5.0 / 6.0 * 2.0 * t * h, inner * tw), None)


def _zee(bf: float, tw: float, inner: float, h: float) -> Section:
    """Upper flange to the left (negative z), lower flange to the right."""
    t = 0.5 * (h - inner)
    _require(t > 0.0)
    J = (2.0 * (bf + 0.5 * tw) * t**3 + (h - t) * tw**3) / 3.0
    parts = [
        (tw, h, 0.0, 0.0),
        (bf, t, -0.5 * (bf + tw), 0.5 * (h - t)),
        (bf, t, 0.5 * (bf + tw), -0.5 * (h - t)),
    ]
    return _compose(parts, J, (tw * inner, 2.0 * t * bf), None)


def _angle(b: float, h: float, t1: float, t2: float) -> Section:
    """Corner at the lower left: horizontal leg of thickness t1, vertical leg of thickness t2."""
    _require(t1 < h, t2 < b)
    J = (t1**3 * (b - 0.5 * t2) + t2**3 * (h - 0.5 * t1)) / 3.0
    parts = [(b, t1, 0.5 * b, 0.5 * t1), (t2, h - t1, 0.5 * t2, t1 + 0.5 * (h - t1))]
    return _compose(parts, J, (t2 * (h - t1), t1 * (b - t2)), (0.5 * t1, 0.5 * t2))


def _hexagon(side: float, b: float, h: float) -> Section:
    inner = b - 2.0 * side
    _require(inner >= 0.0)
    A = (b - side) * h
    I1 = inner * h**3 / 12.0 + side * h**3 / 24.0
    thirds = 4.0 * (side * h / 4.0) * (side**2 / 18.0 + (0.5 * inner + side / 3.0) ** 2)
    I2 = h * inner**3 / 12.0 + thirds
    like = _bar(A / h, h)
    return Section(A, I1, I2, 0.0, like.J, 5.0 / 6.0, 5.0 / 6.0)


def _hat(h: float, t: float, top: float, brim: float) -> Section:
    inner = top - 2.0 * t
    _require(inner > 0.0, h > 2.0 * t)
    J = t**3 / 3.0 * (top + 2.0 * (h - t) + 2.0 * brim)
    parts = [
        (inner, t, 0.0, h - 0.5 * t),
        *_left_and_right(t, h, 0.5 * (top - t), 0.5 * h),
        *_left_and_right(brim, t, 0.5 * (top + brim), 0.5 * t),
    ]
    return _compose(parts, J, (2.0 * t * (h - 2.0 * t), t * (inner + 2.0 * brim)), None)


def _hat1(plate: float, h: float, top: float, t: float, tp: float) -> Section:
    rise = h - tp
    inner = top - 2.0 * t
    _require(inner > 0.0, rise > 2.0 * t, plate >= top)
    brim = 0.5 * (plate - top)
    width, height = top - t, rise - 0.5 * t + 0.5 * tp
    closed = 4.0 * (width * height) ** 2 / (2.0 * height / t + width / t + width / tp)
    parts = [
        (plate, tp, 0.0, 0.5 * tp),
        (inner, t, 0.0, h - 0.5 * t),
        *_left_and_right(t, rise, 0.5 * (top - t), tp + 0.5 * rise),
        *_left_and_right(brim, t, 0.5 * (top + brim), tp + 0.5 * t),
    ]
    flat = t * inner + tp * plate + 2.0 * brim * t
    return _compose(parts, closed, (2.0 * t * (rise - 2.0 * t), flat), None)


SHAPES: dict[str, tuple[int, Callable[..., Section]]] = {
    "ROD": (1, lambda r: _round(r, 0.0, 0.9)),
    "TUBE": (2, lambda outer, inner: _round(outer, inner, 0.5)),
    "TUBE2": (2, lambda outer, t: _round(outer, outer - t, 0.5)),
    "BAR": (2, _bar),
    "BOX": (4, _box),
    "BOX1": (6, _box1),
    "I": (6, _i),
    "I1": (4, _i1),
    "CHAN": (4, _channel),
    "CHAN1": (4, _chan1),
    "CHAN2": (4, lambda side, base, h, b: _turned(_channel(h, b, base, side))),
    "T": (4, _tee),
    "T1": (4, lambda h, web, flange, tw: _turned(_tee(h, web + flange, flange, tw))),
    "T2": (4, _t2),
    "CROSS": (4, _cross),
    "H": (4, _h),
    "Z": (4, _zee),
    "L": (4, _angle),
    "HEXA": (3, _hexagon),
    "HAT": (4, _hat),
    "HAT1": (5, _hat1),
}
"""By TYPE: the number of dimensions and the routine."""
