"""Which of several parameters a fit determines: the rest stay where the deck has them."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Bools, Floats
from .likelihood_numbers import LIKELIHOOD


@dataclass(frozen=True, eq=False)
class InDeck:
    """What the known parameters are in a deck with the effects found; each (n_parameter,).

    `together` is ln p where all of them move, `alone` where those stay at the deck's values that
    are not `clear`: of which the test does not say that they are off. `deviation` is the standard
    deviation of ln p, that of a clear one with the others held.
    """

    together: Floats
    alone: Floats
    deviation: Floats
    clear: Bools
    mesh: float = 0.0


def in_deck(x: Floats, information: Floats, scale: float) -> InDeck:
    """Return which unknowns `x` (n,) of a fit are clear, and where these are without the rest.

    Backward elimination: the unknown that is fewest standard deviations from 0 is held there, the
    others follow to first order, until each that is left is clear (Draper, Smith: Applied
    Regression Analysis, chapter 15). `information` (m, m) is half the Hessian of what was
    minimised over these and further unknowns behind them, `scale` the noise's variance over the
    assumed one.
    """
    C = scale * np.linalg.pinv(information)[: len(x), : len(x)]
    deviation = np.sqrt(np.maximum(np.diag(C), 0.0))
    alone, clear = np.array(x), np.ones(len(x), bool)
    while clear.any():
        left = np.flatnonzero(clear)
        own = np.sqrt(np.maximum(np.diag(C), np.finfo(float).tiny))
        k = left[np.argmin(np.abs(alone[left]) / own[left])]
        if abs(alone[k]) > LIKELIHOOD.significant * own[k]:
            deviation[left] = own[left]
            break
        follow = C[:, k] / own[k] ** 2
        alone = alone - follow * alone[k]
        C = C - np.outer(follow, C[k])
        clear[k] = False
    return InDeck(np.array(x), np.where(clear, alone, 0.0), deviation, clear)
