"""Stiffness lost or gained over a patch of elements: a crack, a repair, a doubler."""

import numpy as np

from ..reduction.elements_and_supports import Structure
from .bar_members import bars_of
from .candidates import Candidates
from .effect_kind import FACTOR, EffectKind, Scale
from .effect_laws import FactorLaw
from .effect_numbers import EFFECTS
from .element_patches import on_patches, patches_of


def _places(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Factors on the stiffness of patches of shells, of bars between joints and of runs in them."""
    trials = np.log(EFFECTS.factors)[:, None]
    prior = np.array([0.0]), np.array([EFFECTS.factor_spread])
    shells = patches_of(structure, scale.size, EFFECTS.patch_radii)
    return tuple(
        c
        for patches in (shells, bars_of(structure, scale.size))
        for c in on_patches(KIND, structure, patches, FactorLaw(), trials, prior)
    )


KIND = EffectKind(
    name="local_stiffness",
    label="local change of stiffness",
    plural="local changes of stiffness",
    sentence="The stiffness is {factor:.3g} times the deck's {region}: a local change of stiffness",
    magnitudes=(FACTOR,),
    places=_places,
    nature="stiffness",
)
