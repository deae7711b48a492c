"""Clamps that reach further in, beside effects that imitate them."""

from dataclasses import replace
from types import SimpleNamespace as Some

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.discovery.strings import N, X, hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.effects.effect_laws import FactorLaw
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.model_error.support_reach import KIND, Reaches
from trueup.core.discovery.search.completeness import Completeness
from trueup.core.discovery.search.found import Found
from trueup.core.discovery.search.search_numbers import SEARCH
from trueup.core.discovery.search.set_up import beside_reach

GAPS = np.eye(N)[0], np.eye(N)[1] - np.eye(N)[0]
FIRST, SECOND = ((N + 1) ** 2 * np.outer(g, g) for g in GAPS)
REACHES = Reaches(
    kind=KIND,
    xyz=np.zeros((2, 3)),
    law=FactorLaw(),
    trials=np.ones((1, 1)),
    root=sp.csr_matrix((0, N)),
    rows_each=0,
    where=({},) * 2,
    typical=np.ones(1),
    spread=np.ones(1),
    lower=np.zeros(1),
    matrices=(sp.csr_matrix(FIRST), sp.csr_matrix(SECOND + 100.0 * FIRST)),
    far=np.r_[0.0, X[:2]],
)
"""Of the wall over one gap between beads, and over two."""


def weighed(truth, evidence=lambda _, f: -0.5 * f.objective, effect=()):
    """Return how many effects are told beside a reach, and how well they explain."""

    def judged(problem, f, _=0.0):
        left = Some(error=0.001, noise=0.02, each=np.zeros(12))
        return Some(evidence=evidence(problem, f), diffuse=left, fit=f)

    s = replace(searcher(truth), judged=judged)
    null = s.null()
    found = Found((null, *(evaluate(s.problem, null.nuisance, (e,)) for e in effect)), ((), ()))
    alone, best = (judged(s.problem, f) for f in (null, found.levels[-1]))
    whole = Completeness(alone, alone, best, best, 99.0, 99.0, np.inf, 3.0, [])
    return beside_reach(s, found, len(effect), whole, REACHES)


@pytest.mark.parametrize("part", [0.3, 0.8])
def test_how_far_a_clamp_reaches_is_told(part):
    k, m = hidden()
    kept, whole = weighed((k + 1e4 * FIRST + part / (1.0 - part) * SECOND, m))
    assert kept == 0
    assert whole.reach.far == pytest.approx(X[0] + part * (X[1] - X[0]), abs=0.2 * X[0])


def test_none_is_told_where_nothing_is_held_further_in():
    assert weighed(hidden())[1].reach is None
    assert weighed(hidden(masses=[(20, 3.0)]))[1].reach is None


@pytest.mark.parametrize(
    ("evidence", "told", "clear"), [(20.0, False, False), (57.0, True, False), (90.0, True, True)]
)
def test_what_imitates_a_reach_is_not_told_and_what_is_no_clearer_not_claimed(
    evidence, told, clear
):
    def of(problem, f):
        return 50.0 if problem.catalogue == (REACHES,) else evidence * len(f.suspects)

    kept, whole = weighed(hidden(), of, [Suspect(1, 9, (np.log(200.0),))])
    assert bool(kept) == told
    assert (whole.reach is None) == clear
    assert (whole.best is whole.alone) != told
    assert (whole.ahead > SEARCH.suspect) == (clear or not told)
