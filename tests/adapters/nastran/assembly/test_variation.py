"""Parameters: the model at other values is the model of the deck rewritten with these values."""

import numpy as np
import pytest

from trueup.adapters.nastran import (
    build_model,
    parse_parameter,
    read_deck,
    read_deck_text,
    set_values,
    write_deck,
)
from trueup.core.errors import InputError

PLATE = """\
GRID,1,,0.,0.,0.
GRID,2,,30.,0.,2.
GRID,3,,31.,25.,0.
GRID,4,,0.,20.,1.
GRID,5,,60.,0.,0.
CQUAD4,1,1,1,2,3,4
CTRIA3,2,1,2,5,3
CBAR,3,2,1,5,0.,0.,1.
CBAR,4,3,4,3,0.,0.,1.
CROD,5,4,1,3
CELAS1,6,5,1,1
CELAS2,7,33.,2,3,4,3
CONM2,8,5,,2.5-6,0.,0.,3.
,1.-4,,2.-4,,,3.-4
CONROD,9,2,4,1,7.,11.
PSHELL,1,1,2.,1,1.1,1,0.8,2.-10
PBAR,2,1,40.,500.,300.,600.
,,,,,,,,
,0.6,0.7
PBARL,3,1,,BOX
,12.,9.,1.,0.8,1.-10
PROD,4,1,20.,30.,,1.-9
PELAS,5,12.,,,6,13.
MAT1,1,7.+4,,.3,2.7-9
"""

FIELDS = [
    "PSHELL 1 T", "PSHELL 1 12I/T**3", "PSHELL 1 TS/T", "PSHELL 1 NSM", "PBAR 2 A", "PBAR 2 I1",
    "PBAR 2 I2", "PBAR 2 J", "PBAR 2 K1", "PBARL 3 DIM1", "PBARL 3 DIM3", "PROD 4 A", "PROD 4 J",
    "PROD 4 NSM", "PELAS 5 K", "CELAS2 7 K", "CONM2 8 M", "CONM2 8 I11", "CONM2 8 X3", "CONROD 9 A",
    "MAT1 1 E", "MAT1 1 NU", "MAT1 1 RHO", "PSHELL 1 T, PBAR 2 I1, PBAR 2 I2",
]  # fmt: skip


def _close(A, B, tolerance):
    scale = np.sqrt(np.abs(B.diagonal()))
    scale[scale == 0.0] = 1.0
    difference = (A - B).toarray() / scale[:, None] / scale
    return np.abs(difference).max() < tolerance


def _rewritten(deck, specs, p, folder):
    values = {}
    for spec, factor, deck_values in p:
        values.update({f: v * factor for f, v in zip(spec.fields, deck_values, strict=True)})
    text = set_values(read_deck_text(deck.path), values)
    write_deck(text, folder)
    return read_deck(folder / deck.path.name)


@pytest.mark.parametrize("field", FIELDS)
@pytest.mark.parametrize("factor", [0.63, 1.0, 1.37])
def test_each_field_moves_the_model_as_it_would_move_the_deck(deck, tmp_path, field, factor):
    found = deck(PLATE)
    spec = parse_parameter(f"{field} [0.6, 1.4]")
    model = build_model(found, [spec])
    rewritten = _rewritten(
        found, [spec], [(spec, factor, model.parameters[0].deck_values)], tmp_path / "out"
    )
    exact = build_model(rewritten)
    p = np.array([factor])
    assert _close(model.K(p), exact.K(), 1e-6)
    assert _close(model.M(p), exact.M(), 1e-9)


def test_wide_bounds_on_a_thickness_keep_the_bending_energy(deck, tmp_path):
    found = deck(PLATE)
    spec = parse_parameter("PSHELL 1 T")
    assert (spec.lower, spec.upper) == (0.2, 5.0)
    model = build_model(found, [spec])
    for factor in (0.2, 0.21, 0.5, 4.9):
        exact = build_model(
            _rewritten(found, [spec], [(spec, factor, (2.0,))], tmp_path / f"{factor}")
        )
        K = exact.K().toarray() + 1e-9 * np.diag(exact.K().diagonal())
        error = (model.K(np.array([factor])) - exact.K()).toarray()
        worst = np.abs(np.linalg.eigvals(np.linalg.solve(K, error))).max()
        assert worst < 1e-6


