"""What would decide between two explanations of a string of beads."""

import numpy as np
import scipy.sparse as sp
from tests.core.discovery.strings import SEEN, N, X, hidden, searcher

from trueup.core.data.geometry import Geometry
from trueup.core.data.parametric_model import Dofs, Model
from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import fit
from trueup.core.discovery.posterior.test_design import (
    _differences,
    _Forecast,
    further_modes,
    further_sensors,
)

GRIDS = np.arange(1, N + 1)
MODES = np.arange(1, 13)
NONE = np.zeros(12, bool)


def model():
    xyz = np.column_stack([X, np.zeros(N), np.zeros(N)])
    dofs = Dofs(GRIDS, np.ones(N, dtype=np.int64))
    eye = sp.identity(N, format="csr")
    return Model(Geometry(GRIDS, xyz), dofs, eye, (), ())


def two(first, second):
    s = searcher(hidden(masses=[(7, 2.0)]))
    null = s.null()
    fits = [fit(s.problem, null.nuisance, q, (0,), 20) for q in (first, second)]
    return s.problem, fits


def test_a_sensor_is_proposed_where_the_two_explanations_differ_most():
    p, (best, rival) = two((Suspect(0, 7, (0.7,)),), (Suspect(0, 24, (0.7,)),))
    said = further_sensors(p, model(), best, (("a mass near grid 25", rival),), MODES, NONE)
    assert 1 <= len(said) <= 3
    grid = int(said[0].split("grid ")[1].split()[0])
    a, b = (p.basis.motion @ f.vectors[:N, f.match] for f in (best, rival))
    a, b = (x / np.sqrt(np.mean(x**2, axis=0)) for x in (a, b))
    b = b * np.sign(np.sum(a * b, axis=0))
    told = np.sum(np.minimum(np.abs(a - b), 1.0) ** 2, axis=1)
    assert told[grid - 1] == told.max()
    assert "a mass near grid 25" in said[0]


def test_a_mode_that_nothing_explains_tells_no_explanations_apart():
    p, (best, rival) = two((Suspect(0, 7, (0.7,)),), (Suspect(0, 24, (0.7,)),))
    rivals = (("a mass near grid 25", rival),)
    named = {
        s.split("there mode ")[1].split()[0]
        for s in further_sensors(p, model(), best, rivals, MODES, NONE)
    }
    stray = np.isin(MODES, [int(k) for k in named])
    left = further_sensors(p, model(), best, rivals, MODES, stray)
    assert left
    assert named.isdisjoint(s.split("there mode ")[1].split()[0] for s in left)
    assert further_sensors(p, model(), best, rivals, MODES, ~NONE) == ()


def test_explanations_that_say_the_same_need_no_sensor_and_no_mode():
    p, (best, same) = two((Suspect(0, 7, (0.7,)),), (Suspect(0, 7, (0.7,)),))
    assert further_sensors(p, model(), best, (("the same", same),), MODES, NONE) == ()
    assert further_modes(p, model(), best, (("the same", same),)) == ()
    assert further_sensors(p, model(), best, (), MODES, NONE) == ()


def test_a_mode_beyond_those_measured_is_proposed_with_both_frequencies():
    p, (best, rival) = two((Suspect(0, 7, (0.7,)),), ())
    (said,) = further_modes(p, model(), best, (("the tension alone", rival),))
    low, high = (float(part.split(" Hz")[0]) for part in said.split(" at ")[1:])
    assert abs(np.log(high / low)) > 0.01
    measured = p.whole.frequencies_hz
    assert low > measured.max() * 0.97
    assert len(SEEN) == p.whole.shapes.shape[0]


def test_a_repeated_pair_turned_within_its_plane_differs_nowhere():
    angle = 2.0 * np.pi * np.arange(12) / 12.0
    pair = np.sqrt(2.0) * np.column_stack([np.cos(2.0 * angle), np.sin(2.0 * angle)])
    c, s = np.cos(0.7), np.sin(0.7)
    turned = pair @ np.array([[c, -s], [s, c]])
    match = np.arange(2)
    same = _differences(pair, _Forecast(np.array([50.0, 50.1]), turned, match))
    np.testing.assert_allclose(same, 0.0, atol=1e-12)
    apart = _differences(pair, _Forecast(np.array([50.0, 60.0]), turned, match))
    assert apart.max() > 0.5
