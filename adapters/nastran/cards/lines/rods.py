"""Rods: CROD, CONROD, CTUBE."""

import math

from ...deck.bulk import Bulk
from ...deck.card_definition import Card
from ...deck.movable_values import Moves
from ...properties.materials import isotropic
from ..element_group import Context, Group, Key, property_groups

_ENDS = "EID:i! PID:i=EID G1,G2>nodes:i!"
_ROD = "A:r=0. J:r=0. C:r=0. NSM:r=0."
_AREA = Moves(also={"AREA": "A"}, linear=("A", "J", "NSM"))


CARDS = (
    Card("CROD", _ENDS, "eid", elements="rod", properties="PROD"),
    Card("CTUBE", _ENDS, "eid", elements="rod", properties="PTUBE"),
    Card("CONROD", f"EID:i! G1,G2>nodes:i! MID:i! {_ROD}", "eid", elements="rod", moves=_AREA),
    Card("PROD", f"PID:i! MID:i! {_ROD}", "pid", moves=_AREA),
    Card(
        "PTUBE",
        "PID:i! MID:i! OD:r! T:r=0. NSM:r=0. OD2:r=OD",
        "pid",
        moves=Moves(also={"OD1": "OD"}),
    ),
)


def rods(context: Context) -> list[Group]:
    """Make the groups of CROD, CONROD and CTUBE."""
    kinds = (("CROD", _rod), ("CTUBE", _tube), ("CONROD", _rod))
    return [g for name, constants in kinds for g in property_groups(context, name, constants)]


def _rod(bulk: Bulk, key: Key) -> tuple[list[float], float]:
    card = bulk.table(key[0])[key[1]]
    E, G, _, rho = isotropic(bulk, card.mid, bulk.place(*key))
    return [E, card.a, G, card.j], rho * card.a + card.nsm


def _tube(bulk: Bulk, key: Key) -> tuple[list[float], float]:
    """Outer diameter OD1 at end A, OD2 at end B (their mean area, as Nastran takes it)."""
    card = bulk.table(key[0])[key[1]]
    place = bulk.place(*key)
    E, G, _, rho = isotropic(bulk, card.mid, place)
    t = card.t  # 0: solid
    A = J = 0.0
    for od in (card.od, card.od2):
        inner = max(od - 2.0 * t, 0.0) if t else 0.0
        if 2.0 * t > od:
            raise place.error("twice the wall thickness exceeds the diameter")
        A += 0.5 * math.pi / 4.0 * (od**2 - inner**2)
        J += 0.5 * math.pi / 32.0 * (od**4 - inner**4)
    return [E, A, G, J], rho * A + card.nsm
