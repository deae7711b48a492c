"""What `discover` says hangs on the case alone: not on order, axes, units, threads or processor.

Verdict, kinds and places are the same, sizes within a tenth of their interval. Small cases are told
in every way, larger ones in fewer, the data folder's ducts and its bowed panel, for time, in two.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest
from benchmarks.discovery.variants import WAYS, alike

ROOT = Path(__file__).resolve().parents[2]
OWN = ROOT / "tests" / "discovery_cases" / "cases"
SHARED = ROOT.parent / "shared" / "data" / "cases"
SMALL = (
    "0003_tower_joint_flexibility",
    "3108_frame_sensor_swap_sensor_polarity",
    "panel_parameters",
    "panel_spring",
    "tower_frame",
    "tower_joint",
    "wheel_faults",
    "wheel_mass",
)
LARGER = (
    "0004_frame_point_mass_sensor_gain",
    "0027_tower_tuned_absorber",
    "3131_tower_ground_spring_support_flexibility",
    "3187_tower_point_mass_local_stiffness",
    "panel_stiffness",
)
LARGEST = ("duct", "duct_oval", "panel_bow")
SIZE = {
    "duct": 900.0,
    "wheel": 760.0,
    "panel": 900.0,
    "plate": 900.0,
    "tower": 2500.0,
    "frame": 1000.0,
}
THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")
SETTINGS = {"threads": dict.fromkeys(THREADS, "4"), "kernel": {"OPENBLAS_CORETYPE": "Haswell"}}
"""Ways that leave the case: four threads, the linear algebra of another processor."""
EVERY = [way for way in WAYS if way != "as_it_is"] + list(SETTINGS)
TOLD = [(name, way) for name in SMALL for way in EVERY]
TOLD += [(name, way) for name in LARGER for way in ("renumbered", "kernel")]
TOLD += [
    ("panel_stiffness", way)
    for way in ("shuffled", "relabelled", "turned", "in_metres", "breathed")
]
TOLD += [(name, way) for name in LARGEST for way in ("renumbered", "breathed")]
TOLD += [("9737_plate_point_mass", way) for way in ("shuffled", "turned")]


@cache
def answer(case: Path, way: str) -> dict:
    """Return what is said of a case told in a way."""
    told = "as_it_is" if way in SETTINGS else way
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.discovery.variants", str(case), told],
        cwd=ROOT,
        env={**os.environ, **dict.fromkeys(THREADS, "1"), **SETTINGS.get(way, {})},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.slow
@pytest.mark.parametrize(("name", "way"), TOLD, ids=[f"{name}-{way}" for name, way in TOLD])
def test_the_answer_is_the_same(name, way):
    case = next((p for p in (OWN / name, SHARED / name) if p.is_dir()), None)
    if case is None:
        pytest.skip("the data folder is not beside the checkout")
    one, other = answer(case, "as_it_is"), answer(case, way)
    assert other["verdict"] == one["verdict"]
    deck = next(case.glob("*_test.unv")).name.replace("_test.unv", "")
    assert alike(one["findings"], other["findings"], SIZE[deck]) == []
