"""pyuff's dictionaries are taken where a file is, and given back."""

from __future__ import annotations

import copy
from pathlib import Path

import numpy as np
import pytest

import trueup
from trueup.adapters.universal import ModalTest
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry

pyuff = pytest.importorskip("pyuff")

DUCT = Path(__file__).parents[3] / "fixtures" / "duct" / "duct_test.unv"


@pytest.fixture(scope="module")
def modes() -> ModalTest:
    test = trueup.read_test(DUCT)
    assert isinstance(test, ModalTest)
    return test


def responses(frequencies: np.ndarray) -> ModalTest:
    rng = np.random.default_rng(7)
    values = rng.standard_normal((3, 1, len(frequencies), 2)) @ np.array([1.0, 1j])
    geometry = Geometry(np.array([1, 2]), np.array([[0.0, 0.0, 0.0], [1.5, 0.0, 0.25]]), "m")
    sensors = Dofs(np.array([1, 1, 2]), np.array([1, 3, 2]))
    return ModalTest(
        geometry, None, Frfs(frequencies, sensors, Dofs(np.array([2]), np.array([3])), values), "m"
    )


def same(a: trueup.Measurement, b: trueup.Measurement, rtol: float) -> None:
    assert np.array_equal(a.geometry.ids, b.geometry.ids)
    assert np.allclose(a.geometry.xyz, b.geometry.xyz, rtol=1e-6, atol=0)
    assert a.length_unit == b.length_unit
    assert (a.modes is None, a.frfs is None) == (b.modes is None, b.frfs is None)
    if a.modes is not None and b.modes is not None:
        assert a.modes.dofs.labels == b.modes.dofs.labels
        assert np.allclose(a.modes.frequencies_hz, b.modes.frequencies_hz, rtol=1e-5)
        assert np.allclose(a.modes.shapes, b.modes.shapes, rtol=rtol, atol=1e-7)
    if a.frfs is not None and b.frfs is not None:
        assert np.allclose(a.frfs.frequencies_hz, b.frfs.frequencies_hz, rtol=1e-6)
        assert a.frfs.responses.labels == b.frfs.responses.labels
        assert np.allclose(a.frfs.values, b.frfs.values, rtol=rtol, atol=0)


def test_a_modal_test_goes_to_pyuff_and_comes_back(modes: ModalTest) -> None:
    sets = modes.to_pyuff()
    assert [s["type"] for s in sets] == [151, 164, 2411] + [55] * 24
    assert sets[3]["freq"] == pytest.approx(33.9097)
    again = trueup.read_test(sets)
    same(modes, again, 1e-5)
    assert again.modes is not None
    assert again.modes.source == "pyuff's sets"


@pytest.mark.parametrize("frequencies", [np.arange(1.0, 9.0, 0.5), np.array([1.0, 2.0, 4.5, 9.0])])
def test_responses_go_to_pyuff_and_come_back(frequencies: np.ndarray) -> None:
    test = responses(frequencies)
    sets = test.to_pyuff()
    assert sum(s["type"] == 58 for s in sets) == 3
    same(test, trueup.read_test(sets), 1e-5)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # pyuff's own leak
@pytest.mark.parametrize("kind", ["modes", "responses"])
def test_a_file_that_pyuff_writes_of_our_dictionaries_reads_alike(
    kind: str, modes: ModalTest, tmp_path: Path
) -> None:
    test = modes if kind == "modes" else responses(np.arange(1.0, 9.0, 0.5))
    file = pyuff.UFF(str(tmp_path / "theirs.unv"))
    file.write_sets(test.to_pyuff(), "add")
    same(test, trueup.read_test(tmp_path / "theirs.unv"), 1e-5)
    same(test, trueup.read_test(pyuff.UFF(str(tmp_path / "theirs.unv"))), 1e-5)


def test_the_callers_dictionaries_stay_as_they_are(modes: ModalTest) -> None:
    sets = modes.to_pyuff()
    before = copy.deepcopy(sets)
    trueup.read_test(sets)
    for a, b in zip(before, sets, strict=True):
        assert a.keys() == b.keys()
        assert all(np.array_equal(a[k], b[k]) for k in a)


@pytest.mark.parametrize(
    ("sets", "said"),
    [
        ([{"type": 55}], r"^pyuff's sets: set 1 \(type 55\) cannot be written by pyuff: "),
        ([{"kind": 1}], r"^pyuff's sets: set 1 \(type None\) cannot be written by pyuff"),
        ({"type": 151}, r"^pyuff's sets: "),
    ],
)
def test_sets_at_fault_are_one_sentence(sets: object, said: str) -> None:
    with pytest.raises(trueup.InputError, match=said) as raised:
        trueup.read_test(sets)
    assert "\n" not in str(raised.value)
    assert raised.value.file is None


def test_a_test_without_geometry_is_refused(modes: ModalTest) -> None:
    shapes = [s for s in modes.to_pyuff() if s["type"] == 55]
    with pytest.raises(trueup.InputError, match=r"^pyuff's sets: a test with no geometry"):
        trueup.read_test(shapes)
