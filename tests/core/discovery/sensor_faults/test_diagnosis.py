from dataclasses import replace

import numpy as np
import pytest
from tests.core.discovery.rings import HZ, judged, planar, radial, read, ring, survey, vibrating

from trueup.core.discovery.faults import corrected, lost
from trueup.core.discovery.sensor_faults.diagnosis import judge_sensors
from trueup.core.discovery.sensor_faults.leave_one_out import Span
from trueup.core.discovery.sensor_faults.misalignment import rotation


def faults(readings, axes=None):
    return judged(readings, radial() if axes is None else axes).faults


def named(found):
    return {(f.kind, tuple(sorted(f.sensors))) for f in found}


@pytest.mark.parametrize("seed", range(5))
def test_sound_sensors_are_not_accused(seed):
    assert faults(read(vibrating(seed), radial(), seed=seed)) == ()


def test_how_much_a_sensor_reads_hangs_on_neither_signs_nor_the_size_of_shapes():
    test, _ = survey(read(vibrating(), radial()), radial())
    mixed = np.random.default_rng(1).permutation(len(test.node))
    sizes = np.linspace(-3.0, 5.0, test.shapes.shape[1])
    other = replace(test, shapes=sizes * test.shapes[mixed])
    assert len(np.unique(test.moves)) == len(test.node)
    np.testing.assert_allclose(other.moves, test.moves[mixed], rtol=1e-12)


def test_a_sensor_wired_backwards_is_named():
    y = read(vibrating(), radial())
    y[7] *= -1.0
    (fault,) = faults(y)
    assert (fault.kind, fault.sensors) == ("sensor_polarity", (7,))
    assert fault.confidence > 0.9


@pytest.mark.parametrize("factor", [0.5, 0.6, 1.5, 1.8])
def test_a_wrong_gain_is_named_with_its_factor(factor):
    y = read(vibrating(), radial())
    y[11] *= factor
    (fault,) = faults(y)
    assert (fault.kind, fault.sensors) == ("sensor_gain", (11,))
    assert abs(fault.factor - factor) < 3.0 * fault.deviation + 0.02 * factor


def test_a_gain_that_might_be_scatter_is_no_fault():
    y = read(vibrating(), radial())
    y[11] *= 1.05
    assert faults(y) == ()


def test_two_swapped_sensors_are_named_together():
    y = read(vibrating(), radial())
    y[[5, 18]] = y[[18, 5]]
    assert named(faults(y)) == {("sensor_swap", (5, 18))}


def test_lone_sensors_that_look_opposite_ways_may_be_swapped_too():
    """What a file says of one along -x another along +x reads backwards."""
    y = read(vibrating(), radial())
    sound = y.copy()
    y[[5, 18]] = -y[[18, 5]]
    found = faults(y)
    assert named(found) == {("sensor_swap", (5, 18))}
    np.testing.assert_allclose(corrected(y.reshape(40, -1), found), sound.reshape(40, -1))


@pytest.mark.parametrize("mixed", [(5, 18, 31), (5, 18, 31, 12)])
def test_of_three_or_more_that_are_mixed_up_no_two_are_called_exchanged(mixed):
    """Which of them is where is not told, but none of them is evidence."""
    y = read(vibrating(), radial())
    y[list(mixed)] = y[list(np.roll(mixed, 1))]
    found = judged(y, radial())
    assert found.faults == ()
    assert set(np.flatnonzero(found.doubtful)) == set(mixed)


@pytest.mark.parametrize("factor", [2.0, 2.1])
def test_a_reading_twice_as_large_is_a_gain_as_any_other(factor):
    y = read(vibrating(), radial())
    y[3] *= factor
    (fault,) = faults(y)
    assert (fault.kind, fault.sensors) == ("sensor_gain", (3,))
    assert fault.factor == pytest.approx(factor, rel=0.03)


