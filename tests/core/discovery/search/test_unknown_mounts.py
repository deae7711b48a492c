"""A mass in a poor model lies in the middle of its sizes on mounts that the test does not tell."""

import numpy as np
import pytest
from tests.core.discovery.search.test_equipment_growth import HALF, asked, searching

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.search.equipment_growth import as_blocks
from trueup.core.discovery.search.unknown_mounts import as_blocks_on_mounts


@pytest.fixture
def on_a_frame(tmp_path, monkeypatch):
    """A search whose best hypothesis is a mass at a point of a frame."""
    request = asked(tmp_path, monkeypatch)
    s = searching(request)
    row = next(i for i, w in enumerate(s.problem.catalogue[0].where) if w["grids"] == [6])
    return request, s, s.fitted(s.null(), (Suspect(0, row, HALF),), 6)


def test_a_body_on_a_mount_stands_on_the_spring_that_tunes_it(on_a_frame):
    request, s, point = on_a_frame
    wide, solid = as_blocks(request.structure, s, point, request.densest, np.log(400.0))
    (found,) = solid.suspects
    c = wide.problem.catalogue[found.kind]
    theta = np.array([found.theta])
    mass, flexibility = c.law.value(theta, np.zeros(1, int)), c.law.own(theta)
    assert 1.0 / np.sqrt(mass * flexibility) == pytest.approx(2.0 * np.pi * 400.0)
    assert c.within(theta + 1.0)[0] == pytest.approx([theta[0, 0] + 1.0, np.log(400.0)])
    assert c.rows_each == 6


def test_the_size_is_the_middle_of_those_on_mounts_as_likely_beforehand(on_a_frame):
    request, s, point = on_a_frame
    wide, rigid, told = as_blocks_on_mounts(request.structure, s, point, (), request.densest)
    c = s.problem.catalogue[0]
    draws = np.random.default_rng(1).normal(c.typical[1], c.spread[1], 100000)
    draws = draws[(draws > c.lower[1]) & (draws < c.upper[1])]
    sizes = [
        mass_on(request, s, point, mount) for mount in np.quantile(draws, (0.1, 0.3, 0.5, 0.7, 0.9))
    ]
    (mass,) = told.fit.suspects[0].theta
    assert mass == pytest.approx(np.median(sizes), abs=0.1)
    assert wide.problem.catalogue[told.fit.suspects[0].kind].rows_each == 6
    assert deviation(told) > deviation(rigid)


def test_without_masses_at_points_nothing_is_sized(on_a_frame):
    request, s, _ = on_a_frame
    assert as_blocks_on_mounts(request.structure, s, s.null(), (), request.densest) is None


def mass_on(request, s, point, mount):
    """Return ln of the mass that is likeliest on a mount."""
    wide, on = as_blocks(request.structure, s, point, request.densest, mount)
    _, solid = as_blocks(request.structure, s, point, request.densest)
    (found,), found_as = on.suspects, (solid.suspects[0].theta[0], point.suspects[0].theta[0])
    starts = [(found.moved(np.array([theta, mount])),) for theta in found_as]
    tried = [
        s.judged(wide.problem, evaluate(wide.problem, solid.nuisance, start)) for start in starts
    ]
    return max(tried, key=lambda j: j.evidence).fit.suspects[0].theta[0]


def deviation(judged):
    return np.sqrt(np.linalg.inv(judged.information)[-1, -1])
