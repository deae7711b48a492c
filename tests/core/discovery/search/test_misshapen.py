"""A structure of another shape than drawn, beside effects that imitate it."""

from dataclasses import replace
from types import SimpleNamespace as Some

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.model_error.geometry_error import Misshapen
from trueup.core.discovery.model_error.support_reach import Reach
from trueup.core.discovery.search import misshapen
from trueup.core.discovery.search.completeness import Completeness
from trueup.core.discovery.search.found import Found
from trueup.core.discovery.search.search_numbers import SEARCH

SHAPE = 50.0
"""ln of the evidence for another shape."""


def weighed(monkeypatch, evidence, kept, error=0.006, moved=True, reach=None):
    """Return how many effects are told beside a shape, how well they explain, shapes tried."""

    def judged(problem, f, _=0.0):
        score = evidence * len(f.suspects)
        none = np.zeros(12)
        left = Some(error=error, noise=0.02, each=none, stray=none, astray=none > 0.5)
        own = Some(evidence=Some(scatter=np.array([0.001])))
        return Some(evidence=score, bare=score, lumped=0.0, diffuse=left, fit=f, problem=own)

    tried = []

    def likeliest(*_):
        tried.append(1)
        return Misshapen("bowed along x", 2.0, 0.002, SHAPE)

    monkeypatch.setattr(misshapen, "likeliest", likeliest)
    monkeypatch.setattr(misshapen, "modal", lambda *_: None)
    s = replace(searcher(hidden()), judged=judged)
    null = s.null()
    effect = [Suspect(1, 9, (np.log(200.0),))] * kept
    found = Found((null, *(evaluate(s.problem, null.nuisance, (e,)) for e in effect)), ((), ()))
    alone, best = (judged(s.problem, f) for f in (null, found.levels[-1]))
    whole = Completeness(alone, alone, best, best, 99.0, 99.0, np.inf, 3.0, [], reach)
    ground = Some(structure=Some(moved=moved or None))
    return *misshapen.beside_geometry(ground, s, found, kept, whole), len(tried)


@pytest.mark.parametrize(
    ("evidence", "told", "clear"), [(20.0, False, False), (57.0, True, False), (65.0, True, True)]
)
def test_what_imitates_a_shape_is_not_told_and_what_is_no_clearer_not_claimed(
    monkeypatch, evidence, told, clear
):
    kept, whole, _ = weighed(monkeypatch, evidence, 1)
    assert bool(kept) == told
    assert (whole.shape is None) == clear
    assert (whole.best is whole.alone) != told
    assert (whole.ahead > SEARCH.suspect) == (clear or not told)


def test_none_is_tried_where_nothing_is_left_or_an_effect_is_beyond_it(monkeypatch):
    for asked in (
        {"kept": 0, "error": 0.0005},
        {"kept": 1, "error": 0.0005},
        {"kept": 0, "moved": False},
    ):
        _, whole, tried = weighed(monkeypatch, 300.0, **asked)
        assert whole.shape is None
        assert not tried
    assert weighed(monkeypatch, 300.0, 0)[1].shape.name == "bowed along x"


@pytest.mark.parametrize(("reach", "told"), [(30.0, "s"), (48.0, "rs"), (53.0, "rs"), (70.0, "r")])
def test_of_a_shape_and_a_clamp_that_reaches_further_in_the_likelier_is_told_or_both(
    monkeypatch, reach, told
):
    _, whole, _ = weighed(monkeypatch, 0.0, 0, reach=Reach(12.0, reach))
    assert "r" * bool(whole.reach) + "s" * bool(whole.shape) == told


@pytest.mark.parametrize(("evidence", "told"), [(20.0, True), (40.0, False), (200.0, False)])
def test_what_an_effect_leaves_may_be_another_shape(monkeypatch, evidence, told):
    monkeypatch.setattr(misshapen, "_worth_trying", lambda *_: False)
    kept, whole, tried = weighed(monkeypatch, evidence, 1)
    assert (kept, tried) == (1, 1)
    assert (whole.shape is not None) == told
