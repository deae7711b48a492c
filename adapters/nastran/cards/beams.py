"""Beams with taper, neutral axis off the shear centre and non-structural mass: CBEAM."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.assembly import Matrices
from ....core.elements.bar import offset_transform
from ....core.elements.beam import BeamSections, beam_mass, beam_stiffness
from ....core.errors import InputError
from ..cards import Bulk, Card
from ..materials import isotropic
from ..sections import section
from .common import Context, Group, Key, distinct_properties, element_sources
from .lines import line_axes

BEAM_PROPERTIES = ("PBEAM", "PBEAML")


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
    cards = list(context.bulk.table("CBEAM").values())
    if not cards:
        return []
    ids = np.array([c.eid for c in cards], dtype=np.int64)
    ends = context.points.rows([c.nodes for c in cards], "CBEAM", ids)
    pids = np.array([c.pid for c in cards])
    keys, of = distinct_properties(context.bulk, BEAM_PROPERTIES, "CBEAM", ids, pids)
    lines = line_axes(context, "CBEAM", cards, ids, ends)
    _note_warping(context, cards, keys)

    def matrices(bulk: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        used, position = np.unique(of[rows], return_inverse=True)
        found = [_constants(context, bulk, keys[k]) for k in used]
        sections = _sections(found, position)
        xa, xb, v = lines.xa[rows], lines.xb[rows], lines.v[rows]

        def each(name: str) -> Floats:
            return np.array([getattr(b, name) for b in found])[position]

        neutral, shear, pins = each("neutral"), each("shear"), lines.pins[rows]
        K = M = None
        if wanted[0]:
            K = beam_stiffness(
                xa, xb, v, each("E"), each("G"), sections, shear[:, 0], shear[:, 1],
                neutral[:, 0], neutral[:, 1], pins[:, :6], pins[:, 6:],
            )  # fmt: skip
        if wanted[1]:
            nsm, at = each("nsm"), each("nsm_at")
            nsm = nsm + np.reshape(context.extra_mass(bulk, ids[rows]), (-1, 1))
            M = beam_mass(
                xa, xb, v, each("rho"), sections, context.settings.coupled, neutral[:, 0],
                neutral[:, 1], nsm, at[:, 0], at[:, 1], each("nsi"),
            )  # fmt: skip
        if lines.offset:
            T = offset_transform(lines.wa[rows], lines.wb[rows])
            K, M = (None if X is None else T.swapaxes(1, 2) @ X @ T for X in (K, M))
        return K, M

    of_property = [
        frozenset([key, ("MAT1", int(context.bulk.table(key[0])[key[1]].mid))]) for key in keys
    ]
    sources, source_of = element_sources(context, ids, of_property, of)
    return [Group("CBEAM", ids, ends, 6, matrices, sources, source_of, "line", ends)]


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


def _constants(context: Context, bulk: Bulk, key: Key) -> _Beam:
    place = context.bulk.place(*key)
    card = bulk.table(key[0])[key[1]]
    E, G, _, rho = isotropic(bulk, card.mid, place)
    make = _pbeam if key[0] == "PBEAM" else _pbeaml
    return make(card, place, E, G, rho)


def _pbeam(card: Card, place: str, E: float, G: float, rho: float) -> _Beam:
    stations = np.array(card.xxb, dtype=np.float64)
    values = np.array([card.A, card.i1, card.i2, card.i12, card.j], dtype=np.float64)
    nsm = np.array(card.nsm, dtype=np.float64)
    A, I1, I2, I12, _ = values
    if not ((A >= 0.0) & (I1 > 0.0) & (I2 > 0.0) & (I12**2 < I1 * I2)).all():
        raise InputError(f"{place}: its area and inertias are not those of a real section")
    stations, values, nsm = _to_end(stations, values, nsm)
    return _Beam(
        E, G, rho, stations, values,
        np.array([card.k1 or 0.0, card.k2 or 0.0]),
        np.array([[card.n1a, card.n2a], [card.n1b, card.n2b]]),
        nsm[[0, -1]],
        np.array([[card.m1a, card.m2a], [card.m1b, card.m2b]]),
        np.array([card.nsia, card.nsib]),
    )  # fmt: skip


def _pbeaml(card: Card, place: str, E: float, G: float, rho: float) -> _Beam:
    shape = str(card.beam_type).upper()
    stations = np.array(card.xxb, dtype=np.float64)
    found = [section(shape, list(np.atleast_1d(d)), place) for d in card.dim]
    order = np.argsort(stations, kind="stable")
    stations = stations[order]
    found = [found[k] for k in order]
    values = np.array([[s.A, s.I1, s.I2, s.I12, s.J] for s in found]).T
    nsm = np.array([n or 0.0 for n in card.nsm], dtype=np.float64)[order]
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


def _note_warping(context: Context, cards: list[Card], keys: list[Key]) -> None:
    """Say that warping is left out."""
    bulk = context.bulk
    warped = [bulk.place("CBEAM", c.eid) for c in cards if c.sa or c.sb]
    tables = ((key, bulk.table(key[0])[key[1]]) for key in keys)
    warped += [
        bulk.place(*key)
        for key, card in tables
        if key[0] == "PBEAM" and (card.cwa or card.cwb) and not warped
    ]
    if warped:
        more = f" and {len(warped) - 1} more" if warped[1:] else ""
        context.notes.append(f"{warped[0]}{more}: warping of the cross section is left out")
