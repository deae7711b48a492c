"""Properties of beams with stations along them: PBEAM, PBEAML."""

import re

from ..deck.card_definition import Card, Known
from ..deck.field_values import FieldError, Fields, take
from ..deck.movable_values import Moves, Read, Variable, after
from ..properties.cross_sections import dimension_count, dimensions
from ..text.real_numbers import parse_real

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
)
