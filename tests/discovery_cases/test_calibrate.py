"""The share of findings that are right, fitted from outcomes with a known law."""

import numpy as np
import pytest


@pytest.mark.parametrize(("share", "fall"), [(0.9, 0.2), (0.7, 0.05)])
def test_the_law_that_made_the_outcomes_is_found_again(monkeypatch, share, fall):
    monkeypatch.syspath_prepend(".")
    from benchmarks.discovery.calibrate import fitted

    rng = np.random.default_rng(5)
    scale = rng.uniform(1.0, 12.0, 20000)
    posterior = rng.uniform(0.5, 1.0, 20000)
    right = rng.random(20000) < posterior * share / (1.0 + fall * (scale - 1.0))
    a, b = fitted(list(zip(posterior, scale, right, strict=True)))
    assert a == pytest.approx(share, abs=0.02)
    assert b == pytest.approx(fall, rel=0.15)
