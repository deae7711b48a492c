"""Searching and judging on a string of beads, where the truth is in the catalogue."""

from dataclasses import replace
from functools import partial
from types import SimpleNamespace as Some

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects import distributed_mass, ground_spring, point_mass
from trueup.core.discovery.effects.candidates import Suspect, together
from trueup.core.discovery.likelihood.map_fit import fit
from trueup.core.discovery.search import model_selection
from trueup.core.discovery.search.beam_search import grown
from trueup.core.discovery.search.credible_places import Place, between, credible_places, middle
from trueup.core.discovery.search.found import Found, noise_scale
from trueup.core.discovery.search.model_selection import (
    Scored,
    adequate,
    chosen,
    complete,
    earned,
    enough,
    held_out,
    hopeless,
    instead,
    kept,
    says_else,
    scored,
    usual,
    without_one_to_spare,
)


def found_in(s):
    found = grown(s)
    return found, chosen(s, found)


def kinds(s, f):
    return [s.problem.catalogue[q.kind].kind.name for q in f.suspects]


@pytest.mark.parametrize("bead", [5, 11])
def test_a_bead_heavier_than_it_should_be_is_found_beside_a_wrong_tension(bead):
    s = searcher(hidden(tension=1.1, masses=[(bead, 2.0)]), modes_out=(4, 10))
    found, accepted = found_in(s)
    best = found.levels[accepted]
    assert kinds(s, best) == ["point_mass"]
    assert best.suspects[0].row == bead
    assert np.exp(best.suspects[0].theta[0]) == pytest.approx(2.0, rel=0.05)
    assert np.exp(best.nuisance[0]) == pytest.approx(1.1, rel=0.01)


def test_a_spring_to_ground_is_found():
    s = searcher(hidden(springs=[(9, 300.0)]), modes_out=(4, 10))
    found, accepted = found_in(s)
    best = found.levels[accepted]
    assert kinds(s, best) == ["ground_spring"]
    assert best.suspects[0].row == 9
    assert np.exp(best.suspects[0].theta[0]) == pytest.approx(300.0, rel=0.1)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("tension", [1.0, 1.15])
def test_where_nothing_is_missing_nothing_is_named(tension, seed):
    s = searcher(hidden(tension=tension), modes_out=(4, 10), seed=seed)
    _, accepted = found_in(s)
    assert accepted == 0


def test_an_effect_that_does_not_foretell_what_was_held_out_loses_what_it_gained():
    s = searcher(hidden(masses=[(7, 2.0)]), modes_out=(1, 4, 7, 10))
    null = s.null()
    right = fit(s.problem, null.nuisance, (Suspect(0, 7, (0.7,)),), (0,), 20)
    wrong = fit(s.problem, null.nuisance, (Suspect(0, 20, (0.7,)),), (0,), 20)
    assert scored(s, wrong).score < scored(s, right).score - 10.0


def test_what_is_left_of_modes_that_were_held_out_is_noise_as_well():
    s = searcher(hidden(masses=[(7, 2.0)]), modes_out=(0, 1, 2, 3))
    quiet = fit(s.problem, s.start, (Suspect(0, 7, (0.7,)),), (0,), 20)
    shifted = s.problem.whole.frequencies_hz * np.where(np.arange(12) < 4, 1.05, 1.0)
    whole = replace(s.problem.whole, frequencies_hz=shifted)
    assert noise_scale(s.problem, quiet) < 2.0
    assert noise_scale(replace(s.problem, whole=whole), quiet) > 5.0


def test_the_credible_set_holds_the_truth_and_its_weights_are_shares():
    s = searcher(hidden(masses=[(7, 1.0)]), scatter=(0.002, 0.02))
    found, accepted = found_in(s)
    best = found.levels[accepted]
    places = credible_places(s, best, 0)
    assert 7 in [p.suspect.row for p in places]
    assert sum(p.weight for p in places) == pytest.approx(1.0)


