"""The units of FMI 2.0 in libcosim, a master for co-simulation that builds on FMI Library."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.adapters.fmu.plants import HZ, held, plant, pushes, unit

pytest.importorskip("libcosimpy", reason="libcosim is not installed: pip install libcosimpy")

STEP, INPUTS, OUTPUTS, FREQUENCY = 0.013, [0, 1, 2], [3, 4, 5, 6, 7], 33  # of mode 2


def stepped(path: Path, u: np.ndarray, hz_of_2: float | None = None, at: int = 0) -> np.ndarray:
    """Outputs after each step; the frequency of mode 2 is set before step `at`, 0: at the start."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(int(STEP * 1e9))
    index = execution.add_local_slave(CosimLocalSlave(str(path), "plant"))
    observer, hand = CosimObserver.create_last_value(), CosimManipulator.create_override()
    assert execution.add_observer(observer)
    assert execution.add_manipulator(hand)
    if hz_of_2 is not None and not at:
        assert execution.real_initial_value(index, FREQUENCY, hz_of_2)
    y = []
    for k, now in enumerate(u):
        assert hand.slave_real_values(index, INPUTS, now.tolist())
        if hz_of_2 is not None and at == k > 0:
            assert hand.slave_real_values(index, [FREQUENCY], [hz_of_2])
        assert execution.step()
        y.append(observer.last_real_values(index, OUTPUTS))
    return np.array(y)


def close(found: np.ndarray, exact: np.ndarray) -> bool:
    return bool((np.abs(found - exact).max(axis=0) < 1e-10 * np.abs(exact).max(axis=0)).all())


def test_co_simulation_is_exact(tmp_path: Path) -> None:
    assert close(stepped(unit(tmp_path, 2), pushes(60)), held(plant(), pushes(60), STEP))


def test_a_frequency_is_changed_before_and_within_the_run(tmp_path: Path) -> None:
    hz = HZ.copy()
    hz[1] = 3.3
    tuned, u = replace(plant(), frequencies_hz=hz), pushes(60)
    assert close(stepped(unit(tmp_path, 2), u, 3.3), held(tuned, u, STEP))
    u[:30] = 0.0  # at rest until then
    later = stepped(unit(tmp_path, 2), u, 3.3, at=25)
    assert close(later, held(tuned, u, STEP))
    assert not close(later, held(plant(), u, STEP))
