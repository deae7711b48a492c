"""Properties of beams: with stations along them (PBEAM, PBEAML), with lumped areas (PBCOMP)."""

import re

import numpy as np

from .....core.arrays import Floats
from .....core.errors import Place
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Known, Values
from ...deck.field_values import FieldError, Fields, take
from ...deck.movable_values import Moves, Read, Variable, after
from ...properties.cross_sections import dimension_count, dimensions
from ...properties.materials import isotropic
from ...text.real_numbers import parse_real

_SECTION = ("A", "I1", "I2", "I12", "J", "NSM")
_SO = ("YES", "YESA", "NO")
_SAME = 1e-6


def _stations(fields: Fields, _: Known) -> list[object]:
    """Stations of a PBEAM from A to B (two lines each, the second with stress points), the rest.

    A blank value at B is that at A; between them it is interpolated.
    """

    def row(first: int, default: str) -> list[float | None]:
        return [take(fields, first + k, f"{n}:r{default}") for k, n in enumerate(_SECTION)]

    rows = [[0.0, take(fields, 3, "A:r!"), *row(3, "=0.")[1:]]]
    padded = [*(str(f).upper() for f in fields), *[""] * 16]
    at = 9 if padded[9] in _SO else 17
    while padded[at : at + 1] and padded[at] in _SO:
        rows.append([take(fields, at + 1, "X/XB:r!"), *row(at + 2, "")])
        at += 16 if padded[at] == "YES" else 8
    rows.sort(key=lambda r: r[0])
    x = [r[0] for r in rows]
    if len(rows) > 1 and (x[-1] != 1.0 or len(set(x)) < len(x)):
        raise FieldError(at, "X/XB", "of the stations must be different, with 1. for end B")
    if len(fields) > at + 16:
        raise FieldError(
            at + 16, "", "there are more fields than PBEAM has (is there an empty line?)"
        )
    end = [a if b is None else b for a, b in zip(rows[0], rows[-1], strict=True)]
    filled = [
        [a + (b - a) * r[0] if v is None else v for a, b, v in zip(rows[0], end, r, strict=True)]
        for r in [rows[0], *rows[1:-1], end][: len(rows)]
    ]
    tail = [take(fields, at + k, f"{n}:r=1.") for k, n in enumerate(("K1", "K2"))]
    for k, names in ((4, "NSI"), (6, "CW")):
        tail.append(_both(fields, at + k, names, 1))
    for k, names in ((8, "M"), (12, "N")):
        tail.append(_both(fields, at + k, names, 2))
    return [tuple(column) for column in zip(*filled, strict=True)] + tail


def _both(fields: Fields, at: int, name: str, width: int) -> tuple[float, ...]:
    """Values at end A and at end B, where blank those at A."""
    a = tuple(take(fields, at + k, f"{name}(A):r=0.") for k in range(width))
    b = (take(fields, at + width + k, f"{name}(B):r") for k in range(width))
    return (*a, *(x if y is None else y for x, y in zip(a, b, strict=True)))


def _library(fields: Fields, card: Known) -> list[object]:
    """Stations of a PBEAML: dimensions and NSM at A, then SO, X/XB and the same at others."""
    x, at = [0.0], 9
    dims: list[tuple[float, ...]] = []
    nsm: list[float] = []
    while at < len(fields):
        if dims:
            x.append(take(fields, at + 1, "X/XB:r=1."))
            at += 2
        first = dims[0] if dims and x[-1] == 1.0 else ()
        padded = [*fields, *[None] * len(first)]
        for k, value in enumerate(first, at):
            padded[k] = padded[k] or repr(value)
        dims.append(dimensions(padded, at, card["type"]))
        at += len(dims[-1])
        nsm.append(take(fields, at, "NSM:r=0."))
        at += 1
    if not dims:
        raise FieldError(9, "DIM1", "must be given")
    return [tuple(x), tuple(dims), tuple(nsm)]


_POINTS = ("C1", "C2", "D1", "D2", "E1", "E2", "F1", "F2")
_TAIL = (
    ("K1", "K2", "S1", "S2", "NSI(A)", "NSI(B)", "CW(A)", "CW(B)"),
    ("M1(A)", "M2(A)", "M1(B)", "M2(B)", "N1(A)", "N2(A)", "N1(B)", "N2(B)"),
)
_STATION = re.compile(r"(?P<what>[A-Z]+\d*)\((?P<at>A|B|0?\.\d+)\)")


def _at_station(name: str) -> tuple[str, float]:
    """Take a name with a station apart: ``I1(0.5)``, ``A(B)``; "" where it has none."""
    match = _STATION.fullmatch(name)
    if not match:
        return "", 0.0
    return match["what"], 1.0 if match["at"] == "B" else _number(match["at"])


def _number(text: str) -> float:
    try:
        return parse_real(text)
    except ValueError:
        return 0.0


def _knows_pbeam(name: str) -> bool:
    named = (*_SECTION, *_POINTS)
    return name in (*_TAIL[0], *_TAIL[1]) or _at_station(name)[0] in named