@pytest.mark.parametrize("degrees", [20.0, 45.0, 90.0])
def test_a_lone_sensor_turned_away_reads_what_its_node_does_in_other_directions(degrees):
    axes = radial()
    axes[9] = axes[9] @ rotation(np.radians([0.0, 0.0, degrees])).T
    (fault,) = faults(read(vibrating(), axes))
    assert (fault.kind, fault.sensors) == ("sensor_axis", (9,))
    assert abs(fault.factor - degrees) < 3.0 * fault.deviation + 1.0
    assert abs(fault.axis[2]) > 0.9


@pytest.mark.parametrize("degrees", [15.0, 30.0, 90.0])
def test_a_turned_pair_is_named_with_its_angle(degrees):
    axes = planar()
    axes[9] = axes[9] @ rotation(np.radians([0.0, 0.0, degrees])).T
    (fault,) = faults(read(vibrating(), axes), planar())
    assert (fault.kind, fault.sensors) == ("sensor_axis", (18, 19))
    assert fault.factor == pytest.approx(degrees, abs=2.0)


def test_exchanged_cables_of_a_pair_are_no_turn():
    """A quarter of a turn reads (y, -x); (y, x) can only be the cables."""
    y = read(vibrating(), planar())
    y[9] = y[9][::-1].copy()
    assert named(faults(y, planar())) == {("sensor_swap", (18, 19))}


def test_one_direction_of_a_pair_may_be_wired_backwards():
    y = read(vibrating(), planar())
    y[9, 1] *= -1.0
    assert named(faults(y, planar())) == {("sensor_polarity", (19,))}


def test_a_pair_wired_backwards_is_one_fault():
    """Half a turn reads the same; cables are exchanged more often than that."""
    y = read(vibrating(), planar())
    y[9] *= -1.0
    assert named(faults(y, planar())) == {("sensor_polarity", (18, 19))}


def test_directions_of_two_nodes_may_be_swapped():
    y = read(vibrating(), planar())
    y[5, 0], y[18, 1] = y[18, 1].copy(), y[5, 0].copy()
    assert named(faults(y, planar())) == {("sensor_swap", (10, 37))}


def test_several_faults_at_once_are_all_named():
    y = read(vibrating(), radial())
    y[[5, 18]] = y[[18, 5]]
    y[7] *= -1.0
    y[30] *= 0.6
    assert named(faults(y)) == {
        ("sensor_swap", (5, 18)),
        ("sensor_polarity", (7,)),
        ("sensor_gain", (30,)),
    }


def test_what_a_model_lacks_at_one_spot_is_no_fault_of_the_sensors_there():
    """Neighbours that move in every mode, each in its own way, as beside a soft foot."""
    y = read(vibrating(), radial())
    near = np.array([0.25, 0.5, 0.25])[:, None, None]
    y[14:17] += near * np.random.default_rng(5).normal(size=14)
    assert faults(y) == ()


def test_neighbours_off_in_proportion_are_a_model_that_is_wrong_there():
    """All move 1.4 times what is predicted, as beside a soft foot; one alone is a gain."""
    y = read(vibrating(), radial())
    y[14:17] *= 1.4
    assert faults(y) == ()
    y = read(vibrating(), radial())
    y[15] *= 1.4
    assert named(faults(y)) == {("sensor_gain", (15,))}


def test_where_the_model_says_no_motion_a_gain_cannot_be_accused():
    motion = vibrating()
    motion[11] *= 0.1
    y = read(motion, radial())
    y[11] *= 1.8
    test, span = survey(y, radial())
    span.rows[11] *= 0.1
    span.around[11] *= 0.1
    assert judge_sensors(test, span).faults == ()


@pytest.mark.parametrize(("share", "told"), [(0.04, False), (0.5, True)])
def test_a_sensor_that_hardly_moves_is_not_called_reversed(share, told):
    """A corner that goes the other way by a twentieth of a shape is the model's."""
    motion = vibrating()
    motion[11] *= share
    y = read(motion, radial(), noise=0.004)
    y[11] *= -1.0
    test, span = survey(y, radial())
    span.rows[11] *= share
    span.around[11] *= share
    found = judge_sensors(test, span)
    assert named(found.faults) == ({("sensor_polarity", (11,))} if told else set())
    assert found.doubtful[11]


