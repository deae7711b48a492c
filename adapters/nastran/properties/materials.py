"""Material constants from MAT1, MAT2, MAT8, MAT9 and MAT11, as elements need them."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ....core.arrays import Floats
from ....core.elements.volumes.solid import isotropic_solid
from ....core.errors import Place
from ..deck.bulk import Bulk
from ..deck.card_definition import Card, Values
from ..deck.movable_values import Doubt, Moves

_RHO = "RHO:r=0."
_INDEFINITE = 1e-3
"""Negative stiffness of a MAT9, beside its largest, that is no rounding of its digits."""

CARDS = (
    Card(
        "MAT1",
        f"MID:i! E:r G:r NU:r {_RHO} A:r=0. TREF:r=0. GE:r=0. / ST:r=0. SC:r=0. SS:r=0. MCSID:i=0",
        "mid",
        space="material",
        moves=Moves(
            also={"ALPHA": "A"},
            linear=("E", "RHO"),
            doubt=Doubt(("E",), 0.1, 0.7, 1.4, binding="G"),
        ),
    ),
    Card(
        "MAT2",
        f"MID:i! G11,G12,G13,G22,G23,G33>g:r=0. {_RHO} / A1:r A2:r A3:r TREF:r=0. GE:r=0. ST:r "
        "SC:r SS:r / MCSID:i GE11,GE12,GE13,GE22,GE23,GE33>damping:r=0.",
        "mid",
        space="material",
        moves=Moves(linear=("RHO",)),
    ),
    Card(
        "MAT8",
        f"MID:i! E1:r! E2:r! NU12:r=0. G12:r=0. G1Z:r G2Z:r {_RHO} / A1:r=0. A2:r=0. TREF:r=0. "
        "XT:r=0. XC:r=XT YT:r=0. YC:r=YT S:r=0. / GE:r=0. F12:r=0. STRN:r=0.",
        "mid",
        space="material",
        moves=Moves(
            also={
                "E11": "E1",
                "E22": "E2",
                "G13": "G1Z",
                "G23": "G2Z",
                "G1,Z": "G1Z",
                "G2,Z": "G2Z",
            },
            linear=("RHO",),
        ),
    ),
    Card(
        "MAT9",
        "MID:i! G11,G12,G13,G14,G15,G16,G22,G23,G24,G25,G26,G33,G34,G35,G36,G44,G45,G46,G55,G56,"
        f"G66>g:r=0. {_RHO} A1,A2,A3,A4,A5,A6>a:r=0. TREF:r=0. GE:r=0.",
        "mid",
        space="material",
        moves=Moves(linear=("RHO",)),
    ),
    Card(
        "MAT11",
        "MID:i! E1,E2,E3>e:r! NU12,NU13,NU23>nu:r! G12,G13,G23>g:r! "
        f"{_RHO} A1,A2,A3>a:r=0. TREF:r=0. GE:r=0.",
        "mid",
        space="material",
        moves=Moves(linear=("RHO",)),
    ),
)

SHELL_MATERIALS = ("MAT1", "MAT2", "MAT8")


class Isotropic(NamedTuple):
    """E, G, nu, rho of a MAT1; G or E or nu derived where the card leaves it blank."""

    E: float
    G: float
    nu: float
    rho: float


@dataclass(frozen=True, eq=False)
class Plane:
    """A material in plane stress.

    Parameters
    ----------
    Q : (3, 3) float
        Stresses from strains.
    shear : (2, 2) float
        Transverse shear moduli; infinite where the material is rigid in shear.
    rho : float
        Density.
    isotropic : bool
        Whether it is the same in all directions.
    """

    Q: Floats
    shear: Floats
    rho: float
    isotropic: bool


@dataclass(frozen=True, eq=False)
class Elastic:
    """A material in three dimensions.

    Parameters
    ----------
    C : (6, 6) float
        Stresses from strains xx, yy, zz, xy, yz, zx (engineering shears).
    rho : float
        Density.
    isotropic : bool
        Whether it is the same in all directions.
    """

    C: Floats
    rho: float
    isotropic: bool


def isotropic(bulk: Bulk, mid: int | None, asked_by: Place) -> Isotropic:
    """Return the constants of a MAT1 for an element that takes E and G apart.

    Where NU is blank nothing follows from it, and E and G may be in any ratio.

    Raises
    ------
    InputError
        No such MAT1, or one that is not physical.
    """
    card = _found(bulk, ("MAT1",), mid, asked_by)[1]
    return _constants(bulk, card, any_ratio=card.nu is None)


def _found(
    bulk: Bulk, names: tuple[str, ...], mid: int | None, asked_by: Place
) -> tuple[str, Values]:
    found = None if mid is None else bulk.find(names, int(mid))
    if found is None:
        raise asked_by.fault(
            f"refers to material {mid}, but there is no {' or '.join(names)} {mid}"
        )
    return found


def _constants(bulk: Bulk, card: Values, any_ratio: bool = False) -> Isotropic:
    place = bulk.place("MAT1", card.mid)
    E, G, nu = _derived(card, place)
    if E < 0.0 or G < 0.0:
        name, value = ("E", E) if E < 0.0 else ("G", G)
        raise place.error(f"{name} is {value:g}; a modulus must not be negative")
    if not (any_ratio or -1.0 < nu <= 0.5):
        raise place.error(
            f"Poisson's ratio is {nu:g}; it must lie between -1 and 0.5 (check E and G where NU is "
            "blank)"
        )
    return Isotropic(E, G, nu, card.rho)


def _derived(card: Values, place: Place) -> tuple[float, float, float]:
    """E, G, nu, the blank one from the other two (MAT1, remark 3); alone it leaves zeros."""
    E, G, nu = card.e, card.g, card.nu
    if E is None and G is None:
        raise place.error("E and G must not both be blank")
    if nu is None:
        nu = 0.0 if E is None or G is None else E / (2.0 * G) - 1.0 if G else np.inf
        return E or 0.0, G or 0.0, nu
    return (
        2.0 * (1.0 + nu) * G if E is None else E,
        E / (2.0 * (1.0 + nu)) if G is None and nu != -1.0 else G or 0.0,
        nu,
    )


def elastic(bulk: Bulk, mid: int, asked_by: Place) -> Elastic:
    """Return a MAT1, MAT9 or MAT11 in three dimensions, in its own axes.

    Raises
    ------
    InputError
        No such material, or one that is not physical.
    """
    name, card = _found(bulk, ("MAT1", "MAT9", "MAT11"), mid, asked_by)
    if name == "MAT1":
        E, _, nu, rho = _constants(bulk, card)
        if not nu < 0.5:
            raise bulk.place(name, int(mid)).error("solids need NU below 0.5")
        return Elastic(isotropic_solid(np.array([E]), np.array([nu]))[0], rho, True)
    if name == "MAT11":
        return Elastic(_orthotropic(card, bulk.place(name, int(mid))), card.rho, False)
    C = np.zeros((6, 6))
    rows, columns = np.triu_indices(6)
    C[rows, columns] = C[columns, rows] = card.g
    values = np.linalg.eigvalsh(C)
    if values[0] < -_INDEFINITE * abs(values).max():
        raise bulk.place(name, int(mid)).error(
            "G11 to G66 are those of no material: some strain of it takes negative energy; "
            "check their order and signs"
        )
    return Elastic(C, card.rho, False)


def _orthotropic(card: Values, place: Place) -> Floats:
    """Stresses from strains of a MAT11: the inverse of its compliances."""
    (E1, E2, E3), (nu12, nu13, nu23), (G12, G13, G23) = card.e, card.nu, card.g
    if not min(*card.e, *card.g) > 0.0:
        raise place.error("every modulus must be positive")
    S = np.diag([1.0 / E1, 1.0 / E2, 1.0 / E3, 1.0 / G12, 1.0 / G23, 1.0 / G13])
    for i, j, value in ((0, 1, nu12 / E1), (0, 2, nu13 / E1), (1, 2, nu23 / E2)):
        S[i, j] = S[j, i] = -value
    if not np.linalg.eigvalsh(S[:3, :3])[0] > 0.0:
        raise place.error("NU12, NU13 and NU23 are not possible with E1, E2 and E3")
    return np.asarray(np.linalg.inv(S))


def plane(bulk: Bulk, mid: int, asked_by: Place) -> Plane:
    """Return a material in plane stress.

    Raises
    ------
    InputError
        No such material, or one that is not physical.
    """
    name, card = _found(bulk, SHELL_MATERIALS, mid, asked_by)
    return {"MAT1": _plane_isotropic, "MAT2": _plane_general, "MAT8": _plane_orthotropic}[name](
        bulk, card
    )


def _plane_isotropic(bulk: Bulk, card: Values) -> Plane:
    E, G, nu, rho = _constants(bulk, card)
    Q = E / (1.0 - nu**2) * np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, 0.5 - 0.5 * nu]])
    return Plane(Q, G * np.eye(2), rho, True)


def _plane_general(bulk: Bulk, card: Values) -> Plane:
    Q = np.zeros((3, 3))
    rows, columns = np.triu_indices(3)
    Q[rows, columns] = Q[columns, rows] = card.g
    return Plane(Q, Q[:2, :2].copy(), card.rho, False)


def _plane_orthotropic(bulk: Bulk, card: Values) -> Plane:
    E1, E2, nu12 = card.e1, card.e2, card.nu12
    nu21 = nu12 * E2 / E1 if E1 else 0.0
    rest = 1.0 - nu12 * nu21
    if not rest > 0.0:
        raise bulk.place("MAT8", card.mid).error(f"NU12 {nu12:g} is not possible with E1 and E2")
    Q = np.zeros((3, 3))
    Q[0, 0], Q[1, 1], Q[2, 2] = E1 / rest, E2 / rest, card.g12
    Q[0, 1] = Q[1, 0] = nu12 * E2 / rest
    shear = np.diag([card.g1z or np.inf, card.g2z or np.inf])
    return Plane(Q, shear, card.rho, False)
