"""Beams of three nodes: CBEAM3."""

from typing import Any

import numpy as np

from .....core.arrays import Floats, Ints, Matrices
from .....core.elements.batch import arms, congruent
from .....core.elements.lines.beam3 import Curves, CurveSections, beam3_mass, beam3_stiffness
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Values
from ...deck.movable_values import Moves
from ...properties.materials import isotropic
from ..element_group import (
    Context,
    Group,
    Key,
    check_shape,
    connected,
    element_sources,
    with_material,
)
from .line_elements import check_orientation, orientation


def _section(at: str, needed: str) -> str:
    names = ",".join(f"{n}({at})" for n in ("A", "IZ", "IY"))
    rest = ",".join(f"{n}({at})" for n in ("IYZ", "J", "NSM"))
    points = ",".join(f"{p}{c}({at})" for p in "CDEF" for c in "YZ")
    low = at.lower()
    return f"{names}>{low}:r{needed} {rest}>{low}:r / {points}>points:r"


def _pairs(names: str, attribute: str) -> str:
    return ",".join(f"{n}({at})" for at in "ABC" for n in names.split()) + f">{attribute}:r"


CARDS = (
    Card(
        "CBEAM3",
        "EID:i! PID:i! GA,GB,GC>nodes:i! X1,X2,X3>x:ir / "
        "W1A,W2A,W3A,W1B,W2B,W3B,W1C,W2C,W3C>w:r=0. TWA,TWB,TWC>twist:r=0. SA,SB,SC>warping:i",
        "eid",
        elements="beam3",
        properties="PBEAM3",
    ),
    Card(
        "PBEAM3",
        f"PID:i! MID:i! {_section('A', '!')} / SO(B)>so:w - {_section('B', '')} / "
        f"SO(C)>so:w - {_section('C', '')} / KY,KZ>k:r=1. {_pairs('NY NZ', 'n')} "
        f"{_pairs('MY MZ', 'm')} {_pairs('NSIY NSIZ NSIYZ', 'nsi')} {_pairs('CW', 'cw')} ...",
        "pid",
        space="beam property",
        moves=Moves(),
    ),
)


def three_node_beams(context: Context) -> list[Group]:
    """Make the group of CBEAM3."""
    cards = list(context.bulk.table("CBEAM3").values())
    if not cards:
        return []
    bulk, points = context.bulk, context.points
    element = bulk.definitions["CBEAM3"].element
    assert element is not None
    ids, nodes, keys, of = connected(context, "CBEAM3", cards)
    v = orientation(context, "CBEAM3", cards, ids, nodes[:, :2])
    offset = np.array([c.w for c in cards]).reshape(-1, 3, 3)
    offset = np.einsum("nkai,nka->nki", points.directions[nodes], offset)
    xyz = points.xyz[nodes] + offset
    check_shape(context, "CBEAM3", element, ids, xyz)
    twist = np.radians([c.twist for c in cards])
    _check(context, ids, xyz, v)
    context.notes.append(
        f"CBEAM3: Nastran's law of {element.unknown} is not known; a quadratic beam flexible in "
        "shear stands for it, warping of the cross section is left out"
    )
    T = arms(np.broadcast_to(np.eye(3), (len(ids), 3, 3)), offset)

    def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        used, position = np.unique(of[rows], return_inverse=True)
        found = [_Constants(values, keys[k]) for k in used]
        curves = Curves(xyz[rows], v[rows], twist[rows])
        K = M = None
        if wanted[0]:
            each = np.array([c.sections for c in found], dtype=object)[position]
            sections = CurveSections(*(np.array(list(x), float) for x in each.T))
            K = congruent(beam3_stiffness(curves, sections), T[rows])
        if wanted[1]:
            masses, centres, inertias = (
                np.array([getattr(c, n) for c in found])[position]
                for n in ("masses", "centres", "inertias")
            )
            masses[:, :, 1] += np.reshape(context.extra_mass(values, ids[rows]), (-1, 1))
            coupled = context.settings.coupled
            M = congruent(beam3_mass(curves, masses, centres, inertias, coupled), T[rows])
        return K, M

    of_property = [with_material(bulk, key) for key in keys]
    sources, source_of = element_sources(context, "CBEAM3", ids, of_property, of)
    return [Group("CBEAM3", ids, element, nodes, matrices, sources, source_of)]


class _Constants:
    """Values of a property at the three points."""

    def __init__(self, bulk: Bulk, key: Key) -> None:
        place, card = bulk.place(*key), bulk.table(key[0])[key[1]]
        E, G, _, rho = isotropic(bulk, card.mid, place)
        at = _at_points(card)
        A, Iz, Iy, Iyz, J, nsm = at.T
        real = (A > 0.0) & (Iz > 0.0) & (Iy > 0.0) & (J >= 0.0) & (Iyz**2 < Iz * Iy)
        if not real.all():
            raise place.error("its area and inertias are not those of a real section")
        if not min(card.k) > 0.0:
            raise place.error("KY and KZ must be positive")
        neutral, beside = _filled(card.n, 2), _filled(card.m, 2)
        nsi = _filled(card.nsi, 3)
        self.sections: list[Any] = [E, G, *card.k, A, Iz, Iy, Iyz, J, neutral[:, 0], neutral[:, 1]]
        self.masses = np.stack([rho * A, nsm], axis=1)
        self.centres = np.stack([neutral, beside], axis=1)
        self.inertias = np.stack([rho * np.stack([Iy, Iz, Iyz], axis=1), nsi], axis=1)


def _at_points(card: Values) -> Floats:
    """Return A, IZ, IY, IYZ, J, NSM, (3, 6): at B and C those at A where blank."""
    a, iz, iy, iyz, j, nsm = card.a
    first = (a, iz, iy, iyz or 0.0, iz + iy if j is None else j, nsm or 0.0)
    return np.array([first, *([x if y is None else y for x, y in zip(first, other, strict=True)]
                              for other in (card.b, card.c))])  # fmt: skip


def _filled(values: tuple[float | None, ...], width: int) -> Floats:
    """Values at A, B and C, (3, width): zero where blank at A, at B and C those at A."""
    a = [v or 0.0 for v in values[:width]]
    rows = (values[k : k + width] for k in (width, 2 * width))
    return np.array(
        [a, *([x if y is None else y for x, y in zip(a, r, strict=True)] for r in rows)]
    )


def _check(context: Context, ids: Ints, xyz: Floats, v: Floats) -> None:
    """Raise `InputError` for a middle node off the middle third, or v along the beam."""
    chord = xyz[:, 1] - xyz[:, 0]
    at = np.einsum("ni,ni->n", xyz[:, 2] - xyz[:, 0], chord) / np.einsum("ni,ni->n", chord, chord)
    off = np.flatnonzero((at < 0.26) | (at > 0.74))
    if len(off):
        place = context.bulk.place("CBEAM3", int(ids[off[0]]))
        raise place.error("its grid GC does not lie between GA and GB")
    check_orientation(context, "CBEAM3", ids, chord, v)
