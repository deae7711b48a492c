"""What a deck says of the damping of its modes."""

from __future__ import annotations

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck
from trueup.adapters.nastran.assembly.deck_damping import modal_ratios
from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError

PLATE = """GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,1.,1.,0.
GRID,4,,0.,1.,0.
GRID,5,,2.,0.,0.
CQUAD4,1,1,1,2,3,4
CBAR,2,2,2,5,0.,1.,0.
SPC1,1,123456,1,4
"""
PBAR = "PBAR,2,2,1.-3,1.-6,2.-6,1.-6\n"
SHELL = f"PSHELL,1,1,.01,1,,1\n{PBAR}"
LAMINATE = "PCOMP,1,,,,,,{ge}\n,1,.01,0.\n" + PBAR


def mats(first: float, second: float) -> str:
    line = "MAT1,{},2.1+11,,.3,7850.,,,{}\n"
    return line.format(1, first) + line.format(2, second)


def ratios(tmp_path, bulk: str, case: str = ""):
    path = tmp_path / "d.bdf"
    path.write_text(f"SOL 103\nCEND\nSPC=1\n{case}\nBEGIN BULK\n{bulk}ENDDATA\n")
    deck = read_deck(path)
    model = build_model(deck)
    found = solve(model, 5)
    return modal_ratios(deck, model, found.frequencies_hz, found.vectors), found, model


def test_a_deck_that_says_nothing_is_not_damped(tmp_path):
    assert ratios(tmp_path, PLATE + SHELL + mats(0.0, 0.0))[0] is None


@pytest.mark.parametrize(
    "bulk", [SHELL + mats(0.06, 0.06), LAMINATE.format(ge=0.06) + mats(0.5, 0.06)]
)
def test_one_loss_factor_everywhere_is_twice_the_ratio(tmp_path, bulk):
    both = "PARAM,G,.02\nTABDMP1,7,Q\n,0.,25.,9999.,25.,ENDT\n"
    found, *_ = ratios(tmp_path, PLATE + bulk + both, "SDAMPING(STRUCTURE) = 7")
    assert found == pytest.approx(0.03 + 0.01 + 0.02)


def test_materials_and_springs_count_by_their_share_of_the_strain_energy(tmp_path):
    springs = "CELAS2,8,3.+6,5,3,,,.2\nCELAS1,9,9,5,2\nPELAS,9,1.+6,.3\nCBUSH,10,10,5,,,,,0\n"
    bulk = springs + "PBUSH,10,K,5.+5,,,,,\n,,GE,.1\n" + SHELL + mats(0.04, 0.0)
    found, modes, model = ratios(tmp_path, PLATE + bulk)
    K, X = model.K().toarray(), modes.vectors
    other = ratios(tmp_path, PLATE + bulk.replace("2.1+11", "4.2+11", 1))[2]
    plate = other.K().toarray() - K  # stiffness is linear in the modulus
    at = [int(np.flatnonzero((model.dofs.node == 5) & (model.dofs.component == c))[0])
          for c in (1, 2, 3)]  # fmt: skip
    move = (model.expansion[at] @ X) ** 2
    share = 0.04 * np.einsum("ij,ij->j", X, plate @ X)
    share += move.T @ np.array([0.1 * 5e5, 0.3 * 1e6, 0.2 * 3e6])
    assert found == pytest.approx(share / (2.0 * modes.eigenvalues))
    assert found.min() > 0.0


def test_a_bush_has_a_loss_factor_of_each_direction_and_the_first_alone_is_of_all(tmp_path):
    bush = "CBUSH,10,10,5,,,,,0\nPBUSH,10,K,5.+5,3.+5,4.+5\n,,GE,{}\n"
    bare = PLATE + SHELL + mats(0.0, 0.0)
    for said, losses in ((".1,.3,.2", (0.1, 0.3, 0.2)), ("0.,.3", (0.0, 0.3, 0.0)),
                         (".1,0.", (0.1, 0.0, 0.0)),
                         (".1", (0.1, 0.1, 0.1))):  # fmt: skip
        found, modes, model = ratios(tmp_path, bare + bush.format(said))
        at = [int(np.flatnonzero((model.dofs.node == 5) & (model.dofs.component == c))[0])
              for c in (1, 2, 3)]  # fmt: skip
        move = (model.expansion[at] @ modes.vectors) ** 2
        share = move.T @ (np.array([5e5, 3e5, 4e5]) * losses)
        assert found == pytest.approx(share / (2.0 * modes.eigenvalues), rel=1e-6, abs=1e-12)


@pytest.mark.parametrize(("kind", "at_0"), [("G", 0.01), ("CRIT", 0.02)])
def test_the_selected_table_is_read_at_each_frequency(tmp_path, kind, at_0):
    table = f"TABDMP1,3,{kind}\n,0.,.02,100.,.04,ENDT\n"
    found, modes, _ = ratios(tmp_path, PLATE + SHELL + mats(0.0, 0.0) + table, "SDAMP = 3")
    assert found == pytest.approx(at_0 * (1.0 + modes.frequencies_hz / 100.0))


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ("", "SDAMPING selects TABDMP1 3, which is not in the deck"),
        ("TABDMP1,3,FOO\n,0.,.1,1.,.1,ENDT\n", r"TABDMP1 3 .*is of type FOO, none of G, CRIT, Q"),
    ],
)
def test_a_table_that_cannot_be_read_is_said(tmp_path, table, says):
    with pytest.raises(InputError, match=says):
        ratios(tmp_path, PLATE + SHELL + mats(0.0, 0.0) + table, "SDAMPING = 3")
