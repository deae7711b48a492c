"""Masses beyond all measure: places that hardly move, where the test is held."""

from collections.abc import Sequence

import numpy as np

from ..effects.candidates import Candidates, Suspect
from ..effects.sentence_parts import listed
from .narrative_numbers import NARRATIVE


def is_held(c: Candidates, s: Suspect, mass: float) -> bool:
    """Whether a suspect is a mass that only says that its place hardly moves.

    It is many times the `mass` of the whole structure, or as heavy as its kind allows.
    """
    heavy = float(s.theta[0]) > np.log(NARRATIVE.held * mass) or s.theta[0] >= c.upper[0]
    return c.kind.magnitudes[0].is_mass and heavy


def held_said(regions: Sequence[str]) -> tuple[str, ...]:
    """Say where the test seems to be held, and what to do."""
    if not regions:
        return ()
    return (
        f"how the test was supported: it seems to be held {listed(regions)}, where what explains "
        "it best would be heavier than the whole model, which is free there; hold the deck where "
        "the test was held, or measure it as free as the deck is",
    )
