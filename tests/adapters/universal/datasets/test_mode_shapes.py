"""Mode shapes of datasets 55 and 2414, real and complex, 3 and 6 values a node."""

import numpy as np
import pytest

from trueup.adapters.universal import read_universal
from trueup.core.errors import InputError

VALUES = {3: (0.1, -0.2, 0.3), 1: (1.0, 2.0, -3.5)}


def test_real_normal_mode(uff, write):
    text = uff.shape_55(VALUES, 12.5, 2.0, 0.015) + uff.shape_55(VALUES, 20.0, 0.0, 0.0, 0.04)
    modes = read_universal(write(text)).modes
    np.testing.assert_array_equal(modes.frequencies_hz, [12.5, 20.0])
    np.testing.assert_array_equal(modes.dofs.labels, ["3:X", "3:Y", "3:Z", "1:X", "1:Y", "1:Z"])
    np.testing.assert_array_equal(modes.shapes[:, 0], [0.1, -0.2, 0.3, 1.0, 2.0, -3.5])
    np.testing.assert_array_equal(modes.damping, [0.015, 0.02])  # structural is twice viscous
    np.testing.assert_array_equal(modes.generalized_mass, [2.0, np.nan])
    assert not modes.is_complex


def test_six_values_a_node(uff, write):
    values = {4: (1, 2, 3, 4, 5, 6), 5: (6, 5, 4, 3, 2, 1)}
    modes = read_universal(write(uff.shape_55(values, kind=(1, 2, 3, 8, 2, 6)))).modes
    np.testing.assert_array_equal(modes.shapes[:, 0], [1, 2, 3, 4, 5, 6, 6, 5, 4, 3, 2, 1])
    np.testing.assert_array_equal(modes.dofs.component, [1, 2, 3, 4, 5, 6] * 2)


@pytest.mark.parametrize("analysis", [3, 7])
@pytest.mark.parametrize("n", [3, 6])
def test_complex_mode_by_its_eigenvalue(uff, write, analysis, n):
    """Eigenvalue -zeta w + i w sqrt(1 - zeta^2) in rad/s: w / 2 pi and zeta come out."""
    zeta, w = 0.02, 2 * np.pi * 40.0
    pole = (-zeta * w, w * np.sqrt(1 - zeta**2))
    row = np.arange(1.0, 2 * n + 1)
    text = uff.shape_55(
        {1: row},
        kind=(1, analysis, 2 if n == 3 else 3, 8, 5, n),
        record_7=(2, 6, 1, 1),
        record_8=(*pole, 0.0, 0.0, 0.0, 0.0),
    )
    modes = read_universal(write(text)).modes
    assert modes.frequencies_hz[0] == pytest.approx(40.0, rel=1e-5)
    assert modes.damping[0] == pytest.approx(0.02, rel=1e-5)
    np.testing.assert_array_equal(modes.shapes[:, 0], row[0::2] + 1j * row[1::2])


def test_complex_data_of_a_normal_mode(uff, write):
    text = uff.shape_55({1: (1, 2, 3, 4, 5, 6)}, 5.0, 3.0, 0.1, kind=(1, 2, 2, 8, 5, 3))
    modes = read_universal(write(text)).modes
    assert (modes.frequencies_hz[0], modes.generalized_mass[0], modes.damping[0]) == (5, 3, 0.1)
    np.testing.assert_array_equal(modes.shapes[:, 0], [1 + 2j, 3 + 4j, 5 + 6j])


def test_zero_and_placeholder_mass_and_damping_are_unknown_not_zero(uff, write):
    text = uff.shape_55(VALUES, mass=0.0, viscous=0.0)
    text += uff.shape_55(VALUES, record_8=(1.0, 1.7977e308, 0.0, 0.0))
    modes = read_universal(write(text)).modes
    assert np.isnan(modes.damping).all()
    assert np.isnan(modes.generalized_mass).all()


def shape_2414(uff, values, place=1, analysis=2, reals=(0.0, 7.5, 0.0, 2.0, 0.01, 0.0)):
    lines = [f"{1:10d}", "Modes", f"{place:10d}", *["NONE"] * 5]
    lines += ["".join(f"{k:10d}" for k in (1, analysis, 2, 8, 2, 3))]
    lines += ["".join(f"{k:10d}" for k in (0, 0, 1, 0, 0, 1, 0, 0)), f"{0:10d}{0:10d}"]
    lines += ["".join(f"{v:13.5E}" for v in reals), "".join(f"{v:13.5E}" for v in [0.0] * 6)]
    for node, row in values.items():
        lines += [f"{node:10d}", "".join(f"{v:13.5E}" for v in row)]
    return uff.dataset(2414, *lines)


def test_2414(uff, write):
    modes = read_universal(write(shape_2414(uff, VALUES))).modes
    assert (modes.frequencies_hz[0], modes.generalized_mass[0], modes.damping[0]) == (7.5, 2, 0.01)
    np.testing.assert_array_equal(modes.shapes[:3, 0], VALUES[3])


