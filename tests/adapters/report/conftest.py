"""Small runs in the shape of interface.md: the content of result.json, and `answer` types it."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from trueup.core.data.geometry import Geometry
from trueup.core.results.correlation import RunTables
from trueup.verbs.runs.report import answer_of


def pair(
    test: int, analysis: int, test_hz: float, analysis_hz: float, mac: float
) -> dict[str, Any]:
    return {
        "test": test,
        "analysis": analysis,
        "test_hz": test_hz,
        "analysis_hz": analysis_hz,
        "deviation_percent": 100.0 * (analysis_hz - test_hz) / test_hz,
        "mac": mac,
        "cluster": None,
        "rotation_deg": None,
    }


def sensor(
    node: int, direction: str, axis: list[float], xyz: list[float], grid: int, distance: float
) -> dict[str, Any]:
    return {
        "node": node,
        "direction": direction,
        "axis": axis,
        "xyz": xyz,
        "nearest_grid": grid,
        "distance": distance,
    }


GAP = {"pairs": 2, "mean_abs_deviation_percent": 6.25, "worst_deviation_percent": 10.0,
       "mean_mac": 0.865}  # fmt: skip
CLOSED = {"pairs": 3, "mean_abs_deviation_percent": 0.77, "worst_deviation_percent": 1.0,
          "mean_mac": 0.933}  # fmt: skip
BEFORE = {
    "pairs": [
        pair(1, 2, 10.0, 9.0, 0.81) | {"cluster": 1, "rotation_deg": 30.0},
        pair(2, 1, 20.0, 20.5, 0.92),
    ],
    "unpaired_test": [3],
    "unpaired_analysis": [3, 4],
    "clusters": [{"id": 1, "analysis": [1, 2], "test": [1]}],
    "mac": {
        "test": [1, 2, 3],
        "analysis": [1, 2, 3, 4],
        "values": [[0.41, 0.40, 0.0, 0.1], [0.92, 0.1, 0.2, 0.0], [0.0, 0.1, 0.58, None]],
    },
    "mac_rotated": {
        "test": [1, 2, 3],
        "analysis": [1, 2, 3, 4],
        "values": [[0.0, 0.81, 0.0, 0.1], [0.92, 0.0, 0.2, 0.0], [0.0, 0.1, 0.58, None]],
    },
    "test_hz": [10.0, 20.0, 31.25],
    "analysis_hz": [20.5, 9.0, 30.0, 90.0],
    "criteria": {
        "mac_min": 0.7,
        "frequency_tolerance": 0.3,
        "cluster_width": 0.02,
        "rotate": "analysis",
    },
    "summary": GAP,
    "alignment": {
        "rotation": [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        "translation": [1.0, 2.0, 3.0],
        "scale": 1000.0,
        "rms": 0.5,
        "sensors": [
            sensor(101, "+X", [1.0, 0.0, 0.0], [0.0, 0.0, 0.0], 1, 0.25),
            sensor(101, "-Z", [0.0, 0.0, -1.0], [0.0, 0.0, 0.0], 1, 0.25),
            sensor(108, "+Y", [0.0, 1.0, 0.0], [1.0, 1.0, 1.0], 8, 1.5),
        ],
    },
    "warnings": ["Sensor 108 lies 1.5 mm from the model."],
}
AFTER = copy.deepcopy(BEFORE) | {
    "pairs": [
        pair(1, 2, 10.0, 10.1, 0.95),
        pair(2, 1, 20.0, 20.1, 0.97),
        pair(3, 3, 31.25, 31.0, 0.88),
    ],
    "unpaired_test": [],
    "unpaired_analysis": [4],
    "summary": CLOSED,
}
PARAMETERS = [
    {
        "name": "front flange",
        "cards": ["PBAR 11 I1", "PBAR 11 I2"],
        "initial": [9000.0, 9000.0],
        "updated": [15750.0, 15750.0],
        "factor": 1.75,
        "standard_error": 0.0123,
        "at_bound": False,
    },
    {
        "name": "skin",
        "cards": ["PSHELL 1 T"],
        "initial": [1.6],
        "updated": [1.28],
        "factor": 0.8,
        "standard_error": None,
        "at_bound": True,
    },
]
HISTORY = [
    {"iteration": k, "stage": 1, "objective": j, "factors": f, "deviations_percent": d}
    for k, (j, f, d) in enumerate(
        [
            (900.0, [1.0, 1.0], [-10.0, 2.5, None]),
            (40.0, [1.5, 0.9], [-2.0, 1.0, -1.5]),
            (2.0, [1.75, 0.8], [1.0, 0.5, -0.8]),
        ]
    )
]
FINDING = {
    "side": "model",
    "kind": "point_mass",
    "where": {"grids": [8], "xyz": [1.0, 1.0, 1.0], "region": "the far corner"},
    "magnitude": {"mass": 0.00062},
    "interval": [0.00058, 0.00066],
    "credible_set": [
        {"grids": [7, 8], "xyz": [1.0, 1.0, 0.5], "weight": 0.6, "kind": "point_mass"},
        {"grids": [6], "xyz": [1.0, 0.0, 1.0], "weight": 0.4, "kind": "point_mass"},
    ],
    "confidence": 0.97,
    "cards": ["CONM2,9001,8,0,6.2-4"],
    "sentence": "About 0.62 kg is missing near grid 8",
}
CHANGING = {
    "deck": "deck/duct.bdf",
    "input_deck": "/runs/duct.bdf",
    "test": ["duct_test.unv"],
    "seconds": 7.4,
    "warnings": [],
}
DIFF = """--- a/properties.bdf
+++ b/properties.bdf
@@ -1,3 +1,3 @@
 $ <section & more>
