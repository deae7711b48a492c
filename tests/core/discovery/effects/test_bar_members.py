"""Which elements of a frame are one bar, and which stretches of it are places."""

from types import SimpleNamespace

import numpy as np
import pytest

from trueup.core.data.geometry import Geometry
from trueup.core.discovery.effects.bar_members import _chains, _stretches, bars_of
from trueup.core.discovery.effects.effect_numbers import EFFECTS
from trueup.core.discovery.reduction.elements_and_supports import Members, Structure
from trueup.core.elements.connectors.lumped import MASS
from trueup.core.elements.lines.bar import BAR


def test_elements_between_two_joints_are_one_bar():
    xyz = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 2, 0]])
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 4]])
    through = np.array([False, True, False, True, False])
    assert [c.tolist() for c in _chains(ends, through, xyz)] == [[0, 1], [2, 3]]


def test_a_corner_ends_a_bar():
    xyz = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0]])
    ends = np.array([[0, 1], [1, 2]])
    assert len(_chains(ends, np.array([False, True, False]), xyz)) == 2


def test_the_elements_of_a_bar_come_in_their_order():
    """Numbered at random, as a pre-processor may; from one end to the other, whichever is first."""
    order = np.array([3, 0, 5, 1, 4, 2])
    ends = np.stack([order, order + 1], axis=1)
    xyz = np.stack([np.arange(7.0), np.zeros(7), np.zeros(7)], axis=1)
    (chain,) = _chains(ends, np.array([False, *[True] * 5, False]), xyz)
    assert abs(np.diff(order[chain])).tolist() == [1] * 5


def test_every_element_alone_and_every_two_in_line_are_stretches():
    spans = _stretches(5, 1)
    assert {(k, k + 1) for k in range(5)} <= set(spans)
    assert {(k, k + 2) for k in range(4)} <= set(spans)
    assert all(b - a < 5 for a, b in spans)


def line_of(n, members=1):
    """Parallel lines of n bars each, of length n; nothing but what `bars_of` looks at."""
    xyz = np.array([[float(k), 10.0 * line, 0.0] for line in range(members) for k in range(n + 1)])
    geometry = Geometry(np.arange(len(xyz)) + 1, xyz, None, {})
    first = np.concatenate([np.arange(n) + line * (n + 1) for line in range(members)])
    corners = np.stack([first, first + 1], axis=1)
    block = SimpleNamespace(width=6)
    member = Members(BAR, np.arange(len(corners)) + 1, corners, block)
    mass = Members(MASS, np.array([900]), np.array([[n // 2]]), block)
    return Structure(SimpleNamespace(geometry=geometry), (member, mass), None)


def test_of_a_beam_that_is_the_structure_stretches_are_scanned_at_once():
    found = bars_of(line_of(20), 20.0)
    assert any(p.first and len(p.rows) in {2, 3} for p in found)
    assert any(not p.first and len(p.rows) == 1 for p in found)


def test_of_a_frame_whole_bars_are_scanned_first_and_a_mass_on_a_grid_ends_none():
    found = bars_of(line_of(4, members=9), 80.0)
    assert sorted(len(p.rows) for p in found if p.first) == [4] * 9


@pytest.mark.parametrize("members", [30, 200])
def test_places_stay_bounded_on_a_large_frame(members):
    found = bars_of(line_of(12, members=members), 2000.0)
    assert len(found) <= members + EFFECTS.bar_stretches
