"""A case told otherwise is the same case: the deck pairs with the test as before."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.discovery.variants import WAYS, Variant, alike

import trueup

CASE = Path(__file__).parent / "cases" / "3187_tower_point_mass_local_stiffness"


def pairs(way: str, folder: Path) -> list[tuple[float, float, float]]:
    """Return test and analysis frequency and MAC of every pair."""
    test = trueup.read_test(next(CASE.glob("*_test.unv")))
    v = WAYS[way](CASE, folder / "deck", test, np.random.default_rng(1))
    found = trueup.correlate(v.deck, v.test, deck_length_unit=v.unit)
    return sorted((p.test_hz, p.analysis_hz, p.mac) for p in found.pairs)


@pytest.mark.parametrize("way", [way for way in WAYS if way != "as_it_is"])
def test_the_deck_pairs_as_before(way, tmp_path):
    expected = pairs("as_it_is", tmp_path)
    assert len(expected) > 5
    np.testing.assert_allclose(pairs(way, tmp_path), expected, rtol=2e-5)


def finding(**other):
    return {
        "what": ("model", "point_mass"),
        "xyz": [[1.0, 2.0, 3.0]],
        "sensors": [],
        "size": 2.0,
        "interval": [1.5, 2.5],
        **other,
    }


@pytest.mark.parametrize(
    ("other", "same"),
    [
        ({}, True),
        ({"size": 2.09}, True),
        ({"size": 2.11}, False),
        ({"xyz": [[1.0, 2.0, 3.9]]}, True),
        ({"xyz": [[1.0, 2.0, 4.1]]}, False),
        ({"sensors": [4]}, False),
        ({"what": ("model", "distributed_mass")}, False),
    ],
)
def test_what_counts_as_the_same_finding(other, same):
    assert (alike([finding()], [finding(**other)], 1000.0) == []) is same


@pytest.mark.parametrize(("components", "size"), [([3], 5e-3), ([4, 5, 6], 5e3)])
def test_sizes_come_back_to_millimetres(components, size):
    """5 N/m and 5 N m; what was in millimetres stays."""
    told = {
        "side": "model",
        "kind": "ground_spring",
        "where": {"xyz": [0.1, 0.0, 0.0]},
        "magnitude": {"stiffness": 5.0, "components": components},
        "interval": [4.0, 6.0],
    }
    test = trueup.read_test(next(CASE.glob("*_test.unv")))
    metres, same = (Variant(CASE, test, unit).back(told) for unit in ("m", "mm"))
    assert metres["size"] == pytest.approx(size)
    assert metres["interval"] == pytest.approx([0.8 * size, 1.2 * size])
    assert metres["xyz"] == [[100.0, 0.0, 0.0]]
    assert (same["size"], same["xyz"]) == (5.0, [[0.1, 0.0, 0.0]])


def test_one_finding_more_is_not_the_same():
    assert alike([finding()], [finding(), finding()], 1000.0)
