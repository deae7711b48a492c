"""Beams with taper, neutral axis off the shear centre and non-structural mass: CBEAM."""

from dataclasses import dataclass

import numpy as np

from ....core.arrays import Floats, Ints, Matrices
from ....core.elements.beam import BeamSections, beam_mass, beam_stiffness
from ....core.errors import Place
from ..deck.bulk import Bulk
from ..deck.card_definition import Card, Values
from ..properties.cross_sections import section
from ..properties.materials import isotropic
from . import beam_properties
from .element_group import Context, Group, Key
from .line_elements import Lines, line_groups

_CBEAM = (
    "EID:i! PID:i=EID GA,GB>nodes:i! X1,X2,X3>x:ir OFFT:x=GGG / PA:i PB:i "
    "W1A,W2A,W3A>wa:r=0. W1B,W2B,W3B>wb:r=0. / SA:i=0 SB:i=0"
)

CARDS = (
    Card("CBEAM", _CBEAM, "eid", blanks_from="BEAMOR", elements="beam", properties="PBEAM PBEAML"),
    Card("BEAMOR", "- PID:i - - X1,X2,X3>x:ir OFFT:x"),
    *beam_properties.CARDS,
)


@dataclass(frozen=True, eq=False)
class _Beam:
    """Constants of a beam property.

    Parameters
    ----------
    E, G, rho : float
        Of the material.
    stations : (m,) float
        Fractions of the length.
    values : (5, m) float
        A, I1, I2, I12, J at the stations.
    shear : (2,) float
        K1, K2; zero: rigid in shear.
    neutral : (2, 2) float
        y and z of the neutral axis at ends A and B, from the shear centre.
    nsm : (2,) float
        Non-structural mass per length at the ends.
    nsm_at : (2, 2) float
        y and z of its centre of gravity.
    nsi : (2,) float
        Its moment of inertia per length.
    """

    E: float
    G: float
    rho: float
    stations: Floats
    values: Floats
    shear: Floats
    neutral: Floats
    nsm: Floats
    nsm_at: Floats
    nsi: Floats


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
    make = _pbeam if key[0] == "PBEAM" else _pbeaml
    return make(card, place, E, G, rho)


def _pbeam(card: Values, place: Place, E: float, G: float, rho: float) -> _Beam:
    stations = np.array(card.x)
    values = np.array([card.a, card.i1, card.i2, card.i12, card.j])
    nsm = np.array(card.nsm)
    A, I1, I2, I12, _ = values
    if not ((A >= 0.0) & (I1 > 0.0) & (I2 > 0.0) & (I12**2 < I1 * I2)).all():
        raise place.error("its area and inertias are not those of a real section")
    stations, values, nsm = _to_end(stations, values, nsm)
    return _Beam(
        E, G, rho, stations, values,
        np.array([card.k1, card.k2]),
        np.reshape(card.n, (2, 2)),
        nsm[[0, -1]],
        np.reshape(card.m, (2, 2)),
        np.array(card.nsi),
    )  # fmt: skip


def _pbeaml(card: Values, place: Place, E: float, G: float, rho: float) -> _Beam:
    stations = np.array(card.x)
    found = [section(card.type, d, place) for d in card.dim]
    order = np.argsort(stations, kind="stable")
    stations = stations[order]
    found = [found[k] for k in order]
    values = np.array([[s.A, s.I1, s.I2, s.I12, s.J] for s in found]).T
    nsm = np.array(card.nsm)[order]
    first, last = found[0], found[-1]
    stations, values, nsm = _to_end(stations, values, nsm)
    return _Beam(
        E, G, rho, stations, values,
        np.array([first.K1, first.K2]),
        np.array([[first.shear_y, first.shear_z], [last.shear_y, last.shear_z]]),
        nsm[[0, -1]],
        np.zeros((2, 2)),
        np.zeros(2),
    )  # fmt: skip


def _to_end(stations: Floats, values: Floats, nsm: Floats) -> tuple[Floats, Floats, Floats]:
    """Repeat the last section at end B where the card gives none there."""
    if stations[-1] < 1.0:
        stations = np.append(stations, 1.0)
        values = np.column_stack([values, values[:, 0] if len(values.T) == 1 else values[:, -1]])
        nsm = np.append(nsm, nsm[-1])
    return stations, values, nsm


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
