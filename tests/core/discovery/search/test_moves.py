"""Steps of the search: on a string of beads."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.discovery.strings import N, hidden, searcher

from trueup.core.discovery.effects import KINDS
from trueup.core.discovery.effects.candidates import Suspect, together
from trueup.core.discovery.likelihood.map_fit import evaluate, fit, promised
from trueup.core.discovery.search import coarse_scan, moves
from trueup.core.discovery.search.patch_reshaping import options_beside
from trueup.core.discovery.search.search_numbers import SEARCH

MASS, SPRING, ABSORBER = range(3)


@pytest.mark.parametrize(
    "held",
    [
        (Suspect(SPRING, 9, (np.log(3000.0),)),),
        (Suspect(MASS, 9, (np.log(2.0),)),),
        (Suspect(ABSORBER, 9, (np.log(0.8), np.log(1.7))),),
        (Suspect(SPRING, 9, (np.log(3000.0),)), Suspect(MASS, 20, (0.0,))),
    ],
)
def test_on_its_own_lowest_modes_a_hypothesis_is_what_it_was(held, monkeypatch):
    monkeypatch.setattr(moves, "SEARCH", replace(SEARCH, search_modes=18))
    s = searcher(hidden(tension=1.1))
    state = evaluate(s.problem, np.array([0.05, 0.0]), held)
    small, here = s.local(state)
    assert small.basis.size <= 18 < s.problem.basis.size
    n = s.problem.columns
    np.testing.assert_allclose(here.eigenvalues[:n], state.eigenvalues[:n], rtol=1e-8)
    assert here.objective == pytest.approx(state.objective, rel=1e-6)


def test_a_fit_whose_softened_one_leaves_no_mass_starts_from_where_it_came(monkeypatch):
    s = searcher(hidden(masses=[(9, 2.0)]))
    state, suspects = s.null(), (Suspect(MASS, 9, (0.0,)),)
    plain = fit(s.problem, state.nuisance, suspects, s.active, SEARCH.steps_whole)
    tried = []

    def thin(problem, start, *rest):
        if problem is s.problem:
            tried.append(start)
            if not np.array_equal(start, state.nuisance):
                raise np.linalg.LinAlgError
        return fit(problem, start, *rest)

    monkeypatch.setattr(moves, "fit", thin)
    found = s.fitted(state, suspects, SEARCH.steps_new, soften=True)
    assert len(tried) == 2
    assert found.objective == plain.objective


def test_two_masses_side_by_side_are_one_between_them_on_points_and_patches_alike():
    s = searcher(hidden(masses=[(9, 2.0)]))
    p = s.problem
    twice = replace(
        p, catalogue=(*p.catalogue, p.catalogue[MASS]), factors=(*p.factors, p.factors[MASS])
    )
    s = replace(s, problem=twice, coarse=(*s.coarse, s.coarse[MASS]))
    light = evaluate(twice, np.zeros(2), (Suspect(MASS, 9, (0.0,)),))
    beside = [b for _, b in s.branches(light, 9) if b.kind in (MASS, 3)]
    spots = p.catalogue[MASS].spots
    assert beside
    assert min(np.linalg.norm(spots[b.row] - spots[9]) for b in beside) >= SEARCH.apart * s.size


def spread_over(s, count):
    """Return a search that also knows masses of several beads side by side, and their number."""
    p, beads = s.problem, np.arange(0, N, count)
    c, each = p.catalogue[MASS], np.arange(N)
    wide = replace(
        c,
        kind=KINDS["distributed_mass"],
        xyz=np.add.reduceat(c.xyz, beads) / count,
        root=sp.csr_matrix((np.full(N, count**-0.5), (each, each)), (N, N)),
        rows_each=count,
        where=tuple({"elements": [k + 1]} for k in range(len(beads))),
    )
    catalogue, factors = (*p.catalogue, wide), (*p.factors, wide.factors(p.basis))
    problem = replace(p, catalogue=catalogue, factors=factors)
    return replace(s, problem=problem, coarse=(*s.coarse, np.arange(len(beads)))), len(p.catalogue)


def test_a_mass_on_a_patch_becomes_one_at_a_point_where_that_is_better():
    s, wide = spread_over(searcher(hidden(masses=[(9, 2.0)])), 4)
    state = fit(s.problem, np.zeros(2), (Suspect(wide, 2, (np.log(2.0),)),), s.active, 20)
    (moved,) = s.refined(state).suspects
    assert (moved.kind, moved.row) == (MASS, 9)
    assert np.exp(moved.theta[0]) == pytest.approx(2.0, rel=0.02)


def test_a_mass_at_a_point_becomes_one_on_a_patch_where_that_is_better():
    s, wide = spread_over(searcher(hidden(masses=[(k, 0.5) for k in range(8, 12)])), 4)
    state = fit(s.problem, np.zeros(2), (Suspect(MASS, 9, (np.log(2.0),)),), s.active, 20)
    (moved,) = s.refined(state).suspects
    assert (moved.kind, moved.row) == (wide, 2)
    assert np.exp(moved.theta[0]) == pytest.approx(2.0, rel=0.02)


@pytest.mark.parametrize(("apart", "forms"), [(4, [MASS]), (30, [])])
def test_twins_beside_each_other_are_one_mass_between_them(apart, forms):
    s = searcher(hidden(masses=[(15, 2.0)]))
    p = s.problem
    rows = np.array([[15 - apart // 2, 15 + apart // 2]])
    twins = together(p.catalogue[MASS], rows % N)
    problem = replace(
        p, catalogue=(*p.catalogue, twins), factors=(*p.factors, twins.factors(p.basis))
    )
    s = replace(s, problem=problem, coarse=(*s.coarse, np.zeros(1, int)))
    both = Suspect(len(p.catalogue), 0, (0.0,))
    assert [kind for kind, *_ in s.forms(both)] == forms
    state = fit(problem, np.zeros(2), (both,), s.active, 20)
    (moved,) = s.refined(state).suspects
    assert ((moved.kind, moved.row) == (MASS, 15)) == bool(forms)
    _, between = options_beside(s, both)
    assert (Suspect(MASS, 15, (pytest.approx(np.log(2.0)),)) in between) == bool(forms)


@pytest.mark.parametrize(("near", "rows"), [(0.5, [9, 17]), (0.0, [12, 14])])
def test_two_masses_near_each_other_move_at_once(near, rows, monkeypatch):
    s = searcher(hidden(masses=[(9, 2.0), (17, 2.0)]))
    beside = (Suspect(MASS, 12, (np.log(2.0),)), Suspect(MASS, 14, (np.log(2.0),)))
    state = evaluate(s.problem, np.zeros(2), beside)
    monkeypatch.setattr(moves, "SEARCH", replace(SEARCH, together_near=near))
    moved = s.moved_at_once(state)
    assert sorted(q.row for q in moved.suspects) == rows


def test_a_spring_has_no_other_form():
    s, _ = spread_over(searcher(hidden(springs=[(14, 150.0)])), 4)
    state = fit(s.problem, np.zeros(2), (Suspect(SPRING, 13, (np.log(150.0),)),), s.active, 20)
    assert [(q.kind, q.row) for q in s.refined(state).suspects] == [(SPRING, 14)]


def test_a_step_of_all_unknowns_promises_what_the_fit_then_finds():
    s = searcher(hidden(tension=1.1, masses=[(9, 2.0)]))
    near = (Suspect(MASS, 9, (np.log(1.98),)),)
    best = fit(s.problem, np.zeros(2), near, s.active, 25, 1e-6)
    start = np.array([best.nuisance[0] + 0.001, 0.0])
    here = evaluate(s.problem, start, near).objective
    assert fit(s.problem, start, near, s.active, 25, 1e-6).objective == pytest.approx(
        best.objective, rel=1e-6
    )
    hope = promised(s.problem, start, near, s.active)
    assert here > 1.05 * best.objective
    assert hope == pytest.approx(best.objective, rel=0.02)
    stays = promised(s.problem, best.nuisance, best.suspects, s.active)
    assert stays == pytest.approx(best.objective, abs=1e-3)


@pytest.mark.parametrize("off", [-2, -1, 1, 2])
def test_a_suspect_moves_to_where_it_is_once_all_else_follows(off):
    s = searcher(hidden(tension=1.15, masses=[(9, 2.0)], springs=[(22, 250.0)]))
    beside = (
        Suspect(MASS, 9 + off, (0.0,)),
        Suspect(SPRING, 22 - off, (np.log(100.0),)),
    )
    state = fit(s.problem, np.zeros(2), beside, s.active, 20)
    moved = s.refined(state)
    assert [q.row for q in moved.suspects] == [9, 22]
    assert np.exp(moved.suspects[0].theta[0]) == pytest.approx(2.0, rel=0.05)
    assert np.exp(moved.suspects[1].theta[0]) == pytest.approx(250.0, rel=0.1)


def test_branches_are_ranked_by_what_is_left_once_the_known_parameters_follow():
    s = searcher(hidden(tension=1.3, masses=[(9, 2.0)]))
    state = evaluate(s.problem, np.zeros(2), ())
    small, here = s.local(state)
    found = s.branches(state, 3, soft=False)
    scores = [score for score, _ in found]
    assert scores == sorted(scores)
    for score, b in found:
        assert score == pytest.approx(promised(small, here.nuisance, (b,), s.active))
        assert score < evaluate(small, here.nuisance, (b,)).objective
    assert (found[0][1].kind, found[0][1].row) == (MASS, 9)
    assert max(np.bincount([b.kind for _, b in found])) == 3


def test_beside_another_hypothesis_only_what_gains_most_beside_the_best_is_looked_at(monkeypatch):
    s = searcher(hidden(tension=1.3, masses=[(9, 2.0)]))
    monkeypatch.setattr(coarse_scan, "SEARCH", replace(SEARCH, hopeful=8, every_size_least=5))
    looked = []

    def seen(problem, state, kind, rows, around, worth):
        looked.append(len(rows))
        return coarse_scan.look(problem, state, kind, rows, around, worth)

    monkeypatch.setattr(moves, "look", seen)
    state = evaluate(s.problem, np.zeros(2), ())
    whole = s.scanned(state, 3, s.coarse)
    assert 9 in whole.live[MASS]
    every, looked[:] = sum(looked), []
    again = s.scanned(evaluate(s.problem, np.array([0.02, 0.0]), ()), 3, whole.live)
    assert sum(looked) < 0.5 * every
    assert (again.best[0][1].kind, again.best[0][1].row) == (MASS, 9)
