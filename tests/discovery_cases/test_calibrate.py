"""The share of findings that are right, from outcomes with a known law."""

import numpy as np
import pytest


def test_the_shares_that_made_the_outcomes_are_found_again(monkeypatch):
    monkeypatch.syspath_prepend(".")
    from benchmarks.discovery.calibrate import shares

    rng = np.random.default_rng(5)
    law = {"effect": 0.9, "other": 0.2}
    told = rng.choice(list(law), 20000)
    posterior = rng.uniform(0.5, 1.0, 20000)
    right = rng.random(20000) < posterior * np.array([law[t] for t in told])
    found = shares(list(zip(told.tolist(), posterior.tolist(), right.tolist(), strict=True)))
    assert {t: share for t, (_, _, share) in found.items()} == pytest.approx(law, abs=0.02)
