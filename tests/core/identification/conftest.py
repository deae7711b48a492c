"""Synthetic surveys with a known truth, varied in everything that makes a survey hard."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from


@dataclass(frozen=True, eq=False)
class Truth:
    """What the survey was made of; modes inside the measured band only."""

    frequencies_hz: np.ndarray
    damping: np.ndarray
    shapes: np.ndarray
    mass: np.ndarray  # modal mass for the shapes as they are
    noise_std: np.ndarray  # (n_response, n_reference, 1) of real and imaginary part together


def make_survey(
    seed: int = 0,
    *,
    frequencies=None,
    damping=(0.002, 0.01),
    n_mode: int = 8,
    n_response: int = 40,
    n_reference: int = 2,
    band=(20.0, 100.0),
    n_line: int = 1600,
    noise: float = 0.01,
    noise_kind: str = "additive",
    complexity: float = 0.0,
    missing: float = 0.0,
    quantity: str = "acceleration",
    outside: bool = True,
) -> tuple[Frfs, Truth]:
    """Make a survey of random shapes; `noise` is relative to each function's rms (additive) or
    to its value at each line (multiplicative)."""
    rng = np.random.default_rng(seed)
    lo, hi = band
    if frequencies is None:
        inside = np.sort(rng.uniform(lo + 0.04 * (hi - lo), hi - 0.04 * (hi - lo), n_mode))
    else:
        inside = np.asarray(frequencies, dtype=float)
    extra = np.array([0.4 * lo, 1.12 * hi, 1.3 * hi, 1.9 * hi]) if outside else np.empty(0)
    f = np.concatenate([inside, extra])
    zeta = rng.uniform(*damping, len(f))
    real = rng.standard_normal((n_response, len(f)))
    imag = rng.standard_normal((n_response, len(f)))
    shapes = real + 1j * complexity * imag
    poles = poles_from(f, zeta)
    mass = rng.uniform(0.5, 2.0, len(f))
    references = np.linspace(0, n_response - 1, n_reference).astype(int)
    participation = shapes[references] / (2j * poles.imag * mass)
    lines = np.linspace(lo, hi, n_line)
    clean = modal_response(lines, poles, shapes, participation, quantity)
    e = rng.standard_normal(clean.shape) + 1j * rng.standard_normal(clean.shape)
    rms = np.sqrt(np.mean(np.abs(clean) ** 2, axis=2, keepdims=True))
    scale = rms if noise_kind == "additive" else np.abs(clean)
    values = clean + noise * scale * e / np.sqrt(2.0)
    if missing:
        gone = rng.uniform(size=values.shape[:2]) < missing
        gone[references, np.arange(n_reference)] = False
        values[gone] = np.nan
    node = np.arange(1, n_response + 1)
    dofs = Dofs(node, np.full(n_response, 3))
    frfs = Frfs(lines, dofs, dofs.take(references), values, quantity, f"survey {seed}")
    n = len(inside)
    return frfs, Truth(inside, zeta[:n], shapes[:, :n], mass[:n], noise * rms)


@pytest.fixture(scope="session")
def survey() -> Callable[..., tuple[Frfs, Truth]]:
    return make_survey
