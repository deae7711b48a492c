"""Mass spread over a region: insulation, paint, liquid, cabling."""

import numpy as np

from ..reduction.elements_and_supports import Structure
from .candidates import Candidates
from .effect_kind import MASS, EffectKind, Scale, Words
from .effect_laws import MassLaw
from .effect_numbers import EFFECTS
from .element_patches import PatchCandidates, area_of, on_patches, patches_of


def _places(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Extra mass, in proportion to the mass that is there, over patches of elements."""
    patches = patches_of(structure, scale.size, EFFECTS.mass_radii)
    prior = np.array([np.log(EFFECTS.spread_mass * scale.mass)]), np.array([EFFECTS.mass_spread])
    return on_patches(KIND, structure, patches, MassLaw(), scale.masses(), prior)


def _per_area(c: Candidates, row: int, magnitude: Words) -> Words:
    assert isinstance(c, PatchCandidates)
    return {"mass_per_area": magnitude["mass"] / area_of(c.structure, c.patches[row])}


KIND = EffectKind(
    name="distributed_mass",
    label="distributed mass",
    plural="distributed masses",
    sentence="About {mass} of mass, spread out, is missing {region}: a distributed mass",
    magnitudes=(MASS,),
    places=_places,
    nature="mass",
    spread_out=True,
    further=_per_area,
)
