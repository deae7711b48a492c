"""What is told of an effect depends on how surely the test lies on the model."""

from types import SimpleNamespace

import numpy as np
import pytest

from trueup.core.data.geometry import Geometry
from trueup.core.data.mass_unit import MassUnit
from trueup.core.discovery.effects import KINDS
from trueup.core.discovery.faults import POLARITY, Fault
from trueup.core.discovery.narrative.build_findings import (
    _few_modes,
    _gains_little,
    _hardly_told,
    _share,
    _told_of_sensors,
)
from trueup.core.discovery.narrative.sentences import sentence_of, spot_of
from trueup.core.discovery.sensor_faults.diagnosis import Verdicts


@pytest.mark.parametrize(("gain", "said"), [(20.0, 0.6), (60.0, 0.9)])
def test_a_claim_that_gains_little_a_mode_is_less_sure(gain, said):
    best = SimpleNamespace(diffuse=SimpleNamespace(each=np.zeros(10)))
    assert _share("effect", True, SimpleNamespace(gain=gain, best=best)) == said


@pytest.mark.parametrize(
    ("grids", "shared", "said"),
    [
        ([1], True, "near grid 1 (x = 0, y = 0, z = 0)"),
        ([1, 2], False, "near grid 1 (x = 0, y = 0, z = 0)"),
        ([1, 2], True, "at grids 1 and 2 together"),
        ([1, 2, 3, 4, 5], True, "over 5 grids together near grid 1 (x = 0, y = 0, z = 0)"),
    ],
)
def test_supports_that_give_together_are_told_by_their_grids(grids, shared, said):
    xyz = np.array([[1e-18, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0]])
    place = SimpleNamespace(where=({"grids": grids},), xyz=xyz, law=SimpleNamespace(shared=shared))
    assert spot_of(Geometry(np.arange(1, 4), xyz), place, 0) == said


def test_what_joins_two_places_is_told_by_both():
    where = ({"grids": [1, 2, 3], "ends": [[1], [2, 3]], "components": [1]},)
    place = SimpleNamespace(where=where, xyz=np.zeros((1, 3)), law=SimpleNamespace(shared=False))
    assert (
        spot_of(Geometry(np.arange(1, 4), np.eye(3)), place, 0)
        == "between grid 1 and grids 2 and 3"
    )


@pytest.mark.parametrize(
    ("interval", "size", "within"),
    [
        ((40.0, 70.0), "about 54.7 (deck units)", "40 to 70"),
        ((0.4, 7530.0), "a size that the test hardly tells", "0.4 to 7.53e+03"),
    ],
)
def test_a_stiffness_that_may_be_anything_is_not_told_as_one_figure(interval, size, within):
    magnitude = {"stiffness": 54.7, "components": [2], "free_components": [4]}
    kind = KINDS["support_flexibility"]
    text = sentence_of(kind, magnitude, "near grid 1", interval, [1], MassUnit())
    where = "The support gives near grid 1, direction 2 and freely in direction 4"
    expected = f"{where}, with a stiffness of {size}: it explains test mode 1 (95 %: {within})."
    assert text == expected


def test_a_factor_that_is_clearly_not_one_is_not_told_as_one():
    kind, said = KINDS["local_stiffness"], {"factor": 1.0306}
    text = sentence_of(kind, said, "near grid 3", (1.0155, 1.0459), [], MassUnit())
    assert text == (
        "The stiffness is 1.03 times the deck's near grid 3: a local change of stiffness explains "
        "the test better as a whole (95 %: 1.02 to 1.05)."
    )


@pytest.mark.parametrize(
    ("interval", "hardly"), [((1.0, 19.0), False), ((1.0, 21.0), True), (None, False)]
)
def test_what_spans_more_than_a_factor_of_twenty_is_hardly_told(interval, hardly):
    assert _hardly_told(SimpleNamespace(interval=interval)) is hardly


@pytest.mark.parametrize(("gain", "little"), [(24.0, True), (26.0, False)])
def test_less_than_two_and_a_half_nats_a_mode_are_little(gain, little):
    whole = SimpleNamespace(
        gain=gain, best=SimpleNamespace(diffuse=SimpleNamespace(each=np.zeros(10)))
    )
    assert _gains_little(whole) is little


@pytest.mark.parametrize(
    ("places", "modes", "astray", "few"),
    [(2, 6, 0, False), (3, 6, 0, True), (3, 9, 0, False), (3, 9, 1, True), (0, 0, 0, False)],
)
def test_each_effect_of_a_claim_takes_three_modes_that_are_explained(places, modes, astray, few):
    diffuse = SimpleNamespace(astray=np.arange(modes) < astray)
    said = _few_modes(SimpleNamespace(best=SimpleNamespace(diffuse=diffuse)), places)
    assert bool(said) is few
    assert not few or f"there are {modes - astray} for {places}" in said[0]


@pytest.mark.parametrize(("explained", "accused"), [(3, 1), (2, 0), (0, 0)])
def test_shapes_that_no_model_explains_accuse_no_sensor(explained, accused):
    reversed_one = Fault(POLARITY.name, (0,), -np.eye(1), -1.0, 0.0, (), 0.97)
    tested = Verdicts((reversed_one,), np.zeros(1, bool), 0.5)
    diffuse = SimpleNamespace(astray=np.arange(12) >= explained)
    whole = SimpleNamespace(best=SimpleNamespace(diffuse=diffuse), explains=True, clear=True)
    assert len(_told_of_sensors(whole, tested, False).faults) == accused
