"""Beams and pipes along an arc of a circle: CBEND."""

from typing import Any

import numpy as np

from .....core.arrays import Floats, Ints, Matrices
from .....core.elements.batch import congruent
from .....core.elements.lines.bar import offset_transform
from .....core.elements.lines.bend import Arcs, BendSections, bend_mass, bend_stiffness
from .....core.elements.quadrature import gauss_line
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Values
from ...deck.field_values import Fields, parse, value_of
from ...deck.movable_values import Moves, Read, Variable, position_of
from ...properties.materials import isotropic
from ..element_group import (
    Context,
    Group,
    check_shape,
    connected,
    element_sources,
    with_material,
)
from .line_elements import orientation

_BEAM = tuple(
    parse(
        "PID:i! MID:i! A:r! I1:r! I2:r! J:r! RB:r THETAB:r / C1,C2,D1,D2,E1,E2,F1,F2>points:r / "
        "K1:r=0. K2:r=0. NSM:r=0. RC:r=0. ZC:r=0. DELTAN:r=0."
    )
)
_PIPE = tuple(
    parse("PID:i! MID:i! FSI:i! RM:r! T:r! P:r RB:r THETAB:r / - - NSM:r=0. RC:r=0. ZC:r=0.")
)
_FORMS = {f.name: k for k, f in [*enumerate(_PIPE), *enumerate(_BEAM)] if f.kind == "r"}
"""Reals of both forms with their data fields; those that both have stand last."""
_READ = "a i1 i2 j k1 k2 deltan fsi rm t rb thetab nsm rc zc"


def _is_pipe(third: str | None) -> bool:
    return (third or "").isdigit()


def _values(fields: Fields, _: Any) -> list[Any]:
    form = _PIPE if _is_pipe([*fields, None, None][3]) else _BEAM
    padded = [*fields, *[None] * len(form)]
    found = {f.attribute: value_of(f, k + 1, padded[k + 1]) for k, f in enumerate(form)}
    return [found.get(name) for name in _READ.split()]


def _find(name: str, read: Read) -> int | None:
    form = _PIPE if _is_pipe(read(4)) else _BEAM
    return next((position_of(k) for k, f in enumerate(form) if f.name == name), None)


CARDS = (
    Card(
        "CBEND",
        "EID:i! PID:i=EID GA,GB>nodes:i! X1,X2,X3>x:ir GEOM:i!",
        "eid",
        elements="bend",
        properties="PBEND",
    ),
    Card(
        "PBEND",
        "PID:i! MID:i!",
        "pid",
        more=_values,
        extra=_READ,
        moves=Moves(variable=Variable(tuple(_FORMS), _FORMS.__contains__, _find)),
    ),
)

_TURNED = 1e-6


