"""Beams with taper, neutral axis off the shear centre and non-structural mass: CBEAM."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .....core.arrays import Floats, Ints, Matrices
from .....core.elements.lines.beam import BeamSections, beam_mass, beam_stiffness
from .....core.errors import Place
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Values
from ...deck.movable_values import Moves
from ...properties.cross_sections import section
from ...properties.materials import isotropic
from ..element_group import Context, Group, Key
from . import beam_properties
from .beam_properties import lumped_areas
from .line_elements import Lines, line_groups

_CBEAM = (
    "EID:i! PID:i=EID GA,GB>nodes:i! X1,X2,X3>x:ir OFFT:x=GGG / PA:i PB:i "
    "W1A,W2A,W3A>wa:r=0. W1B,W2B,W3B>wb:r=0. / SA:i=0 SB:i=0"
)

CARDS = (
    Card(
        "CBEAM",
        _CBEAM,
        "eid",
        blanks_from="BEAMOR",
        elements="beam",
        properties="PBEAM PBEAML PBCOMP",
        moves=Moves(),
    ),
    Card("BEAMOR", "- PID:i - - X1,X2,X3>x:ir OFFT:x"),
    *beam_properties.CARDS,
)


class _Beam(NamedTuple):
    """Constants of a beam property; those at ends A and B are (2,), with y and z (2, 2)."""

    E: float
    G: float
    rho: float
    stations: Floats  # (m,) fractions of the length
    values: Floats  # (5, m) A, I1, I2, I12, J at the stations
    nsm: Floats  # non-structural mass per length at the ends
    shear: Sequence[float]  # K1, K2; zero: rigid in shear
    neutral: ArrayLike  # neutral axis at the ends, from the shear centre
    nsm_at: ArrayLike  # centre of gravity of the non-structural mass
    nsi: ArrayLike  # its moment of inertia per length


def beams(context: Context) -> list[Group]:
    """Make the groups of CBEAM."""

    def make(
        bulk: Bulk,
        keys: list[Key],
        position: Ints,
        at: Lines,
        extra: Floats | float,
        wanted: tuple[bool, bool],
    ) -> Matrices:
        found = [_constants(bulk, key) for key in keys]
        sections = _sections(found, position)

        def each(name: str) -> Floats:
            return np.array([getattr(b, name) for b in found])[position]

        neutral, shear, ends = each("neutral"), each("shear"), (at.xa, at.xb, at.v)
        K = M = None
        if wanted[0]:
            K = beam_stiffness(
                *ends, each("E"), each("G"), sections, shear[:, 0], shear[:, 1],
                neutral[:, 0], neutral[:, 1], at.pins[:, :6], at.pins[:, 6:],
            )  # fmt: skip
        if wanted[1]:
            nsm, beside = each("nsm") + np.reshape(extra, (-1, 1)), each("nsm_at")
            M = beam_mass(
                *ends, each("rho"), sections, context.settings.coupled, neutral[:, 0],
                neutral[:, 1], nsm, beside[:, 0], beside[:, 1], each("nsi"),
            )  # fmt: skip
        return K, M

    groups = line_groups(context, "CBEAM", make)
    if groups:
        _note_warping(context)
    return groups


def _sections(found: list[_Beam], position: Ints) -> BeamSections:
    """Stations of a batch, the last repeated where a beam has fewer."""
    m = max(2, *(len(b.stations) for b in found))
    stations = np.ones((len(found), m))
    values = np.zeros((len(found), 5, m))
    for k, b in enumerate(found):
        n = len(b.stations)
        stations[k, :n] = b.stations
        values[k, :, :n] = b.values
        values[k, :, n:] = b.values[:, -1:]
    A, I1, I2, I12, J = (values[position, i] for i in range(5))
    return BeamSections(stations[position], A, I1, I2, I12, J)


def _constants(bulk: Bulk, key: Key) -> _Beam:
    place = bulk.place(*key)
    card = bulk.table(key[0])[key[1]]
    E, G, _, rho = isotropic(bulk, card.mid, place)
    if key[0] == "PBCOMP":
        return _composite(bulk, card, place)
    stations, nsm = np.array(card.x), np.array(card.nsm)
    if key[0] == "PBEAM":
        values = np.array([card.a, card.i1, card.i2, card.i12, card.j])
        A, I1, I2, I12, _ = values
        if not ((A >= 0.0) & (I1 > 0.0) & (I2 > 0.0) & (I12**2 < I1 * I2)).all():
            raise place.error("its area and inertias are not those of a real section")
        shear, neutral = (card.k1, card.k2), np.reshape(card.n, (2, 2))
        nsm_at, nsi = np.reshape(card.m, (2, 2)), card.nsi
    else:
        order = np.argsort(stations, kind="stable")
        found = [section(card.type, card.dim[k], place) for k in order]
        stations, nsm = stations[order], nsm[order]
        values = np.array([[s.A, s.I1, s.I2, s.I12, s.J] for s in found]).T
        shear = (found[0].K1, found[0].K2)
        neutral = np.array([[s.shear_y, s.shear_z] for s in (found[0], found[-1])])
        nsm_at, nsi = np.zeros((2, 2)), np.zeros(2)
    if stations[-1] < 1.0:  # the last section holds to end B where the card gives none there
        stations = np.append(stations, 1.0)
        values = np.column_stack([values, values[:, -1]])
    return _Beam(E, G, rho, stations, values, nsm[[0, -1]], shear, neutral, nsm_at, nsi)


def _composite(bulk: Bulk, card: Values, place: Place) -> _Beam:
    """Constants of a PBCOMP; its lumped areas, where it has any, in place of its inertias."""
    E, G, _, rho = isotropic(bulk, card.mid, place)
    neutral = np.array(card.n)
    lumped = lumped_areas(bulk, card, place)
    if lumped:
        values, line, neutral = lumped
        rho = line / values[0]
    else:
        values = np.array([card.a, card.i1, card.i2, card.i12, card.j])
        A, I1, I2, I12, _ = values
        if not (min(A, I1, I2) > 0.0 and I12**2 < I1 * I2):
            raise place.error("its area and inertias are not those of a real section")
    ends = np.array([0.0, 1.0])
    nsm, shear = np.full(2, card.nsm), (card.k1, card.k2)
    return _Beam(
        E,
        G,
        rho,
        ends,
        np.stack([values] * 2, axis=1),
        nsm,
        shear,
        [neutral] * 2,
        [card.m] * 2,
        np.zeros(2),
    )


def _note_warping(context: Context) -> None:
    """Say that warping is left out."""
    bulk = context.bulk
    cards, properties = bulk.table("CBEAM").values(), bulk.table("PBEAM")
    warped = [bulk.place("CBEAM", c.eid) for c in cards if c.sa or c.sb]
    if not warped:
        used = sorted({c.pid for c in cards} & properties.keys())
        warped = [bulk.place("PBEAM", pid) for pid in used if any(properties[pid].cw)]
    if warped:
        more = f" and {len(warped) - 1} more" if warped[1:] else ""
        context.notes.append(f"{warped[0]}{more}: warping of the cross section is left out")
