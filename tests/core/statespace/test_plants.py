"""Modal plants beside the matrices that they are made of."""

from __future__ import annotations

import numpy as np
import pytest
from tests.core.chains import chain, scalar_model

from trueup.core.data.modes import Modes
from trueup.core.errors import InputError
from trueup.core.statespace.build_plant import ModalBasis, basis_of_model, basis_of_modes
from trueup.core.statespace.channels import read_channels, rows_of
from trueup.core.statespace.damping_choice import choose_damping, read_damping
from trueup.core.statespace.modal_plant import ModalPlant

N = 40
INTO = read_channels("1:X,17:X", "input")
OUT = read_channels("1:X,17:X:vel,33:X:acc", "output")
RATIO = 0.02


def basis(ground: float, **options: object) -> ModalBasis:
    model = scalar_model(*chain(N, k=4e4, ground=ground))
    rows = rows_of(INTO, model.dofs, "it"), rows_of(OUT, model.dofs, "it")
    return basis_of_model(model, INTO, OUT, *rows, **options)  # type: ignore[arg-type]


def plant(ground: float, **options: object) -> ModalPlant:
    made = basis(ground, **options)
    return made.plant(np.full(len(made.frequencies_hz), RATIO), INTO, OUT)


def direct(hz: np.ndarray, ground: float) -> np.ndarray:
    """Responses by all modes, of numpy's own eigenvectors."""
    K = chain(N, k=4e4, ground=ground)[0].toarray()
    values, X = np.linalg.eigh(K)
    w, s = np.sqrt(np.maximum(values, 0.0)), 2j * np.pi * hz
    modal = 1.0 / (s**2 + 2.0 * RATIO * w[:, None] * s + w[:, None] ** 2)
    H = np.einsum("ik,jk,kf->ijf", X[[0, 16, 32]], X[[0, 16]], modal)
    return H * np.array([s**0, s, s**2])[:, None]


@pytest.mark.parametrize("ground", [0.0, 300.0])
def test_the_error_in_the_band_is_as_stated_and_residual_modes_make_it_small(
    ground: float,
) -> None:
    fmax = 9.0
    hz = np.linspace(0.5, fmax, 60)
    truth = direct(hz, ground)
    scale = np.median(np.abs(truth), axis=2, keepdims=True)
    off = {}
    for residual in (False, True):
        made = plant(ground, fmax=fmax, residual=residual)
        assert len(made) - made.residual_modes < N // 2
        assert made.residual_modes == (2 if residual else 0)
        assert made.error is not None
        off[residual] = np.max(np.abs(made.responses(hz) - truth) / scale)
        by_displacement = np.abs(made.responses(hz) - truth)[0] / scale[0]
        assert by_displacement.max() < 1.3 * made.error + 1e-9
    first_left_out = 1.5 * fmax
    assert off[True] < (fmax / first_left_out) ** 2 * off[False]


def test_the_static_answer_is_whole() -> None:
    K = chain(N, k=4e4, ground=300.0)[0].toarray()
    made = plant(300.0, n_modes=6)
    static = np.linalg.inv(K)[np.ix_([0], [0, 16])]
    assert made.receptances(np.array([0.0]))[:1, :, 0].real == pytest.approx(static, rel=1e-6)
    alone = plant(300.0, n_modes=6, residual=False)
    assert alone.receptances(np.array([0.0]))[0, 0, 0].real < 0.95 * static[0, 0]


def test_rigid_body_modes_are_kept_at_zero_unless_refused() -> None:
    assert plant(0.0, n_modes=5).frequencies_hz[0] == 0.0
    refused = basis(0.0, n_modes=5, rigid=False)
    assert refused.frequencies_hz.min() > 0.1
    assert "1 rigid-body modes are left out as asked for" in refused.notes


def test_all_modes_leave_nothing_for_residual_modes() -> None:
    assert plant(300.0, n_modes=N).residual_modes == 0


