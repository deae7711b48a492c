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
    deviation of ln p; that of a clear one is averaged over which of the others are off as well. By
    `mesh`, relative, the deck's mesh makes frequencies too low on average.
    """

    together: Floats
    alone: Floats
    deviation: Floats
    clear: Bools
    mesh: float = 0.0


def in_deck(x: Floats, information: Floats, scale: float, spread: Floats) -> InDeck:
    """Return which unknowns `x` (n,) of a fit are clear, and where these are without the rest.

    Backward elimination: the unknown that is fewest standard deviations from 0 is held there, the
    others follow to first order, until each that is left is clear (Draper, Smith: Applied
    Regression Analysis, chapter 15), whichever of the others are off: no interval that is told
    holds the deck's value. `information` (m, m) is half the Hessian of what was minimised over
    these and further unknowns behind them, `scale` the noise's variance over the assumed one,
    `spread` (n,) how far they may be off beforehand.
    """
    whole = scale * np.linalg.pinv(information)[: len(x), : len(x)]
    C, alone, clear = whole, np.array(x), np.ones(len(x), bool)
    while clear.any():
        left = np.flatnonzero(clear)
        own = np.sqrt(np.maximum(np.diag(C), np.finfo(float).tiny))
        k = left[np.argmin(np.abs(alone[left]) / own[left])]
        if abs(alone[k]) > LIKELIHOOD.significant * own[k]:
            off = np.abs(alone[left]) / _averaged(x, whole, clear, spread)
            if off.min() > LIKELIHOOD.interval:
                break
            k = left[np.argmin(off)]
        follow = C[:, k] / own[k] ** 2
        alone = alone - follow * alone[k]
        C = C - np.outer(follow, C[k])
        clear[k] = False
    deviation = np.sqrt(np.maximum(np.diag(whole), 0.0))
    deviation[clear] = _averaged(x, whole, clear, spread)
    return InDeck(np.array(x), np.where(clear, alone, 0.0), deviation, clear)


def _averaged(x: Floats, C: Floats, clear: Bools, spread: Floats) -> Floats:
    """Return standard deviations of the clear unknowns, each of the others off or not, (n_clear,).

    What one more of them does to the clear ones counts by its posterior probability, one half
    beforehand (Hoeting et al. 1999, section 1; the ratio of densities at 0: Dickey 1971).
    """
    variance = _of_free(x, C, clear)[1].diagonal().copy()
    for k in np.flatnonzero(~clear):
        free = clear | (np.arange(len(x)) == k)
        there = int(np.count_nonzero(free[:k]))
        mean, own = _of_free(x, C, free)
        square = own[there, there]
        bayes = min(np.sqrt(square) / spread[k], 1.0) * np.exp(0.5 * mean[there] ** 2 / square)
        chance = bayes / (1.0 + bayes)
        lever = np.delete(own[:, there] / square, there)
        variance += chance * lever**2 * (square + (1.0 - chance) * mean[there] ** 2)
    return np.asarray(np.sqrt(variance))


def _of_free(x: Floats, C: Floats, free: Bools) -> tuple[Floats, Floats]:
    """Return mean and covariance of some unknowns, the others at 0."""
    across = C[np.ix_(free, ~free)]
    follow = np.linalg.solve(C[np.ix_(~free, ~free)], across.T).T
    return x[free] - follow @ x[~free], C[np.ix_(free, free)] - follow @ across.T
