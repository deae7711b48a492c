"""What takes part: modes, sensors and bands left out, pairs and nodes by hand, weights."""

from __future__ import annotations

import numpy as np
import pytest

import trueup
from trueup.core.errors import InputError


@pytest.fixture(scope="module")
def sides(duct):
    deck, test = trueup.read_deck(duct / "duct.bdf"), trueup.read_test(duct / "duct_test.unv")
    return deck, test, {"deck_length_unit": "mm"}


def _of(found, mode):
    return next((p for p in found.pairs if p.test == mode), None)


def test_excluded_modes_pair_with_nothing_and_are_not_missed(sides):
    deck, test, unit = sides
    found = trueup.correlate(deck, test, exclude_test="5,7:9", exclude_analysis=10, **unit)
    assert not {5, 7, 8, 9} & set(found.test_modes)
    assert len(found.test_modes) == 20
    assert 10 not in {*(p.analysis for p in found.pairs), *found.unpaired_analysis}
    assert found.mac.values.shape[0] == 24


def test_a_band_takes_its_test_modes(sides):
    deck, test, unit = sides
    found = trueup.correlate(deck, test, fmin=50.0, fmax=200.0, **unit)
    hz = found.test_hz
    assert found.test_modes == tuple((np.flatnonzero((hz >= 50.0) & (hz <= 200.0)) + 1).tolist())


def test_a_pair_by_hand_counts_whatever_its_mac(sides):
    deck, test, unit = sides
    found = trueup.correlate(deck, test, pairs="9:12", **unit)
    pair = _of(found, 9)
    assert pair.analysis == 12
    assert pair.mac == pytest.approx(found.mac.values[8, 11])
    assert pair.mac < found.criteria.mac_min
    assert [p.analysis for p in found.pairs].count(12) == 1


def test_excluded_sensors_are_read_nowhere(sides):
    deck, test, unit = sides
    label = test.modes.dofs.labels[4]
    found = trueup.correlate(deck, test, exclude_sensors=[label], **unit)
    seen = {f"{s.node}:{s.direction}" for s in found.alignment.sensors}
    assert label not in seen
    assert len(seen) == len(test.modes.dofs) - 1


def test_nodes_by_hand_lay_the_test_on_their_grids(sides):
    deck, test, unit = sides
    plain = trueup.correlate(deck, test, **unit)
    nearest = {s.node: s.nearest_grid for s in plain.alignment.sensors}
    named = dict(list(nearest.items())[::7])
    moved = trueup.correlate(deck, test, node_map=named, **unit)
    at = {s.node: s for s in moved.alignment.sensors}
    for node, grid in named.items():
        assert at[node].nearest_grid == grid
        assert at[node].distance == pytest.approx(0.0, abs=1e-6)
    np.testing.assert_allclose(moved.alignment.rotation, plain.alignment.rotation, atol=0.02)
    assert len(moved.pairs) == len(plain.pairs)


def test_a_mode_that_counts_little_pulls_the_parameter_little(sides):
    deck, test, unit = sides
    asked = {"residuals": "frequencies", "exclude_test": "3:24", **unit}
    say = ["PBAR 11 I1", "PBAR 11 I2"]
    both = trueup.update(deck, test, say, **asked).after
    first = trueup.update(deck, test, say, mode_weights={2: 1e-4}, **asked).after
    alike = abs(_of(first, 1).deviation_percent)
    assert alike <= abs(_of(both, 1).deviation_percent) + 1e-9
    assert both.test_modes == first.test_modes == (1, 2)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"exclude_test": 99}, "there is no test mode 99"),
        ({"exclude_test": "1:24"}, "no test mode takes part"),
        ({"exclude_test": "9:7"}, "write it as 7, or 9:12"),
        ({"exclude_test": 3, "pairs": "3:9"}, "in a pair by hand, and excluded"),
        ({"pairs": ["3:9", "3:10"]}, "test mode 3 is in two pairs"),
        ({"pairs": "3:1"}, "a motion at 0 Hz"),
        ({"pairs": 3}, "TEST:ANALYSIS"),
        ({"exclude_sensors": "4711"}, "no sensor 4711"),
        ({"exclude_sensors": "40:Q"}, "a node"),
        ({"node_map": {1: 999999}}, "names grid 999999"),
        ({"mode_weights": {2: 0.5}}, "mode_weights has no effect"),
        ({"parameters": "PBAR 11 I1"}, "parameters has no effect"),
    ],
)
def test_what_cannot_be_or_has_no_effect_is_refused(sides, given, sentence):
    deck, test, unit = sides
    with pytest.raises(InputError, match=sentence):
        trueup.correlate(deck, test, **unit, **given)


def test_without_a_test_nothing_is_compared(sides):
    with pytest.raises(InputError, match="rotate has no effect: there is no test"):
        trueup.parameters(sides[0], rotate="test")


def test_a_study_keeps_what_takes_part(sides, duct, call, tmp_path):
    study = tmp_path / "study.toml"
    study.write_text(
        f"deck = {str(duct / 'duct.bdf')!r}\ntest = [{str(duct / 'duct_test.unv')!r}]\n"
        'deck_length_unit = "mm"\nexclude_test = [5, "7:9"]\npairs = [[10, 12]]\n'
        "[mode_weights]\n3 = 0.2\n"
    )
    said = call("correlate", "--study", study, "--out", tmp_path / "run", "--exclude-test", "1")
    assert said.status == 0
    again = call("correlate", "--study", tmp_path / "run" / "study.toml", "--out", tmp_path / "b")
    assert again.status == 0
    one, two = (trueup.open_run(tmp_path / name) for name in ("run", "b"))
    assert one.criteria.pairs == two.criteria.pairs == ((10, 12),)
    assert two.criteria.exclude_test == (1,)
    assert two.study.mode_weights == ((3, 0.2),)