def test_a_place_is_as_credible_as_it_is_once_all_else_followed():
    s = searcher(hidden(tension=1.1, masses=[(7, 1.0)]), scatter=(0.002, 0.02))
    found, accepted = found_in(s)
    best = found.levels[accepted]
    (one,) = best.suspects
    by_hand = np.array(
        [
            fit(s.problem, best.nuisance, (replace(one, row=row),), s.active, 20).objective
            for row in range(len(s.problem.catalogue[one.kind]))
        ]
    )
    behind = (by_hand - by_hand.min()) / noise_scale(s.problem, best)
    places = {p.suspect.row: p.weight for p in credible_places(s, best, 0)}
    assert set(places) == set(np.flatnonzero(behind < 6.0).tolist())
    expected = np.exp(-0.5 * behind[list(places)])
    np.testing.assert_allclose(list(places.values()), expected / expected.sum(), atol=0.03)


def test_sizes_that_differ_between_places_widen_the_interval():
    places = [Place(Suspect(0, 1, (1.0, 5.0)), 0.75), Place(Suspect(0, 2, (2.0, 5.0)), 0.25)]
    np.testing.assert_allclose(between(places), [np.sqrt(0.75 * 0.25), 0.0])


def test_a_rival_of_another_kind_that_fits_as_well_is_told():
    s = searcher(hidden(masses=[(7, 1.0)]))
    s = replace(s, judged=leaving(0.002, evidence=lambda f: -0.5 * f.objective))
    null = s.null()
    best = fit(s.problem, null.nuisance, (Suspect(0, 7, (0.0,)),), (0,), 20)
    rival = fit(s.problem, null.nuisance, (Suspect(1, 7, (5.0,)),), (0,), 20)
    rival = replace(rival, objective=best.objective + 2.0)
    found = Found((null, best), ((), (rival,)))
    accepted = chosen(s, found)
    ((other, weight),) = instead(s, found, accepted, 0)
    assert (other.kind, other.row) == (1, 7)
    assert weight == pytest.approx(np.exp(-1.0), rel=1e-6)


def leaving(error, stray=0.0, evidence=lambda f: 0.0):
    left = Some(
        error=error,
        noise=0.02,
        each=np.zeros(10),
        stray=np.full(10, stray),
        astray=np.full(10, stray > 0.5),
        complete=error < 1e-3,
    )
    return lambda _, f, *least: Some(diffuse=left, evidence=evidence(f))


def test_a_search_ends_where_nothing_is_left_to_explain():
    s = searcher(hidden(masses=[(7, 2.0)]))
    all_of_it, nothing = leaving(0.1), leaving(5e-4, evidence=lambda f: 100.0)
    s = replace(s, judged=lambda _, f, *least: (nothing if f.suspects else all_of_it)(_, f))
    found = grown(s, explains=partial(complete, s))
    assert [len(f.suspects) for f in found.levels] == [0, 1]


@pytest.mark.parametrize(
    ("error", "stray", "is_adequate"), [(0.002, 0.0, True), (0.1, 0.0, False), (0.002, 1.0, False)]
)
def test_a_hypothesis_is_adequate_that_leaves_what_right_models_do(error, stray, is_adequate):
    s = replace(searcher(hidden()), judged=leaving(error, stray))
    assert adequate(s, s.null()) is is_adequate


def test_an_error_is_usual_that_half_of_right_models_leave():
    s = searcher(hidden())
    assert usual(replace(s, judged=leaving(0.002)), s.null())
    assert not usual(replace(s, judged=leaving(0.01)), s.null())


def test_a_search_ends_where_one_more_neither_pays_nor_is_likelier_by_the_error_of_the_model():
    """Two that hide each other hardly fit alone; what an adequate one leaves is no proof."""
    s = searcher(hidden(masses=[(7, 2.0)]), scatter=(0.03, 0.2))
    null = s.null()
    one = fit(s.problem, null.nuisance, (Suspect(0, 7, (0.7,)),), (0,), 20)
    little, much = (replace(null, objective=one.objective + gain) for gain in (1.0, 1000.0))
    poor, adequate = (replace(s, judged=leaving(error)) for error in (0.1, 0.002))
    likelier = leaving(0.1, evidence=lambda f: 100.0 * bool(f.suspects))
    assert enough(poor, little, one)
    assert not enough(poor, much, one)
    assert enough(adequate, much, one)
    assert not enough(replace(s, judged=likelier), little, one)


