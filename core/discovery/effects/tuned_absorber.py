"""A mass on a spring of its own: a vibration absorber, a pendulum, equipment on soft mounts."""

import numpy as np

from ..reduction.elements_and_supports import Structure
from .candidates import Candidates
from .effect_kind import EffectKind, Magnitude, Scale
from .effect_laws import TunedLaw
from .effect_numbers import EFFECTS
from .structure_points import along_axes, points_of


def _places(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Give every grid, shell middle and shell edge an absorber along each basic axis."""
    xyz, root, where = along_axes(points_of(structure))
    low, high = np.log(scale.band_hz) + np.log(EFFECTS.absorber_band)
    masses = np.log(scale.mass * np.array(EFFECTS.absorber_masses))
    hz = np.linspace(low, high, 2 + int((high - low) / EFFECTS.absorber_spacing))
    made = Candidates(
        kind=KIND,
        xyz=xyz,
        law=TunedLaw(np.zeros((len(xyz), 1)), 0.0),
        trials=np.array([(m, f) for m in masses for f in hz]),
        root=root,
        rows_each=1,
        where=where,
        typical=np.array([np.log(EFFECTS.absorber_mass * scale.mass), 0.5 * (low + high)]),
        spread=np.array([EFFECTS.absorber_spread, 0.5 * (high - low)]),
        steps=np.array([1.0, EFFECTS.absorber_step]),
        lower=np.array([-np.inf, low]),
        upper=np.array([np.inf, high]),
    )
    return (made,)


KIND = EffectKind(
    name="tuned_absorber",
    label="tuned absorber",
    sentence="About {mass} of mass on a spring tuned to "
    "{frequency_hz:.4g} Hz ({frequency_hz_interval[0]:.4g} to {frequency_hz_interval[1]:.4g}) in "
    "direction {components} is missing {region}: an absorber, which adds a mode,",
    magnitudes=(
        Magnitude("mass", EFFECTS.absorber_error[0], is_mass=True),
        Magnitude("frequency_hz", EFFECTS.absorber_error[1]),
    ),
    places=_places,
    across=EFFECTS.springs_across,
    directed=True,
    late=True,
)
