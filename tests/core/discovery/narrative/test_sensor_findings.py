import numpy as np
import pytest
import scipy.sparse as sp

from trueup.core.data.dofs import Dofs
from trueup.core.discovery.faults import Fault
from trueup.core.discovery.narrative.sensor_findings import accusations, remarks
from trueup.core.discovery.sensor_faults.diagnosis import Verdicts
from trueup.core.sensors.sensor_map import Observation


def seen():
    """Three nodes, 11 to 13, each with sensors along x and y."""
    sensors = Dofs(np.repeat([11, 12, 13], 2), np.tile([1, 2], 3), np.tile(np.eye(3)[:2], (3, 1)))
    six = np.zeros(6)
    xyz = np.repeat(np.arange(9.0).reshape(3, 3), 2, axis=0)
    return Observation(
        sp.csr_matrix((6, 6)), sensors, xyz, six.astype(int), six, six == 0.0, six + 1.0
    )


def fault(kind, rows, factor=1.0, deviation=0.0, axis=()):
    return Fault(kind, rows, np.eye(len(rows)), factor, deviation, axis, 0.9)


def verdicts(*faults, doubtful=()):
    rows = [i for f in faults for i in f.sensors]
    mask = np.zeros(6, bool)
    mask[[*rows, *doubtful]] = True
    return Verdicts(faults, mask, 0.02)


def told(*faults):
    return accusations(seen(), verdicts(*faults))


def test_a_gain_is_told_with_factor_and_interval():
    (f,) = told(fault("sensor_gain", (2, 3), 1.5, 0.1))
    assert (f.side, f.kind, f.where.sensors) == ("test", "sensor_gain", (12,))
    assert f.magnitude == {"factor": 1.5}
    assert f.interval == pytest.approx((1.304, 1.696))
    assert "Sensor 12 reads 1.50 times" in f.sentence


def test_a_turned_sensor_is_told_with_angle_and_axis():
    (f,) = told(fault("sensor_axis", (2, 3), 30.0, 1.0, (0.0, 0.0, 1.0)))
    assert f.magnitude == {"angle_deg": 30.0, "axis": [0.0, 0.0, 1.0]}
    assert "turned by 30°" in f.sentence
    assert f.where.xyz == (3.0, 4.0, 5.0)


def test_a_swap_names_both_nodes_and_one_direction_is_said_to_be_one():
    whole, one = told(fault("sensor_swap", (0, 1, 4, 5)), fault("sensor_polarity", (3,), -1.0))
    assert whole.where.sensors == (11, 13)
    assert whole.where.directions is None
    assert "Sensors 11 and 13 are swapped" in whole.sentence
    (direction,) = one.where.directions
    assert "12" in direction
    assert direction in one.sentence


def test_exchanged_directions_of_one_node_are_told_as_such():
    (f,) = told(fault("sensor_swap", (2, 3)))
    assert f.where.sensors == (12,)
    first, second = f.where.directions
    assert f"{first} and {second} are swapped" in f.sentence


def test_what_may_be_faulty_is_remarked():
    tested = verdicts(fault("sensor_gain", (2, 3), 1.5, 0.1), doubtful=(4, 5))
    (remark,) = remarks(seen(), tested)
    assert remark.startswith("sensor 13 may be faulty")


def test_nothing_odd_no_remark():
    assert remarks(seen(), verdicts()) == ()


def test_what_an_error_of_the_model_looks_like_is_in_doubt_where_the_model_is():
    both = verdicts(fault("sensor_gain", (2, 3), 1.5, 0.1), fault("sensor_polarity", (5,), -1.0))
    (kept,) = accusations(seen(), both.beyond_doubt)
    assert kept.kind == "sensor_polarity"
    (said,) = remarks(seen(), both.beyond_doubt)
    assert "sensor 12 may be faulty, or the model wrong there" in said
