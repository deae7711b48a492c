"""The one sentence that is read first."""

from __future__ import annotations

from typing import Any

import pytest

from trueup.adapters.report import headline
from trueup.adapters.report.tables.headline import figures, story
from trueup.verbs.runs.report import answer_of


def test_correlation_counts_pairs_and_names_the_worst_and_the_lonely(
    correlation: dict[str, Any],
) -> None:
    assert headline(answer_of(correlation)) == (
        "2 of 3 test modes pair with the model; frequencies are 6.2 % off on average, 10.0 % at"
        " worst (test mode 1). Test mode 3 has no partner. trueup discover, given the same, looks"
        " for what explains the difference."
    )


def test_update_tells_now_and_before(update: dict[str, Any]) -> None:
    assert headline(answer_of(update)) == (
        "After updating 2 parameters, 3 of 3 test modes pair with the model (2 before) and"
        " frequencies are 0.8 % off on average (6.2 % before). One parameter stopped at a bound:"
        " skin."
    )


def test_discovery_leads_with_one_short_sentence(discovery: dict[str, Any]) -> None:
    first, *rest = story(answer_of(discovery))
    assert first == (
        "The model lacks an attached mass the far corner, and the test is at fault: sensor 108."
    )
    assert rest[0].startswith("With that adopted, 3 test modes pair with the completed model (2")
    assert rest[-1] == "Next best: local stiffness at the near edge; 41 times less likely."


def test_an_undecided_run_says_so_before_its_best_explanation(discovery: dict[str, Any]) -> None:
    first, second, *_ = story(answer_of(discovery | {"verdict": "undecided"}))
    assert first == "The data do not decide what is missing."
    assert second.startswith(
        "The best explanation so far: the model lacks an attached mass the far"
    )


def test_modes_that_lost_their_partner_are_named(discovery: dict[str, Any]) -> None:
    after = discovery["after"] | {"pairs": discovery["after"]["pairs"][1:]}
    told = story(answer_of(discovery | {"after": after}))
    lost = discovery["after"]["pairs"][0]["test"]
    assert f"Test mode {lost} paired before and no longer does." in told


def test_known_parameters_that_explain_the_gap_are_named_the_farthest_first(
    discovery: dict[str, Any], update: dict[str, Any]
) -> None:
    moved = [
        update["parameters"][0] | {"name": name, "factor": factor, "significant": clear}
        for name, factor, clear in (
            ("PSHELL 1 T", 1.1, True), ("MAT1 1 E", 3.0, False), ("CONM2 7 M", 0.5, True),
        )
    ]  # fmt: skip
    discovery |= {"verdict": "parameters_only", "findings": [], "parameters": moved}
    said = "CONM2 7 M is 0.5 times the deck's value; PSHELL 1 T is 1.1 times the deck's value."
    first, second = story(answer_of(discovery))[:2]
    assert (first, second) == ("Known parameters alone explain the gap; nothing is missing.", said)
    told = story(answer_of(discovery | {"verdict": "undecided"}))
    assert told[1] == f"What fits best, not written: {said}"
    assert story(answer_of(discovery | {"verdict": "test_fault"}))[1] == said


@pytest.mark.parametrize(("mesh", "said"), [(0.009, "0.9 % too low"), (-0.006, "0.6 % too high")])
def test_what_the_mesh_leaves_is_said_where_the_deck_was_changed(
    discovery: dict[str, Any], mesh: float, said: str
) -> None:
    discovery["judgement"] |= {"mesh": mesh}
    assert any(f"mesh makes them about {said}" in told for told in story(answer_of(discovery)))
    doubted = answer_of(discovery | {"verdict": "undecided"})
    assert not any("mesh" in told for told in story(doubted))
    discovery["judgement"] |= {"mesh": mesh / 10.0}
    assert not any("mesh" in told for told in story(answer_of(discovery)))


@pytest.mark.parametrize(
    ("verdict", "said"),
    [
        ("no_gap", "Nothing is missing"),
        ("undecided", "do not decide"),
        ("parameters_only", "known parameters or the mesh"),
        ("test_fault", "from the test"),
    ],
)
def test_every_verdict_has_a_sentence(discovery: dict[str, Any], verdict: str, said: str) -> None:
    discovery |= {"verdict": verdict, "findings": []}
    assert said in story(answer_of(discovery))[0]


def test_where_nothing_is_missing_it_is_said_how_far_off_frequencies_are_all_the_same(
    discovery: dict[str, Any],
) -> None:
    discovery |= {"verdict": "no_gap", "findings": []}
    mean = discovery["gap"]["before"]["mean_abs_deviation_percent"]
    first = story(answer_of(discovery))[0]
    said = f"mesh and usual errors explain the {mean:.1f} % that frequencies are off."
    assert first == f"Nothing is missing: {said}"
    unclear = [p | {"significant": False} for p in discovery["parameters"]]
    discovery |= {"verdict": "parameters_only", "parameters": unclear}
    said = f"known parameters or the mesh explain the {mean:.1f} % that frequencies are off."
    first, second = story(answer_of(discovery))[:2]
    assert first == f"Nothing is missing: {said}"
    assert "adopted" not in second
    discovery["gap"]["before"] |= {"pairs": 0, "mean_abs_deviation_percent": None}
    assert story(answer_of(discovery))[0] == "Nothing is missing."


@pytest.mark.parametrize("verdict", ["no_gap", "parameters_only"])
def test_modes_that_nothing_explains_are_named_where_nothing_is_missing(
    discovery: dict[str, Any], verdict: str
) -> None:
    judged = discovery["judgement"] | {"unexplained": [2, 8]}
    discovery |= {"verdict": verdict, "findings": [], "judgement": judged}
    first = story(answer_of(discovery))[0]
    assert first.endswith(", but for test modes 2 and 8, which nothing explains.")
    assert len(first) < 150


def test_what_the_rest_looks_like_leads_where_no_effect_is_found(
    discovery: dict[str, Any],
) -> None:
    judged = discovery["judgement"] | {"looks_like": "a structure that is bowed along y by 6 mm"}
    discovery |= {"verdict": "undecided", "findings": [], "judgement": judged}
    said = "It looks like a structure that is bowed along y by 6 mm, which no listed effect is."
    assert story(answer_of(discovery))[1] == said
    discovery |= {"verdict": "no_gap"}
    assert said not in story(answer_of(discovery))


def test_nothing_pairs(correlation: dict[str, Any]) -> None:
    correlation |= {"pairs": [], "unpaired_test": [1, 2, 3]}
    assert headline(answer_of(correlation)) == "None of the 3 test modes pairs with the model."


def test_a_test_without_modes_claims_nothing(correlation: dict[str, Any]) -> None:
    correlation |= {"pairs": [], "unpaired_test": []}
    assert headline(answer_of(correlation)) == "The test holds no modes to pair."


def test_key_figures_stand_beside_their_former_values(update: dict[str, Any]) -> None:
    assert figures(answer_of(update)) == [
        ("pairs", "3 of 3", "2 of 3"),
        ("mean frequency deviation", "0.77 %", "6.25 %"),
        ("worst frequency deviation", "1.00 %", "10.00 %"),
        ("mean MAC of the pairs", "93.3 %", "86.5 %"),
        ("full eigensolutions", "3", ""),
        ("time", "7.4 s", ""),
    ]
