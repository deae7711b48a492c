"""Dashpots of a deck, and one written into it."""

from __future__ import annotations

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck, read_deck_text, write_deck
from trueup.adapters.nastran.assembly.deck_damping import free_damping
from trueup.adapters.nastran.assembly.deck_dashpots import damping_matrix
from trueup.adapters.nastran.discovery.write_effect import adopt
from trueup.core.discovery.findings import Finding, Where

GRIDS = "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nSPOINT,9\n"
BARS = "CBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,1.,1.,1.,1.\nMAT1,1,1.,,0.3,1.\nSPC1,1,123456,1\n"
CD = "CORD2R,5,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\n"
"""A system whose axes x, y, z are the basic y, z, x."""


def _dense(found) -> np.ndarray:
    return found.toarray()


def test_scalar_dampers_stand_where_their_cards_say(deck):
    D = _dense(
        damping_matrix(
            deck(
                f"{GRIDS}CDAMP2,1,3.,1,2\nCDAMP1,2,7,1,1,2,1\nPDAMP,7,5.\n"
                "CDAMP3,3,7,9\nCDAMP4,4,2.,9"
            )
        )
    )
    expected = np.zeros((13, 13))
    expected[1, 1] = 3.0
    expected[np.ix_([0, 6], [0, 6])] = 5.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    expected[12, 12] = 7.0
    np.testing.assert_allclose(D, expected)


def test_viscous_rods_and_bushings_damp_along_their_axes(deck):
    viscous = _dense(damping_matrix(deck(f"{GRIDS}CVISC,1,3,1,2\nPVISC,3,4.,6.")))
    expected = np.zeros((13, 13))
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    expected[np.ix_([0, 6], [0, 6])] = 4.0 * pair
    expected[np.ix_([3, 9], [3, 9])] = 6.0 * pair
    np.testing.assert_allclose(viscous, expected, atol=1e-12)
    bush = _dense(damping_matrix(deck(f"{GRIDS}CBUSH,1,3,2,,,,,0\nPBUSH,3,K,1.,,,,,\n,,B,,2.")))
    assert bush[7, 7] == pytest.approx(2.0)
    assert np.count_nonzero(np.abs(bush) > 1e-12) == 1


def test_displacement_systems_count(deck):
    bulk = f"{CD}GRID,1,,0.,0.,0.,5\nCDAMP2,1,3.,1,1"
    D = damping_matrix(deck(bulk))
    assert D[0, 0] == pytest.approx(3.0)
    bush = damping_matrix(deck(f"{CD}GRID,1,,0.,0.,0.,5\nCBUSH,1,3,1,,,,,0\nPBUSH,3,B,2."))
    np.testing.assert_allclose(np.diag(bush.toarray())[:3], [0.0, 0.0, 2.0], atol=1e-12)


def test_a_deck_without_dampers_has_none(deck):
    assert damping_matrix(deck(GRIDS + BARS)) is None
    assert damping_matrix(deck(f"{GRIDS}CBUSH,1,3,2,,,,,0\nPBUSH,3,K,1.")) is None


def _finding(component: int) -> Finding:
    return Finding(
        "model",
        "local_damper",
        Where(grids=(2,), xyz=(2.0, 0.0, 0.0), region="near grid 2"),
        {"damping": 0.5, "components": [component]},
        (0.4, 0.6),
        (),
        0.9,
        "A dashpot is missing.",
    )


@pytest.mark.parametrize("cd", ["", ",5"])
@pytest.mark.parametrize("component", [1, 2, 3])
def test_an_adopted_dashpot_is_read_back_in_basic_axes(tmp_path, cd, component):
    path = tmp_path / "d.bdf"
    grids = f"GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.{cd}\n"
    path.write_text(f"SOL 103\nCEND\nSPC=1\nBEGIN BULK\n{CD}{grids}{BARS}ENDDATA\n")
    done = adopt(read_deck_text(path), read_deck(path), _finding(component))
    again = read_deck(write_deck(done.deck, tmp_path / "out"))
    model = build_model(again)
    D = free_damping(again, model)
    rows = np.flatnonzero((model.dofs.node == 2) & (model.dofs.component <= 3))
    E = model.expansion[rows].toarray()
    expected = 0.5 * np.outer(E[component - 1], E[component - 1])
    np.testing.assert_allclose(D.toarray(), expected, atol=1e-12)
    assert done.cards[-1].startswith("CBUSH" if cd else "CDAMP2")
    assert b"Dampers do not enter normal modes" in done.deck.files[0].data
    unchanged = build_model(read_deck(path))
    np.testing.assert_allclose(model.K().toarray(), unchanged.K().toarray())
