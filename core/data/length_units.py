"""Length units, and nouns in another one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..errors import InputError
from .geometry import Geometry
from .modes import Modes

METRES = {"m": 1.0, "mm": 1e-3, "in": 0.0254, "ft": 0.3048}
"""Metres in each length unit."""


def length_factor(unit_from: str, unit_to: str) -> float:
    """Return how many `unit_to` are in one `unit_from`.

    Raises
    ------
    InputError
        A unit that is not one of m, mm, in, ft.
    """
    for unit in (unit_from, unit_to):
        if unit not in METRES:
            raise InputError(f"the length unit '{unit}' is not known; use m, mm, in or ft")
    return METRES[unit_from] / METRES[unit_to]


def to_length_unit(
    geometry: Geometry, modes: Modes | None, unit_from: str, unit_to: str
) -> tuple[Geometry, Modes | None]:
    """Convert positions and shapes of a test (or an analysis) to another length unit.

    Displacements are multiplied by the factor, rotations (components 4 to 6) are not, so the
    motion stays the same motion. Generalised masses take the factor squared: they belong to the
    new numbers of the shapes in the same unit of mass.

    Raises
    ------
    InputError
        A unit that is not one of m, mm, in, ft.
    """
    factor = length_factor(unit_from, unit_to)
    converted = replace(geometry, xyz=geometry.xyz * factor, length_unit=unit_to)
    if modes is None:
        return converted, None
    by_row = np.where(modes.dofs.component > 3, 1.0, factor)
    mass = modes.generalized_mass * factor**2
    return converted, replace(modes, shapes=modes.shapes * by_row[:, None], generalized_mass=mass)
