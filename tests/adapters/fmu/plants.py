"""A plant of all kinds of modes and channels, written as a unit, and importers to run it."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

from trueup.adapters.fmu import write_unit
from trueup.adapters.fmu.build_kernel import _own_platform
from trueup.core.statespace.channels import read_channels
from trueup.core.statespace.modal_plant import ModalPlant

VERSIONS = (2, 3)
HZ = np.array([0.0, 4.0, 4.02, 17.0, 60.0, 2500.0])
RATIOS = np.array([0.0, 0.01, 0.02, 1.0, 1.7, 0.03])
"""A rigid-body mode, a close pair, a critical and an overdamped mode, a stiff residual one."""
INPUTS = "1:Z,2:RX,push=3:-Y"
OUTPUTS = "1:Z,2:RX:vel,3:Y:acc,tip=4:X,1:Z:acc"


def plant() -> ModalPlant:
    r = np.random.default_rng(4)
    inputs, outputs = read_channels(INPUTS, "input"), read_channels(OUTPUTS, "output")
    drive, sense = r.normal(size=(6, 3)), r.normal(size=(5, 6))
    return ModalPlant(HZ, RATIOS, drive, sense, inputs, outputs, 1, 30.0, 0.01)


def unit(folder: Path, version: int) -> Path:
    path = folder / f"plant{version}.fmu"
    if not write_unit(path, plant(), version, [_own_platform() or "linux64"]):
        pytest.skip("no C compiler is at hand")
    return path


def held(of: ModalPlant, u: np.ndarray, step: float) -> np.ndarray:
    """Outputs after each step with its input u (n_step, n_input) held, by one matrix exponential.

    The last outputs of a step see the input that was held.
    """
    A, B, C, D = of.matrices()
    n, m = B.shape
    E = expm(np.block([[A, B], [np.zeros((m, n + m))]]) * step)[:n]
    x, y = np.zeros(n), []
    for now in u:
        x = E[:, :n] @ x + E[:, n:] @ now
        y.append(C @ x + D @ now)
    return np.array(y)


def grown(of: ModalPlant, u: np.ndarray, step: float) -> np.ndarray:
    """As `held`, of inputs (n_step + 1, n_input) that go straight from point to point."""
    A, B, C, D = of.matrices()
    n, m = B.shape
    whole = np.zeros((n + 2 * m, n + 2 * m))
    whole[:n, : n + m] = np.hstack([A, B])
    whole[n : n + m, n + m :] = np.eye(m)
    E = expm(whole * step)[:n]
    x, y = np.zeros(n), []
    for now, then in pairwise(u):
        x = E @ np.concatenate([x, now, (then - now) / step])
        y.append(C @ x + D @ then)
    return np.array(y)


def pushes(n: int) -> np.ndarray:
    return np.random.default_rng(9).normal(size=(n, 3))
