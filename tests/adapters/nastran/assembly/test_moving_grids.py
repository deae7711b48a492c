"""Positions of grids as parameters: as the deck with moved grids, of the elements that follow."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.linalg

import trueup
from trueup.adapters.nastran import build_model, read_deck, set_values
from trueup.adapters.nastran.assembly.build_model import assemble
from trueup.adapters.nastran.assembly.wide_parameters import parameters_of
from trueup.adapters.nastran.fields.parameter_references import moved
from trueup.core.errors import InputError

L, A, BENDING, E, RHO = 1.0, 1e-4, 1e-9, 7e10, 2700.0
HEAD = "SOL 103\nCEND\nSPC = 1\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,,5\nSPC1,1,123456,1\n"


def beam(folder: Path, length: float = L, more: str = "") -> Path:
    n = 16
    rows = [f"GRID,{k + 1},,{length * k / n:.9f},0.,0.,,345" for k in range(n + 1)]
    rows += [f"CBAR,{k + 1},1,{k + 1},{k + 2},0.,1.,0." for k in range(n)]
    rows += [f"PBAR,1,1,{A},{BENDING},2.-9,1.-9", f"MAT1,1,{E},,.3,{RHO}", "PARAM,COUPMASS,1", more]
    path = folder / f"beam_{length:g}.bdf"
    path.write_text(HEAD + "\n".join(rows) + "\nENDDATA\n")
    return path


def shell(folder: Path, more: str = "") -> Path:
    """A curved panel with a bar that its neighbour's grid orients, and a mass off its grid."""
    rows = []
    for j in range(5):
        for i in range(7):
            angle = 0.15 * i
            rows.append(
                f"GRID,{1 + i + 7 * j},,{np.sin(angle):.6f},{0.2 * j + 0.1:.6f},{np.cos(angle):.6f}"
            )
    for j in range(4):
        for i in range(6):
            g = 1 + i + 7 * j
            rows.append(f"CQUAD4,{1 + i + 6 * j},1,{g},{g + 1},{g + 8},{g + 7}")
    rows += ["CBAR,900,9,9,10,17", "PBAR,9,1,1.-4,1.-8,2.-8,1.-8", "CONM2,901,10,,2.,,,.01"]
    rows += ["PSHELL,1,1,.004,1,,1", f"MAT1,1,{E},,.3,{RHO}", "SPC1,1,123456,1,THRU,7", more]
    path = folder / "shell.bdf"
    path.write_text(HEAD + "\n".join(rows) + "\nENDDATA\n")
    return path


def eigenvalues(K, M, n: int = 6) -> np.ndarray:
    """The lowest, of matrices of which the mass may be singular."""
    size = K.shape[0]
    largest = scipy.linalg.eigh(
        M.toarray(), K.toarray(), eigvals_only=True, subset_by_index=[size - n, size - 1]
    )
    return 1.0 / largest[::-1]


@pytest.mark.parametrize(
    ("beside", "factors"),
    [("PSHELL 1 T [0.7, 1.4]", (1.03, 1.2)), ("GRID 34:35 X2 [=0.8, =1.0]", (0.97, 1.05))],
)
def test_a_model_is_that_of_the_deck_with_moved_grids(
    tmp_path: Path, beside: str, factors: tuple[float, float]
):
    """Shared normals, a bar that a moved grid orients and a mass beside it included."""
    deck = read_deck(shell(tmp_path))
    _, specs = parameters_of(deck, ["GRID 17 X3 [0.95, 1.05]", beside])
    model = build_model(deck, specs)
    p = np.array(factors)
    text = set_values(deck.text, moved(specs, model.parameters, p))
    again = build_model(read_deck(text))
    own, other = (eigenvalues(m.K(f), m.M(f)) for m, f in ((model, p), (again, np.ones(0))))
    np.testing.assert_allclose(own, other, rtol=1e-6)
    assert np.abs(own / eigenvalues(model.K(np.ones(2)), model.M(np.ones(2))) - 1.0).max() > 1e-4


