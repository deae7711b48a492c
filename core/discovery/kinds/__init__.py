"""The catalogue of effects: one module a kind."""

from __future__ import annotations

from collections.abc import Callable

from ..candidates import Candidates
from ..structure import Structure
from . import (
    distributed_mass,
    ground_spring,
    joint_flexibility,
    local_stiffness,
    point_mass,
    support_flexibility,
    tuned_absorber,
)
from .scale import Scale

KINDS: dict[str, Callable[[Structure, Scale], tuple[Candidates, ...]]] = {
    "point_mass": point_mass.candidates,
    "distributed_mass": distributed_mass.candidates,
    "local_stiffness": local_stiffness.candidates,
    "ground_spring": ground_spring.candidates,
    "support_flexibility": support_flexibility.candidates,
    "joint_flexibility": joint_flexibility.candidates,
    "tuned_absorber": tuned_absorber.candidates,
}
