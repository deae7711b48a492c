"""What a person is told of a dashpot."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace as Request

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.core.data.geometry import Geometry
from trueup.core.discovery.dampers.damped_model import damped
from trueup.core.discovery.dampers.damper_evidence import Weighed
from trueup.core.discovery.dampers.damper_search import DamperFound
from trueup.core.discovery.effects.structure_points import Axes
from trueup.core.discovery.findings import Discovery, Finding, Where
from trueup.core.discovery.likelihood.complex_modes import Oriented
from trueup.core.discovery.likelihood.mode_likelihood import Evidence, noise_of
from trueup.core.discovery.narrative.damper_findings import with_damper

XYZ = np.column_stack([np.linspace(0.0, 10.0, 11), np.zeros(11), np.zeros(11)])
REQUEST = Request(
    structure=Request(model=Request(geometry=Geometry(np.arange(1, 12), XYZ))),
    numbers=np.arange(1, 100),
)
PLACES = Axes(
    XYZ,
    sp.identity(11, format="csr"),
    tuple({"grids": [i + 1], "components": [3]} for i in range(11)),
)
LEVEL = np.full(3, 0.01)
QUIET = Discovery("no_gap", (), (), (), 1.0, 0.0, 1.0, 0.0, (), (), (), (), ())


def weighed(exists, weights, omega=(10.0, 10.5, 20.0, 30.0), c=0.2):
    rows = np.argsort(-np.asarray(weights), kind="stable")
    rows = rows[np.asarray(weights)[rows] > 0.0]
    n = len(rows)
    found = DamperFound(
        exists,
        2.0 * np.log(exists / (1.0 - exists)),
        rows,
        np.asarray(weights)[rows],
        np.full(n, np.log(c)),
        np.full(n, 0.1),
        LEVEL,
        LEVEL,
    )
    omega = np.array(omega)
    modes = Oriented(omega, np.eye(4), 3)
    u = np.tile([1.0, 0.8, 0.3, 0.5], (11, 1))
    test = Evidence(omega[:3] / (2.0 * np.pi), np.eye(4)[:, :3], noise_of(None, 0.03))
    D = c * np.outer(u[0], u[0]) + np.diag(2.0 * 0.01 * omega)
    with_it = damped(test, test.shapes, omega, np.eye(4), D)
    return Weighed(found, PLACES, modes, u, with_it, np.eye(4))


def at(*pairs):
    weights = np.zeros(11)
    for row, weight in pairs:
        weights[row] = weight
    return weights


def spring(x):
    where = Where(grids=(1,), xyz=(x, 0.0, 0.0), region="near grid 1")
    magnitude = {"stiffness": 5.0, "components": [3]}
    return Finding("model", "ground_spring", where, magnitude, (4.0, 6.0), (), 0.9, "A spring.")


def test_a_sure_dashpot_is_an_effect_with_its_place_and_size():
    said = with_damper(REQUEST, weighed(0.99, at((4, 1.0))), QUIET)
    assert said.verdict == "effect"
    (f,) = said.findings
    assert (f.kind, f.where.grids, f.magnitude["components"]) == ("local_damper", (5,), [3])
    assert f.magnitude["damping"] == pytest.approx(0.2)
    low, high = f.interval
    assert low < 0.2 < high
    assert "no dashpot at all is more than 10 times less likely" in f.sentence
    assert said.damping is not None


def test_one_that_may_sit_anywhere_is_undecided_and_says_what_would_decide():
    said = with_damper(REQUEST, weighed(0.99, at((1, 0.4), (5, 0.35), (9, 0.25))), QUIET)
    assert said.verdict == "undecided"
    (f,) = said.findings
    assert f.confidence < 0.5
    assert {p.grids[0] for p in f.credible_set} == {2, 6, 10}
    assert said.would_decide


def test_an_unlikely_one_stands_among_the_alternatives_only():
    said = with_damper(REQUEST, weighed(0.1, at((4, 1.0))), QUIET)
    assert said.verdict == "no_gap"
    assert said.findings == ()
    assert said.alternatives[-1].kinds == ("local_damper",)
    assert said.alternatives[-1].times_less_likely == pytest.approx(9.0)


def test_nothing_is_said_where_no_damping_was_measured():
    assert with_damper(REQUEST, None, QUIET) is QUIET


def test_a_heavy_dashpot_moves_close_modes_and_a_light_one_does_not():
    heavy, light = weighed(0.99, at((4, 1.0)), c=2.0), weighed(0.99, at((4, 1.0)), c=0.05)
    assert set(heavy.damped.moved.tolist()) >= {0, 1}
    assert heavy.heavy
    assert not light.heavy
    assert not weighed(0.1, at((4, 1.0)), c=2.0).heavy


def test_beside_an_error_everywhere_a_dashpot_is_claimed_if_right_models_leave_as_much():
    """The error that the model completed by the dashpot leaves decides, as for any effect."""
    w = weighed(0.99, at((4, 1.0)))
    usual = replace(QUIET, verdict="undecided", adequacy=0.4)
    assert with_damper(REQUEST, w, usual).verdict == "effect"
    assert with_damper(REQUEST, w, replace(usual, adequacy=0.1)).verdict == "undecided"
    beside_doubt = replace(usual, findings=(spring(9.5),))
    assert with_damper(REQUEST, w, beside_doubt).verdict == "undecided"


def test_a_spring_beside_a_heavy_dashpot_is_not_believed():
    effect = replace(QUIET, verdict="effect", findings=(spring(4.5),))
    heavy, light = weighed(0.99, at((4, 1.0)), c=2.0), weighed(0.99, at((4, 1.0)), c=0.05)
    said = with_damper(REQUEST, heavy, effect)
    assert said.verdict == "undecided"
    assert "taken off" in said.would_decide[-1]
    assert with_damper(REQUEST, light, effect).verdict == "effect"
    far = replace(QUIET, verdict="effect", findings=(spring(9.5),))
    assert with_damper(REQUEST, heavy, far).verdict == "effect"
