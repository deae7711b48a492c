"""Shear panels: CSHEAR."""

from dataclasses import replace

from ...deck.bulk import Bulk
from ...deck.card_definition import Card
from ...deck.movable_values import Moves
from ...properties.materials import isotropic
from ..element_group import Context, Group, Key, property_groups

CARDS = (
    Card(
        "CSHEAR",
        "EID:i! PID:i=EID G1,G2,G3,G4>nodes:i!",
        "eid",
        elements="shear_panel",
        properties="PSHEAR",
    ),
    Card("PSHEAR", "PID:i! MID:i! T:r! NSM:r=0. F1:r=0. F2:r=0.", "pid", moves=Moves()),
)


def panels(context: Context) -> list[Group]:
    """Make the group of CSHEAR, whose mass stays lumped: COUPMASS does not list it (QRG)."""
    lumped = replace(context.settings, coupled=False)
    return property_groups(replace(context, settings=lumped), "CSHEAR", _constants)


def _constants(bulk: Bulk, key: Key) -> tuple[list[float], float]:
    place = bulk.place(*key)
    card = bulk.table(key[0])[key[1]]
    E, G, _, rho = isotropic(bulk, card.mid, place)
    if not card.t > 0.0 or not G > 0.0:
        raise place.error("a shear panel needs a thickness and a shear modulus")
    return [E, G, card.t, card.f1, card.f2], rho * card.t + card.nsm
