"""How far off a model is everywhere, as the test itself tells it.

Shapes with a MAC of 0.9 and frequencies off by several per cent are usual on real structures,
and a few modes that nobody explains as well. So two scales are estimated, of the frequencies and
of the shapes, by the modes that a hypothesis explains: one that is far off counts little, and what
it leaves says nothing of the scales.
"""

from dataclasses import replace

import numpy as np

from .hypothesis import Fit, Problem
from .likelihood_numbers import LIKELIHOOD
from .map_fit import off_and_apart
from .mode_likelihood import Noise

WIDE = Noise(
    LIKELIHOOD.wide[0],
    LIKELIHOOD.wide[1],
    independent=1.0,
    robust=LIKELIHOOD.wide_robust,
    mixing=LIKELIHOOD.wide_mixing,
)
"""What a search begins with where nothing is known: one shape says one thing."""


def by_noise(problem: Problem, noise: Noise) -> Problem:
    """Return the problem with other errors of the test and the model, modes all alike."""
    both = (replace(e, noise=noise) for e in (problem.evidence, problem.whole))
    evidence, whole = both
    return replace(problem, evidence=evidence, whole=whole)


def estimated(problem: Problem, state: Fit) -> Noise:
    """Return the noise by which what a fit leaves is as likely as can be, no wider than it was.

    With ln f off by x and 1 - MAC = y, J = x²/σ_f² + y/σ_s² and the loss c ln(1 + J/c), each mode
    weighs 1/(1 + J/c), and σ_f² and σ_s² are the weighted means of x² and y.
    """
    noise = problem.whole.noise
    off, apart = off_and_apart(problem.entire(), state)
    f, s = float(np.max(noise.frequency)), float(np.max(noise.shape))
    for _ in range(LIKELIHOOD.wide_steps):
        weight = 1.0 / (1.0 + ((off / f) ** 2 + apart / s**2) / noise.robust)
        f = float(np.sqrt(np.average(off**2, weights=weight)))
        s = float(np.sqrt(np.average(apart, weights=weight)))
        f, s = max(f, LIKELIHOOD.frequency), max(s, LIKELIHOOD.shape)
    f, s = min(f, LIKELIHOOD.wide[0]), min(s, LIKELIHOOD.wide[1])
    return replace(noise, frequency=f, shape=s)
