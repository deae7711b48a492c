"""The tuned numbers of the small models that a discovery works on."""

from dataclasses import dataclass

from ...number_table import ROUNDING, number


@dataclass(frozen=True)
class ReductionNumbers:
    own: float = number(1e-6, "of the mass of a mode", "that moves with the structure, for it to count", ROUNDING)
    rounding: float = number(1e-7, "of a vector", "what is left of it is rounding", ROUNDING)
    dependent: float = number(1e-5, "of the largest squared length", "directions with less are not new to a basis")
    as_far: float = number(1e-6, "of the structure's size", "by which points are at one place along an axis", ROUNDING)
    alike: float = number(1e-3, "of the largest", "difference of moments of inertia of axes that are as good as any other between them")
    nil: float = number(1e-12, "of the largest eigenvalue or squared length", "below which one is rounding, also of what a release frees: it cancels stiffness, and may hardly move mass", ROUNDING)
    free: float = number(1e-9, "of the stiffest direction", "below which one is free", ROUNDING)
    strained: float = number(1e-6, "of the highest eigenvalue", "below it a mode strains nothing", ROUNDING)
    log_step: float = number(1e-3, "of ln p", "by which a known parameter is moved for its derivatives", ROUNDING)
    parts_at_once: int = number(16, "parts", "of a structure whose matrices on a basis are made at once", "cache and memory")
    at_once: int = number(128, "loads", "whose displacements are found at once, and places of supports whose stiffness is", "memory")
    shared_at_once: int = number(600, "loads", "whose flexibilities among each other are found together", "memory")


REDUCTION = ReductionNumbers()