def test_several_parameters_on_the_same_elements(deck, tmp_path):
    found = deck(PLATE)
    names = ["PSHELL 1 T", "MAT1 1 E", "MAT1 1 RHO", "PBAR 2 I1", "PBAR 2 A", "CONM2 8 M"]
    specs = [parse_parameter(f"{n} [0.5, 2]") for n in names]
    model = build_model(found, specs)
    p = np.array([0.52, 1.9, 0.7, 1.3, 0.6, 1.8])
    rows = zip(specs, p, [q.deck_values for q in model.parameters], strict=True)
    exact = build_model(_rewritten(found, specs, list(rows), tmp_path / "out"))
    assert _close(model.K(p), exact.K(), 1e-6)
    assert _close(model.M(p), exact.M(), 1e-9)
    assert model.parameters[0].deck_values == (2.0,)
    assert model.parameters[3].handle == ("PBAR 2 I1",)


def test_a_modulus_a_density_and_a_spring_take_one_term_each(deck):
    model = build_model(deck(PLATE), [parse_parameter("CELAS2 7 K"), parse_parameter("MAT1 1 RHO")])
    assert len(model.stiffness) == 2  # the rest, and the spring
    assert model.stiffness[1].matrix.nnz == 4
    assert len(model.mass) == 2  # what stays, and what the density makes


def test_derivatives_are_those_of_the_matrices(deck):
    model = build_model(deck(PLATE), [parse_parameter("PSHELL 1 T [0.6, 1.4]")])
    p, h = np.array([1.1]), 1e-5
    difference = (model.K(p + h) - model.K(p - h)) / (2.0 * h)
    assert _close(model.dK(0, p) + model.K(), difference + model.K(), 1e-8)


@pytest.mark.parametrize(
    ("parameter", "message"),
    [
        ("PSHELL 9 T", r"there is no PSHELL 9 in the deck; the deck has PSHELL 1"),
        ("PCOMP 9 T1", r"there is no PCOMP 9 in the deck"),
        ("MAT1 1 G", r"G is blank on MAT1 1 \(.*deck.bdf line 28\)"),
        ("PROD 4 C", r"C is blank on PROD 4"),
        ("PELAS 6 K", r"changes neither stiffness nor mass"),
        ("MAT1 1 NU [0.9, 5]", r"parameter 'MAT1 1 NU'.*MAT1 1 .*Poisson's ratio is 1.5"),
        ("PBARL 3 DIM3 [0.9, 5]", r"parameter 'PBARL 3 DIM3'.*PBARL 3 .*BOX do not fit together"),
    ],
)
def test_a_parameter_that_cannot_be(deck, parameter, message):
    with pytest.raises(InputError, match=message):
        build_model(deck(PLATE), [parse_parameter(parameter)])


def test_a_zero_cannot_be_moved(deck):
    bulk = PLATE.replace("PROD,4,1,20.,30.,,1.-9", "PROD,4,1,20.,0.")
    with pytest.raises(InputError, match="J is zero on PROD 4"):
        build_model(deck(bulk), [parse_parameter("PROD 4 J")])


def test_a_field_belongs_to_one_parameter(deck):
    specs = [parse_parameter("PBAR 2 A"), parse_parameter("both = PBAR 2 A, PBAR 2 J")]
    with pytest.raises(
        InputError, match="PBAR 2 A is moved by the parameter 'PBAR 2 A' and by 'both'"
    ):
        build_model(deck(PLATE), specs)


def test_direct_matrices_move_by_the_params_that_scale_them(tmp_path):
    """PARAM CK2 and CM2, beside an element and a matrix of damping that stay."""
    text = (
        "CEND\nK2GG = KX\nM2GG = MX\nBEGIN BULK\nGRID,1\nGRID,2,,1.\nCELAS2,1,9.,1,3,2,3\n"
        "CONM2,2,1,,.5\nPARAM,CK2,1.5\nPARAM,CM2,{}\nDMIG,KX,0,6,1,0\nDMIG,KX,1,3,,1,3,2.\n"
        "DMIG,MX,0,6,1,0\nDMIG,MX,2,3,,2,3,3.\n"
    )
    path = tmp_path / "a.bdf"
    path.write_text(text.format("1."))
    specs = [parse_parameter("PARAM CK2"), parse_parameter("scale = PARAM CM2")]
    model = build_model(read_deck(path), specs)
    np.testing.assert_allclose(model.K(np.array([2.0, 1.0])).diagonal()[[0, -1]], [15.0, 9.0])
    path.write_text(text.format("1.2"))
    heavier = build_model(read_deck(path))
    p = np.array([1.0, 1.2])
    assert abs(model.M(p) - heavier.M()).max() < 1e-12
    np.testing.assert_allclose(model.rigid_mass[-1][2, 2], 3.0)
