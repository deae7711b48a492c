"""What an error of the model without a place is told as."""

from ...arrays import Ints
from ..effects.sentence_parts import mode_ranges
from ..search.completeness import Completeness
from .narrative_numbers import NARRATIVE


def left_over(whole: Completeness, numbers: Ints) -> tuple[str, ...]:
    """Say by how much the best explanation is off, and what that looks like.

    `numbers` are those of the test modes.
    """
    best = whole.best
    said = [f"the best explanation is off by {100.0 * best.diffuse.error:.2g} % of the stiffness"]
    if whole.unexplained:
        modes = mode_ranges([int(numbers[k]) for k in whole.unexplained])
        said.append(f"nothing explains {modes}")
    if best.drifts and best.evidence - best.plain > NARRATIVE.looks_like:
        d = best.drifts[0]
        said.append(f"it looks like {d.name} that drifts by {100.0 * abs(d.amplitude):.2g} %")
    said.append("further modes or sensors, or an effect that the catalogue does not have")
    return ("; ".join(said),)
