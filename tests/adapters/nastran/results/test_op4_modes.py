"""Modes of OP4 files: as the analysis on all of a deck, as a test on what a list names."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

import trueup
from trueup.adapters.nastran import NastranMatrix, read_modes, write_op4
from trueup.core.errors import InputError

DUCT = Path(__file__).parents[4] / "fixtures" / "duct"


@pytest.fixture(scope="module")
def solved() -> trueup.Solved:
    return trueup.solve(DUCT / "duct.bdf", 14)


def write(path: Path, solved: trueup.Solved, rows: np.ndarray, named: str = "LAMA") -> None:
    hz = solved.shapes.frequencies_hz
    values = hz if named == "FREQS" else (2 * np.pi * hz) ** 2
    held = {"PHG": solved.shapes.shapes[rows], named: values[:, None]}
    write_op4(path, [NastranMatrix(n, sp.csc_matrix(m)) for n, m in held.items()])


@pytest.mark.parametrize("named", ["LAMA", "FREQS"])
def test_modes_of_the_whole_deck_are_the_analysis(solved, tmp_path, named):
    path = tmp_path / "phi.op4"
    write(path, solved, np.arange(len(solved.shapes.dofs)), named)
    found = read_modes(path, trueup.read_deck(DUCT / "duct.bdf"))
    np.testing.assert_allclose(found.frequencies_hz, solved.shapes.frequencies_hz, atol=1e-9)
    np.testing.assert_array_equal(found.shapes, solved.shapes.shapes)
    own = trueup.correlate(
        DUCT / "duct.bdf", DUCT / "duct_test.unv", modes=path, deck_length_unit="mm"
    )
    assert [p.analysis for p in own.pairs][:6] == [8, 7, 10, 9, 12, 11]


def test_modes_at_some_grids_are_a_test(solved, tmp_path):
    dofs = solved.shapes.dofs
    rows = np.flatnonzero((dofs.node % 40 == 7) & (dofs.component <= 3))[::-1]
    write(tmp_path / "phi.op4", solved, rows)
    with pytest.raises(InputError, match=r"not a universal file|nothing says"):
        trueup.correlate(DUCT / "duct.bdf", [tmp_path / "phi.op4", DUCT / "duct.bdf"])
    listed = [f"{dofs.node[r]}:{'XYZ'[dofs.component[r] - 1]}" for r in rows]
    (tmp_path / "phi.dofs").write_text("# rows\n" + "\n".join(listed) + "\n", encoding="utf-8")
    found = trueup.correlate(DUCT / "duct.bdf", [tmp_path / "phi.op4", DUCT / "duct.bdf"])
    assert len(found.pairs) == 8
    assert min(p.mac for p in found.pairs) > 0.999999
    with pytest.raises(InputError, match=r"lacks \d+ of the deck's degrees of freedom"):
        read_modes(tmp_path / "phi.op4", trueup.read_deck(DUCT / "duct.bdf"))
    shutil.copy(tmp_path / "phi.op4", tmp_path / "few.op4")
    (tmp_path / "few.dofs").write_text("\n".join(listed[1:]), encoding="utf-8")
    with pytest.raises(InputError, match=f"lists {len(rows) - 1} rows"):
        read_modes(tmp_path / "few.op4")
    (tmp_path / "few.dofs").write_text("7 up\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"few\.dofs line 1: a point and its component"):
        read_modes(tmp_path / "few.op4")
