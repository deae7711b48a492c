"""The structures under test, each with sizes drawn from a generator so that no two are alike."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .mesh import Bar, Floats, Line, Material, Patch, Structure

ALUMINIUM = Material(70000.0, 0.33, 2.7e-9)
STEEL = Material(210000.0, 0.3, 7.85e-9)
Vec = tuple[float, float, float]


def flat(group: int, o: Vec, a: Vec, b: Vec, nu: int, nv: int) -> Patch:
    """Parallelogram patch from corner o along a and b."""
    oo, aa, bb = (np.array(x, dtype=float) for x in (o, a, b))
    return Patch(group, lambda u, v: oo + u[..., None] * aa + v[..., None] * bb, nu, nv)


def straight(group: int, p: Vec, q: Vec, n: int, plane: Vec, name: str = "") -> Line:
    """Straight line of n bars."""
    pp, qq = np.array(p, dtype=float), np.array(q, dtype=float)
    return Line(group, lambda t: pp + t[..., None] * (qq - pp), n, plane, name)


def panel(rng: np.random.Generator) -> Structure:
    """Free rectangular plate with three long and two cross stiffeners, two thicknesses."""
    w, h = 900.0, 600.0
    t = float(rng.choice([2.0, 2.5, 3.0]))
    cut = int(rng.choice([10, 15]))
    x = cut / 30 * w
    lines = [straight(11, (0, y, 0), (w, y, 0), 30, (0, 0, 1)) for y in (90.0, 300.0, 510.0)]
    lines += [straight(12, (c, 0, 0), (c, h, 0), 20, (0, 0, 1)) for c in (240.0, 660.0)]
    return Structure(
        "panel",
        "STIFFENED PANEL",
        w,
        ALUMINIUM,
        {1: t, 2: t},
        {11: Bar(14.0, 12.0), 12: Bar(12.0, 12.0)},
        (
            flat(1, (0, 0, 0), (x, 0, 0), (0, h, 0), cut, 20),
            flat(2, (x, 0, 0), (w - x, 0, 0), (0, h, 0), 30 - cut, 20),
        ),
        tuple(lines),
        14,
        sensors=(38, 43),
        wording={1: "t1", 2: "t2", 11: "long", 12: "cross"},
    )


def _ring(r: float, z: float, phase: float = 0.0) -> Callable[[Floats], Floats]:
    def point(t: Floats) -> Floats:
        a = 2.0 * np.pi * t + phase
        return np.stack([r * np.cos(a), r * np.sin(a), np.full_like(a, z)], axis=-1)

    return point


def wheel(rng: np.random.Generator) -> Structure:
    """Free annular disc with rim and hub stiffeners."""
    r0, r1, r2 = 60.0, 220.0, 380.0
    t = float(rng.choice([5.0, 6.0, 7.0]))

    def annulus(a: float, b: float) -> Callable[[Floats, Floats], Floats]:
        def point(u: Floats, v: Floats) -> Floats:
            r, th = a + (b - a) * u, 2.0 * np.pi * v
            return np.stack([r * np.cos(th), r * np.sin(th), np.zeros_like(r)], axis=-1)

        return point

    return Structure(
        "wheel",
        "WHEEL DISC",
        760.0,
        STEEL,
        {1: t, 2: 0.8 * t},
        {11: Bar(20.0, 15.0), 12: Bar(22.0, 18.0)},
        (
            Patch(1, annulus(r0, r1), 5, 60),
            Patch(2, annulus(r1, r2), 5, 60),
        ),
        (Line(11, _ring(r2, 0.0), 60, (0, 0, 1)), Line(12, _ring(r0, 0.0), 60, (0, 0, 1))),
        20,
        sensors=(46, 51),
        wording={1: "t1", 2: "t2", 11: "rim", 12: "hub"},
    )


def duct(rng: np.random.Generator) -> Structure:
    """Free cylinder with flanges, one rib and a framed port."""
    r, length = 450.0, 900.0
    nt, nz = 72, 26
    z0, t0 = 12, int(rng.integers(0, nt - 6))

    def point(u: Floats, v: Floats) -> Floats:
        a = 2.0 * np.pi * u
        return np.stack([r * np.cos(a), r * np.sin(a), length * v], axis=-1)

    def hole(u: float, v: float) -> bool:
        return t0 <= u * nt < t0 + 5 and z0 <= v * nz < z0 + 3

    def along(a: float, b: float, c: float, d: float) -> Callable[[Floats], Floats]:
        return lambda t: point((a + (b - a) * t) / nt, (c + (d - c) * t) / nz)

    port = [
        (t0, t0 + 5, z0, z0),
        (t0, t0 + 5, z0 + 3, z0 + 3),
        (t0, t0, z0, z0 + 3),
        (t0 + 5, t0 + 5, z0, z0 + 3),
    ]
    middle = point(np.array((t0 + 2.5) / nt), np.array(0.0))
    out = (float(middle[0]), float(middle[1]), 0.0)
    return Structure(
        "duct",
        "BYPASS DUCT",
        900.0,
        ALUMINIUM,
        {1: 1.6},
        {11: Bar(14.0, 14.0), 12: Bar(12.0, 12.0), 21: Bar(9.0, 9.0)},
        (Patch(1, point, nt, nz, hole),),
        (
            Line(11, _ring(r, 0.0), nt, (0, 0, 1)),
            Line(12, _ring(r, length), nt, (0, 0, 1)),
            *(Line(21, along(*p), max(abs(p[1] - p[0]), p[3] - p[2]), out) for p in port),
        ),
        24,
        sensors=(68, 78),
        refine=1,
        wording={1: "t1", 11: "front", 12: "rear", 21: "port"},
    )


def _frame(
    name: str, title: str, a: float, b: float, storey: float, floors: int, braces: int
) -> tuple[list[Line], float]:
    feet = [(0.0, 0.0), (a, 0.0), (a, b), (0.0, b)]
    lines: list[Line] = []
    for f in range(floors):
        z, top = f * storey, (f + 1) * storey
        for i, (x, y) in enumerate(feet):
            lines.append(
                straight(1, (x, y, z), (x, y, top), 4, (1, 0, 0), f"column {i + 1} floor {f + 1}")
            )
        for i in range(4):
            p, q = feet[i], feet[(i + 1) % 4]
            lines.append(
                straight(2, (*p, top), (*q, top), 4, (0, 0, 1), f"beam {i + 1} floor {f + 1}")
            )
        if f < braces:
            i = f % 4
            p, q = feet[i], feet[(i + 1) % 4]
            side = (0.0, 1.0, 0.0) if i % 2 == 0 else (1.0, 0.0, 0.0)
            lines.append(straight(3, (*p, z), (*q, top), 4, side, f"brace floor {f + 1}"))
    return lines, floors * storey


def tower(rng: np.random.Generator) -> Structure:
    """Frame of five storeys on clamped feet with one brace."""
    lines, top = _frame("tower", "", 400.0, 320.0, float(rng.choice([450.0, 500.0])), 5, 1)
    return Structure(
        "tower",
        "FRAME TOWER",
        top,
        STEEL,
        {},
        {1: Bar(20.0, 18.0), 2: Bar(18.0, 16.0), 3: Bar(12.0, 12.0)},
        (),
        tuple(lines),
        14,
        clamped=lambda p: p[:, 2] < 1e-6,
        axes="xyz",
        sensors=(38, 43),
        turned=True,
        wording={1: "col", 2: "beam", 3: "brace"},
    )


def frame(rng: np.random.Generator) -> Structure:
    """Cantilever frame of two storeys with a jib, on clamped feet."""
    a, b, storey = float(rng.choice([500.0, 600.0])), 300.0, 400.0
    lines, top = _frame("frame", "", a, b, storey, 2, 0)
    for y in (0.0, b):
        end = (a + 500.0, b / 2 + (y - b / 2) / 3, top)
        lines.append(straight(3, (a, y, top), end, 4, (0, 0, 1), f"jib y={y}"))
    lines.append(
        straight(3, (a + 500.0, b / 3, top), (a + 500.0, 2 * b / 3, top), 2, (0, 0, 1), "jib end")
    )
    return Structure(
        "frame",
        "CANTILEVER FRAME",
        a + 500.0,
        STEEL,
        {},
        {1: Bar(22.0, 20.0), 2: Bar(18.0, 18.0), 3: Bar(16.0, 16.0)},
        (),
        tuple(lines),
        12,
        clamped=lambda p: p[:, 2] < 1e-6,
        axes="xyz",
        sensors=(20, 32),
        turned=True,
        wording={1: "col", 2: "beam", 3: "jib"},
    )


def box(rng: np.random.Generator) -> Structure:
    """Wing box: skins, spars and ribs, clamped at the root."""
    length, depth, height = 900.0, 240.0, float(rng.choice([80.0, 100.0]))
    n, m, k = 27, 8, 2
    x, y, z = (length, 0.0, 0.0), (0.0, depth, 0.0), (0.0, 0.0, height)
    patches = [flat(1, (0, 0, 0), x, y, n, m), flat(2, (0, 0, height), x, y, n, m)]
    patches += [flat(3, (0, c, 0), x, z, n, k) for c in (0.0, depth)]
    patches += [flat(4, (c, 0, 0), y, z, m, k) for c in (300.0, 600.0, length)]
    return Structure(
        "box",
        "WING BOX",
        length,
        ALUMINIUM,
        {1: 2.0, 2: 2.0, 3: 3.0, 4: 2.0},
        {},
        tuple(patches),
        (),
        14,
        clamped=lambda p: p[:, 0] < 1e-6,
        sensors=(36, 56),
        wording={1: "lower", 2: "upper", 3: "spar", 4: "rib"},
    )


def bracket(rng: np.random.Generator) -> Structure:
    """L-bracket, clamped along the lower edge of its wall, with a stiffened free edge."""
    w, h, d = 400.0, float(rng.choice([280.0, 320.0])), 260.0
    x, y, z = (w, 0.0, 0.0), (0.0, d, 0.0), (0.0, 0.0, h)
    return Structure(
        "bracket",
        "L BRACKET",
        w,
        STEEL,
        {1: 4.0, 2: 3.0},
        {11: Bar(10.0, 10.0)},
        (flat(1, (0, 0, 0), x, z, 16, 12), flat(2, (0, 0, h), x, y, 16, 10)),
        (straight(11, (0, d, h), (w, d, h), 16, (0, 0, 1)),),
        12,
        clamped=lambda p: p[:, 2] < 1e-6,
        sensors=(28, 44),
        turned=True,
        wording={1: "wall", 2: "shelf", 11: "edge"},
    )


def plate(rng: np.random.Generator) -> Structure:
    """Plate clamped at one edge, with one rib along it."""
    w, h = 800.0, 500.0
    t = float(rng.choice([4.0, 5.0]))
    return Structure(
        "plate",
        "CLAMPED PLATE",
        w,
        ALUMINIUM,
        {1: t, 2: t},
        {11: Bar(14.0, 14.0)},
        (
            flat(1, (0, 0, 0), (400, 0, 0), (0, h, 0), 12, 15),
            flat(2, (400, 0, 0), (400, 0, 0), (0, h, 0), 12, 15),
        ),
        (straight(11, (0, 300.0 + 100.0 / 3.0, 0), (w, 300.0 + 100.0 / 3.0, 0), 24, (0, 0, 1)),),
        12,
        clamped=lambda p: p[:, 0] < 1e-6,
        sensors=(28, 44),
        wording={1: "t1", 2: "t2", 11: "rib"},
    )


def wing(rng: np.random.Generator) -> Structure:
    """Tapered and swept wing: skins with a stringer each, spars, ribs; clamped at the root."""
    span, height = 800.0, float(rng.choice([50.0, 60.0]))
    n, m = 16, 6

    def corner(y: Floats, c: Floats, up: Floats) -> Floats:
        chord = 260.0 - 120.0 * y
        z = (up - 0.5) * height * (1.0 - 0.5 * y)
        return np.stack([160.0 * y + chord * c, span * y, z], axis=-1)

    def skin(up: float) -> Callable[[Floats, Floats], Floats]:
        return lambda u, v: corner(u, v, np.full_like(u, up))

    def spar(c: float) -> Callable[[Floats, Floats], Floats]:
        return lambda u, v: corner(u, np.full_like(u, c), v)

    def rib(y: float) -> Callable[[Floats, Floats], Floats]:
        return lambda u, v: corner(np.full_like(u, y), u, v)

    def stringer(up: float) -> Callable[[Floats], Floats]:
        return lambda t: corner(t, np.full_like(t, 0.5), np.full_like(t, up))

    return Structure(
        "wing",
        "SWEPT WING",
        span,
        ALUMINIUM,
        {1: 1.5, 2: 1.5, 3: 2.5, 4: 1.5},
        {11: Bar(8.0, 8.0)},
        (
            *(Patch(k + 1, skin(up), n, m) for k, up in enumerate((0.0, 1.0))),
            *(Patch(3, spar(c), n, 1) for c in (0.0, 1.0)),
            *(Patch(4, rib(y), m, 1) for y in (0.25, 0.5, 0.75, 1.0)),
        ),
        tuple(Line(11, stringer(up), n, (0, 0, 1)) for up in (0.0, 1.0)),
        8,
        clamped=lambda p: p[:, 1] < 1e-6,
        axes="xz",
        sensors=(28, 44),
        turned=True,
        wording={1: "lower", 2: "upper", 3: "spar", 4: "rib", 11: "stringer"},
    )


def cowl(rng: np.random.Generator) -> Structure:
    """Free part of a cylinder with two edge frames and a stringer."""
    r, length, arc = 400.0, 500.0, float(rng.choice([1.6, 2.2]))
    nt, nz = 21, 14

    def point(u: Floats, v: Floats) -> Floats:
        a = arc * (u - 0.5)
        return np.stack([r * np.cos(a), r * np.sin(a), length * v], axis=-1)

    def along(v: float) -> Callable[[Floats], Floats]:
        return lambda t: point(t, np.full_like(t, v))

    return Structure(
        "cowl",
        "ENGINE COWL",
        2.0 * r * float(np.sin(0.5 * arc)),
        ALUMINIUM,
        {1: 2.0, 2: 2.5},
        {11: Bar(10.0, 8.0), 12: Bar(10.0, 10.0)},
        (
            Patch(1, lambda u, v: point(u, 0.5 * v), nt, nz // 2),
            Patch(2, lambda u, v: point(u, 0.5 + 0.5 * v), nt, nz // 2),
        ),
        (
            *(Line(11, along(v), nt, (0, 0, 1)) for v in (0.0, 1.0)),
            Line(12, lambda t: point(np.full_like(t, 1.0 / 3.0), t), nz, (1, 0, 0)),
        ),
        10,
        sensors=(34, 48),
        wording={1: "t1", 2: "t2", 11: "edge", 12: "stringer"},
    )


STRUCTURES: dict[str, Callable[[np.random.Generator], Structure]] = {
    "panel": panel,
    "wheel": wheel,
    "duct": duct,
    "tower": tower,
    "frame": frame,
    "box": box,
    "bracket": bracket,
    "plate": plate,
    "wing": wing,
    "cowl": cowl,
}
