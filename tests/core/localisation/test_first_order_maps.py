"""First-order maps point at the place of a small change and tell its size."""

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp

from trueup.core.correlation.criteria import Criteria
from trueup.core.correlation.mode_pairing import correlate
from trueup.core.errors import InputError
from trueup.core.localisation.first_order_maps import (
    linearise,
    mass_evidence,
    patches_of,
    root_of,
    stiffness_evidence,
)
from trueup.core.localisation.shape_misfit import paired_shapes
from trueup.core.localisation.shape_noise import given_noise

N = 30  # a free chain of uneven masses and springs
RNG = np.random.default_rng(3)
MASS = RNG.uniform(0.8, 1.3, N)
SPRING = RNG.uniform(0.7, 1.4, N - 1) * 1e4
LINKS = np.array([[i, i + 1] for i in range(N - 1)])
SENSORS = np.arange(1, N, 2)
MODES, MEASURED = 22, slice(1, 9)


def modes(mass=MASS, spring=SPRING, count=MODES):
    K = np.zeros((N, N))
    for (i, j), k in zip(LINKS, spring, strict=True):
        K[i, i] += k
        K[j, j] += k
        K[i, j] -= k
        K[j, i] -= k
    value, vector = scipy.linalg.eigh(K, np.diag(mass))
    return np.sqrt(np.maximum(value[:count], 0)) / (2 * np.pi), vector[:, :count]


def element_matrices():
    return SPRING[:, None, None] * np.array([[1.0, -1.0], [-1.0, 1.0]])


def prepared(mass=MASS, spring=SPRING, noise=0.01, rotate="analysis", seed=None):
    hz, shapes = modes()
    test_hz, test = modes(mass, spring)
    test_hz, test = test_hz[MEASURED], test[SENSORS, MEASURED] * [1, -3, 0.1, 1, 2, 1, 1, -1]
    if seed is not None:
        rng = np.random.default_rng(seed)
        test = test + noise * np.sqrt((test**2).mean(axis=0)) * rng.normal(size=test.shape)
        test_hz = test_hz * (1 + 0.005 * rng.normal(size=8))
    found = correlate(hz, shapes[SENSORS], test_hz, test, Criteria(rotate=rotate), 1)
    pairs = paired_shapes(found, shapes[SENSORS], test)
    return linearise(found, pairs, given_noise(test, noise), hz, shapes[SENSORS]), shapes


@pytest.mark.parametrize("place", [3, 8, 15, 26])
def test_small_mass_is_found_with_its_size(place):
    added = 0.02
    lin, shapes = prepared(mass=MASS + added * (np.arange(N) == place))
    got = mass_evidence(lin, shapes[:, None])
    assert np.argmax(got.explained) == place
    assert got.size[place] == pytest.approx(added, rel=0.1)
    assert got.explained[place] > 0.95 * got.total
    assert np.all(got.size >= 0)


@pytest.mark.parametrize("place", [2, 9, 14, 25])
@pytest.mark.parametrize("change", [-0.04, 0.04])
def test_small_change_of_stiffness_is_found_with_its_sign_and_size(place, change):
    lin, shapes = prepared(spring=SPRING * (1 + change * (np.arange(N - 1) == place)))
    strain = root_of(element_matrices(), shapes[LINKS])
    got = stiffness_evidence(lin, strain)
    assert np.argmax(got.explained) == place
    assert got.size[place] == pytest.approx(change, rel=0.15)
    assert got.explained[place] > 0.9 * got.total


def test_a_common_modulus_is_no_evidence_for_any_place():
    lin, shapes = prepared(spring=SPRING * 1.05)
    got = stiffness_evidence(lin, root_of(element_matrices(), shapes[LINKS]))
    assert got.total < 1e-3


def test_noise_alone_explains_about_one_at_each_place():
    means = []
    for seed in range(40):
        lin, shapes = prepared(seed=seed)
        means.append(stiffness_evidence(lin, root_of(element_matrices(), shapes[LINKS])).explained)
    assert np.mean(means) == pytest.approx(1.0, abs=0.15)


def test_patch_is_the_sum_of_its_places():
    soft = (np.arange(N - 1) >= 11) & (np.arange(N - 1) <= 14)
    lin, shapes = prepared(spring=SPRING * (1 - 0.03 * soft))
    strain = root_of(element_matrices(), shapes[LINKS])
    centres = np.column_stack([np.arange(N - 1) + 0.5, np.zeros(N - 1), np.zeros(N - 1)])
    middles = centres[1:-2] + np.array([0.5, 0, 0])
    patches = patches_of(middles, centres, 1.6)
    assert set(patches.getnnz(axis=1)) == {4}
    got = stiffness_evidence(lin, strain, patches)
    best = np.argmax(got.explained)
    assert list(patches[best].indices) == [11, 12, 13, 14]
    assert got.size[best] == pytest.approx(-0.03, rel=0.1)
    single = stiffness_evidence(lin, strain)
    assert got.explained[best] > single.explained.max()


def test_root_reproduces_the_modal_stiffness():
    A = RNG.normal(size=(5, 6, 4))
    K = A @ np.swapaxes(A, 1, 2)
    phi = RNG.normal(size=(5, 6, 3))
    S = root_of(K, phi)
    want = np.swapaxes(phi, 1, 2) @ K @ phi
    np.testing.assert_allclose(np.swapaxes(S, 1, 2) @ S, want, atol=1e-9)


def test_many_places_in_chunks_are_the_same_as_few():
    lin, shapes = prepared(mass=MASS + 0.02 * (np.arange(N) == 8))
    few = mass_evidence(lin, shapes[:, None])
    many = mass_evidence(lin, np.tile(shapes[:, None], (600, 1, 1)))
    np.testing.assert_allclose(many.explained, np.tile(few.explained, 600), rtol=1e-9)


def test_rotated_test_side_is_refused():
    with pytest.raises(InputError, match="analysis side rotated"):
        prepared(rotate="test")


@pytest.mark.parametrize("evidence", [mass_evidence, stiffness_evidence])
def test_patches_of_no_places_explain_nothing(evidence):
    """As around rods, which have no bending."""
    lin, _ = prepared()
    found = evidence(lin, np.zeros((0, 2, MODES)), sp.csr_matrix((3, 0)))
    assert found.explained.tolist() == [0.0, 0.0, 0.0]
