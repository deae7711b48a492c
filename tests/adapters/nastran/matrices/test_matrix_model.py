"""Models made of exported matrices alone give the frequencies that Nastran printed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.adapters.nastran import (
    DofMap,
    NastranMatrix,
    build_model,
    model_matrices,
    model_of_matrices,
    read_deck,
    read_matrices,
    read_modes,
    stiffness_and_mass,
    write_op4,
)
from trueup.core.eigen import normal_modes
from trueup.core.errors import InputError

PRINTED = {
    "dmig_punch/test_case": (
        2, (21.1406, 21.3557, 128.7332, 129.7476, 437.1801, 438.2013, 1258.988, 1259.566)),
    "dmig_punch_swept/sol103_swept_plane": (
        3, (1.33921, 3.40603, 5.61005, 10.88232, 11.05762, 16.00409)),
}  # fmt: skip
SPACE_TRUSS = (
    1.69880, 1.76749, 1.85772, 3.41961, 7.02421, 7.02541, 10.7236, 10.9825, 13.8668, 14.3899,
)  # fmt: skip


@pytest.mark.parametrize("name", PRINTED)
def test_punched_stiffness_and_mass_give_the_frequencies_of_the_f06(data: Path, name: str) -> None:
    rigid, printed = PRINTED[name]
    base = data / "matrices" / name
    K, M = stiffness_and_mass(read_matrices(base.with_suffix(".pch1")))
    model = model_of_matrices([K], [M], read_deck(base.with_suffix(".bdf")))
    solution = normal_modes.solve(model, n_modes=rigid + len(printed))
    assert solution.rigid_body_modes == rigid
    np.testing.assert_allclose(solution.frequencies_hz[rigid:], printed, rtol=3e-6)


def test_the_shapes_of_a_punched_model_are_those_of_the_f06(data: Path) -> None:
    base = data / "matrices" / "dmig_punch" / "test_case"
    K, M = stiffness_and_mass(read_matrices(base.with_suffix(".pch1")))
    deck = read_deck(base.with_suffix(".bdf"))
    model = model_of_matrices([K], [M], deck)
    modes = normal_modes.modes_of(model, normal_modes.solve(model, n_modes=10))
    printed = read_modes(base.with_suffix(".f06"), deck)
    assert modes.dofs.labels == printed.dofs.labels
    a, b = modes.shapes[:, 2:], printed.shapes[:, 2:]
    mac = (a * b).sum(0) ** 2 / (a * a).sum(0) / (b * b).sum(0)
    assert mac.min() > 1.0 - 1e-8
    np.testing.assert_allclose(abs(a).max(0), abs(b).max(0), rtol=1e-5)


def test_two_external_superelements_make_the_whole_structure(data: Path) -> None:
    there = data / "matrices" / "superelements"
    stiffness, mass = [], []
    for name in ("inboard", "outboard"):
        K, M = stiffness_and_mass(read_matrices(there / f"{name}.op4"))
        stiffness.append(K)
        mass.append(M)
    model = model_of_matrices(stiffness, mass, read_deck(there / "inboard.asm"))
    solution = normal_modes.solve(model, n_modes=16)
    assert solution.rigid_body_modes == 6
    np.testing.assert_allclose(solution.frequencies_hz[6:], SPACE_TRUSS, rtol=5e-6)


def test_matrices_of_an_op2_say_which_degrees_of_freedom_they_are(data: Path) -> None:
    path = data / "nastran" / "solid_shell_bar" / "static_solid_shell_bar_kelm.op2"
    found = {m.name: m for m in read_matrices(path)}
    assert list(found) == ["KELM", "KGG", "MELM"]
    K = found["KGG"]
    assert K.rows is not None
    ids = sorted(read_deck(path.with_suffix(".bdf")).bulk.table("GRID"))
    np.testing.assert_array_equal(K.rows.point, np.repeat(ids, 6))
    np.testing.assert_array_equal(K.rows.component, np.tile(np.arange(1, 7), len(ids)))
    translations = K.rows.component == 1
    assert abs(K.matrix @ translations).max() < 1e-6 * abs(K.matrix).max()


def test_an_assembled_deck_exported_and_read_again_has_the_same_modes(
    data: Path, tmp_path: Path
) -> None:
    deck = read_deck(data / "cases" / "panel_spring" / "panel.bdf")
    model = build_model(deck)
    write_op4(tmp_path / "m.op4", model_matrices(model))
    K, M = stiffness_and_mass(read_matrices(tmp_path / "m.op4"))
    again = model_of_matrices([K], [M], deck)
    a, b = normal_modes.solve(model, n_modes=12), normal_modes.solve(again, n_modes=12)
    assert a.rigid_body_modes == b.rigid_body_modes
    np.testing.assert_allclose(a.frequencies_hz, b.frequencies_hz, rtol=1e-9, atol=1e-5)
    shapes = [normal_modes.modes_of(m, s).shapes[:, a.rigid_body_modes :]
              for m, s in ((model, a), (again, b))]  # fmt: skip
    np.testing.assert_allclose(abs(shapes[0]), abs(shapes[1]), atol=1e-6 * abs(shapes[0]).max())


def test_op4_takes_its_dof_map_from_the_deck(data: Path, tmp_path: Path) -> None:
    deck = read_deck(data / "cases" / "panel_spring" / "panel.bdf")
    K, M = model_matrices(build_model(deck))
    write_op4(tmp_path / "m.op4", [replace(m, rows=None, columns=None) for m in (K, M)])
    found = read_matrices(tmp_path / "m.op4", deck)
    assert K.rows is not None
    for m in found:
        assert m.rows is not None
        np.testing.assert_array_equal(m.rows.keys, np.sort(K.rows.keys))


def _matrix(name: str, A: np.ndarray, rows: DofMap | None) -> NastranMatrix:
    return NastranMatrix(name, sp.csc_matrix(A), 6, rows, rows)


THREE = DofMap(np.array([1, 2, 3]), np.array([1, 1, 1]))
CHAIN = np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 2.0]])


def test_matrices_on_different_degrees_of_freedom_are_added_over_their_union() -> None:
    first = DofMap(np.array([2, 1]), np.array([1, 1]))
    springs = _matrix("K", np.array([[1.0, -1.0], [-1.0, 1.0]]), first)
    model = model_of_matrices(
        [_matrix("K", CHAIN, THREE), springs], [_matrix("M", np.eye(3), THREE)]
    )
    expected = CHAIN + np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    np.testing.assert_array_equal(model.K().toarray(), expected)
    np.testing.assert_allclose(
        (2 * np.pi * normal_modes.solve(model, n_modes=3).frequencies_hz) ** 2,
        np.linalg.eigvalsh(expected), rtol=1e-12,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("K", "M", "why"),
    [
        (_matrix("K", CHAIN, None), _matrix("M", np.eye(3), THREE), "rows of matrix K"),
        (_matrix("K", 1j * CHAIN, THREE), _matrix("M", np.eye(3), THREE), "complex"),
        (_matrix("K", np.triu(CHAIN), THREE), _matrix("M", np.eye(3), THREE), "not symmetric"),
        (_matrix("K", CHAIN * np.nan, THREE), _matrix("M", np.eye(3), THREE), "not finite"),
    ],
)
def test_matrices_that_are_no_model_are_refused(
    K: NastranMatrix, M: NastranMatrix, why: str
) -> None:
    with pytest.raises(InputError, match=why):
        model_of_matrices([K], [M])


def test_which_matrices_are_stiffness_and_mass_must_be_clear() -> None:
    names = ("KAA", "MAA", "KGG", "MGG", "PG")
    many = [_matrix(n, CHAIN, THREE) for n in names]
    with pytest.raises(InputError, match="KAA and KGG"):
        stiffness_and_mass(many)
    assert [m.name for m in stiffness_and_mass(many, "kgg", "mgg")] == ["KGG", "MGG"]
    assert [m.name for m in stiffness_and_mass(many[:2])] == ["KAA", "MAA"]
    with pytest.raises(InputError, match="no pair"):
        stiffness_and_mass(many[4:])
    with pytest.raises(InputError, match="no square matrix KXX"):
        stiffness_and_mass(many, "KXX")
