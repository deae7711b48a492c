"""What an error of the model without a place is told as."""

import numpy as np

from ...arrays import Ints
from ..effects.sentence_parts import mode_ranges
from ..model_error.diffuse_fit import Drift
from ..model_error.geometry_error import Misshapen
from ..model_error.set_up_fields import MESH, SENSORS, SUSPENSION
from ..search.completeness import Completeness


def left_over(whole: Completeness, numbers: Ints) -> tuple[str, ...]:
    """Say by how much the best explanation is off, and what that looks like.

    `numbers` are those of the test modes.
    """
    best = whole.best
    said = [f"the best explanation is off by {100.0 * best.diffuse.error:.2g} % of the stiffness"]
    if not whole.legible:
        said.append(f"sensors read {100.0 * best.diffuse.noise:.2g} % of a shape's rms beside it")
    if whole.unexplained:
        modes = mode_ranges([int(numbers[k]) for k in whole.unexplained])
        said.append(f"nothing explains {modes}")
    if look := looks_like(whole):
        said.append(f"it looks like {look}")
    said.append("further modes or sensors, or an effect that the catalogue does not have")
    return ("; ".join(said),)


def looks_like(whole: Completeness) -> str:
    """Say what an error without a place would be that explains what is left, if any does."""
    said = []
    if whole.reach is not None:
        said.append(f"supports that reach {whole.reach.far:.2g} deck units further in")
    if whole.shape is not None:
        said.append(_shape(whole.shape))
    elif whole.reach is None and whole.in_fields:
        said.append(_drift(whole.best.drifts[0]))
    return " and ".join(said)


def _shape(s: Misshapen) -> str:
    off = f"a structure that is {s.name} by {s.amplitude:.2g} deck units"
    return f"{off}, which leaves {100.0 * s.error:.2g} %"


def _drift(d: Drift) -> str:
    if d.name == SUSPENSION:
        share = 100.0 * np.sqrt(abs(d.amplitude))
        return f"{d.name} on which it swings at {share:.2g} % of its lowest frequency"
    if d.name == SENSORS:
        return f"{d.name}, {100.0 * d.amplitude:.2g} % of the structure's in all"
    if d.name.startswith(MESH):
        return f"{d.name}, by {abs(d.amplitude):.2g} of what lumped masses do"
    what, _, way = d.name.partition(" ")
    return f"{what} that drifts by {100.0 * abs(d.amplitude):.2g} % {way}".rstrip()
