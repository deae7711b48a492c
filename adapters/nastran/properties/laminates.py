"""Sections of shells from PSHELL, PCOMP and PCOMPG, in material axes."""

from dataclasses import dataclass

import numpy as np

from ....core.arrays import Floats
from ....core.errors import Place
from ..deck.bulk import Bulk
from ..deck.card_definition import Card, Values
from ..deck.movable_values import Doubt, Moves
from .materials import SHELL_MATERIALS, Plane, isotropic, plane

_LAMINATE = "PID:i! Z0:r NSM:r=0. SB:r=0. FT:w TREF:r=0. GE:r=0. LAM:w"

CARDS = (
    Card(
        "PSHELL",
        "PID:i! MID1:i T:r MID2:i 12I/T**3>bending:r=1. MID3:i TS/T>shear:r=.833333 NSM:r=0. / "
        "Z1:r Z2:r MID4:i",
        "pid",
        space="shell property",
        moves=Moves(
            also={
                **dict.fromkeys(("12I/T3", "12I/T^3", "12I/TTT", "12I/T*3", "BK"), "12I/T**3"),
                "TST": "TS/T",
                "THICKNESS": "T",
            },
            linear=("NSM",),
            doubt=Doubt(("T",), 0.06, 0.7, 1.4),
        ),
    ),
    Card(
        "PCOMP",
        f"{_LAMINATE} [MID:i=^ T:r=^ THETA:r=0. SOUT:w=NO]",
        "pid",
        space="shell property",
        moves=Moves(linear=("NSM",)),
    ),
    Card(
        "PCOMPG",
        f"{_LAMINATE} [GPLYID:i! MID:i=^ T:r=^ THETA:r=0. SOUT:w=NO - - -]",
        "pid",
        space="shell property",
        moves=Moves(),
    ),
)


@dataclass(frozen=True, eq=False)
class Layup:
    """Stiffness and mass of a shell property.

    Parameters
    ----------
    A, B, D : (3, 3) float
        See `core.elements.section.ShellSection`.
    S : (2, 2) float
        Transverse shear stiffness.
    density : float
        Mass per area, NSM included.
    isotropic : bool
        Whether turning it changes nothing.
    materials : tuple of (card, number)
        Materials used.
    """

    A: Floats
    B: Floats
    D: Floats
    S: Floats
    density: float
    isotropic: bool
    materials: tuple[tuple[str, int], ...]


def layup(
    bulk: Bulk, key: tuple[str, int], place: Place, own: float = 0.0, share: float = 1.0
) -> Layup:
    """Return the section of a shell property.

    Parameters
    ----------
    bulk : Bulk
        Cards.
    key : (str, int)
        Card name and number of the property.
    place : Place
        The same with file and line, for messages.
    own, share : float
        The thickness is ``own + share * T`` (PSHELL only): corners may have their own.

    Raises
    ------
    InputError
        No thickness, no material, values that are not possible.
    """
    card = bulk.table(key[0])[key[1]]
    if key[0] == "PSHELL":
        return _pshell(bulk, card, place, own, share)
    return _pcomp(bulk, card, place)


def _pshell(bulk: Bulk, card: Values, place: Place, own: float, share: float) -> Layup:
    t = own + share * (card.t or 0.0)
    if not t > 0.0:
        raise place.error(f"the thickness T is {t:g}; it must be positive")
    mid1, mid2, mid3, mid4 = (m or None for m in (card.mid1, card.mid2, card.mid3, card.mid4))
    zero = np.zeros((3, 3))
    strain = mid2 == -1
    mid2 = None if strain else mid2
    mids = [mid for mid in (mid1, mid2, mid3, mid4) if mid is not None]
    used = {mid: plane(bulk, mid, place) for mid in mids}
    if not used:
        raise place.fault("names no material")
    if strain and mid1 is not None:
        used[mid1] = _plane_strain(bulk, mid1, used[mid1], place)
    A = used[mid1].Q * t if mid1 is not None else zero
    inertia = card.bending * t**3 / 12.0
    D = used[mid2].Q * inertia if mid2 is not None else zero
    B = used[mid4].Q * t**2 if mid4 is not None else zero
    S = np.diag([np.inf, np.inf])
    if mid3 is not None and mid2 is not None:
        S = used[mid3].shear * (card.shear * t)
    first = used[mids[0]]
    density = first.rho * t + card.nsm
    keys = tuple(_key(bulk, mid) for mid in used)
    same = all(m.isotropic for m in used.values())
    return Layup(A, B, D, S, density, same, keys)


def _key(bulk: Bulk, mid: int) -> tuple[str, int]:
    found = bulk.find(SHELL_MATERIALS, mid)
    return (found[0] if found else "MAT1"), mid


def _plane_strain(bulk: Bulk, mid: int, material: Plane, place: Place) -> Plane:
    if mid not in bulk.table("MAT1"):
        raise place.error("plane strain (MID2 -1) needs a MAT1 as MID1")
    E, _, nu, _ = isotropic(bulk, mid, place)
    if not nu < 0.5:
        raise place.error("plane strain needs a Poisson's ratio below 0.5")
    c = E / ((1.0 + nu) * (1.0 - 2.0 * nu))
    Q = c * np.array([[1.0 - nu, nu, 0.0], [nu, 1.0 - nu, 0.0], [0.0, 0.0, 0.5 - nu]])
    return Plane(Q, material.shear, material.rho, True)


