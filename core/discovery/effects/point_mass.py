"""An attached mass: equipment, a bracket, ballast, a sensor's own mass."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..reduction.elements_and_supports import Structure
from .candidates import Candidates, with_twins
from .effect_kind import MASS, EffectKind, Scale
from .effect_laws import MassLaw
from .effect_numbers import EFFECTS
from .element_patches import Patch, on_patches, patches_of
from .equipment import further
from .structure_points import points_of, translations


def _places(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Masses at points, and masses on small patches of shells.

    Points are grids and the middles of shells, their edges and bars. Equipment has a footprint,
    and a thin shell gives under a point far more than under a foot, so small patches count as well.
    """
    points, xyz, grids = points_of(structure)
    typical, spread = np.array([np.log(EFFECTS.mass * scale.mass)]), np.array([EFFECTS.mass_spread])
    at_points = Candidates(
        kind=KIND,
        xyz=xyz,
        law=MassLaw(),
        trials=scale.masses(),
        root=translations(structure, points),
        rows_each=3,
        where=tuple({"grids": g} for g in grids),
        typical=typical,
        spread=spread,
    )
    feet, prior = patches_of(structure, scale.size, EFFECTS.feet), (typical, spread)
    on_feet = on_patches(KIND, structure, feet, MassLaw(), scale.masses(), prior, _grids)
    return (*with_twins(at_points, scale.size), *on_feet)


def _grids(structure: Structure, feet: Sequence[Patch]) -> tuple[dict[str, Any], ...]:
    ids = structure.model.geometry.ids
    corners = [structure.members[p.member].corners[p.rows] for p in feet]
    return tuple({"grids": ids[np.unique(c)].tolist()} for c in corners)


KIND = EffectKind(
    name="point_mass",
    label="attached mass",
    plural="attached masses",
    sentence="About {mass} of mass is missing {region}: an attached mass",
    magnitudes=(MASS,),
    places=_places,
    across=EFFECTS.masses_across,
    nature="mass",
    further=further,
)