@pytest.mark.parametrize(("share", "told"), [(0.06, False), (1.0, True)])
def test_a_turn_is_told_of_what_moves_across_its_axis(share, told):
    """At the leading edge of a wing, which hardly moves in its plane, 79 degrees were told."""
    triads, turned = np.tile(np.eye(3), (40, 1, 1)), np.tile(np.eye(3), (40, 1, 1))
    turned[9] = turned[9] @ rotation(np.radians([0.0, 0.0, 79.0])).T
    motion, model = vibrating(), ring()
    for moves in (motion, model):
        moves[:, 2] = 2.0 * moves[:, 0] + moves[:, 1]
        moves[9, :2] *= share
    test, _ = survey(read(motion, turned, noise=0.002), triads)
    span = Span(model.reshape(120, -1), model, HZ)
    found = judge_sensors(test, span)
    assert named(found.faults) == ({("sensor_axis", (27, 28, 29))} if told else set())
    assert found.doubtful[27]


def test_the_noise_of_sound_sensors_is_estimated():
    assert 0.015 < judged(read(vibrating(), radial(), noise=0.03), radial()).noise < 0.05


def test_sensors_of_large_standard_error_are_not_accused():
    y = read(vibrating(), radial())
    y[7] += 0.8 * np.random.default_rng(3).normal(size=14)
    errors = np.full((40, 14), 0.005)
    errors[7] = 1.0
    test, span = survey(y, radial(), errors)
    assert not judge_sensors(test, span).doubtful.any()


def test_a_handful_of_sensors_cannot_judge_each_other():
    y = read(vibrating(), radial())
    y[2] *= -1.0
    test, span = survey(y, radial())
    few = np.arange(6)
    part = replace(
        test,
        shapes=test.shapes[few],
        node=test.node[few],
        component=test.component[few],
        axis=test.axis[few],
        xyz=test.xyz[few],
    )
    own = replace(span, rows=span.rows[few], around=span.around[few])
    assert judge_sensors(part, own).faults == ()


def test_corrected_readings_are_those_of_sound_sensors():
    sound = read(vibrating(), planar())
    y = sound.copy()
    y[[5, 18]] = y[[18, 5]]
    y[7] *= -1.0
    y[9] = rotation(np.radians([0.0, 0.0, -90.0]))[:2, :2] @ y[9]
    found = faults(y, planar())
    back = corrected(y.reshape(80, -1), found)
    assert not lost(found, 80).any()
    np.testing.assert_allclose(back, sound.reshape(80, -1), atol=0.06)


def test_what_a_lone_turned_sensor_should_read_is_not_made_up():
    axes = radial()
    axes[9] = axes[9] @ rotation(np.radians([0.0, 0.0, 45.0])).T
    found = faults(read(vibrating(), axes))
    assert np.flatnonzero(lost(found, 40)).tolist() == [9]


@pytest.mark.slow
def test_two_hundred_sound_tests_accuse_next_to_nobody():
    """At the assumed noise no sensor of 8000 is accused, and hardly one is set aside."""
    verdicts = [judged(read(vibrating(s), radial(), seed=s), radial()) for s in range(200)]
    assert sum(len(v.faults) for v in verdicts) == 0
    assert sum(int(v.doubtful.sum()) for v in verdicts) <= 4


@pytest.mark.slow
def test_chances_that_are_told_are_kept():
    """Of faults told with a chance of p about a share p is there, of gains too that hardly show."""
    told, true = [], []
    for seed in range(120):
        rng = np.random.default_rng([seed, 2])
        y = read(vibrating(seed), radial(), seed=seed)
        sensor, factor = int(rng.integers(40)), float(np.exp(rng.normal(0.0, 0.25)))
        y[sensor] *= factor
        for f in faults(y):
            told.append(f.confidence)
            true.append(f.sensors == (sensor,) and f.kind == "sensor_gain")
    assert len(told) > 15
    assert np.mean(true) > np.mean(told) - 0.1
