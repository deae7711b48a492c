"""Material constants from MAT1, MAT2, MAT8 and MAT9, as elements need them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...core.arrays import Floats
from ...core.elements.material import isotropic_solid
from ...core.errors import InputError
from .cards import Bulk, Card

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


def isotropic(bulk: Bulk, mid: int | None, asked_by: str) -> Isotropic:
    """Return the constants of a MAT1.

    Raises
    ------
    InputError
        No such MAT1, or one that is not physical.
    """
    card = None if mid is None else bulk.table("MAT1").get(int(mid))
    if card is None:
        raise InputError(f"{asked_by} refers to material {mid}, but there is no MAT1 {mid}")
    return _constants(bulk, card)


def _constants(bulk: Bulk, card: Card) -> Isotropic:
    E, G, nu = float(card.e or 0.0), float(card.g or 0.0), float(card.nu or 0.0)
    rho = float(card.rho or 0.0)
    if E < 0.0 or G < 0.0:
        name, value = ("E", E) if E < 0.0 else ("G", G)
        raise InputError(
            f"{bulk.place('MAT1', int(card.mid))}: {name} is {value:g}; a modulus must not be "
            "negative"
        )
    if not -1.0 < nu <= 0.5:
        raise InputError(
            f"{bulk.place('MAT1', int(card.mid))}: Poisson's ratio is {nu:g}; it must lie between "
            "-1 and 0.5 (check E and G where NU is blank)"
        )
    return Isotropic(E, G, nu, rho)


def elastic(bulk: Bulk, mid: int, asked_by: str) -> Elastic:
    """Return a MAT1 or MAT9 in three dimensions, in its own axes.

    Raises
    ------
    InputError
        No such material, or one that is not physical.
    """
    found = bulk.find(("MAT1", "MAT9"), int(mid))
    if found is None:
        raise InputError(f"{asked_by} refers to material {mid}, but there is no MAT1 or MAT9 {mid}")
    name, card = found
    if name == "MAT1":
        E, _, nu, rho = _constants(bulk, card)
        if not nu < 0.5:
            raise InputError(f"{bulk.place(name, int(mid))}: solids need NU below 0.5")
        return Elastic(isotropic_solid(np.array([E]), np.array([nu]))[0], rho, True)
    C = np.zeros((6, 6))
    for i in range(6):
        for j in range(i, 6):
            C[i, j] = C[j, i] = float(getattr(card, f"G{i + 1}{j + 1}") or 0.0)
    return Elastic(C, float(card.rho or 0.0), False)


def plane(bulk: Bulk, mid: int, asked_by: str) -> Plane:
    """Return a material in plane stress.

    Raises
    ------
    InputError
        No such material, or one that is not physical.
    """
    found = bulk.find(SHELL_MATERIALS, int(mid))
    if found is None:
        raise InputError(
            f"{asked_by} refers to material {mid}, but there is no {' or '.join(SHELL_MATERIALS)} "
            f"{mid}"
        )
    name, card = found
    return {"MAT1": _plane_isotropic, "MAT2": _plane_general, "MAT8": _plane_orthotropic}[name](
        bulk, card
    )


def _plane_isotropic(bulk: Bulk, card: Card) -> Plane:
    E, G, nu, rho = _constants(bulk, card)
    Q = E / (1.0 - nu**2) * np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, 0.5 - 0.5 * nu]])
    return Plane(Q, G * np.eye(2), rho, True)


def _plane_general(bulk: Bulk, card: Card) -> Plane:
    Q = np.array(
        [
            [card.G11, card.G12, card.G13],
            [card.G12, card.G22, card.G23],
            [card.G13, card.G23, card.G33],
        ],
        dtype=np.float64,
    )
    return Plane(Q, Q[:2, :2].copy(), float(card.rho or 0.0), False)


def _plane_orthotropic(bulk: Bulk, card: Card) -> Plane:
    E1, E2, nu12 = float(card.e11), float(card.e22), float(card.nu12)
    nu21 = nu12 * E2 / E1 if E1 else 0.0
    rest = 1.0 - nu12 * nu21
    if not rest > 0.0:
        raise InputError(
            f"{bulk.place('MAT8', int(card.mid))}: NU12 {nu12:g} is not possible with E1 and E2"
        )
    Q = np.zeros((3, 3))
    Q[0, 0], Q[1, 1], Q[2, 2] = E1 / rest, E2 / rest, float(card.g12 or 0.0)
    Q[0, 1] = Q[1, 0] = nu12 * E2 / rest
    shear = np.diag([float(card.g1z or np.inf), float(card.g2z or np.inf)])
    return Plane(Q, shear, float(card.rho or 0.0), False)