def test_the_matrices_have_the_responses() -> None:
    made = plant(300.0, n_modes=8)
    A, B, C, D = made.matrices()
    hz = np.array([0.7, 3.0, 8.0])
    s = 2j * np.pi * hz
    by_matrices = [C @ np.linalg.solve(x * np.eye(len(A)) - A, B) + D for x in s]
    assert np.moveaxis(by_matrices, 0, 2) == pytest.approx(made.responses(hz), rel=1e-9)
    assert np.linalg.eigvals(A).real.max() < 0.0


def test_modes_alone_make_the_same_plant_without_residual_modes() -> None:
    model = scalar_model(*chain(N, k=4e4, ground=300.0))
    values, X = np.linalg.eigh(model.K().toarray())
    mass = np.linspace(1.0, 5.0, N)
    modes = Modes(np.sqrt(values) / 2 / np.pi, X * np.sqrt(mass), model.dofs,
                  generalized_mass=mass)  # fmt: skip
    rows = rows_of(INTO, model.dofs, "it"), rows_of(OUT, model.dofs, "it")
    alone = basis_of_modes(modes, INTO, OUT, *rows, n_modes=6)
    whole = basis(300.0, n_modes=6, residual=False)
    assert alone.frequencies_hz == pytest.approx(whole.frequencies_hz)
    assert alone.sense @ alone.drive == pytest.approx(whole.sense @ whole.drive)
    with pytest.raises(InputError, match=r"mode 1 of .* has no generalised mass"):
        basis_of_modes(Modes(modes.frequencies_hz, X, model.dofs), INTO, OUT, *rows)
    with pytest.raises(InputError, match="are complex"):
        basis_of_modes(Modes(modes.frequencies_hz, X * 1j, model.dofs), INTO, OUT, *rows)


def test_where_no_mode_moves_is_refused() -> None:
    model = scalar_model(*chain(N, k=4e4, ground=300.0))
    shapes = np.ones((N, 1))
    shapes[16] = 0.0
    modes = Modes(np.array([2.0]), shapes, model.dofs, generalized_mass=np.ones(1))
    rows = rows_of(INTO, model.dofs, "it"), rows_of(OUT, model.dofs, "it")
    with pytest.raises(InputError, match="input 17:\\+X is fixed: no mode moves there"):
        basis_of_modes(modes, INTO, OUT, *rows)


def test_modes_in_any_order_and_close_ones_keep_their_own_damping() -> None:
    ratios = np.array([0.03, 0.01, 0.05, 0.02])
    alone = of_modes(np.array([200.0, 100.0, 100.05, 0.01]), damping=ratios)
    assert alone.damping == pytest.approx([0.03, 0.01, 0.05, np.nan], nan_ok=True)
    assert "modes up to 0.01 Hz are taken to be rigid-body motions" in alone.notes


def test_a_mode_below_zero_is_unstable_and_no_rigid_body_motion() -> None:
    with pytest.raises(InputError, match=r"mode 2 of m has -100 Hz: the model is unstable"):
        of_modes(np.array([50.0, -100.0]))
    assert len(of_modes(np.array([-1e-5, 100.0])).frequencies_hz) == 2


def test_rounding_is_no_motion() -> None:
    with pytest.raises(InputError, match=r"output 5:\+X is fixed: no mode moves there"):
        of_modes(np.array([50.0, 100.0]), at_5=1e-15)


def of_modes(hz: np.ndarray, damping: np.ndarray | None = None, at_5: float = 1.0) -> ModalBasis:
    model = scalar_model(*chain(N, k=4e4, ground=300.0))
    shapes = np.ones((N, len(hz)))
    shapes[4] = at_5
    modes = Modes(hz, shapes, model.dofs, damping, np.ones(len(hz)), "m")
    into, out = read_channels("1:X", "input"), read_channels("5:X", "output")
    rows = rows_of(into, model.dofs, "it"), rows_of(out, model.dofs, "it")
    return basis_of_modes(modes, into, out, *rows)