def test_dashpots_and_loss_factors_follow(tmp_path: Path):
    path = shell(tmp_path, "PVISC,77,5.,1.\nCVISC,950,77,17,18")
    path.write_text(path.read_text().replace(f".3,{RHO}", f".3,{RHO},,,0.02"))
    deck = read_deck(path)
    _, specs = parameters_of(deck, ["GRID 17 X3 [0.95, 1.05]"])
    model = build_model(deck, specs, damped=True)
    p = np.array([1.04])
    text = set_values(deck.text, moved(specs, model.parameters, p))
    again = build_model(read_deck(text), damped=True)

    def total(terms, p: np.ndarray) -> np.ndarray:
        return sum(t.coefficient(p) * t.matrix for t in terms).toarray()

    for name in ("loss", "damping"):
        own, other = total(getattr(model, name), p), total(getattr(again, name), np.ones(0))
        assert np.abs(own - other).max() < 1e-7 * np.abs(other).max()
        before = total(getattr(model, name), np.ones(1))
        assert np.abs(before - other).max() > 0.05 * np.abs(other).max()


def test_only_elements_that_change_follow(tmp_path: Path):
    """Those at the grid, those that share a normal there, and the bar that it orients."""
    deck = read_deck(shell(tmp_path))
    _, specs = parameters_of(deck, ["GRID 17 X3 [0.95, 1.05]"])
    groups = assemble(deck, specs).structure.groups
    follow = {
        (g.card, int(i))
        for g in groups
        for i, k in zip(g.ids, g.source_of, strict=True)
        if ("GRID", 17) in g.sources[k]
    }
    at = {("CQUAD4", e) for e in (8, 9, 14, 15)}
    assert at < follow
    assert ("CBAR", 900) in follow
    shared = {("CQUAD4", 1 + i + 6 * j) for j in range(4) for i in range(4)}
    assert follow - {("CBAR", 900)} <= shared
    assert sum(len(g.ids) for g in groups) == 26


def test_a_beam_of_another_length_is_the_closed_form(tmp_path: Path):
    deck = read_deck(beam(tmp_path))
    _, specs = parameters_of(deck, ["GRID * X1 [0.7, 1.4]"])
    model = build_model(deck, specs)
    for factor in (0.75, 1.0, 1.3):
        lowest = eigenvalues(model.K(np.array([factor])), model.M(np.array([factor])), 2)[0]
        assert np.sqrt(lowest) == pytest.approx(
            1.8751041**2 * np.sqrt(E * BENDING / (RHO * A)) / (factor * L) ** 2, rel=2e-5
        )


def test_an_update_writes_the_length_to_the_grids(tmp_path: Path):
    truth = 1.04
    trueup.solve(beam(tmp_path, truth * L), 5).save(tmp_path / "solved")
    trueup.convert([tmp_path / "solved" / "result.h5"], tmp_path / "test.unv")
    done = trueup.update(
        beam(tmp_path), tmp_path / "test.unv", ["length = GRID * X1 [0.9, 1.1]"],
        residuals="frequencies", deck_length_unit="m", regularisation=0.0,
    )  # fmt: skip
    assert done.parameters[0].factor == pytest.approx(truth, rel=1e-4)
    done.deck.write(tmp_path / "out")
    grids = read_deck(tmp_path / "out" / "beam_1.bdf").bulk.table("GRID")
    x = np.array([grid.xyz[0] for grid in grids.values()])
    np.testing.assert_allclose(x, truth * np.linspace(0.0, L, 17), rtol=2e-4)
    assert done.after.summary.worst_deviation_percent < 0.02


@pytest.mark.parametrize(
    ("more", "what"),
    [
        ("RBE2,70,9,123456,17", "a rigid element changes"),
        ("CORD1R,5,1,2,17", "a coordinate system turns"),
    ],
)
def test_what_elements_do_not_tell_is_refused(tmp_path: Path, more: str, what: str):
    deck = read_deck(shell(tmp_path, more))
    _, specs = parameters_of(deck, ["GRID 17 X3 [0.95, 1.05]"])
    with pytest.raises(InputError, match=rf"\(17\) {what} as they move"):
        build_model(deck, specs)


def test_how_far_has_to_be_said(tmp_path: Path):
    deck = read_deck(shell(tmp_path))
    _, specs = parameters_of(deck, ["GRID 17 X3"])
    with pytest.raises(InputError, match=r"say how far GRID 17 X3 may move, such as 'GRID 17 X3"):
        build_model(deck, specs)


def test_a_moved_mass_is_not_weighed(tmp_path: Path):
    path = beam(tmp_path)
    trueup.solve(path, 5).save(tmp_path / "solved")
    with pytest.raises(InputError, match="the model does not tell its mass"):
        trueup.update(
            path, tmp_path / "solved" / "result.h5", ["GRID * X1 [0.9, 1.1]"],
            residuals="frequencies, mass", measured_mass=1.0, deck_length_unit="m",
        )  # fmt: skip
