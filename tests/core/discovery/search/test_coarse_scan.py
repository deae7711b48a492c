"""The first look at every place of a kind."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.core.discovery import strings
from tests.core.discovery.strings import N, hidden, searcher

from trueup.core.discovery.effects.effect_laws import FactorLaw, MassLaw
from trueup.core.discovery.likelihood.hypothesis import softened
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.search import coarse_scan
from trueup.core.discovery.search.coarse_scan import (
    every_other,
    foretold,
    look,
    neighbourhoods,
    promising,
)
from trueup.core.discovery.search.exact_scan import scan
from trueup.core.discovery.search.search_numbers import SEARCH

EVERY = np.arange(N)


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


def begun(s):
    """The problem on the modes of the deck as it is, with the noise of a first look."""
    small, here = s.local(evaluate(s.problem, np.zeros(2), ()))
    small = softened(small)
    return small, evaluate(small, here.nuisance, here.suspects)


@pytest.mark.parametrize(
    ("kind", "truth"), [(0, {"masses": [(9, 1.7)]}), (1, {"springs": [(14, 150.0)]})]
)
def test_what_comes_back_is_exact_and_the_best_of_all_is_in_it(kind, truth, monkeypatch):
    evaluated = []

    def counted(*args):
        out = scan(*args)
        evaluated.append(out.size)
        return out

    monkeypatch.setattr(coarse_scan, "SEARCH", replace(SEARCH, hopeful=8))
    monkeypatch.setattr(coarse_scan, "scan", counted)
    small, here = begun(searcher(hidden(**truth)))
    c = small.catalogue[kind]
    every = scan(small, here, kind, EVERY, c.trials) + c.surprise(c.trials)
    seen = look(small, here, kind, EVERY)
    assert seen.rows[np.argmin(seen.cost)] == np.argmin(every.min(axis=1))
    assert seen.cost.min() == pytest.approx(every.min(), rel=1e-9)
    assert sum(evaluated) < every.size / 4
    for row, cost, theta in zip(seen.rows, seen.cost, seen.theta, strict=True):
        size = int(np.flatnonzero(c.trials[:, 0] == theta[0])[0])
        assert cost == pytest.approx(every[row, size], rel=1e-9)


def test_what_is_foretold_of_small_masses_is_what_they_do():
    small, here = begun(searcher(hidden(masses=[(9, 1.7)])))
    theta = np.log([[0.02]])
    exact, told = (f(small, here, 0, EVERY, theta)[:, 0] - here.misfit for f in (scan, foretold))
    assert np.abs(exact).max() > 1.0
    assert np.abs(told - exact).max() < 0.15 * np.abs(exact).max()


@pytest.mark.parametrize("size", [2.0, 50.0, 3000.0])
def test_what_the_secular_equation_promises_of_springs_is_what_they_do_however_large(size):
    small, here = begun(searcher(hidden(springs=[(14, size)])))
    theta = np.log([[size]])
    exact, told = (f(small, here, 1, EVERY, theta)[:, 0] for f in (scan, promising))
    assert np.argmin(exact) == np.argmin(told) == 14
    gain = here.misfit - exact[14]
    assert gain > 1.0
    assert told[14] == pytest.approx(exact[14], abs=0.1 * gain)


@pytest.fixture
def hoop(monkeypatch):
    """A closed string on soft ground: every mode but one is one of two of a frequency."""
    K = strings.K + 200.0 * np.eye(N)
    K[0, -1] = K[-1, 0] = K[0, 1]
    monkeypatch.setattr(strings, "K", K)
    monkeypatch.setattr(strings, "SEEN", EVERY)


@pytest.mark.parametrize("bead", [9, 10, 11])
def test_a_mass_between_the_places_of_a_first_scan_shows_where_it_turns_modes_right(hoop, bead):
    s = searcher(hidden(masses=[(bead, 1.7)]))
    small, here = begun(s)
    first, c = np.arange(0, N, 4), s.problem.catalogue[0]
    assert look(small, here, 0, first).cost.min() > here.objective
    across = replace(c, kind=replace(c.kind, across=12.0))
    around = neighbourhoods(across, first, 1.0)
    among = (first, *(rows[:0] for rows in s.coarse[1:]))
    beside = replace(s, coarse=among, beside=(around,))
    left, best = beside.scanned(evaluate(s.problem, np.zeros(2), ()), 1, among).best[0]
    assert best.row == bead
    assert left < 0.2 * here.objective


@pytest.mark.parametrize("bead", [9, 10, 11])
def test_so_does_an_absorber(hoop, bead):
    s = searcher(hidden(absorbers=[(bead, 2.0, 3.2)]))
    _, here = begun(s)
    first, c = np.arange(0, N, 4), s.problem.catalogue[2]
    around = neighbourhoods(replace(c, kind=replace(c.kind, across=12.0)), first, 1.0)
    among = (*(rows[:0] for rows in s.coarse[:2]), first)
    state = evaluate(s.problem, np.zeros(2), ())
    found = replace(s, coarse=among, beside=(None, None, around)).scanned(state, 1, among).best[0]
    alone = replace(s, coarse=among).scanned(state, 1, among).best[0]
    assert alone[0] > here.objective
    assert found[1].row == bead
    assert found[0] < 0.2 * here.objective


def not_at_points(s):
    """The same masses and springs as a kind that sits on patches."""
    c = s.problem.catalogue[0]
    patches = replace(c, kind=replace(c.kind, across=0.0))
    return replace(s, problem=replace(s.problem, catalogue=(patches, *s.problem.catalogue[1:])))


def test_of_other_kinds_every_place_is_evaluated_and_the_best_at_every_size(monkeypatch):
    monkeypatch.setattr(coarse_scan, "SEARCH", replace(SEARCH, every_size_least=3))
    small, here = begun(not_at_points(searcher(hidden(masses=[(9, 1.7)]))))
    c = small.catalogue[0]
    every = scan(small, here, 0, EVERY, c.trials) + c.surprise(c.trials)
    seen = look(small, here, 0, EVERY)
    assert seen.rows.tolist() == EVERY.tolist()
    assert seen.cost.min() == pytest.approx(every.min(), rel=1e-9)
    assert seen.cost[np.argmin(every.min(axis=1))] == seen.cost.min()


def test_places_that_cost_more_than_is_worth_are_not_looked_at_more_closely():
    small, here = begun(not_at_points(searcher(hidden(masses=[(9, 1.7)]))))
    c = small.catalogue[0]
    every = look(small, here, 0, EVERY)
    one = look(small, here, 0, EVERY, worth=float(every.cost.min()) + 1.0)
    assert one.cost.min() == every.cost.min()
    none = look(small, here, 0, EVERY, worth=-np.inf)
    first = c.trials[every_other(c)][:, 0]
    assert np.isin(none.theta[:, 0], first).all()
    assert not np.isin(every.theta[:, 0], first).all()


def test_a_scan_that_sees_every_place_has_no_neighbourhoods():
    c = searcher(hidden()).problem.catalogue[0]
    assert neighbourhoods(c, EVERY, 1.0) is None


def test_each_neighbourhood_gives_the_place_that_costs_least():
    c = searcher(hidden()).problem.catalogue[0]
    around = neighbourhoods(replace(c, kind=replace(c.kind, across=8.0)), EVERY[::8], 1.0)
    rows = around.around(EVERY[::8])
    cost = np.abs(rows - 13.2)
    kept = rows[around.first(rows, cost)]
    assert len(kept) == 4
    for k in range(4):
        own = around.of[rows] == k
        assert cost[own].min() in cost[np.isin(rows, kept)]
