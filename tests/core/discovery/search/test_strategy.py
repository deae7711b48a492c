"""Simple explanations first, absorbers where these do clearly worse: on a string of beads."""

from dataclasses import replace
from types import SimpleNamespace as Some

import numpy as np
import pytest
from tests.core.discovery.strings import K, N, hidden, searcher

from trueup.core.discovery.effects import KINDS
from trueup.core.discovery.effects.candidates import Suspect, factors_of, with_twins
from trueup.core.discovery.search import strategy
from trueup.core.discovery.search.found import Found
from trueup.core.discovery.search.model_selection import chosen
from trueup.core.discovery.search.strategy import searched


def told(s):
    found = searched(s)
    accepted = chosen(s, found)
    best = found.levels[accepted]
    return [s.problem.catalogue[q.kind].kind.name for q in best.suspects], best


@pytest.mark.parametrize("bead", [5, 11])
def test_a_mass_stays_a_mass_though_an_absorber_could_imitate_it(bead):
    kinds, best = told(searcher(hidden(masses=[(bead, 2.0)]), modes_out=(4, 10)))
    assert kinds == ["point_mass"]
    assert best.suspects[0].row == bead


def test_an_absorber_is_found_where_no_simple_kind_does_as_well():
    s = searcher(hidden(absorbers=[(11, 0.8, 1.7)]), modes_out=(4, 10))
    kinds, best = told(s)
    assert kinds == ["tuned_absorber"]
    assert np.exp(best.suspects[0].theta[0]) == pytest.approx(0.8, rel=0.1)


@pytest.mark.parametrize("seed", range(4))
def test_a_quiet_string_has_neither(seed):
    kinds, _ = told(searcher(hidden(tension=1.1), modes_out=(4, 10), seed=seed))
    assert kinds == []


@pytest.mark.parametrize("usual", [True, False])
def test_late_kinds_are_looked_for_where_the_others_leave_more_than_is_usual(usual, monkeypatch):
    s = searcher(hidden(tension=1.1), modes_out=(4, 10))
    springs = replace(s.problem.catalogue[1], kind=replace(KINDS["ground_spring"], late=True))
    catalogue = (s.problem.catalogue[0], springs, s.problem.catalogue[2])
    s, said = replace(s, problem=replace(s.problem, catalogue=catalogue)), []
    monkeypatch.setattr(strategy, "usual", lambda *_: usual)
    searched(s, said.append)
    assert any("two places" in line for line in said) != usual


@pytest.mark.parametrize(
    ("left", "evidence", "followed"),
    [(None, 0.0, False), (1e4, 0.0, False), (1e4, 21.0, True), (-1e4, 28.0, True)],
)
def test_late_kinds_are_looked_for_beside_what_does_not_pay_alone(
    left, evidence, followed, monkeypatch
):
    """Two that hide each other: neither pays while the other is not there.

    On goes the search with what is likelier than the best or, of as many suspects, fits better
    than all else and earns its place.
    """
    s = searcher(hidden(masses=[(5, 2.0)], absorbers=[(20, 0.8, 1.7)]), modes_out=(4, 10))
    null = s.null()
    one = s.fitted(null, (Suspect(0, 5, (0.7,)),), 6)
    tuned = s.fitted(null, (Suspect(2, 20, (-0.2, 0.5)),), 6)
    tuned = replace(tuned, objective=one.objective + (left or 0.0), misfit=one.misfit)
    grown, states = [], []

    def beside(_, state, *simpler, few=0):
        states.append(len(state.suspects))
        return [] if left is None or state.suspects else [tuned]

    def beam(*a, **k):
        grown.append(a)
        return Found((null, one), ((), ()))

    each = np.zeros(4)
    error = Some(error=0.1, noise=0.02, each=each, stray=each, astray=each > 0.5, complete=False)
    s = replace(
        s, judged=lambda _, f, *least: Some(diffuse=error, evidence=evidence * (f is tuned))
    )
    monkeypatch.setattr(strategy, "chosen", lambda *_: 0)
    monkeypatch.setattr(strategy, "usual", lambda *_: False)
    monkeypatch.setattr(strategy, "complete", lambda *_: False)
    monkeypatch.setattr(strategy, "_beside", beside)
    monkeypatch.setattr(strategy, "grown", beam)
    searched(s)
    assert states == [0, 1]
    assert len(grown) == 1 + followed