def test_2414_by_its_eigenvalue(uff, write):
    w2 = (2 * np.pi * 3.0) ** 2
    text = shape_2414(uff, VALUES, reals=(0.0, 0.0, w2, 0.0, 0.0, 0.0))
    assert read_universal(write(text)).modes.frequencies_hz[0] == pytest.approx(3.0, rel=1e-5)


def test_results_that_are_no_mode_shapes_are_listed(uff, write):
    text = uff.shape_55(VALUES, kind=(1, 5, 2, 8, 2, 3), record_7=(2, 1, 1, 1), record_8=(9.0,))
    text += uff.shape_55({1: (1.0,)}, kind=(1, 2, 1, 5, 2, 1))
    text += shape_2414(uff, VALUES, place=2)
    content = read_universal(write(text))
    assert content.modes is None
    assert [(s.what, s.why) for s in content.skipped] == [
        ("dataset 55", "frequency response results are no modes"),
        ("dataset 55", "specific data type 5 is no motion"),
        ("dataset 2414", "data not at nodes"),
    ]
    assert [s.line for s in content.skipped] == [2, 17, 30]


def test_nodes_missing_in_some_modes_are_left_out_and_told(uff, write):
    text = uff.shape_55({1: (1, 1, 1), 2: (2, 2, 2)}) + uff.shape_55({2: (5, 5, 5), 9: (1, 0, 0)})
    content = read_universal(write(text))
    np.testing.assert_array_equal(content.modes.shapes, [[2, 5]] * 3)
    assert "node(s) 1, 9 are missing in some modes" in content.warnings[0]


def test_order_of_nodes_may_differ(uff, write):
    text = uff.shape_55({1: (1, 2, 3), 2: (4, 5, 6)}) + uff.shape_55(
        {2: (40, 50, 60), 1: (10, 20, 30)}
    )
    modes = read_universal(write(text)).modes
    np.testing.assert_array_equal(modes.shapes[:, 1], 10 * modes.shapes[:, 0])


def test_only_some_modes(uff, write):
    text = "".join(uff.shape_55(VALUES, f) for f in (1.0, 2.0, 3.0, 4.0))
    content = read_universal(write(text), modes=(2, 4))
    np.testing.assert_array_equal(content.modes.frequencies_hz, [2, 4])
    assert content.skipped == ()
    assert len(content.datasets) == 4


GLUED = """    -1
    55   %VALEURS AUX NOEUDS
ASTER
NONE
NONE
NONE
NONE
         1         2         3         8         2         6
         2         4         1         1
  0.26690E+00  0.17977+309  0.00000E+00  0.00000E+00
      1011     % NOEUD NO1011
-1.37933E-001 7.39432E-007 3.38287E-001-2.00000E+000 0.00000E+000 0.00000D+000
    -1
"""


def test_as_code_aster_writes_it(write):
    modes = read_universal(write(GLUED)).modes
    np.testing.assert_array_equal(modes.shapes[:, 0], [-0.137933, 7.39432e-7, 0.338287, -2, 0, 0])
    assert np.isnan(modes.generalized_mass[0])


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("-3.50000E+00", "         NaN", "line 14: .*not a finite number at node 1"),
        ("-3.50000E+00", "************", "line 14: .*'\\*+' is not a number; remove node 1"),
        ("-3.50000E+00", "            ", "line 14: .*node 1 does not have 3 values"),
        ("         1\n", "         x\n", "line 13: .*node number is expected, found 'x'"),
        ("         1\n", "         3\n", "gives node 3 twice"),
        ("  1.00000E+01", "          NaN", "the frequency is not a number"),
        ("         2         4         1         1", "         2", "line 9: .*2 integers"),
    ],
)
def test_damage_is_one_sentence_with_its_line(uff, write, old, new, said):
    text = uff.shape_55(VALUES)
    head, found, tail = text.rpartition(old)
    assert found
    with pytest.raises(InputError, match=said):
        read_universal(write(head + new + tail))


def test_a_file_cut_anywhere_in_a_mode_keeps_the_modes_before(uff, write):
    text = uff.shape_55(VALUES, 1.0) + uff.shape_55(VALUES, 2.0)
    second = len(text) // 2
    for cut in range(second + 15, len(text) - 5, 7):
        content = read_universal(write(text[:cut]))
        assert content.modes.frequencies_hz.tolist() == [1.0]
        (listed,) = content.skipped
        assert "cut off" in listed.why
        assert listed.line == text[:second].count("\n") + 2


def test_a_file_cut_anywhere_in_its_only_mode_is_refused(uff, write):
    text = uff.shape_55(VALUES, 1.0)
    for cut in range(15, len(text) - 5, 7):
        with pytest.raises(InputError, match="cut off"):
            read_universal(write(text[:cut]))


def test_a_line_lost_from_a_mode_is_refused(uff, write):
    lines = uff.shape_55(VALUES).split("\n")
    for k in range(10, 14):
        with pytest.raises(InputError, match=r"test\.unv line"):
            read_universal(write("\n".join(lines[:k] + lines[k + 1 :])))