@pytest.mark.parametrize(("gain", "vain"), [(1.0, True), (100.0, False)])
def test_one_that_gains_next_to_nothing_of_its_price_is_not_moved_about(gain, vain):
    s = searcher(hidden(masses=[(7, 2.0)]))
    null = s.null()
    one = fit(s.problem, null.nuisance, (Suspect(0, 7, (0.7,)),), (0,), 20)
    assert hopeless(s, replace(null, objective=one.objective + gain), one) is vain


@pytest.mark.parametrize(("error", "first", "gain", "accepted"), [
    (0.05, 100.0, 100.0, 2), (0.05, 100.0, 5.0, 1), (0.05, -50.0, 58.0, 1), (0.05, -50.0, 158.0, 2),
    (0.0005, 100.0, 40.0, 1), (0.0005, 100.0, 100.0, 2),
])  # fmt: skip
def test_a_richer_one_counts_by_the_error_of_the_model(error, first, gain, accepted):
    """It needs more beside one that leaves what right models do half of the time."""
    s = searcher(hidden(masses=[(7, 2.0)]))
    null = s.null()
    one, two = (
        fit(s.problem, null.nuisance, suspects, (0,), 20)
        for suspects in ((Suspect(0, 7, (0.7,)),), (Suspect(0, 7, (0.7,)), Suspect(0, 20, (-3.0,))))
    )
    before = leaving(0.3)(None, null)

    def judged(problem, f, *least):
        evidence = first * bool(f.suspects) + gain * (len(f.suspects) > 1)
        return leaving(error, evidence=lambda _: evidence)(problem, f) if f.suspects else before

    s = replace(s, judged=judged)
    assert chosen(s, Found((null, one, two), ((), (), ()))) == accepted


@pytest.mark.parametrize("other", [point_mass, distributed_mass, ground_spring])
@pytest.mark.parametrize("away", [0.0, 0.5])
def test_a_mass_at_one_place_is_no_rival_of_itself_spread_out(other, away):
    kinds = (point_mass.KIND, other.KIND)
    places = (np.zeros((1, 3)), np.full((1, 3), away))
    catalogue = [
        Some(kind=kind, xyz=xyz, single=None, where=[{}])
        for kind, xyz in zip(kinds, places, strict=True)
    ]
    s = Some(problem=Some(catalogue=catalogue), size=1.25)
    best, rival = (Some(suspects=(Suspect(k, 0, (0.0,)),)) for k in (0, 1))
    assert says_else(s, best, rival) == (away > 0.0 or other is ground_spring)


@pytest.mark.parametrize(
    ("more", "components", "others"),
    [({}, [5], True), ({}, [3], False), ({"free_components": [5]}, [5], False)],
)
def test_a_support_that_turns_is_another_explanation_than_one_that_only_moves(
    more, components, others
):
    where = [{"components": [3], **more}, {"components": components}]
    support = Some(kind="support", xyz=np.zeros((2, 3)), where=where, single=None)
    searcher = Some(problem=Some(catalogue=[support]), size=1.25)
    best, rival = (Some(suspects=(Some(kind=0, row=row),)) for row in (0, 1))
    assert says_else(searcher, best, rival) == others


def test_the_middle_is_nearest_to_where_a_suspect_may_be_each_place_as_likely_as_it_is():
    s = searcher(hidden(masses=[(7, 1.0)]))
    c = s.problem.catalogue[0]

    def at(weights):
        places = [Place(Suspect(0, row, (float(row),)), w) for row, w in weights.items()]
        return places[middle(c, places)].suspect

    assert at({7: 0.2, 8: 0.2, 9: 0.2, 10: 0.2, 11: 0.2}) == Suspect(0, 9, (9.0,))
    assert at({7: 0.6, 8: 0.1, 9: 0.1, 10: 0.1, 11: 0.1}).row == 7


def test_the_same_spring_in_another_direction_says_else():
    s = searcher(hidden())
    spring = s.problem.catalogue[1]
    turned = replace(spring, where=tuple({**w, "components": [2]} for w in spring.where))
    s = replace(s, problem=replace(s.problem, catalogue=(*s.problem.catalogue, turned)))
    number = len(s.problem.catalogue) - 1

    def at(kind, row):
        return Some(suspects=(Suspect(kind, row, (0.0,)),))

    assert says_else(s, at(1, 7), at(number, 7))
    assert says_else(s, at(1, 7), at(1, 25))
    assert says_else(s, at(1, 7), at(0, 7))
    assert not says_else(s, at(1, 7), at(1, 7))