def test_no_error_is_stated_of_a_band_that_the_modes_asked_for_do_not_reach() -> None:
    short = basis(300.0, n_modes=3, fmax=20.0)
    assert short.difference is None
    assert any(n.startswith("the 3 modes end at") for n in short.notes)
    assert basis(300.0, n_modes=8, fmax=2.0).difference is not None


def test_a_sensor_and_a_grid_of_one_number_do_not_become_one_node() -> None:
    into, out = read_channels("1:X", "input"), read_channels("2:X,@1:X", "output")
    made = ModalPlant(np.ones(1), np.zeros(1), np.ones((1, 1)), np.ones((2, 1)), into, out,
                      band_hz=9.0)  # fmt: skip
    with pytest.raises(InputError, match="grid 1 and sensor 1 would be one node"):
        made.frfs(10)


def test_units_of_the_deck_become_si() -> None:
    """One tonne on a spring of 5 N/mm, a moment arm beside: as in kilograms and metres."""
    into = read_channels("1:X,1:RZ", "input")
    out = read_channels("1:X,1:RZ", "output")
    m, inertia = 1.0, 4e5  # t, t mm²
    shapes = np.diag([1.0 / np.sqrt(m), 1.0 / np.sqrt(inertia)])
    made = ModalPlant(np.array([0.5, 0.7]), np.zeros(2), shapes, shapes, into, out, si=False)
    H = made.in_si(1e-3, 1e3).receptances(np.array([0.0]))[:, :, 0].real
    w = 2 * np.pi * made.frequencies_hz
    assert np.diag(H) == pytest.approx([1.0 / (1000.0 * w[0] ** 2), 1.0 / (400.0 * w[1] ** 2)])


def test_an_unstable_mode_is_refused() -> None:
    with pytest.raises(InputError, match=r"mode 2 has a damping ratio of -0\.1: the model is unst"):
        ModalPlant(np.ones(2), np.array([0.0, -0.1]), np.ones((2, 2)), np.ones((3, 2)), INTO, OUT)


HZ = np.array([0.0, 4.0, 5.0, 6.0])


@pytest.mark.parametrize(
    ("asked", "ratios"),
    [
        (0.03, [0.03] * 4),
        ("2:0.01, 3=0.02, 0.005", [0.005, 0.01, 0.02, 0.005]),
        ([0.0, 0.1, 0.2, 0.3], [0.0, 0.1, 0.2, 0.3]),
        ("test,0.05", [0.0, 0.011, 0.05, 0.05]),
        ("deck", [0.0, 0.004, 0.004, 0.004]),
    ],
)
def test_damping_is_as_asked(asked: object, ratios: list[float]) -> None:
    known = {
        "test": np.array([np.nan, 0.011, np.nan, np.nan]),
        "deck": np.array([np.nan, 0.004, 0.004, 0.004]),
    }
    found, notes = choose_damping(read_damping(asked), known, HZ)  # type: ignore[arg-type]
    assert found[1:] == pytest.approx(ratios[1:])
    assert not notes


def test_damping_that_nobody_knows_is_said_and_a_default_taken() -> None:
    found, notes = choose_damping(read_damping(None), {}, HZ)
    assert found.tolist() == [0.0, 0.01, 0.01, 0.01]
    assert notes == ["no damping is known of 3 of 4 modes: 1 % of critical is taken, a default"]
    heard = {"test": np.array([np.nan, 0.02, 0.04, np.nan])}
    found, notes = choose_damping(read_damping(None), heard, HZ)
    assert found[3] == pytest.approx(0.03)
    assert "the median of the test" in notes[0]


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        (-0.01, "a damping of '-0.01' would be unstable"),
        ("a lot", "a damping of 'a lot' is no damping ratio"),
        ("9:0.01", "a damping is given for mode 9; there are 4 modes"),
        ("test", "the test says nothing of damping"),
    ],
)
def test_damping_that_is_none_is_refused(asked: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        choose_damping(read_damping(asked), {}, HZ)  # type: ignore[arg-type]
