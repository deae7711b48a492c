"""Tapered beams as Nastran's CBEAM."""

from dataclasses import dataclass, fields

import numpy as np

from ...arrays import Floats, Numbers, hold
from ...data.shapes import LINE
from ..batch import congruent, symmetric, transpose
from ..element import Element
from ..quadrature import gauss_line
from .bar import add_spring, from_axes, lumped_ends, release

_X, _W = gauss_line(8)
_X, _W = 0.5 * (_X + 1.0), 0.5 * _W
_X3, _W3 = gauss_line(3)
_X3, _W3 = 0.5 * (_X3 + 1.0), 0.5 * _W3


@dataclass(frozen=True, eq=False)
class BeamSections:
    """Section properties at stations along each beam, linear in between.

    Parameters
    ----------
    station : (n, m) float
        Fractions of the length, from 0 at end A rising to 1 at end B; a station may be repeated,
        so that beams of a batch may have different numbers of them.
    A, I1, I2, I12, J : (n, m) float
        Area, inertias (I1: bending in plane 1, x-y), torsion constant.
    """

    station: Floats
    A: Floats
    I1: Floats
    I2: Floats
    I12: Floats
    J: Floats

    def __post_init__(self) -> None:
        shape = np.asarray(self.station).shape
        for field in fields(self):
            hold(self, field.name, np.float64, shape, f"beam property {field.name}")

    def __len__(self) -> int:
        return len(self.station)

    def integration(
        self, points: Floats = _X, weights: Floats = _W
    ) -> tuple[Floats, Floats, dict[str, Floats]]:
        """Points x, weights w (fractions of the length) and properties there, each (n, k)."""
        a, width = self.station[:, :-1], np.diff(self.station, axis=1)
        n = len(self)

        def at(values: Floats) -> Floats:
            ends = values[:, :-1, None] + np.diff(values, axis=1)[..., None] * points
            return np.asarray(ends.reshape(n, -1))

        x = (a[..., None] + width[..., None] * points).reshape(n, -1)
        w = (width[..., None] * weights).reshape(n, -1)
        names = ("A", "I1", "I2", "I12", "J")
        return x, w, {name: at(getattr(self, name)) for name in names}


def beam_stiffness(
    xa: Floats,
    xb: Floats,
    v: Floats,
    E: Floats,
    G: Floats,
    sections: BeamSections,
    k1: Floats,
    k2: Floats,
    neutral_a: Floats,
    neutral_b: Floats,
    pins_a: Numbers,
    pins_b: Numbers,
) -> Floats:
    """Stiffness of beams between their ends, from the flexibility of the tapered beam.

    It is summed over three Gauss points from station to station, as MSC does (identified from
    twelve modes of a glider whose tail is tapered from 1 to 20 in one element).

    Parameters
    ----------
    xa, xb, v : (n, 3) float
        End points of the shear centre line (offsets already added), orientation vectors.
    E, G : (n,) float
        Moduli.
    sections : BeamSections
    k1, k2 : (n,) float
        Shear area factors in planes 1 and 2; 0: no shear flexibility.
    neutral_a, neutral_b : (n, 2) float
        Element y and z of the neutral axis, from the shear centre, at the ends.
    pins_a, pins_b : (n, 6) bool
        Motions of the element axes that the beam does not transmit to its ends.

    Returns
    -------
    (n, 12, 12) float
        Basic frame; u v w rx ry rz of end A, then of end B.
    """
    n = len(xa)
    L = np.linalg.norm(xb - xa, axis=1)
    x, w, p = sections.integration(_X3, _W3)
    w = w * L[:, None]
    K = np.zeros((n, 12, 12))
    add_spring(K, 0, _series(w, E[:, None] * p["A"]))
    add_spring(K, 3, _series(w, G[:, None] * p["J"]))
    EI = np.empty((*x.shape, 2, 2))
    EI[..., 0, 0], EI[..., 1, 1] = p["I1"], p["I2"]
    EI[..., 0, 1] = EI[..., 1, 0] = p["I12"]
    EI *= E[:, None, None, None]
    dead = ~((EI[..., 0, 0] > 0.0) & (EI[..., 1, 1] > 0.0)).all(axis=1)
    EI[dead] = np.eye(2)
    H = np.zeros((*x.shape, 2, 4))  # moments along the beam from forces and moments at end B
    H[..., 0, 0] = H[..., 1, 1] = L[:, None] * (1.0 - x)
    H[..., 0, 2] = H[..., 1, 3] = 1.0
    F = np.einsum("ng,ngai,ngaj->nij", w, H, np.linalg.solve(EI, H))
    for i, k in enumerate((k1, k2)):
        shear = np.asarray(k * G)[:, None] * p["A"]
        F[:, i, i] += np.where(shear > 0.0, w / np.where(shear > 0.0, shear, 1.0), 0.0).sum(axis=1)
    T = _tip_motion(L)
    bending = transpose(T) @ np.linalg.inv(F) @ T
    bending[dead] = 0.0
    K = congruent(K + symmetric(bending), _neutral_axis(neutral_a, neutral_b))
    K = release(K, np.concatenate([pins_a, pins_b], axis=1))
    return from_axes(K, xa, xb, v)