@pytest.mark.parametrize(("pair", "other"), [((6, 8), False), ((6, 25), True), ((8, 6), False)])
def test_twins_on_either_side_of_a_place_say_the_same_as_one_there(pair, other):
    """A mass between two grids is as well told as half of it at each."""
    s = searcher(hidden())
    twins = together(s.problem.catalogue[0], np.array([pair]))
    s = replace(s, problem=replace(s.problem, catalogue=(*s.problem.catalogue, twins)))
    one = Some(suspects=(Suspect(0, 7, (0.0,)),))
    two = Some(suspects=(Suspect(len(s.problem.catalogue) - 1, 0, (0.0,)),))
    assert says_else(s, one, two) == says_else(s, two, one) == other


def test_what_is_held_out_does_not_hang_on_the_order_of_a_file():
    hz = np.array([10.0, 30.0, 50.0, 70.0, 90.0, 110.0])
    mixed = np.array([3, 0, 5, 1, 4, 2])
    told = held_out(1, 2, 6, hz)
    assert told.tolist() == [False, True] * 3
    assert held_out(1, 2, 6, hz[mixed]).tolist() == told[mixed].tolist()
    assert not held_out(1, 2, 7, hz).any()


@pytest.mark.parametrize(
    ("error", "gain", "clear"),
    [
        pytest.param(0.002, 45.0, False, id="no more than right models leave"),
        pytest.param(0.002, 55.0, True, id="that, and five nats a mode gained"),
        pytest.param(0.02, 30.0, False, id="much is left after as well"),
        pytest.param(0.02, 45.0, True, id="much was left"),
    ],
)
def test_beside_what_leaves_no_more_than_right_models_an_effect_has_to_be_clear(error, gain, clear):
    """Ten modes, of whose error a further effect takes a third."""

    def leaving(error, score, *suspects):
        left = Some(error=error, noise=0.0, each=np.zeros(10))
        return Scored(Some(suspects=suspects), Some(diffuse=left), score)

    poorer, richer = leaving(error, 0.0, "a mass"), leaving(0.7 * error, gain, "a mass", "a spring")
    assert earned(richer, poorer) == clear


@pytest.mark.parametrize(
    ("error", "lost", "noise", "told"),
    [
        (0.05, 2, 0.02, 1),
        (0.06, 2, 0.02, 0),
        (0.06, 1, 0.02, 1),
        pytest.param(0.06, 2, 0.01, 1, id="but shapes pair that were noise"),
    ],
)
def test_what_leaves_more_error_and_explains_no_mode_more_is_not_told(
    monkeypatch, error, lost, noise, told
):
    """Two masses in doubt left 5.7 % of the stiffness, the known parameters alone 5.2 %."""

    def leaving(error, lost, score, *suspects, noise=0.02):
        left = Some(error=error, noise=noise, each=np.zeros(10), astray=np.arange(10) < lost)
        return Scored(Some(suspects=suspects), Some(diffuse=left), score)

    monkeypatch.setattr(model_selection, "told_beside", lambda *_: True)
    alone = leaving(0.055, 2, 0.0)
    assert kept(None, [alone, leaving(error, lost, 90.0, "a mass", noise=noise)]) == told


def test_what_no_longer_earns_its_place_is_to_spare():
    s = searcher(hidden(masses=[(9, 2.0)]))
    right, spare = Suspect(0, 9, (np.log(2.0),)), Suspect(1, 22, (np.log(0.01),))
    null, both, one = (
        fit(s.problem, np.zeros(2), suspects, s.active, 20)
        for suspects in ((), (right, spare), (right,))
    )
    left = without_one_to_spare(s, both, null)
    assert left is not None
    assert [q.row for q in left.suspects] == [9]
    assert without_one_to_spare(s, one, null) is None


def test_what_earns_its_place_is_not_to_spare():
    s = searcher(hidden(masses=[(9, 2.0)], springs=[(22, 250.0)]))
    beside = Suspect(0, 9, (np.log(2.0),)), Suspect(1, 22, (np.log(250.0),))
    null, both = (fit(s.problem, np.zeros(2), f, s.active, 20) for f in ((), beside))
    assert without_one_to_spare(s, both, null) is None
