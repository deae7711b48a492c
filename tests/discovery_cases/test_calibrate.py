"""The share of findings that are right, from outcomes with a known law."""

import numpy as np
import pytest


def test_the_shares_that_made_the_outcomes_are_found_again(monkeypatch):
    monkeypatch.syspath_prepend(".")
    from benchmarks.discovery.calibrate import shares

    rng = np.random.default_rng(5)
    law = {"effect": 0.9, "other": 0.2}
    told = rng.choice(list(law), 20000)
    right = rng.random(20000) < np.array([law[t] for t in told])
    found = shares([(t, 0.95, r) for t, r in zip(told.tolist(), right.tolist(), strict=True)])
    assert {t: row["share"] for t, row in found.items()} == pytest.approx(law, abs=0.02)
    assert {row["said"] for row in found.values()} == {0.95}


def test_few_outcomes_give_no_certainty(monkeypatch):
    monkeypatch.syspath_prepend(".")
    from benchmarks.discovery.calibrate import shares

    assert shares([("effect", 0.9, True)] * 3)["effect"]["share"] == 0.8
