"""What is clear, and what an error of the model imitates."""

from dataclasses import replace
from types import SimpleNamespace as Some

import numpy as np
import pytest

from trueup.core.discovery.effects import point_mass
from trueup.core.discovery.likelihood.hypothesis import Fit
from trueup.core.discovery.model_error.support_reach import Reach
from trueup.core.discovery.search import completeness as room, model_selection
from trueup.core.discovery.search.completeness import Completeness, completeness
from trueup.core.discovery.search.credible_places import Place
from trueup.core.discovery.search.found import Found
from trueup.core.discovery.search.model_selection import Scored


def judged(each, error=0.001, noise=0.02, stray=(), evidence=0.0, mesh=0.0, scatter=0.0):
    chance = np.isin(np.arange(10), stray).astype(float)
    each = np.asarray(each, float)
    shared = Some(each=each, error=error, noise=noise, stray=chance, astray=chance > 0.5)
    here = Some(nuisance=np.zeros(2), suspects=())
    test = Some(evidence=Some(scatter=scatter))
    sure = Some(evidence=evidence, plain=evidence, lumped=mesh)
    return Some(**vars(sure), diffuse=shared, fit=here, problem=test)


def found(gain=30.0, ahead=np.inf, agree=3.0, before=0.03, lost=(), **more):
    none = judged(np.zeros(10), error=before, stray=lost)
    best = judged(np.zeros(10), **more)
    return Completeness(none, none, best, best, gain, gain, ahead, agree, [])


def test_what_many_modes_gain_by_and_foretell_is_clear():
    assert found().clear


def test_a_small_gain_is_not_clear():
    assert not found(gain=4.0).clear


def test_the_larger_the_error_that_is_left_the_more_has_to_be_gained():
    assert not found(error=0.02).clear
    assert found(error=0.02, gain=50.0).clear


def test_five_nats_a_mode_are_clear_whatever_is_left():
    assert found(error=0.3, gain=51.0).clear
    assert not found(error=0.3, gain=40.0).clear


def test_the_odds_count_as_they_are_where_a_right_model_may_leave_as_much():
    assert found(ahead=3.5).clear
    assert not found(ahead=2.5).clear
    assert not found(ahead=3.5, error=0.02, gain=50.0).clear
    assert found(ahead=5.5, error=0.02, gain=50.0).clear


def test_beside_what_the_set_up_may_do_they_do_not():
    near = Reach(25.0, 0.0)
    assert not replace(found(ahead=4.5), reach=near).clear
    assert replace(found(ahead=5.5), reach=near).clear


def test_what_takes_only_a_part_of_the_error_away_has_to_leave_what_is_usual():
    assert found(error=0.004, before=0.1).true
    assert not found(error=0.004, before=0.0045).true
    assert not found(error=0.05, before=3.0).true
    assert found(error=0.004, before=0.004, lost=(2, 3)).true


def test_a_poor_test_excuses_an_error_of_the_model():
    assert not found(error=0.01, gain=20.0).clear
    assert found(error=0.01, noise=0.2, gain=20.0).clear


def test_known_parameters_that_gain_little_do_not_show_that_nothing_is_missing():
    assert found(before=0.001).lacks_nothing
    assert not found(before=0.01).lacks_nothing


@pytest.mark.parametrize(
    ("gain", "drifts", "told"), [(9.0, 1, True), (2.0, 1, False), (9.0, 0, False)]
)
def test_smooth_fields_are_spoken_of_where_they_gain(gain, drifts, told):
    """A plate 7 % thinner in half was told to lack nothing, with no word of where."""
    whole = found()
    best = Some(**{**vars(whole.best), "evidence": gain, "bare": 0.0, "drifts": ("y",) * drifts})
    assert replace(whole, best=best).in_fields == told


def beside(gain, error=0.001, mesh=0.0, scatter=0.0):
    deck = judged(np.zeros(10), error=error, mesh=mesh, scatter=scatter)
    alone = judged(np.zeros(10), error=0.0005, evidence=gain)
    return Completeness(deck, alone, alone, alone, 0.0, 0.0, np.inf, 0.0, [])


def test_a_deck_that_smooth_fields_explain_alone_lacks_something():
    assert beside(2.0).lacks_nothing
    assert not beside(17.0).lacks_nothing


def test_what_a_mesh_of_shells_leaves_is_no_gap():
    assert beside(-2.0, error=0.005, mesh=0.02).lacks_nothing
    assert not beside(-2.0, error=0.005, mesh=0.0).lacks_nothing


def test_a_test_that_scatters_more_than_a_good_model_errs_shows_no_absence():
    assert beside(0.0, scatter=0.002).lacks_nothing
    assert not beside(0.0, scatter=0.05).lacks_nothing