-PBAR    11      1       200.    9000.   9000.   3000.
+PBAR    11      1       200.    15750.  15750.  3000.
"""


@pytest.fixture(scope="session")
def answer() -> Callable[[dict[str, Any]], RunTables]:
    """The tables of a result.json."""
    return answer_of


@pytest.fixture
def correlation() -> dict[str, Any]:
    named = {"schema": "trueup/correlate/1", "deck": "/runs/duct.bdf", "test": ["duct_test.unv"]}
    return copy.deepcopy({**named, **BEFORE})


@pytest.fixture
def update() -> dict[str, Any]:
    return copy.deepcopy(
        {
            "schema": "trueup/update/1",
            **CHANGING,
            "before": BEFORE,
            "after": AFTER,
            "parameters": PARAMETERS,
            "history": HISTORY,
            "eigensolutions": 3,
            "weights": None,
            "stopped": "converged",
        }
    )


@pytest.fixture
def discovery() -> dict[str, Any]:
    fault = FINDING | {
        "side": "test",
        "kind": "sensor_polarity",
        "where": {"sensors": [108], "xyz": [1.0, 1.0, 1.0], "region": "sensor 108"},
        "magnitude": {},
        "interval": None,
        "credible_set": [],
        "cards": [],
        "sentence": "Sensor 108 has its sign reversed.",
    }
    return copy.deepcopy(
        {
            "schema": "trueup/discover/1",
            **CHANGING,
            "before": BEFORE,
            "after": AFTER,
            "pairs": AFTER["pairs"],
            "parameters": [],
            "would_decide": [],
            "noise_scale": 1.0,
            "judgement": {
                "evidence": 30.0,
                "posterior": 0.99,
                "foretold": 12.0,
                "error": 0.003,
                "error_alone": 0.019,
                "gain": 40.0,
                "adequacy": 0.5,
            },
            "verdict": "effect",
            "findings": [FINDING, fault],
            "alternatives": [
                {
                    "kinds": ["local_stiffness"],
                    "xyz": [[0.0, 1.0, 0.0]],
                    "times_less_likely": 41.0,
                    "where": "local stiffness at the near edge",
                    "odds": "41 times less likely",
                    "sentence": "local stiffness at the near edge: 41 times less likely",
                },
                {
                    "kinds": [],
                    "xyz": [],
                    "times_less_likely": 200.0,
                    "where": "the known parameters alone",
                    "odds": "200 times less likely",
                    "sentence": "the known parameters alone: 200 times less likely",
                },
            ],
            "gap": {
                "before": GAP,
                "after": CLOSED,
                "held_out": {
                    "test_modes": [2],
                    "sensors": [],
                    "before": GAP | {"pairs": 1},
                    "after": CLOSED | {"pairs": 1},
                },
            },
            "misfit": {
                "grids": [1, 8],
                "values": [0.5, 2.0],
                "mass": [0.1, 0.4],
                "stiffness": [0.3, 0.2],
                "ground": [0.0, 0.0],
                "peaks": [
                    {"of": "mass", "grid": 8, "xyz": [0.0, 0.0, 0.0], "explained": 0.4},
                    {"of": "stiffness", "grid": 1, "xyz": [0.0, 0.0, 0.0], "explained": 0.3},
                ],
                "modes": [{"test": 1, "analysis": 2, "shape": 3.21, "frequency": -4.5}],
                "sensors": [
                    {"sensor": "12:Z", "misfit": 1.5, "comac": 0.98},
                    {"sensor": "11:Z", "misfit": 7.5, "comac": 0.61},
                ],
            },
        }
    )


@pytest.fixture
def cube() -> Geometry:
    """A unit cube of eight grids, number 1 at the origin and 8 opposite."""
    corners = [[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]
    hexa = {"hexa": np.array([[0, 4, 6, 2, 1, 5, 7, 3]])}
    return Geometry(np.arange(1, 9), np.array(corners), "mm", hexa)


@pytest.fixture
def diff() -> str:
    return DIFF