def _find_pbeam(name: str, read: Read) -> int | None:
    """Stations (one or two lines each) may stand between end A and the last two lines."""
    line = 1 if read(12) in _SO else 2
    lines: list[tuple[int, float]] = [(0, 0.0)]
    while read(10 * line + 2) in _SO:
        lines.append((line, _number(read(10 * line + 3))))
        line += 2 if read(10 * line + 2) == "YES" else 1
    for row, names in enumerate(_TAIL):
        if name in names:
            return 10 * (line + row) + 2 + names.index(name)
    what, wanted = _at_station(name)
    for first, at in lines:
        if abs(at - wanted) < _SAME:
            if what in _SECTION:
                return 10 * first + 4 + _SECTION.index(what)
            if not first or read(10 * first + 2) == "YES":
                return 10 * first + 12 + _POINTS.index(what)
    return None


def _knows_pbeaml(name: str) -> bool:
    return bool(re.fullmatch(r"NSM|DIM[1-9]\d?", _at_station(name)[0]))


def _find_pbeaml(name: str, read: Read) -> int | None:
    """DIM1..DIMn and NSM at A, then SO, X/XB and the same before each further station."""
    count = dimension_count(read(5))
    what, wanted = _at_station(name)
    start, at = 12, 0.0
    while count and abs(at - wanted) >= _SAME:
        start = after(start, count + 1)
        if read(start) not in _SO:
            return None
        at, start = _number(read(after(start, 1))), after(start, 2)
    number = count + 1 if what == "NSM" else int(what.removeprefix("DIM"))
    return after(start, number - 1) if number <= count + (what == "NSM") and count else None


CARDS = (
    Card(
        "PBEAM",
        "PID:i! MID:i!",
        "pid",
        space="beam property",
        more=_stations,
        extra="x a i1 i2 i12 j nsm k1 k2 nsi cw m n",
        moves=Moves(
            also={"AREA": "A(A)"},
            variable=Variable(
                (*(f"{n}(A)" for n in (*_SECTION, *_POINTS)), *_TAIL[0], *_TAIL[1]),
                _knows_pbeam,
                _find_pbeam,
            ),
        ),
    ),
    Card(
        "PBEAML",
        "PID:i! MID:i! GROUP:w=MSCBML0 TYPE:w!",
        "pid",
        space="beam property",
        more=_library,
        extra="x dim nsm",
        moves=Moves(
            variable=Variable(
                (*(f"DIM{n}(A)" for n in range(1, 11)), "NSM(A)"), _knows_pbeaml, _find_pbeaml
            )
        ),
    ),
    Card(
        "PBCOMP",
        "PID:i! MID:i! A:r! I1:r=0. I2:r=0. I12:r=0. J:r=0. NSM:r=0. / "
        "K1:r=1. K2:r=1. M1,M2>m:r=0. N1,N2>n:r=0. SYMOPT:i=0 - / "
        "[Y:r Z:r C:r=0. MID>mids:i - - - -]",
        "pid",
        space="beam property",
        moves=Moves(linear=("NSM",)),
    ),
)

_MIRRORED = {0: ((1, 1),), 5: ((1, 1),), 2: ((1, 1), (1, -1)), 3: ((1, 1), (-1, 1))}
_MIRRORED[1] = (*_MIRRORED[2], (-1, 1), (-1, -1))
"""Signs of y and z of the images that SYMOPT adds: symmetric about y and z, y, z."""


def lumped_areas(bulk: Bulk, card: Values, place: Place) -> tuple[Floats, float, Floats] | None:
    """Return A, I1, I2, I12, J of a PBCOMP with lumped areas, mass per length, neutral axis.

    Sums over the areas weighed by their moduli beside those of MID (Quick Reference Guide,
    PBCOMP); None where every area is zero: the card's own values hold.

    Raises
    ------
    InputError
        SYMOPT is not known, areas are negative or lie on a line.
    """
    if not any(card.c):
        return None
    if card.symopt not in _MIRRORED:
        raise place.error(
            f"SYMOPT {card.symopt} with lumped areas is not supported: list all of them with 5"
        )
    E0, G0, *_ = isotropic(bulk, card.mid, place)
    if not min(E0, G0) > 0.0:
        raise place.error("E and G of its material, to which those of the areas relate, are zero")
    found = [isotropic(bulk, mid or card.mid, place) for mid in card.mids]
    images = np.array(_MIRRORED[card.symopt], dtype=float)
    E, G, rho, c, y, z = (
        np.repeat(np.asarray(v, dtype=float), len(images))
        for v in (
            [m[0] / E0 for m in found],
            [m[1] / G0 for m in found],
            [m[3] for m in found],
            card.c,
            *([v or 0.0 for v in values] for values in (card.y, card.z)),
        )
    )
    y, z = y * np.tile(images[:, 0], len(card.c)), z * np.tile(images[:, 1], len(card.c))
    if (c < 0.0).any():
        raise place.error("a fraction C of the area is negative")
    share = c * E
    y0, z0 = (float(share @ v / share.sum()) for v in (y, z))
    inertias = [share @ v for v in ((y - y0) ** 2, (z - z0) ** 2, (y - y0) * (z - z0))]
    values = np.array([card.a * share.sum(), *(card.a * v for v in inertias), card.j * (c @ G)])
    if not card.a > 0.0:
        raise place.error("its area is not positive")
    if not inertias[0] * inertias[1] > inertias[2] ** 2 * (1.0 + 1e-9):
        raise place.error("its lumped areas lie on a straight line")
    return values, float(card.a * (c @ rho)), np.array([y0, z0])
