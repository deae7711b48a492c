"""`trueup.update` and `trueup.discover`: the changed deck in hand, its run folder opened again."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import trueup
from trueup.core.discovery import discover as core

DUCT = Path(__file__).parents[2] / "fixtures" / "duct"
FILES = (DUCT / "duct.bdf", DUCT / "duct_test.unv")
CASE = Path(__file__).parents[2].parent / "shared" / "data" / "cases" / "tower_frame"
FRONT = "front = PBAR 11 I1, PBAR 11 I2"


@pytest.fixture(scope="module")
def better() -> trueup.Updated:
    deck, test = trueup.read_deck(FILES[0]), trueup.read_test(FILES[1])
    return trueup.update(deck, test, [FRONT], residuals="frequencies", deck_length_unit="mm")


def test_the_updated_deck_is_in_hand(better: trueup.Updated, tmp_path: Path) -> None:
    (row,) = better.parameters
    assert (row.name, row.cards) == ("front", ("PBAR 11 I1", "PBAR 11 I2"))
    off = [abs(new / old - row.factor) for new, old in zip(row.updated, row.initial, strict=True)]
    assert 0.0 < max(off) < 0.051 * row.standard_error + 1e-5
    assert better.after.summary.pairs >= better.before.summary.pairs
    assert better.deck.diff.count("\n+") > 1
    assert "PBAR" in better.deck.diff
    top = better.deck.write(tmp_path / "out")
    assert top.name == "duct.bdf"
    after = trueup.correlate(top, FILES[1], deck_length_unit="mm")
    assert after.summary.pairs == better.after.summary.pairs
    assert FILES[0].read_bytes() == (tmp_path / "out" / "duct.bdf").read_bytes()


def saved_and_opened(found: Any, tmp_path: Path) -> Any:
    """Save, open, save again: every text file stays what it was."""
    folder = found.save(tmp_path / "run")
    again = trueup.open_run(folder)
    assert type(again) is type(found)
    assert again.to_dict() == found.to_dict() == json.loads((folder / "result.json").read_text())
    assert again.deck.diff == found.deck.diff
    twice = again.save(tmp_path / "again")
    for path in folder.rglob("*"):
        if path.is_file() and path.name not in ("result.h5", "study.toml"):
            other = twice / path.relative_to(folder)
            assert other.read_bytes() == path.read_bytes(), path.name
    return again


def test_what_an_update_saved_is_opened_again(better: trueup.Updated, tmp_path: Path) -> None:
    again = saved_and_opened(better, tmp_path)
    assert again.history[0].factors.tolist() == [1.0]
    assert set(again.content.modes) == {"test", "analysis", "updated"}


def test_a_discovery_runs_on_one_thread_of_the_linear_algebra(monkeypatch: Any) -> None:
    """On two, on a busy machine, it took sixteen times as long."""
    threads: list[int] = []

    def stopped(*_: object) -> None:
        threads.extend(p["num_threads"] for p in threadpool_info() if p["user_api"] == "blas")
        raise trueup.TrueupError("enough")

    monkeypatch.setattr(core, "discover", stopped)
    with threadpool_limits(2, "blas"), pytest.raises(trueup.TrueupError, match="enough"):
        trueup.discover(*FILES, deck_length_unit="mm")
    assert set(threads) == {1}


@pytest.mark.slow
@pytest.mark.skipif(not CASE.is_dir(), reason="../shared/data is absent")
def test_what_a_discovery_saved_is_opened_again(tmp_path: Path) -> None:
    said: list[str] = []
    files = CASE / "tower.bdf", CASE / "tower_test.unv"
    told = trueup.discover(*files, deck_length_unit="mm", progress=said.append)
    assert told.verdict == "parameters_only"
    assert "discovering" in said
    again = saved_and_opened(told, tmp_path)
    assert again.gap == told.gap
    assert again.judgement == told.judgement


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({}, "no parameter is named"),
        ({"parameters": 3}, "'parameters' has a value of the wrong type: 3"),
        ({"parameters": ["PBAR 999 I1"]}, "PBAR 999"),
        ({"parameters": FRONT, "modes": "x.op2"}, "modes= gives fixed modes"),
        ({"parameters": FRONT, "out": "run"}, "update: unknown key 'out'"),
        ({"parameters": FRONT, "residuals": "everything"}, "residuals is 'everything'"),
        ({"parameters": FRONT, "max_iterations": 0}, "max_iterations must be at least 1"),
        ({"parameters": FRONT, "test_modes": []}, "update: test_modes is empty"),
        (
            {"parameters": FRONT, "residuals": []},
            "'residuals' has a value of the wrong",
        ),
        ({"parameters": FRONT, "test_modes": [0]}, "test_modes are mode numbers"),
        ({"parameters": FRONT, "test_modes": 99}, "test_modes names mode 99"),
        ({"parameters": FRONT, "stages": [{"parameters": ["rear"]}]}, "'rear'"),
        ({"parameters": FRONT, "stages": [{"parameter": ["rear"]}]}, "unknown key 'parameter'"),
        ({"parameters": FRONT, "stages": 3}, "'stages' has a value of the wrong type"),
    ],
)
def test_what_an_update_cannot_use_is_named(more: dict[str, Any], said: str) -> None:
    with pytest.raises(trueup.InputError, match=said):
        trueup.update(*FILES, deck_length_unit="mm", **more)


def test_a_model_has_no_deck_to_change() -> None:
    from trueup.adapters.nastran import build_model

    model = build_model(trueup.read_deck(FILES[0]))
    with pytest.raises(trueup.InputError, match="a model has none"):
        trueup.update(model, FILES[1], FRONT)
    with pytest.raises(trueup.InputError, match="a model has none"):
        trueup.discover(model, FILES[1])
    found = trueup.correlate(model, FILES[1], deck_length_unit="mm")
    assert len(found.pairs) > 5


def test_the_updated_deck_is_taken_where_a_deck_is(better: trueup.Updated, tmp_path: Path) -> None:
    deck = trueup.read_deck(better.deck)
    assert deck.path == FILES[0]
    assert deck.files == trueup.read_deck(FILES[0]).files
    after = trueup.correlate(better.deck, FILES[1], deck_length_unit="mm")
    assert (after.study.deck, after.deck_file) == (None, "duct.bdf (an object, not the file)")
    assert after.summary == trueup.correlate(deck, FILES[1], deck_length_unit="mm").summary
    assert after.summary.pairs == better.after.summary.pairs
    assert trueup.solve(better.deck, 8).modes[6].frequency_hz == pytest.approx(
        better.after.analysis_hz[6], rel=1e-6
    )
    again = trueup.update(
        better.deck, FILES[1], [FRONT], residuals="frequencies", deck_length_unit="mm"
    )
    assert again.parameters[0].initial == better.parameters[0].updated
    for refused in (deck.to_pynastran, lambda: trueup.inspect(deck)):
        with pytest.raises(trueup.InputError, match="was changed: write the deck"):
            refused()
