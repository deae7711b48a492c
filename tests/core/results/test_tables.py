"""Tables of result.json: counted from 1, plain values, nothing lost."""

from __future__ import annotations

import json
from types import SimpleNamespace

import numpy as np
import pytest

from trueup.core.correlation.criteria import Criteria
from trueup.core.correlation.mode_pairing import correlate
from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.modes import Modes
from trueup.core.data.parameter import Parameter
from trueup.core.errors import InputError
from trueup.core.results.correlation import CorrelateTables, Gap, compared, gap
from trueup.core.results.plain import Table, plain, typed
from trueup.core.results.update import parameter_rows
from trueup.core.updating.update import Iteration, Reason, Stop, Updated

ANGLE = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)


@pytest.fixture
def found():
    """Two pairs of a ring, spun, and one test mode that nothing explains."""
    shapes = np.column_stack([f(n * ANGLE) for n in (2, 3) for f in (np.cos, np.sin)])
    shapes /= np.sqrt(12.0)
    hz = np.array([10.0, 10.0, 30.0, 30.0])
    c, s = np.cos(0.6), np.sin(0.6)
    test = np.column_stack([shapes[:, :2] @ [[c, -s], [s, c]], shapes[:, 2:], np.cos(9 * ANGLE)])
    test_hz = np.array([9.8, 10.2, 29.0, 31.0, 40.0])
    dofs = Dofs(np.arange(24), np.ones(24, int))
    c = correlate(hz, shapes, test_hz, test, Criteria())
    return c, Modes(test_hz, test, dofs), Modes(hz, shapes, dofs)


def correlation_tables(c, test, analysis):
    seen = SimpleNamespace(
        sensors=test.dofs, xyz=np.zeros((24, 3)), nearest_grid=np.arange(24),
        distance=np.zeros(24), matrix=np.eye(24),
    )  # fmt: skip
    at = Geometry(np.zeros(0, int), np.zeros((0, 3)), "mm")
    placed = SimpleNamespace(length_factor=1000.0, mpc=None, test_geometry=at)
    move = SimpleNamespace(rotation=np.eye(3), translation=np.zeros(3), rms=0.1)
    tables = compared(
        SimpleNamespace(
            correlation=c, test=test, analysis=analysis, warnings=("one",), alignment=move,
            geometry=SimpleNamespace(xyz=np.zeros((0, 3))), observation=seen, placed=placed,
        )
    )  # fmt: skip
    return CorrelateTables(**vars(tables), deck_file="a.bdf", test_files=("a.unv",)).to_dict()


def test_modes_count_from_one(found):
    c, test, analysis = found
    tables = correlation_tables(c, test, analysis)
    assert [p["test"] for p in tables["pairs"]] == [1, 2, 3, 4]
    assert sorted(p["analysis"] for p in tables["pairs"]) == [1, 2, 3, 4]
    assert tables["unpaired_test"] == [5]
    assert tables["unpaired_analysis"] == []
    assert tables["mac"]["test"] == [1, 2, 3, 4, 5]
    assert tables["mac"]["analysis"] == [1, 2, 3, 4]
    ids = {k["id"]: k for k in tables["clusters"]}
    assert ids[1] == {"id": 1, "analysis": [1, 2], "test": [1, 2], "harmonic": None}
    assert all(p["analysis"] in ids[p["cluster"]]["analysis"] for p in tables["pairs"])
    assert tables["pairs"][0]["deviation_percent"] == pytest.approx(100 * 0.2 / 9.8)


def test_the_tables_are_plain_and_keep_every_digit(found):
    c, test, analysis = found
    tables = correlation_tables(c, test, analysis)
    back = json.loads(json.dumps(tables, allow_nan=False))
    assert back == tables
    again = CorrelateTables.from_dict(back)
    assert again.to_dict() == tables
    assert (again.deck_file, again.test_files, again.pairs[0].test) == ("a.bdf", ("a.unv",), 1)
    np.testing.assert_array_equal(again.mac_rotated.values, c.mac_rotated)
    np.testing.assert_array_equal(back["mac_rotated"]["values"], c.mac_rotated)
    np.testing.assert_array_equal(back["test_hz"], test.frequencies_hz)


def test_the_gap_in_four_figures(found):
    c, _, _ = found
    off = [abs(p.deviation_percent) for p in c.pairs]
    told = gap(c)
    assert told.pairs == 4
    assert told.mean_abs_deviation_percent == pytest.approx(np.mean(off))
    assert told.worst_deviation_percent == max(off)
    assert told.mean_mac == pytest.approx(1.0)


def test_the_gap_without_pairs_is_empty_not_zero(found):
    _, test, analysis = found
    none = correlate(analysis.frequencies_hz, analysis.shapes, 9 * test.frequencies_hz, test.shapes)
    assert gap(none) == Gap(0, None, None, None)


def test_parameters_and_history_in_words_of_the_deck(found):
    history = (Iteration(0, 1, 5.0, np.array([1.0, 1.0]), np.array([3.0, np.nan])),)
    done = Updated(
        np.array([1.5, 0.2]), np.array([0.1, np.nan]), np.array([False, True]), None, None,
        history, 3, Stop(Reason.SETTLED, "settled"), (),
    )  # fmt: skip
    parameters = (
        Parameter("ring", ("PBAR 11 I1", "PBAR 11 I2"), (9000.0, 8000.0)),
        Parameter("skin", ("PSHELL 1 T",), (1.6,)),
    )
    rows = parameter_rows(parameters, done, [[13500.0, 12000.0], [0.32]]).to_dict()
    assert rows[0] == {
        "name": "ring", "cards": ["PBAR 11 I1", "PBAR 11 I2"], "initial": [9000.0, 8000.0],
        "updated": [13500.0, 12000.0], "factor": 1.5, "standard_error": 0.1, "at_bound": False,
    }  # fmt: skip
    assert rows[1]["standard_error"] is None
    assert rows[1]["at_bound"] is True
    assert Table(history).to_dict() == [
        {"iteration": 0, "stage": 1, "objective": 5.0, "factors": [1.0, 1.0],
         "deviations_percent": [3.0, None]},
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "value"),
    [(int, 1.5), (str, 3), (float, "x"), (tuple[int, ...], 3), (Gap, [1]), (Gap, {"pairs": "x"})],
)
def test_a_value_of_another_type_is_refused(kind, value):
    with pytest.raises(InputError):
        typed(kind, value, "place")


def test_what_is_no_number_is_none():
    assert plain({"a": np.array([1.0, np.nan]), "b": (np.int64(3), True)}) == {
        "a": [1.0, None], "b": [3, True],
    }  # fmt: skip
