"""The first look at every place of a kind."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.core.discovery.strings import N, hidden, searcher

from trueup.core.discovery.effects.effect_laws import FactorLaw, MassLaw
from trueup.core.discovery.likelihood.hypothesis import softened
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.search import coarse_scan
from trueup.core.discovery.search.coarse_scan import every_other, look
from trueup.core.discovery.search.exact_scan import scan
from trueup.core.discovery.search.search_numbers import SEARCH


@pytest.mark.parametrize(
    ("law", "sizes", "first"),
    [
        (MassLaw(), [1.0, 2.0, 4.0, 8.0], [1.0, 4.0]),
        (MassLaw(), [8.0, 4.0, 2.0, 1.0], [4.0, 1.0]),
        (FactorLaw(), [0.2, 0.5, 1.6, 3.0], [0.5, 1.6]),
        (FactorLaw(), [0.5], [0.5]),
    ],
)
def test_the_smallest_size_comes_first_whether_it_gives_or_takes(law, sizes, first):
    kind = SimpleNamespace(law=law, trials=np.log(sizes)[:, None])
    assert np.array(sizes)[every_other(kind)].tolist() == first


@pytest.mark.parametrize(
    ("kind", "truth"), [(0, {"masses": [(9, 1.7)]}), (1, {"springs": [(14, 150.0)]})]
)
def test_what_comes_back_is_exact_and_the_best_of_all_is_in_it(kind, truth, monkeypatch):
    evaluated = []

    def counted(*args):
        out = scan(*args)
        evaluated.append(out.size)
        return out

    monkeypatch.setattr(coarse_scan, "SEARCH", replace(SEARCH, every_size_least=3))
    monkeypatch.setattr(coarse_scan, "scan", counted)
    s = searcher(hidden(**truth))
    small, here = s.local(evaluate(s.problem, np.zeros(2), ()))
    small, rows, c = softened(small), np.arange(N), s.problem.catalogue[kind]
    every = scan(small, here, kind, rows, c.trials) + c.surprise(c.trials)
    seen = look(small, here, kind, rows)
    assert seen.rows[np.argmin(seen.cost)] == np.argmin(every.min(axis=1))
    assert seen.cost.min() == pytest.approx(every.min(), rel=1e-9)
    assert sum(evaluated) < every.size
    for row, cost, theta in zip(seen.rows, seen.cost, seen.theta, strict=True):
        size = int(np.flatnonzero(c.trials[:, 0] == theta[0])[0])
        assert cost == pytest.approx(every[row, size], rel=1e-9)


def test_places_that_cost_more_than_is_worth_are_not_looked_at_more_closely():
    s = searcher(hidden(masses=[(9, 1.7)]))
    small, here = s.local(evaluate(s.problem, np.zeros(2), ()))
    rows, c = np.arange(N), s.problem.catalogue[0]
    every = look(small, here, 0, rows)
    one = look(small, here, 0, rows, worth=float(every.cost.min()) + 1.0)
    assert one.cost.min() == every.cost.min()
    none = look(small, here, 0, rows, worth=-np.inf)
    first = c.trials[every_other(c)][:, 0]
    assert np.isin(none.theta[:, 0], first).all()
    assert not np.isin(every.theta[:, 0], first).all()