def bends(context: Context) -> list[Group]:
    """Make the group of CBEND."""
    cards = list(context.bulk.table("CBEND").values())
    if not cards:
        return []
    element = context.bulk.definitions["CBEND"].element
    assert element is not None
    ids, nodes, keys, of = connected(context, "CBEND", cards)
    check_shape(context, "CBEND", element, ids, context.points.xyz[nodes])
    v = orientation(context, "CBEND", cards, ids, nodes)
    context.notes.append(
        f"CBEND: Nastran's law of {element.unknown} is not known; half stands at each end, or with "
        "COUPMASS 1 what moves consistently with the arc"
    )

    def matrices(bulk: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        own = [bulk.table("PBEND")[keys[k][1]] for k in of[rows]]
        arcs = _arcs(
            context, own, [cards[k] for k in rows], context.points.xyz[nodes[rows]], v[rows]
        )
        sections, rho = _sections(bulk, own, arcs.radius)
        wa, wb = (x - context.points.xyz[nodes[rows, k]] for k, x in ((0, arcs.xa), (1, arcs.xb)))
        K = M = None
        if wanted[0]:
            K = bend_stiffness(arcs, sections)
        if wanted[1]:
            nsm = np.array([p.nsm for p in own]) + context.extra_mass(bulk, ids[rows])
            M = bend_mass(arcs, sections, rho, nsm, context.settings.coupled)
        T = offset_transform(wa, wb)
        return tuple(None if X is None else congruent(X, T) for X in (K, M))  # type: ignore[return-value]

    of_property = [with_material(context.bulk, key) for key in keys]
    sources, source_of = element_sources(context, "CBEND", ids, of_property, of)
    return [Group("CBEND", ids, element, nodes, matrices, sources, source_of)]


def _arcs(context: Context, own: list[Values], cards: list[Values], xyz: Floats, v: Floats) -> Arcs:
    """Arcs of centroids from the grids, as GEOM says.

    1: the centre lies along the vector from GA; 2: the arc starts at GA along it; 3, 4: the arc
    lies on its side of the chord, RB or THETAB is given. RC and ZC move grids outward and across.
    """
    d = xyz[:, 1] - xyz[:, 0]
    chord = np.linalg.norm(d, axis=1)
    d = d / chord[:, None]
    size = np.linalg.norm(v, axis=1)
    along = np.einsum("ni,ni->n", v, d) / np.where(size > 0.0, size, 1.0)
    side = v - np.einsum("ni,ni->n", v, d)[:, None] * d
    bulge, angle = np.zeros_like(d), np.zeros(len(d))
    for k, (card, p) in enumerate(zip(cards, own, strict=True)):
        place = context.bulk.place("CBEND", card.eid)
        across = float(np.linalg.norm(side[k]))
        if not across > _TURNED * float(size[k]):
            raise place.error("its vector X1, X2, X3 or G0 is zero or runs along the chord")
        angle[k] = _angle(context, card, p, float(chord[k]), float(along[k]))
        inward = card.geom == 1 and along[k] > 0.0
        bulge[k] = side[k] / (-across if inward else across)
    on_grids = Arcs(xyz[:, 0], xyz[:, 1], bulge, angle)
    axes = on_grids.at(np.array([0.0, 1.0]))[1]
    rc, zc = (np.array([getattr(p, name) for p in own])[:, None] for name in ("rc", "zc"))
    xa, xb = (xyz[:, k] + rc * axes[:, k, 0] + zc * axes[:, k, 2] for k in (0, 1))
    return Arcs(xa, xb, bulge, angle)


def _angle(context: Context, card: Values, p: Values, chord: float, along: float) -> float:
    place, given = context.bulk.place("CBEND", card.eid), context.bulk.place("PBEND", p.pid)
    if card.geom == 1:
        angle = 2.0 * np.arcsin(min(abs(along), 1.0))
    elif card.geom == 2:
        angle = 2.0 * np.arccos(np.clip(along, -1.0, 1.0))
    elif card.geom == 3:
        if p.rb is None or not p.rb - p.rc >= 0.5 * chord * (1.0 - 1e-9):
            raise given.error(f"GEOM 3 of {place} needs RB, no less than half its chord")
        angle = 2.0 * np.arcsin(min(0.5 * chord / (p.rb - p.rc), 1.0))
    elif card.geom == 4:
        if p.thetab is None or not 0.0 < p.thetab <= 180.0:
            raise given.error(f"GEOM 4 of {place} needs THETAB, above 0 and up to 180 degrees")
        angle = np.radians(p.thetab)
    else:
        raise place.error(f"GEOM {card.geom} is not one of 1, 2, 3, 4")
    if not angle > _TURNED:
        raise place.fault("its arc is straight: give a CBAR or CBEAM")
    return float(angle)


def _sections(bulk: Bulk, own: list[Values], radius: Floats) -> tuple[BendSections, Floats]:
    """Sections and densities."""
    table = np.array([_constants(bulk, p, R) for p, R in zip(own, radius.tolist(), strict=True)]).T
    return BendSections(*table[:-1]), table[-1]


def _constants(bulk: Bulk, p: Values, R: float) -> list[float]:
    place = bulk.place("PBEND", p.pid)
    E, G, _, rho = isotropic(bulk, p.mid, place)
    if not min(E, G) > 0.0:
        raise place.error("E and G of its material must be positive")
    if p.fsi is None:
        A, I1, I2, J, k1, k2 = p.a, p.i1, p.i2, p.j, p.k1, p.k2
        if not min(A, I1, I2, J) > 0.0:
            raise place.error("A, I1, I2 and J must be positive")
        neutral = p.deltan or I1 / (A * R)
    else:
        A, I1, J, k1, neutral = _pipe(p, R, place)
        I2, k2 = I1, k1
    if not 0.0 < neutral < R:
        raise place.error(f"the neutral axis, {neutral:g} off the centroid, is not within the arc")
    return [E, G, A, I1, I2, J, k1, k2, neutral, rho]


def _pipe(p: Values, R: float, place: Any) -> tuple[float, ...]:
    """Area, inertia, torsion constant, shear factor, neutral axis of a ring or a full circle.

    1/K = (A/I^2) int Q^2/b dy (complementary energy), e = R - A / int dA/r.
    """
    if p.fsi != 1:
        raise place.error(
            f"FSI {p.fsi} (flexibility factors of a code) is not supported: 1 is, or give A, I1, "
            "I2 and J, with I1 and I2 divided by that factor"
        )
    outer = p.rm + 0.5 * p.t
    inner = p.rm - 0.5 * p.t if p.t else 0.0
    if not (p.t >= 0.0 and inner >= 0.0 and outer < R):
        raise place.error("RM and T are not those of a pipe within its bend")
    A, I1 = np.pi * (outer**2 - inner**2), 0.25 * np.pi * (outer**4 - inner**4)
    x, w = gauss_line(24)
    energy = 0.0
    for low, high in ((0.0, inner), (inner, outer)):
        # y = high sin(t): the roots at y = high are smooth in t
        start = float(np.arcsin(low / high)) if high else 0.0
        half = 0.5 * (0.5 * np.pi - start)
        y = high * np.sin(start + half * (x + 1.0))
        dy = half * w * np.sqrt(np.maximum(high**2 - y**2, 0.0))
        o, i = (np.sqrt(np.maximum(r**2 - y**2, 0.0)) for r in (outer, inner))
        energy += float(((2.0 / 3.0 * (o**3 - i**3)) ** 2 / (2.0 * (o - i)) * dy).sum()) * 2.0
    log = 2.0 * np.pi * (np.sqrt(R**2 - inner**2) - np.sqrt(R**2 - outer**2))
    return A, I1, 2.0 * I1, I1**2 / (A * energy), R - A / log
