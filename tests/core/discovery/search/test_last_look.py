"""What is to be claimed is looked for anew, by what the claim is weighed by."""

from dataclasses import replace
from types import SimpleNamespace as Some

import numpy as np
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects import KINDS
from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import fit
from trueup.core.discovery.search import last_look
from trueup.core.discovery.search.last_look import looked_again
from trueup.core.discovery.search.model_selection import scored

MASS, SPRING, ABSORBER = range(3)


def by_misfit(_, f, __):
    """Judge by half the objective."""
    left = Some(error=0.001, noise=0.02, each=np.zeros(12))
    return Some(evidence=-0.5 * f.objective, diffuse=left)


def test_a_suspect_far_off_its_place_and_size_is_found_there():
    s = searcher(hidden(tension=1.1, masses=[(9, 2.0)], springs=[(25, 20.0)]))
    s = replace(s, judged=by_misfit)
    wrong = Suspect(MASS, 9, (np.log(2.0),)), Suspect(SPRING, 4, (np.log(2000.0),))
    state = fit(s.problem, np.zeros(2), wrong, s.active, 20)
    _, tried = looked_again(s, scored(s, state), scored(s, s.null()).score)
    best = tried[0].fit
    places = {(t.kind, t.row) for t in best.suspects}
    assert best.objective < 0.5 * state.objective
    assert places == {(MASS, 9), (SPRING, 25)}
    assert np.exp([t.theta[0] for t in best.suspects if t.kind == SPRING]) < 40.0
    assert any(t.fit is state for t in tried)


def test_another_kind_at_the_place_of_a_suspect_is_looked_at_however_badly_it_fits(monkeypatch):
    """A soft beam was told as the joint at its end, which fits better on the basis of a search."""
    s = searcher(hidden(springs=[(9, 200.0)]))
    p = s.problem
    joint = replace(p.catalogue[SPRING], kind=KINDS["joint_flexibility"])
    both = replace(p, catalogue=(*p.catalogue, joint), factors=(*p.factors, p.factors[SPRING]))
    s = replace(s, problem=both, coarse=(*s.coarse, s.coarse[SPRING]), judged=by_misfit)
    told = fit(both, np.zeros(2), (Suspect(len(p.catalogue), 10, (np.log(50.0),)),), s.active, 20)
    monkeypatch.setattr(last_look, "_elsewhere", lambda *_: [])
    _, tried = looked_again(s, scored(s, told), scored(s, s.null()).score)
    kinds = {(o.kind, o.row) for t in tried for o in t.fit.suspects}
    assert (SPRING, 9) in kinds
    assert MASS in {kind for kind, _ in kinds}


def test_what_comes_next_elsewhere_is_moved_before_it_is_left_behind(monkeypatch):
    """An absorber between the places of a scan was told as equipment at 0.9, 60 nats ahead."""
    bead, hz = 10, 2.3
    s = searcher(hidden(absorbers=[(bead, 1.0, hz)]))

    def told(*suspect):
        return fit(s.problem, np.zeros(2), (Suspect(*suspect),), s.active, 20)

    mass = told(MASS, 21, (0.0,))
    beside = told(ABSORBER, bead - 1, (0.0, np.log(hz)))

    def judged(problem, f, least=0.0):
        of = by_misfit(problem, f, least)
        ahead = 33.0 - 0.5 * beside.objective
        return Some(evidence=ahead if f is mass else of.evidence, diffuse=of.diffuse)

    s = replace(s, judged=judged)
    monkeypatch.setattr(last_look, "_elsewhere", lambda *_: [beside])
    _, tried = looked_again(s, scored(s, mass), scored(s, s.null()).score)
    (best,) = tried[0].fit.suspects
    assert (best.kind, best.row) == (ABSORBER, bead)
