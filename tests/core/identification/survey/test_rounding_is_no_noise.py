"""Functions that were computed hold rounding, which says nothing against any of them."""

import numpy as np

from trueup.core.identification.survey.function_faults import noise_ratio


def _rough(values: np.ndarray) -> np.ndarray:
    return np.std(np.diff(values, axis=2), axis=2)


def _functions(noise: float) -> np.ndarray:
    """Five functions of one input: one with noise a hundred times that of the others."""
    rng = np.random.default_rng(4)
    values = rng.normal(size=(5, 1, 4000)) + 1j * rng.normal(size=(5, 1, 4000))
    values *= noise * np.array([1.0, 1.0, 1.0, 1.0, 100.0])[:, None, None]
    return values + 1.0


def test_a_noisy_function_stands_out() -> None:
    ratio = noise_ratio(_functions(1e-3), np.ones((5, 1), bool), _rough)
    assert ratio[4, 0] > 50.0
    assert ratio[:4].max() < 2.0


def test_rounding_does_not() -> None:
    assert not noise_ratio(_functions(1e-12), np.ones((5, 1), bool), _rough).any()