def test_less_error_than_right_models_leave_is_no_proof():
    assert not found(error=1e-4, gain=9.0).clear
    assert found(error=1e-4, gain=11.0).clear


def test_what_leaves_more_than_a_small_part_of_the_error_has_to_gain_on_every_mode():
    assert not found(error=1e-3, before=3e-3, gain=14.0).clear
    assert found(error=1e-3, before=3e-3, gain=16.0).clear


def test_two_places_that_are_as_good_are_not_clear():
    assert not found(ahead=1.0).clear
    assert found(ahead=6.0).clear
    assert found(ahead=1.0).posterior == pytest.approx(1.0 / (1.0 + np.exp(-1.0)), abs=1e-6)


def test_an_explanation_with_many_modes_left_is_proposed_not_claimed():
    assert found(stray=(4,)).true
    assert found(stray=(4, 5)).clear
    assert not found(stray=(4, 5)).true


def test_modes_that_nothing_explains_count_in_what_a_right_model_leaves():
    usual = found(error=0.001)
    assert usual.adequacy > 0.8
    assert usual.explains
    one, two = found(error=0.001, stray=(4,)), found(error=0.001, stray=(4, 5))
    assert one.adequacy == pytest.approx(usual.adequacy * (1.0 - 0.97**10))
    assert one.explains
    assert two.adequacy < 0.04
    assert not two.explains


def gaining(evidence):
    return judged(np.full(10, evidence), error=0.0031, evidence=evidence)


def hypothesis(objective, *rows):
    suspects = tuple(Some(kind=0, row=r) for r in rows)
    return Fit(objective, objective, None, suspects, None, None, None, None, ())


def weighed(monkeypatch, found, evidence, alike=(), nothing=False, size=1.0):
    """Return what is kept, masses at a hundred places a unit apart, `evidence` by their rows.

    Places `alike` explain as well as any of them.
    """
    monkeypatch.setattr(
        room,
        "credible_places",
        lambda s, f, q: [Place(Some(kind=0, row=r), 1.0) for r in alike or [f.suspects[q].row]],
    )
    monkeypatch.setattr(room, "looked_again", lambda searcher, first, _: (searcher, [first]))
    monkeypatch.setattr(room, "lacks_nothing", lambda *_: nothing)
    monkeypatch.setattr(room, "foretold", lambda judged: judged.diffuse.each)
    for where in (room, model_selection):
        monkeypatch.setattr(
            where, "evaluate", lambda problem, _, s: hypothesis(99.0, *(t.row for t in s))
        )
    xyz = np.column_stack([np.arange(100.0), np.zeros((100, 2))])
    kind = Some(
        kind=point_mass.KIND,
        law=Some(acts_on="M"),
        tunings=1,
        xyz=xyz,
        spots=xyz,
        many=lambda row: 1,
        where=[{}] * 100,
        single=None,
    )
    searcher = Some(
        problem=Some(catalogue=[kind], heard=None),
        coarse=[np.arange(100)],
        size=size,
        fitted=lambda f, suspects, _: hypothesis(f.objective, *(t.row for t in suspects)),
        judged=lambda _, f, __: gaining(evidence.get(tuple(s.row for s in f.suspects), 0.0)),
    )
    accepted = len(found.levels) - 1
    deck = judged(np.zeros(10))
    return completeness(searcher, found, accepted, deck)[1:]


def test_a_suspect_that_gains_less_than_its_choices_is_dropped(monkeypatch):
    levels = hypothesis(100.0), hypothesis(40.0, 3), hypothesis(20.0, 3, 7)
    evidence = {(): 0.0, (3,): 30.0, (3, 7): 39.0}
    _, kept, said = weighed(monkeypatch, Found(levels, ((), (), ())), evidence)
    assert kept == 1
    assert said.gain == pytest.approx(30.0 - np.log(100))
    assert said.agree > 2.5


@pytest.mark.parametrize(("gains", "kept"), [(13.0, 0), (30.0, 1)])
def test_what_gains_little_on_every_mode_is_not_told_in_doubt_either(monkeypatch, gains, kept):
    levels = hypothesis(100.0), hypothesis(40.0, 3)
    evidence = {(): 0.0, (3,): gains}
    assert weighed(monkeypatch, Found(levels, ((), ())), evidence)[1] == kept


@pytest.mark.parametrize(("rival", "kept"), [(30.0, 0), (20.0, 1)])
def test_in_a_deck_that_lacks_nothing_only_what_is_clear_is_told(monkeypatch, rival, kept):
    found = Found((hypothesis(100.0), hypothesis(40.0, 3)), ((), (hypothesis(41.0, 60),)))
    evidence = {(): 0.0, (3,): 30.0, (60,): rival}
    assert weighed(monkeypatch, found, evidence)[1] == 1
    assert weighed(monkeypatch, found, evidence, nothing=True)[1] == kept