@pytest.mark.parametrize("astray", [False, True])
def test_beside_what_is_adequate_absorbers_are_looked_for_where_a_mode_is_astray(
    astray, monkeypatch
):
    """An absorber adds a mode; what else an adequate explanation leaves it would imitate."""
    s = searcher(hidden(masses=[(5, 2.0)], absorbers=[(20, 0.8, 1.7)]), modes_out=(4, 10))
    one = s.fitted(s.null(), (Suspect(0, 5, (0.7,)),), 6)
    lost = astray & (np.arange(10) == 3)
    left = Some(error=0.003, noise=0.02, each=np.zeros(10), astray=lost, complete=False)
    s = replace(s, judged=lambda *_: Some(diffuse=left, evidence=0.0))
    tuned = s.problem.catalogue[2]
    assert tuned.tunings > 1
    places = []
    monkeypatch.setattr(strategy, "chosen", lambda *_: 1)
    monkeypatch.setattr(strategy, "_beside", lambda own, *_: places.append(own.coarse[2]) or [])
    monkeypatch.setattr(strategy, "grown", lambda *_, **__: Found((s.null(), one), ((), ())))
    searched(s, explained=lambda *_: False)
    assert all(bool(len(rows)) == astray for rows in places)
    assert places or not astray


def off_everywhere(truth, size, seed):
    """K with a random error of relative `size` in modal coordinates, M as it is."""
    k, m = truth
    values, vectors = np.linalg.eigh(K)
    E = np.random.default_rng(seed).normal(size=(N, N))
    root = vectors * np.sqrt(values)
    return k + size * root @ (0.5 * (E + E.T)) @ root.T, m


@pytest.mark.parametrize("seed", range(3))
def test_twin_masses_are_found_though_every_mode_is_off(seed):
    s = searcher(off_everywhere(hidden(masses=[(5, 4.0), (26, 4.0)]), 0.04, seed))
    singles = s.problem.catalogue[0]
    twins = with_twins(singles, singles.xyz, s.size, singles.xyz[:0])[1]
    catalogue = (*s.problem.catalogue, twins)
    problem = replace(
        s.problem, catalogue=catalogue, factors=factors_of(catalogue, s.problem.basis)
    )
    s = replace(s, problem=problem, coarse=(*s.coarse, np.arange(len(twins))))
    _, best = told(s)
    (pair,) = best.suspects
    places = twins.copies[pair.row]
    assert max(abs(a - b) for a, b in zip(sorted(places), (5, 26), strict=True)) <= 1
    assert np.exp(pair.theta[0]) == pytest.approx(4.0, rel=0.3)


def test_a_mass_and_an_absorber_that_hide_each_other_are_both_found():
    s = searcher(hidden(absorbers=[(9, 0.6, 2.3)], masses=[(22, 3.0)]), modes_out=(4, 10))
    kinds, best = told(s)
    assert sorted(kinds) == ["point_mass", "tuned_absorber"]
    assert {q.row for q in best.suspects} == {9, 22}


@pytest.mark.parametrize(
    ("hide", "last"), [({"masses": [(5, 2.0)]}, 1), ({"springs": [(5, 40.0)]}, 2)]
)
def test_masses_that_explain_all_on_their_footprints_end_the_search(hide, last, monkeypatch):
    """Not known parameters alone, nor stiffness: beside these there is room for more."""
    monkeypatch.setattr(strategy, "adequate", lambda *_: True)
    monkeypatch.setattr(strategy, "complete", lambda *_: False)
    said = []
    searched(searcher(hidden(**hide), modes_out=(4, 10)), said.append, lambda *_: True)
    assert [line for line in said if "missing" in line][-1].startswith(f"looking for {last} ")
