"""A kind of effect: all that is particular about it, in one declaration; what is large or small."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...arrays import Floats
from ..reduction.elements_and_supports import Structure
from .effect_numbers import EFFECTS

if TYPE_CHECKING:
    from .candidates import Candidates

Words = dict[str, Any]
_NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


@dataclass(frozen=True)
class Magnitude:
    """A size of an effect, e^θ.

    Parameters
    ----------
    word : str
        Its key in ``magnitude`` of result.json.
    place_error : float
        Standard deviation of θ that comes of a place or patch which is not quite the true one and
        of the mesh, as measured on generated cases (`benchmarks/discovery`).
    is_mass : bool
        Whether it is told in the deck's unit of mass.
    known_only : bool
        Whether it is told only where the test tells it.
    """

    word: str
    place_error: float
    is_mass: bool = False
    known_only: bool = False


MASS = Magnitude("mass", EFFECTS.mass_error, is_mass=True)
STIFFNESS = Magnitude("stiffness", EFFECTS.stiffness_error)
FACTOR = Magnitude("factor", EFFECTS.stiffness_error)


@dataclass(frozen=True, eq=False)
class EffectKind:
    """A kind of effect that a model may lack.

    One with several magnitudes can imitate what has one: the search looks for it in a second
    round, beside what was found of simple kinds.

    Parameters
    ----------
    name : str
        The fixed word of result.json.
    label : str
        What the report calls it.
    sentence : str
        What is missing, up to the words ``explains test mode ...``: a template of `magnitudes`,
        ``components``, ``region`` and, of a stiffness, ``size``: about how large, where it is
        known.
    magnitudes : tuple of Magnitude
        One for each θ of its laws: one with fewer has the first of them.
    places : callable
        Candidates, with their law, on a structure; none of a kind that is not searched for.
    across : float
        Of a kind that sits at points: so many places across the structure, each way, does the
        first scan look at. 0: all places, of patches those marked so.
    directed : bool
        Whether a place has one direction, looked at only where something moves that way.
    nature : str
        Effects of one nature at one place, along the same components, say the same. "" says the
        same as its own kind alone.
    spread_out : bool
        Whether it is what small patches of its nature become when they grow.
    further : callable
        Further words of the magnitude of one place.
    plural : str
        The label of several; "" where it ends with another s.
    late : bool
        Whether it is looked for only where the others leave much.
    """

    name: str
    label: str
    sentence: str
    magnitudes: tuple[Magnitude, ...]
    places: Callable[[Structure, Scale], tuple[Candidates, ...]] = lambda *_: ()
    across: float = 0.0
    directed: bool = False
    nature: str = ""
    spread_out: bool = False
    further: Callable[[Candidates, int, Words], Words] = lambda *_: {}
    plural: str = ""
    late: bool = False

    def said(self, number: int) -> str:
        """Return so many of it in words: ``an attached mass``, ``two attached masses``."""
        if number == 1:
            return f"{'an' if self.label[0] in 'aeiou' else 'a'} {self.label}"
        count = _NUMBERS[number] if number < len(_NUMBERS) else str(number)
        return f"{count} {self.plural or f'{self.label}s'}"

    @property
    def at_points(self) -> bool:
        """Whether it sits at points."""
        return self.across > 0.0

    def joins(self, other: EffectKind) -> bool:
        """Whether two effects side by side may be one."""
        return self.nature == other.nature != ""


@dataclass(frozen=True, eq=False)
class Scale:
    """What is large and small on this structure.

    Parameters
    ----------
    mass : float
        Of the whole structure.
    size : float
        Diagonal of its box.
    omega2 : float
        (rad/s)² in the middle of the measured band.
    band_hz : (float, float)
        Lowest and highest frequency that was measured.
    """

    mass: float
    size: float
    omega2: float
    band_hz: tuple[float, float]

    def masses(self) -> Floats:
        """Trial masses, ln, (n, 1)."""
        shares = np.geomspace(*EFFECTS.mass_trials, EFFECTS.trials)
        return np.asarray(np.log(self.mass * shares))[:, None]

    @property
    def spring(self) -> Floats:
        """A usual stiffness, ln, (1,)."""
        return np.array([np.log(EFFECTS.spring * self.mass * self.omega2)])

    def springs(self) -> Floats:
        """Trial stiffnesses, ln, (n, 1): at steps, down to what the lowest mode would notice."""
        first, last = np.log(self.mass * self.omega2 * np.array(EFFECTS.spring_trials))
        step = (last - first) / (EFFECTS.trials - 1)
        noticed = np.log(EFFECTS.spring * self.mass * (2.0 * np.pi * self.band_hz[0]) ** 2)
        below = max(0, int(np.ceil((first - noticed) / step)))
        return np.asarray(last - step * np.arange(EFFECTS.trials + below)[::-1])[:, None]
