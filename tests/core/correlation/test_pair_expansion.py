"""Test shapes of a model itself, expanded to all of it, are its modes."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.correlation.comparison import compare, place_test
from trueup.core.correlation.criteria import Criteria
from trueup.core.correlation.mac import mac
from trueup.core.correlation.pair_expansion import expand_pairs
from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.measurement import Measurement
from trueup.core.data.modes import Modes
from trueup.core.eigen.normal_modes import modes_of, solve
from trueup.core.errors import InputError

PLACES = np.array([1, 3, 5, 6, 8, 10, 12])


@pytest.fixture
def mast(frame):
    """A bent mast, two of its modes measured in the wrong mixture."""
    t = np.linspace(0.0, 1.0, 13)
    xyz = np.column_stack([t, 0.3 * t**2, 0.2 * np.sin(2.0 * t)])
    bars = [(i, i + 1) for i in range(12)]
    model = frame(xyz, bars, fixed=[(0, c) for c in range(1, 7)], masses=[(7, 0.2)])
    geometry = replace(model.geometry, elements={"line": np.array(bars)})
    modes = modes_of(model, solve(model, 8))
    rows = (6 * PLACES[:, None] + np.arange(3)).ravel()
    mixed = np.eye(8)[:, :5]
    mixed[:2, :2] = [[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]]
    nodes = geometry.ids[PLACES] + 100
    dofs = Dofs(np.repeat(nodes, 3), np.tile([1, 2, 3], len(PLACES)))
    shapes = -3.0 * modes.shapes[rows] @ mixed
    test = Measurement(
        Geometry(nodes, geometry.xyz[PLACES], "m"),
        Modes(modes.frequencies_hz[:5], shapes, dofs, np.full(5, 0.01)),
        None,
        "m",
    )
    return model, modes, mixed, place_test(geometry, modes, test, "m"), geometry


@pytest.mark.parametrize(
    ("method", "least"), [("serep", 1.0 - 1e-9), ("guyan", 0.95), ("irs", 0.99)]
)
def test_what_was_measured_in_places_is_known_everywhere(mast, method, least):
    model, modes, mixed, placed, geometry = mast
    together = Criteria(cluster_width=0.5) if method == "serep" else Criteria(rotate="none")
    found = expand_pairs(compare(geometry, modes, placed, together), model, method, 0)
    assert len(found.modes) == 5
    assert np.diag(mac(found.modes.shapes, modes.shapes @ mixed)).min() > least
    np.testing.assert_allclose(found.modes.damping, 0.01)
    own = found.orthogonality.own
    assert np.abs(own - np.eye(5)).max() < (1e-9 if method == "serep" else 0.3)


def test_a_mixture_shows_beside_the_pairs(mast):
    model, modes, _, placed, geometry = mast
    loose = Criteria(rotate="none", frequency_tolerance=2.0)
    found = expand_pairs(compare(geometry, modes, placed, loose), model, "serep", 0)
    np.testing.assert_allclose(
        found.orthogonality.cross[:2, :2],
        [[np.cos(0.3), np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]],
        atol=1e-9,
    )


def test_without_pairs_there_is_nothing_to_expand(mast):
    model, modes, _, placed, geometry = mast
    nothing = compare(geometry, modes.take(np.arange(1)), placed.of_modes([4]))
    with pytest.raises(InputError, match="nothing to expand"):
        expand_pairs(nothing, model, "serep", 0)
