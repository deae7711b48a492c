"""A deck reduced to a boundary and component modes."""

from pathlib import Path

import numpy as np
import pytest

import trueup
from trueup.adapters.nastran import (
    build_model,
    craig_bampton,
    model_of_matrices,
    read_deck,
    read_matrices,
    stiffness_and_mass,
)
from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError

BEAM = "".join(f"GRID,{k},,{0.1 * k}\n" for k in range(1, 12))
BEAM += "".join(f"CBAR,{k},1,{k},{k + 1},0.,1.,0.\n" for k in range(1, 11))
BEAM += "PBAR,1,1,1.E-4,1.E-9,2.E-9,2.E-9\nMAT1,1,2.+11,,.3,7800.\n"


@pytest.fixture
def deck(tmp_path):
    path = tmp_path / "beam.bdf"
    path.write_text("BEGIN BULK\n" + BEAM + "ENDDATA\n")
    return read_deck(path)


def test_reduced_beam_has_the_frequencies_of_the_whole_one(deck):
    """With all modes of the inside it is the whole; with four, the first three nearly."""
    whole = solve(build_model(deck), 15).frequencies_hz
    every = craig_bampton(deck, "1, 11:123456", 27)
    np.testing.assert_allclose(solve(every, 15).frequencies_hz[6:], whole[6:], rtol=1e-9)
    few = craig_bampton(deck, "1, 11", 4)
    assert few.n_free == 16
    assert few.free_labels[-1] == "15:0"
    off = solve(few, 9).frequencies_hz[6:] / whole[6:9] - 1.0
    assert (off > -1e-9).all()
    assert 1e-6 < off.max() < 5e-3
    assert any("frequencies of the reduced model" in w for w in few.warnings)


def test_modes_above_a_frequency_are_left_out(deck):
    """Clamped at both ends, omega = 4.73**2 sqrt(E I / rho A) for a length of one."""
    first = 4.73004**2 * np.sqrt(2e11 * 1e-9 / (7800.0 * 1e-4)) / (2.0 * np.pi)
    few = craig_bampton(deck, "1-1 11", 27, fmax=1.02 * first)
    assert few.n_free == 12 + 1


def test_what_is_written_is_what_is_read(deck, tmp_path):
    expected = craig_bampton(deck, "1, 11", 6)
    for name in ("cb.op4", "cb.pch"):
        told = trueup.convert(deck.path, tmp_path / name, boundary="1, 11", modes=6)
        assert told.written == {"matrices": "KAA 18 x 18, MAA 18 x 18"}
        assert any("component modes" in w for w in told.warnings)
        model = model_of_matrices(
            *([m] for m in stiffness_and_mass(read_matrices(tmp_path / name)))
        )
        assert model.free_labels == expected.free_labels
        for ours, theirs in ((model.K(), expected.K()), (model.M(), expected.M())):
            np.testing.assert_allclose(
                ours.toarray(), theirs.toarray(), rtol=1e-7, atol=1e-7 * abs(theirs).max()
            )


@pytest.mark.parametrize(
    ("boundary", "sentence"),
    [
        ("1;2", "'1;2' is none of 11"),
        ("99", "there is no grid 99"),
        ("1:7", "'1:7' is none of"),
    ],
)
def test_a_boundary_that_is_none_is_refused(deck, boundary, sentence):
    with pytest.raises(InputError, match=sentence):
        craig_bampton(deck, boundary)


def test_a_deck_that_is_reduced_is_refused(tmp_path):
    path = tmp_path / "reduced.bdf"
    path.write_text("BEGIN BULK\n" + BEAM + "ASET1,123456,1,5\nENDDATA\n")
    with pytest.raises(InputError, match=r"a reduction of its own \(ASET1\)"):
        craig_bampton(read_deck(path), "1")
    with pytest.raises(InputError, match="give 1 or more"):
        trueup.convert(path, tmp_path / "cb.op4", boundary="1", modes=0)


def test_an_external_superelement_is_made_as_nx_makes_it(deck, tmp_path):
    """Boundary stiffness and mass of a free truss beside NX 9.1; all six rigid motions are free."""
    data = Path(__file__).parents[5] / "shared" / "data"
    if not data.is_dir():
        pytest.skip("no shared data beside the repository")
    (tmp_path / "part.dat").write_text(
        "SOL 103\nINCLUDE 'some.dmap'\nCEND\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,50.\n"
        "BSET1,123456,3,11,19,27\nSPOINT,101,THRU,108\nQSET1,,101,THRU,108\n"
        f"INCLUDE '{data / 'nastran/space_truss/inboard.blk'}'\nENDDATA\n"
    )
    model = build_model(read_deck(tmp_path / "part.dat"))
    by_nx = {m.name: m.matrix for m in read_matrices(data / "matrices/superelements/inboard.op4")}
    for mine, name in ((model.K(), "KXX"), (model.M(), "MXX")):
        A, B = np.asarray(mine.todense())[:24, :24], np.asarray(by_nx[name].todense())[:24, :24]
        np.testing.assert_allclose(A, B, atol=1e-9 * abs(B).max())
    found = solve(model, 12)
    assert found.rigid_body_modes == 6
    assert found.frequencies_hz[6] > 50.0
