"""How well a hypothesis foretells modes that it was not fitted to.

What a hypothesis gains on the modes that it is fitted to grows with its freedom and with what the
likelihood leaves out; on modes held out it grows with what is true of it (Stone 1974, Journal of
the Royal Statistical Society B 36, 111; Vehtari, Gelman, Gabry 2017, Statistics and Computing 27,
1413). Model and test may be as poor as they like: both hypotheses stand before the same modes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...arrays import Floats
from .diffuse_error import at
from .diffuse_fit import Judged, everything, judged, seen
from .model_error_numbers import MODEL_ERROR


def foretold(hypothesis: Judged) -> Floats:
    """Return ln of the likelihood of each test mode by the hypothesis fitted to others, (n_test,).

    Parameters, smooth fields, magnitudes, error and noise are fitted anew without every so many
    modes; the size of the fields that is likeliest, and the places, are those of all modes.
    """
    problem, state = hypothesis.problem, hypothesis.state
    n = len(problem.evidence.frequencies_hz)
    sensors = np.ones(len(problem.sensors), bool)
    out = np.empty(n)
    for first in range(min(MODEL_ERROR.folds, n)):
        away = np.zeros(n, bool)
        away[first :: MODEL_ERROR.folds] = True
        part = replace(problem, evidence=problem.evidence.take(~away, sensors))
        rest = judged(part, state, everything(part), hypothesis.diffuse)
        left = at(seen(problem, rest.fit), rest.diffuse.error, rest.diffuse.noise)
        out[away] = left.each[away]
    return out


def agreement(first: Floats, second: Floats) -> float:
    """Return by how many standard deviations modes agree that the first foretells them better.

    Of the signed ranks of the differences (Wilcoxon 1945, Biometrics Bulletin 1, 80), so that no
    single mode decides.
    """
    d = first - second
    ranks = np.argsort(np.argsort(np.abs(d))) + 1.0
    return float(np.sum(np.sign(d) * ranks) / np.sqrt(np.sum(ranks**2)))
