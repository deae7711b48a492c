"""Causes that no list of effects has, of sizes from negligible to gross, at random.

Ways that the search does not know. Each changes the truth's mesh (its nodes keep their numbers),
its `Truth`, or the modes themselves.
"""

from __future__ import annotations

from collections.abc import Callable

from ..hide import Scene
from ..mesh import Structure
from .cause import Cause
from .fields import density_drift, modulus_drift, scattered, temperature, thickness_drift
from .geometry import bow, lean, length, out_of_round, taper, twist, warp
from .members import (
    brace,
    detached,
    eccentric,
    member_position,
    missing_member,
    stiffener,
    stiffener_position,
)
from .physics import diffuse, frequency_dependent, model_error, preload, rigid_joints
from .survey import clamp_reach, roving_sensors, suspension

__all__ = ["CAUSES", "FAMILIES", "Cause", "diffuse", "possible"]

FAMILIES: dict[str, tuple[Callable[[Scene], Cause], ...]] = {
    "geometry": (out_of_round, bow, twist, taper, lean, length, warp),
    "field": (thickness_drift, modulus_drift, density_drift, temperature, scattered),
    "member": (
        brace,
        stiffener,
        missing_member,
        detached,
        member_position,
        stiffener_position,
        eccentric,
    ),
    "set-up": (suspension, roving_sensors, clamp_reach),
    "physics": (preload, rigid_joints, frequency_dependent, model_error),
}
"""Ways to be outside the list, by what they are."""

CAUSES = {f.__name__: f for family in FAMILIES.values() for f in family}


def possible(s: Structure, family: str) -> list[str]:
    """Return the causes of a family that this structure can have."""
    flat, frame = s.name in ("panel", "plate"), not s.patches
    never = {"out_of_round"} if s.name not in ("duct", "wheel", "cowl") else {"lean"}
    never.add("suspension" if s.clamped is not None else "clamp_reach")
    never |= set() if flat else {"stiffener_position"}
    never |= {"member_position"}
    if frame:
        never = never - {"member_position"} | {"detached", "stiffener", "thickness_drift"}
    if flat or s.name == "wheel":
        never.add("brace")
    if not s.lines:
        never |= {"missing_member", "detached", "eccentric"}
    return [f.__name__ for f in FAMILIES[family] if f.__name__ not in never]
