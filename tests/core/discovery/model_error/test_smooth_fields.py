"""Polynomials that stiffness and mass drift by."""

import numpy as np
from tests.core.discovery.search.test_patch_reshaping import membrane

from trueup.core.discovery.model_error import smooth_fields
from trueup.core.discovery.model_error.smooth_fields import _cells, _polynomials


def test_polynomials_have_rms_one_and_are_orthogonal_by_mass():
    rng = np.random.default_rng(1)
    xyz, mass = rng.uniform(size=(200, 3)), rng.uniform(0.5, 2.0, 200)
    q, names = _polynomials(xyz, mass)
    gram = (q.T * mass / mass.sum()) @ q
    assert np.allclose(gram, np.eye(9), atol=1e-12)
    assert np.allclose(mass @ q, 0.0, atol=1e-10)
    assert names[:3] == ("along x", "along y", "along z")
    assert names[3:5] == ("from the middle to the ends along x", "from corner to corner in x and y")


def test_a_flat_structure_has_no_field_across():
    rng = np.random.default_rng(1)
    xyz = rng.uniform(size=(200, 3)) * np.array([1.0, 1.0, 0.0])
    q, names = _polynomials(xyz, np.ones(200))
    assert q.shape == (200, 5)
    assert not any("z" in n for n in names)


def test_one_place_is_one_cell_and_has_no_field():
    with np.errstate(all="raise"):
        assert _cells(np.ones((1, 3))).tolist() == [0]
        assert _polynomials(np.ones((1, 3)), np.ones(1))[0].size == 0


def test_fields_are_the_same_however_many_elements_are_made_at_once(monkeypatch):
    structure = membrane()
    vectors = np.random.default_rng(2).normal(size=(structure.displacement.shape[1], 6))
    whole = smooth_fields.smooth_fields(structure, vectors)
    monkeypatch.setattr(smooth_fields, "CHUNK", 7)
    parts = smooth_fields.smooth_fields(structure, vectors)
    assert parts.names == whole.names
    np.testing.assert_allclose(parts.stiffness, whole.stiffness, atol=1e-9)
    np.testing.assert_allclose(parts.mass, whole.mass, atol=1e-9)
    assert np.abs(whole.stiffness).max() > 1e-3
