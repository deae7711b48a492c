"""Offsets and thicknesses of single elements as parameters: as the rewritten deck has them."""

from __future__ import annotations

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, parse_parameter, read_deck, set_values
from trueup.adapters.nastran.assembly.candidate_parameters import properties_of
from trueup.adapters.nastran.assembly.wide_parameters import parameters_of
from trueup.adapters.nastran.fields.parameter_references import moved
from trueup.core.errors import InputError

DECK = """\
SOL 103
CEND
SPC = 1
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,1.,1.,0.
GRID,4,,0.,1.,0.
GRID,5,,2.,0.,0.
GRID,6,,2.,1.,0.
CQUAD4,101,1,1,2,3,4,,0.05
CQUAD4,102,1,2,5,6,3,,-0.03
,,0,0.02,0.02,,0.03
CTRIA3,103,1,1,2,3,,0.02
CBAR,201,11,1,2,0.,0.,1.
,,,0.,0.1,0.2,0.,0.1,0.2
CBAR,202,11,2,5,0.,0.,1.
CBEAM,203,12,3,6,0.,0.,1.
,,,0.3,0.,0.1,0.,0.,0.1
PSHELL,1,1,0.02,1,,1
PBAR,11,1,.01,1.-5,2.-5,3.-5
PBEAM,12,1,.01,1.-5,2.-5,,3.-5
MAT1,1,7.+10,,0.3,2700.
SPC1,1,123456,1,4
ENDDATA
"""


@pytest.fixture
def deck(tmp_path):
    path = tmp_path / "plate.bdf"
    path.write_text(DECK)
    return read_deck(path)


@pytest.mark.parametrize(
    "text",
    [
        "CQUAD4 101 ZOFFS",
        "CQUAD4 102 ZOFFS",
        "CQUAD4 101:102 ZOFFS",
        "CTRIA3 * ZOFFS",
        "CQUAD4 102 T1, CQUAD4 102 T2",
        "CBAR 201 W3A, CBAR 201 W3B",
        "CBAR 201 W2A",
        "CBEAM 203 W1A [0.2, 2]",
    ],
)
def test_a_value_of_an_element_moves_as_in_the_rewritten_deck(deck, text, tmp_path):
    _, (spec,) = parameters_of(deck, [text])
    model = build_model(deck, [spec])
    for factor in (0.3, 1.7):
        text = set_values(deck.text, moved([spec], model.parameters, [factor]))
        path = tmp_path / "moved.bdf"
        path.write_bytes(text.files[0].data)
        own = build_model(read_deck(path))
        for found, known in ((model.K, own.K), (model.M, own.M)):
            off = abs(found(np.array([factor])) - known()).max()
            assert off <= 2e-6 * abs(known()).max()
    changed = abs(model.K(np.array([1.7])) - model.K()).max()
    assert changed > 1e-5 * abs(model.K()).max()


def test_an_offset_moves_beside_the_property(deck):
    """Thickness, offset and a bar's offset in one model: no term of one lacks the others."""
    specs = [parse_parameter(t) for t in ("PSHELL 1 T", "CQUAD4 101 ZOFFS", "CBAR 201 W3A")]
    model = build_model(deck, specs)
    alone = [build_model(deck, [s]) for s in specs]
    for k, one in enumerate(alone):
        p = np.ones(3)
        p[k] = 1.4
        off = abs(model.K(p) - one.K(np.array([1.4]))).max()
        assert off < 2e-6 * abs(model.K()).max()


def test_elements_are_not_listed_among_the_properties(deck):
    assert not {"CQUAD4", "CBAR"} & {row.card for row in properties_of(deck)}


def test_an_offset_that_is_not_there_cannot_move(deck):
    with pytest.raises(InputError, match="W3A is blank on CBAR 202"):
        build_model(deck, [parse_parameter("CBAR 202 W3A")])
