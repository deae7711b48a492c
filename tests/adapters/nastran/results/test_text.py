"""Modes from punch and F06: the last resort."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from trueup.adapters.nastran import describe_results, read_deck, read_modes
from trueup.core.errors import InputError

ROOT = Path(__file__).resolve().parents[4]
DATA = ROOT.parent / "shared" / "data" / "nastran"

needs_data = pytest.mark.skipif(not DATA.is_dir(), reason=f"no shared data beside {ROOT.name}")

PAIRS = {
    "svanberg_beam/modes.f06": "svanberg_beam/modes.op2",
    "solid_shell_bar/mode_solid_shell_bar.f06": "solid_shell_bar/mode_solid_shell_bar.op2",
    "cantilever/noreduction.f06": "cantilever/noReduction.h5",
    "cantilever/dynamicreduction.f06": "cantilever/dynamicReduction.h5",
}


@needs_data
@pytest.mark.parametrize(("f06", "binary"), PAIRS.items())
def test_an_f06_holds_the_modes_of_the_binary_file(f06: str, binary: str) -> None:
    a, b = read_modes(DATA / f06), read_modes(DATA / binary)
    assert a.dofs.labels == b.dofs.labels
    np.testing.assert_allclose(a.frequencies_hz, b.frequencies_hz, rtol=1e-6)
    scale = abs(b.shapes).max(axis=0)
    assert (abs(a.shapes - b.shapes) / scale).max() < 2e-6
    if binary.endswith(".h5"):  # the OP2 files have no summary of the eigenvalues
        np.testing.assert_allclose(a.generalized_mass, b.generalized_mass, rtol=2e-6)


@pytest.mark.parametrize(
    "banner",
    ["* *   N A S T R A N   * *", "* *   M S C   N a s t r a n   * *", "a page cut off"],
)
def test_an_f06_is_known_by_its_banner_or_by_its_name(tmp_path: Path, banner: str) -> None:
    (tmp_path / "a.f06").write_text(f"1\n   {banner}\n   FLUTTER  SUMMARY\n")
    assert describe_results(tmp_path / "a.f06")["format"] == "Nastran F06"
    with pytest.raises(InputError, match="holds no eigenvectors"):
        read_modes(tmp_path / "a.f06")


@needs_data
def test_an_f06_without_eigenvectors_says_so() -> None:
    told = describe_results(DATA / "ten_bar" / "modes.f06")
    assert told["format"] == "Nastran F06"
    assert told["contents"] == {"modes": [], "tables": ["real eigenvalues"]}
    with pytest.raises(InputError, match="holds no eigenvectors"):
        read_modes(DATA / "ten_bar" / "modes.f06")


def _head(number: int, eigenvalue: str, output: str = "$REAL OUTPUT", subcase: int = 1) -> str:
    lines = (
        "$TITLE   = TWO GRIDS AND A SCALAR POINT", "$SUBTITLE=", "$LABEL   =", "$EIGENVECTOR",
        output, f"$SUBCASE ID = {subcase:11d}", f"$EIGENVALUE = {eigenvalue}  MODE = {number:5d}",
    )  # fmt: skip
    return "".join(f"{line:<72}{k:8d}\n" for k, line in enumerate(lines, 1))


def _rows(point: int, kind: str, *values: float) -> str:
    text = ""
    for k in range(0, len(values), 3):
        start = f"{point:10d}{kind:>8}" if k == 0 else f"{'-CONT-':<18}"
        text += f"{start}{''.join(f'{v:18.6E}' for v in values[k : k + 3]):<54}{k:8d}\n"
    return text


def test_punched_real_eigenvectors(tmp_path: Path) -> None:
    path = tmp_path / "a.pch"
    path.write_text(
        _head(1, f"{(2 * np.pi * 5) ** 2:15.7E}")
        + _rows(7, "G", 1, 2, 3, 4, 5, 6) + _rows(9, "G", 0, -1, 0, 0, 0, 0.5) + _rows(20, "S", 8)
        + _head(2, f"{(2 * np.pi * 9) ** 2:15.7E}")
        + _rows(7, "G", 6, 5, 4, 3, 2, 1) + _rows(9, "G", 1, 1, 1, 0, 0, 0) + _rows(20, "S", -8)
    )  # fmt: skip
    modes = read_modes(path)
    np.testing.assert_allclose(modes.frequencies_hz, [5.0, 9.0], rtol=1e-6)
    np.testing.assert_array_equal(modes.shapes[:, 0], [1, 2, 3, 4, 5, 6, 0, -1, 0, 0, 0, 0.5, 8])
    np.testing.assert_array_equal(modes.shapes[:, 1], [6, 5, 4, 3, 2, 1, 1, 1, 1, 0, 0, 0, -8])
    np.testing.assert_array_equal(modes.dofs.node, [7] * 6 + [9] * 6 + [20])
    assert not modes.is_complex


def test_punched_complex_eigenvectors(tmp_path: Path) -> None:
    root = 2 * np.pi * 10 * (-0.02 + 1j * np.sqrt(1 - 0.02**2))
    path = tmp_path / "a.pch"
    text = _head(1, f"{root.real:15.7E} {root.imag:15.7E}", "$REAL-IMAGINARY OUTPUT")
    path.write_text(text + _rows(3, "G", 1, 2, 3, 4, 5, 6, -1, -2, -3, -4, -5, -6))
    modes = read_modes(path)
    np.testing.assert_allclose(modes.frequencies_hz, [10.0], rtol=1e-6)
    np.testing.assert_allclose(modes.damping, [0.02], rtol=1e-5)
    np.testing.assert_array_equal(modes.shapes[:, 0], np.arange(1, 7) * (1 - 1j))


def test_punched_modes_of_two_subcases_must_be_told_apart(tmp_path: Path) -> None:
    path = tmp_path / "a.pch"
    path.write_text(
        _head(1, "1.0E+02") + _rows(3, "G", *[1] * 6)
        + _head(1, "4.0E+02", subcase=2) + _rows(3, "G", *[2] * 6)
    )  # fmt: skip
    with pytest.raises(InputError, match="subcases 1, 2"):
        read_modes(path)
    assert read_modes(path, subcase=2).shapes[0, 0] == 2.0


@pytest.mark.parametrize(
    ("body", "why"),
    [
        (
            _rows(3, "G", *[1] * 6) + _head(2, "2.0E+02") + _rows(4, "G", *[1] * 6),
            "different points",
        ),
        (_rows(3, "G", *[1] * 6).replace("1.000000E+00", "1.00000xE+00", 1), "line 8"),
    ],
)
def test_damaged_punch_files_are_one_sentence(tmp_path: Path, body: str, why: str) -> None:
    path = tmp_path / "a.pch"
    path.write_text(_head(1, "1.0E+02") + body)
    with pytest.raises(InputError, match=why):
        read_modes(path)


@needs_data
def test_an_f06_whose_row_is_damaged_names_the_line(tmp_path: Path) -> None:
    text = (DATA / "svanberg_beam" / "modes.f06").read_text("latin-1").splitlines()
    at = next(k for k, x in enumerate(text) if "E I G E N V E C T O R" in x) + 4
    assert " G " in text[at]
    text[at] = text[at].replace("E-", "X-").replace("0.0", "0.x", 1)
    (tmp_path / "a.f06").write_text("\n".join(text))
    with pytest.raises(InputError, match=f"line {at + 1}"):
        read_modes(tmp_path / "a.f06")


@needs_data
def test_an_f06_in_axes_of_its_grids_is_turned_by_the_deck() -> None:
    there = DATA / "solid_shell_bar"
    deck = read_deck(there / "mode_solid_shell_bar.bdf")
    a = read_modes(there / "mode_solid_shell_bar.f06", deck)
    b = read_modes(there / "mode_solid_shell_bar.op2", deck)
    assert abs(a.shapes - b.shapes).max() < 2e-6 * abs(b.shapes).max()


@pytest.mark.parametrize("polar", [False, True])
def test_complex_eigenvectors_of_an_f06(tmp_path: Path, polar: bool) -> None:
    """Two lines a grid: real and imaginary parts, or magnitudes and phases."""
    rng = np.random.default_rng(9)
    zeta, omega = 0.02, 2 * np.pi * np.array([8.0, 21.0])
    root = omega * (-zeta + 1j * np.sqrt(1 - zeta**2))
    shapes = rng.normal(size=(2, 3, 6)) + 1j * rng.normal(size=(2, 3, 6))
    lines = ["1 N A S T R A N"]
    for k, (value, shape) in enumerate(zip(root, shapes, strict=True), 1):
        kind = "(MAGNITUDE/PHASE)" if polar else "(REAL/IMAGINARY)"
        lines += [
            "1    TITLE                                                          PAGE",
            f"0{'':60}SUBCASE 1",
            f"0     COMPLEX EIGENVALUE = {value.real:13.6E}, {value.imag:13.6E}",
            f"{'':30}C O M P L E X   E I G E N V E C T O R   NO. {k:10d}",
            f"{'':50}{kind}",
            " ",
            "      POINT ID.   TYPE          T1             T2             T3",
        ]
        for grid, row in zip((4, 7, 90), shape, strict=True):
            first, second = (
                (np.abs(row), np.angle(row, deg=True)) if polar else (row.real, row.imag)
            )
            lines.append(f"0{grid:13d} {'G':>6}     " + "  ".join(f"{v:13.6E}" for v in first))
            lines.append(f" {'':13} {'':>6}     " + "  ".join(f"{v:13.6E}" for v in second))
    path = tmp_path / "a.f06"
    path.write_text("\n".join(lines) + "\n")
    modes = read_modes(path)
    np.testing.assert_allclose(modes.frequencies_hz, [8.0, 21.0], rtol=1e-6)
    np.testing.assert_allclose(modes.damping, zeta, rtol=1e-5)
    np.testing.assert_allclose(modes.shapes, shapes.reshape(2, -1).T, atol=1e-5)
    assert modes.dofs.node[::6].tolist() == [4, 7, 90]
    assert describe_results(path)["skipped"] == []
