"""Clamps that hold more of a plate than its deck says."""

import numpy as np
import pytest
import scipy.linalg as la

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.core.discovery.model_error.support_reach import reaches_of

DECK = """CEND
BEGIN BULK
{cards}PSHELL,1,1,3.,1,,1
MAT1,1,70000.,,0.3,2.7-9
ENDDATA
"""
LONG, WIDE = 12, 3


@pytest.fixture
def plate(tmp_path):
    """Return a plate whose first rows of grids are held by a clamp, or at a few components."""

    def held(rows, by="123456"):
        cards = ""
        for i in range(LONG + 1):
            for j in range(WIDE + 1):
                fixed = f",,{by}" if i < rows else ""
                cards += f"GRID,{1 + j + 4 * i},,{20.0 * i},{20.0 * j},0.{fixed}\n"
        for i in range(LONG):
            for j in range(WIDE):
                a = 1 + j + 4 * i
                cards += f"CQUAD4,{1 + j + WIDE * i},1,{a},{a + 1},{a + 5},{a + 4}\n"
        path = tmp_path / f"{rows}{by}.bdf"
        path.write_text(DECK.format(cards=cards))
        return build_structure(read_deck(path))

    return held


def frequencies(K, M):
    return 1.0 / np.sqrt(la.eigh(M.toarray(), K.toarray(), eigvals_only=True)[:-5:-1])


@pytest.mark.parametrize("rows", [1, 2, 3])
def test_a_clamp_that_reaches_over_rows_of_elements_holds_their_grids(plate, rows):
    drawn = plate(1)
    reaches = reaches_of(drawn)
    stiff = 1e4 * reaches.acting(rows - 1)
    longer = plate(1 + rows).model
    np.testing.assert_allclose(
        frequencies(drawn.model.K() + stiff, drawn.model.M()),
        frequencies(longer.K(), longer.M()),
        rtol=5e-3,
    )
    np.testing.assert_allclose(reaches.far, 20.0 * np.arange(len(reaches.far)))


def test_one_that_ends_within_a_row_holds_more_than_none_and_less_than_the_row(plate):
    drawn = plate(1)
    A = reaches_of(drawn).acting(0)
    first = [frequencies(drawn.model.K() + k * A, drawn.model.M())[0] for k in (0.0, 1.0, 1e4)]
    assert first[0] < first[1] < first[2]


def test_what_is_not_held_in_every_direction_is_no_clamp(plate):
    assert reaches_of(plate(1, by="3")) is None
    assert reaches_of(plate(0)) is None
