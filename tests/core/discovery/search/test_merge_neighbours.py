"""Neighbours of one nature are told as one effect."""

from types import SimpleNamespace

import numpy as np
import pytest

from trueup.core.discovery.effects import KINDS
from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.hypothesis import Fit
from trueup.core.discovery.search.merge_neighbours import merged

XYZ = np.array([[0.0, 0, 0], [50.0, 0, 0], [500.0, 0, 0]])


def searcher():
    catalogue = [
        SimpleNamespace(
            kind=KINDS[kind],
            xyz=XYZ,
            where=tuple({"components": [3]} for _ in XYZ),
            many=lambda row: 1,
        )
        for kind in ("point_mass", "distributed_mass", "local_stiffness", "ground_spring")
    ]
    return SimpleNamespace(problem=SimpleNamespace(catalogue=catalogue), size=1000.0)


def fit(*suspects):
    none = np.zeros(0)
    return Fit(1.0, 1.0, none, suspects, none, none, none, none, ())


def test_masses_side_by_side_are_one_with_the_mass_of_both():
    got = merged(searcher(), fit(Suspect(0, 1, (np.log(0.2),)), Suspect(1, 0, (np.log(0.6),))))
    (one,) = got.suspects
    assert (one.kind, one.row) == (1, 0)
    assert np.exp(one.theta) == pytest.approx(0.8)


def test_masses_apart_stay_two():
    state = fit(Suspect(0, 0, (0.0,)), Suspect(0, 2, (0.0,)))
    assert merged(searcher(), state) is state


def test_a_mass_and_a_spring_at_one_place_stay_two():
    state = fit(Suspect(0, 0, (0.0,)), Suspect(3, 0, (0.0,)))
    assert merged(searcher(), state) is state


def test_of_overlapping_patches_the_one_that_changes_most_stays():
    got = merged(searcher(), fit(Suspect(2, 0, (np.log(0.9),)), Suspect(2, 1, (np.log(0.4),))))
    assert got.suspects == (Suspect(2, 1, (np.log(0.4),)),)


def test_springs_side_by_side_add_up():
    got = merged(searcher(), fit(Suspect(3, 0, (np.log(10.0),)), Suspect(3, 1, (np.log(5.0),))))
    assert np.exp(got.suspects[0].theta) == pytest.approx(15.0)