def _pcomp(bulk: Bulk, card: Values, place: Place) -> Layup:
    """Classical laminate theory; transverse shear as Nastran finds it for the whole laminate."""
    t, theta, mids = _plies(card, place)
    lam = card.lam or ""
    if lam not in ("", "BEND", "MEM", "SYM", "SMEAR", "SMCORE"):
        raise place.error(f"LAM {lam!r} is not one of SYM, MEM, BEND, SMEAR, SMCORE")
    if lam == "SMCORE" and len(t) < 2:
        raise place.error("LAM SMCORE needs plies of the faces and, as the last, the core")
    materials = {mid: plane(bulk, mid, place) for mid in dict.fromkeys(mids)}
    Q = np.array([_turned(materials[m].Q, a) for m, a in zip(mids, theta, strict=True)])
    G = np.array([_turned_shear(materials[m].shear, a) for m, a in zip(mids, theta, strict=True)])
    rho = np.array([materials[m].rho for m in mids])
    if lam == "SMCORE":
        Q, G, rho = (_smeared_faces(t, x) for x in (Q, G, rho))
        t = _smeared_faces(t, None)
    total = float(t.sum())
    bottom = -0.5 * total if card.z0 is None else float(card.z0)
    low = bottom + np.concatenate([[0.0], np.cumsum(t)[:-1]])
    high = low + t
    A = np.einsum("p,pij->ij", high - low, Q)
    B = np.einsum("p,pij->ij", 0.5 * (high**2 - low**2), Q)
    D = np.einsum("p,pij->ij", (high**3 - low**3) / 3.0, Q)
    S = _transverse_shear(Q, G, low, high)
    zero = np.zeros((3, 3))
    if lam == "SMEAR":
        B, D = zero, A * total**2 / 12.0
        S = np.diag([np.inf, np.inf])  # no MID3 on the PSHELL derived
    elif lam == "MEM":
        B, D = zero, zero
    elif lam == "BEND":
        A, B = zero, zero
    if np.abs(B).max() <= 1e-12 * np.abs(A).max() * total:
        B = zero
    density = float(rho @ t) + card.nsm
    same = all(m.isotropic for m in materials.values())
    keys = tuple(_key(bulk, mid) for mid in materials)
    return Layup(A, B, D, S, density, same, keys)


def _smeared_faces(t: Floats, values: Floats | None) -> Floats:
    """Values per ply of a sandwich whose last ply is the core and whose others are smeared.

    Half of the thickness of the faces is above the core and half below, whatever the order of
    the plies (LAM SMCORE). Without values, the thicknesses themselves.
    """
    if values is None:
        half = 0.5 * float(t[:-1].sum())
        return np.array([half, t[-1], half])
    face = np.average(values[:-1], axis=0, weights=t[:-1])
    return np.array([face, values[-1], face])


def _plies(card: Values, place: Place) -> tuple[Floats, Floats, list[int]]:
    t = np.array(card.t, dtype=np.float64)
    theta = np.radians(np.array(card.theta, dtype=np.float64))
    mids = list(card.mid)
    if None in mids:
        raise place.error("a ply names no material")
    if not len(t) or not (t > 0.0).all():
        raise place.error("every ply needs a positive thickness")
    if card.lam == "SYM":  # the plies listed are the lower half
        t, theta = (np.concatenate([x, x[::-1]]) for x in (t, theta))
        mids = [*mids, *mids[::-1]]
    return t, theta, mids


def _turned(Q: Floats, angle: float) -> Floats:
    """Plane stress stiffness of a ply at an angle, in laminate axes."""
    c, s = np.cos(angle), np.sin(angle)
    T = np.array(
        [[c * c, s * s, s * c], [s * s, c * c, -s * c], [-2 * s * c, 2 * s * c, c * c - s * s]]
    )
    return np.asarray(T.T @ Q @ T)


def _turned_shear(G: Floats, angle: float) -> Floats:
    if not np.isfinite(G).all():
        return G
    c, s = np.cos(angle), np.sin(angle)
    R = np.array([[c, s], [-s, c]])
    return np.asarray(R.T @ G @ R)


def _transverse_shear(Q: Floats, G: Floats, low: Floats, high: Floats) -> Floats:
    """Shear stiffness of a laminate from equilibrium, in x and in y separately.

    The shear stress that equilibrium asks for, tau = -V F(z) / R with F the integral of
    Q (z - z_neutral) from the bottom and R the bending stiffness about the neutral axis, gives the
    strain energy V**2 / (2 S) (MSC Nastran Theoretical Manual, laminates; for one isotropic ply
    S = 5/6 G t).
    """
    S = np.zeros((2, 2))
    for k in (0, 1):
        if not np.isfinite(G[:, k, k]).all():
            return np.diag([np.inf, np.inf])
        E = Q[:, k, k]
        neutral = float((E * 0.5 * (high**2 - low**2)).sum() / (E * (high - low)).sum())
        a, b = low - neutral, high - neutral
        R = float((E * (b**3 - a**3) / 3.0).sum())
        below, energy = 0.0, 0.0
        for e, g, za, zb in zip(E, G[:, k, k], a, b, strict=True):
            # F(z) = below + e (z**2 - za**2) / 2, squared and integrated over the ply
            c = below - 0.5 * e * za**2
            energy += (
                c**2 * (zb - za)
                + c * e * (zb**3 - za**3) / 3.0
                + 0.25 * e**2 * (zb**5 - za**5) / 5.0
            ) / g
            below += 0.5 * e * (zb**2 - za**2)
        S[k, k] = R**2 / energy
    return S