@pytest.mark.parametrize(("anew", "first"), [(25.0, 9), (15.0, 3)])
def test_a_rival_is_fitted_from_where_the_best_has_the_parameters_too(monkeypatch, anew, first):
    """Likelier from there it takes the lead, else it stays what it was."""

    def of(row, score, nuisance):
        return Scored(
            hypothesis(40.0, row),
            Some(fit=Some(nuisance=nuisance, suspects=(Some(kind=0, row=row),))),
            score,
        )

    best, rival = of(3, 20.0, "there"), of(9, 10.0, "here")
    monkeypatch.setattr(room, "says_else", lambda s, f, g: f.suspects[0].row != g.suspects[0].row)
    monkeypatch.setattr(room, "evaluate", lambda problem, nuisance, s: (nuisance, s[0].row))

    def scored(searcher, fit, best):
        nuisance, row = fit
        return of(row, anew if (nuisance, row) == ("there", 9) else 0.0, nuisance)

    monkeypatch.setattr(room, "scored", scored)
    out = room._from_there(Some(problem=None), [rival, best])
    assert [s.fit.suspects[0].row for s in out] == [first, 12 - first]
    assert out[0].score == max(anew, 20.0)


@pytest.mark.parametrize(
    ("behind", "same", "row"),
    [
        pytest.param(2.0, True, 0, id="about as likely"),
        pytest.param(9.0, True, 1, id="far less likely"),
        pytest.param(2.0, False, 1, id="elsewhere"),
    ],
)
def test_a_mass_between_two_grids_is_told_before_half_of_it_at_each(monkeypatch, behind, same, row):
    monkeypatch.setattr(room, "says_else", lambda s, f, g: f is not g and not same)
    kind = Some(many=lambda row: 1 + row)
    one, two = (
        Scored(hypothesis(40.0, r), None, score) for r, score in ((0, 50.0 - behind), (1, 50.0))
    )
    searcher = Some(problem=Some(catalogue=[kind]))
    out = room._plainest_first(searcher, [two, one])
    assert [s.fit.suspects[0].row for s in out] == [row, 1 - row]


def test_shapes_that_are_off_everywhere_bear_no_model_out():
    assert found(error=0.0003, noise=0.29).explains
    assert not found(error=0.0003, noise=0.34).explains


@pytest.mark.parametrize("objective", [50.0, 90.0])
def test_a_rival_that_the_error_of_the_model_makes_likelier_leads(monkeypatch, objective):
    rival, other = hypothesis(objective, 9), hypothesis(45.0, 9, 11)
    levels = hypothesis(100.0), hypothesis(40.0, 3)
    evidence = {(): 0.0, (3,): 30.0, (9,): 80.0}
    found, kept, said = weighed(monkeypatch, Found(levels, ((), (rival, other))), evidence)
    assert kept == 1
    assert found.levels[1].suspects[0].row == 9
    assert said.ahead == pytest.approx(50.0)


def test_the_richer_hypothesis_without_a_suspect_is_one_of_the_poorer(monkeypatch):
    levels = hypothesis(100.0), hypothesis(40.0, 3), hypothesis(20.0, 9, 7)
    evidence = {(): 0.0, (3,): 20.0, (9,): 40.0, (9, 7): 46.0}
    found, kept, said = weighed(monkeypatch, Found(levels, ((), (), ())), evidence)
    assert kept == 1
    assert [s.row for s in found.levels[1].suspects] == [9]
    assert said.ahead == pytest.approx(20.0)


@pytest.mark.parametrize(("lost", "row"), [(0.1, 5), (1.0, 3)])
def test_what_is_found_stands_in_the_middle_of_places_that_are_as_likely(monkeypatch, lost, row):
    levels = hypothesis(100.0), hypothesis(40.0, 3)
    evidence = {(): 0.0, (3,): 30.0, (5,): 30.0 - 10.0 * lost}
    found, kept, said = weighed(monkeypatch, Found(levels, ((), ())), evidence, (3, 4, 5, 6, 7))
    assert [s.row for s in found.levels[kept].suspects] == [row]
    assert said.best.evidence == evidence[(row,)]


@pytest.mark.parametrize(("size", "kept"), [(1.0, 2), (100.0, 1)])
def test_the_second_of_two_masses_side_by_side_has_to_gain_a_share_of_what_the_first_does(
    monkeypatch, size, kept
):
    levels = hypothesis(100.0), hypothesis(40.0, 3), hypothesis(20.0, 3, 7)
    evidence = {(): 0.0, (3,): 400.0, (3, 7): 460.0}
    found = Found(levels, ((), (), ()))
    assert weighed(monkeypatch, found, evidence, size=size)[1] == kept
