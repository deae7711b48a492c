"""A mass that is many times the whole model's is a place at which the test is held."""

from types import SimpleNamespace as Some

import numpy as np
import pytest

from trueup.core.discovery.effects import KINDS
from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.narrative.held_places import held_said, is_held


@pytest.mark.parametrize(
    ("kind", "size", "most", "held"),
    [
        pytest.param("distributed_mass", 60000.0, np.inf, True, id="a mass beyond all measure"),
        pytest.param("distributed_mass", 88.0, np.inf, False, id="liquid, twice the structure"),
        pytest.param("point_mass", 44.0, 44.0, True, id="as heavy as its kind allows"),
        pytest.param("point_mass", 4.0, 44.0, False, id="an engine"),
        pytest.param("ground_spring", 60000.0, np.inf, False, id="a stiffness is no mass"),
    ],
)
def test_a_mass_is_a_held_place_by_what_the_structure_weighs(kind, size, most, held):
    c = Some(kind=KINDS[kind], upper=np.array([np.log(most)]))
    assert is_held(c, Suspect(0, 0, (float(np.log(size)),)), 44.0) == held


def test_what_is_said_of_a_held_place_is_where_and_no_mass():
    (said,) = held_said(["near grid 58 (x = 0.3)", "near grid 60 (x = 0.4)"])
    assert "seems to be held near grid 58 (x = 0.3) and near grid 60 (x = 0.4)" in said
    assert held_said([]) == ()