def beam_mass(
    xa: Floats,
    xb: Floats,
    v: Floats,
    density: Floats,
    sections: BeamSections,
    coupled: bool,
    neutral_a: Floats,
    neutral_b: Floats,
    nsm: Floats | None = None,
    nsm_a: Floats | None = None,
    nsm_b: Floats | None = None,
    nsi: Floats | None = None,
    rotary: bool = False,
) -> Floats:
    """Mass of beams, (n, 12, 12), basic frame.

    Parameters
    ----------
    xa, xb, v, sections, neutral_a, neutral_b
        As for `beam_stiffness`; the structural mass lies on the neutral axis.
    density : (n,) float
        Mass per volume.
    coupled : bool
        Hermite bending without rotary inertia, linear along the axis and with rho (I1 + I2) about
        it: to 2e-8 what Nastran's frequencies of tapered cantilevers with all offsets say.
        Otherwise lumped at the ends.
    nsm : (n, 2) float, optional
        Non-structural mass per length at the ends.
    nsm_a, nsm_b : (n, 2) float, optional
        Element y and z of its centre of gravity at the ends.
    nsi : (n, 2) float, optional
        Its moment of inertia about the axis, per length, at the ends.
    rotary : bool
        Give lumped beams the inertias rho I of end A across the axis too, as NX 2412 does and
        MSC does not.
    """
    L = np.linalg.norm(xb - xa, axis=1)
    x, w, p = sections.integration()
    w = w * (density * L)[:, None]
    if coupled:
        M = _hermite(x, w * p["A"], w * (p["I1"] + p["I2"]), L)
    else:
        M = _lumped(_ends(x, w * p["A"]), _ends(x, w * (p["I1"] + p["I2"])))
        half = 0.5 * density * L * rotary
        for end in (0, 6):
            M[:, end + 4, end + 4] += half * sections.I2[:, 0]
            M[:, end + 5, end + 5] += half * sections.I1[:, 0]
    M = congruent(M, _arms(neutral_a, neutral_b))
    if nsm is not None:
        zero = np.zeros((len(L), 2))
        line = _between(nsm)
        weight = np.broadcast_to(_W, line.shape) * L[:, None]
        spin = weight * _between(zero if nsi is None else nsi)
        x = np.broadcast_to(_X, line.shape)
        if coupled:
            N = _hermite(x, weight * line, 0.0 * line, L)
            N += _lumped(zero, _ends(x, spin))
        else:
            N = _lumped(_ends(x, weight * line), _ends(x, spin))
        arms = _arms(zero if nsm_a is None else nsm_a, zero if nsm_b is None else nsm_b)
        M = M + congruent(N, arms)
    return from_axes(M, xa, xb, v)


def _series(w: Floats, stiffness: Floats) -> Floats:
    """Stiffness of the pieces in series; zero where any has none."""
    alive = stiffness > 0.0
    flexibility = (w / np.where(alive, stiffness, 1.0)).sum(axis=1)
    return np.where((alive | (w == 0.0)).all(axis=1), 1.0 / flexibility, 0.0)


def _tip_motion(L: Floats) -> Floats:
    """v, w, rz, -ry of end B relative to the rigid motion of end A, (n, 4, 12)."""
    T = np.zeros((len(L), 4, 12))
    T[:, 0, 7], T[:, 0, 1], T[:, 0, 5] = 1.0, -1.0, -L
    T[:, 1, 8], T[:, 1, 2], T[:, 1, 4] = 1.0, -1.0, L
    T[:, 2, 11], T[:, 2, 5] = 1.0, -1.0
    T[:, 3, 10], T[:, 3, 4] = -1.0, 1.0
    return T


def _neutral_axis(a: Floats, b: Floats) -> Floats:
    """Axial motion of the neutral axis from the motions of the shear centre, (n, 12, 12)."""
    T = np.tile(np.eye(12), (len(a), 1, 1))
    for first, at in ((0, a), (6, b)):
        T[:, first, first + 4] = at[:, 1]
        T[:, first, first + 5] = -at[:, 0]
    return T


def _arms(a: Floats, b: Floats) -> Floats:
    """Move translations to points y, z beside the shear centre, (n, 12, 12)."""
    T = _neutral_axis(a, b)
    for first, at in ((0, a), (6, b)):
        T[:, first + 1, first + 3] = -at[:, 1]
        T[:, first + 2, first + 3] = at[:, 0]
    return T


def _between(ends: Floats) -> Floats:
    return np.asarray(ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * _X)


def _ends(x: Floats, amount: Floats) -> Floats:
    """Share of a distributed amount that falls to each end by linear functions, (n, 2)."""
    return np.stack([(amount * (1.0 - x)).sum(axis=1), (amount * x).sum(axis=1)], axis=1)


def _lumped(mass: Floats, spin: Floats) -> Floats:
    M = lumped_ends(mass)
    M[:, 3, 3], M[:, 9, 9] = spin.T
    return M


def _hermite(x: Floats, m: Floats, spin: Floats, L: Floats) -> Floats:
    """Consistent mass from amounts at points x: mass, and inertia about the axis."""
    M = np.zeros((len(x), 12, 12))
    linear, ends = np.stack([1.0 - x, x], axis=-1), np.array([0, 6])
    for first, amount in ((0, m), (3, spin)):
        rows = ends + first
        M[:, rows[:, None], rows] = np.einsum("ng,ngi,ngj->nij", amount, linear, linear)
    for w, r, sign in ((1, 5, 1.0), (2, 4, -1.0)):
        s = (sign * L)[:, None]
        shapes = [1.0 - 3 * x**2 + 2 * x**3, s * (x - 2 * x**2 + x**3)]
        shapes += [3 * x**2 - 2 * x**3, s * (x**3 - x**2)]
        N = np.stack(shapes, axis=-1)
        rows = np.array([w, r, w + 6, r + 6])
        M[:, rows[:, None], rows] = np.einsum("ng,ngi,ngj->nij", m, N, N)
    return M


BEAM = Element(
    name="beam", shape=LINE, freedoms=6, stiffness=beam_stiffness, mass=beam_mass, exact=True
)
