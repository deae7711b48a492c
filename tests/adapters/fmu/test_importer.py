"""The units in FMPy, a simulator that knows nothing of the kernel."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from tests.adapters.fmu.plants import HZ, VERSIONS, grown, held, plant, pushes, unit

import trueup
from trueup.adapters.fmu.build_kernel import _own_platform
from trueup.adapters.nastran import build_model
from trueup.core.numerics.factorisation import factorise

fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed: pip install FMPy")

DUCT = Path(__file__).parents[3] / "fixtures" / "duct" / "duct.bdf"
OWN = [_own_platform() or "linux64"]
N, NU, NY = len(HZ), 3, 5
INPUTS, OUTPUTS = list(range(NU)), list(range(NU, NU + NY))
STATES = list(range(NU + NY, NU + NY + 2 * N))
SLOPES = list(range(NU + NY + 2 * N, NU + NY + 4 * N))
FREQUENCY, RATIO = NU + NY + 4 * N + 1, NU + NY + 5 * N + 1  # of mode 2


@contextmanager
def running(path: Path, kind: str, values: dict[int, float] | None = None) -> Iterator[Any]:
    """Yield an instance after its initialisation: `kind` is ModelExchange or CoSimulation."""
    from fmpy import extract, instantiate_fmu, read_model_description

    folder, told = extract(str(path)), read_model_description(str(path))
    fmu = instantiate_fmu(folder, told, kind)
    fmu.told = told
    try:
        if told.fmiVersion == "2.0":
            fmu.setupExperiment(startTime=0.0)
        fmu.enterInitializationMode()
        for vr, value in (values or {}).items():
            put(fmu, [vr], [value])
        fmu.exitInitializationMode()
        yield fmu
        fmu.terminate()
    finally:
        fmu.freeInstance()
        shutil.rmtree(folder)


def get(fmu: Any, vr: list[int]) -> np.ndarray:
    return np.array(fmu.getReal(vr) if hasattr(fmu, "getReal") else fmu.getFloat64(vr))


def put(fmu: Any, vr: list[int], values: Any) -> None:
    (fmu.setReal if hasattr(fmu, "setReal") else fmu.setFloat64)(vr, list(map(float, values)))


def stepped(fmu: Any, u: np.ndarray, step: float) -> np.ndarray:
    y = []
    for k, now in enumerate(u):
        put(fmu, INPUTS, now)
        fmu.doStep(k * step, step)
        y.append(get(fmu, OUTPUTS))
    return np.array(y)


def off(found: np.ndarray, exact: np.ndarray) -> float:
    """Largest difference of an output beside its largest value."""
    return float((np.abs(found - exact).max(axis=0) / np.abs(exact).max(axis=0)).max())


@pytest.mark.parametrize("version", VERSIONS)
def test_validation_finds_nothing(tmp_path: Path, version: int) -> None:
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(unit(tmp_path, version))) == []


@pytest.mark.parametrize("version", VERSIONS)
def test_another_checker_finds_nothing(tmp_path: Path, version: int) -> None:
    checker = shutil.which("fmutool", path=str(Path(sys.executable).parent))
    if checker is None:
        pytest.skip("no checker: pip install fmu-manipulation-toolbox")
    command = [checker, "-input", str(unit(tmp_path, version)), "-check"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    said = done.stdout + done.stderr
    assert f"seems to be compliant with FMI-{version}.0" in said
    assert f"No semantic error against the FMI-{version} standard" in said


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("step", [1e-5, 1e-3, 0.013, 0.4, 7.0])
def test_co_simulation_is_exact_whatever_the_step(
    tmp_path: Path, version: int, step: float
) -> None:
    u = pushes(40)
    with running(unit(tmp_path, version), "CoSimulation") as fmu:
        assert off(stepped(fmu, u, step), held(plant(), u, step)) < 1e-10


@pytest.mark.parametrize("step", [1e-5, 1e-3, 0.013, 0.4])
def test_inputs_that_grow_over_a_step_are_exact_too(tmp_path: Path, step: float) -> None:
    """Derivatives of inputs are of FMI 2.0 alone."""
    u = pushes(41)
    with running(unit(tmp_path, 2), "CoSimulation") as fmu:
        y = []
        for k, (now, then) in enumerate(pairwise(u)):
            put(fmu, INPUTS, now)
            fmu.setRealInputDerivatives(INPUTS, [1] * NU, ((then - now) / step).tolist())
            fmu.doStep(k * step, step)
            y.append(get(fmu, OUTPUTS))
        assert off(np.array(y), grown(plant(), u, step)) < 1e-10
        with pytest.raises(fmpy.fmi1.FMICallException):
            fmu.setRealInputDerivatives(INPUTS[:1], [2], [1.0])


@pytest.mark.parametrize("version", VERSIONS)
def test_a_frequency_and_a_ratio_are_tuned_before_and_within_the_run(
    tmp_path: Path, version: int
) -> None:
    hz, ratios, u = HZ.copy(), plant().damping.copy(), pushes(40)
    hz[1], ratios[1] = 3.3, 0.04
    tuned = replace(plant(), frequencies_hz=hz, damping=ratios)
    path = unit(tmp_path, version)
    with running(path, "CoSimulation", {FREQUENCY: 3.3, RATIO: 0.04}) as fmu:
        assert off(stepped(fmu, u, 0.02), held(tuned, u, 0.02)) < 1e-10
    with running(path, "CoSimulation") as fmu:
        put(fmu, [FREQUENCY, RATIO], [3.3, 0.04])
        assert off(stepped(fmu, u, 0.02), held(tuned, u, 0.02)) < 1e-10
        with pytest.raises(fmpy.fmi1.FMICallException):
            put(fmu, [RATIO], [-0.01])


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("before", [True, False])
def test_model_exchange_follows_tuned_parameters(
    tmp_path: Path, version: int, before: bool
) -> None:
    hz, ratios = HZ.copy(), plant().damping.copy()
    hz[1], ratios[1] = 3.3, 0.04
    A, B, C, D = replace(plant(), frequencies_hz=hz, damping=ratios).matrices()
    x, u = np.random.default_rng(2).normal(size=2 * N), pushes(1)[0]
    tuned = {FREQUENCY: 3.3, RATIO: 0.04}
    with running(unit(tmp_path, version), "ModelExchange", tuned if before else None) as fmu:
        if not before:  # in event mode, which follows the initialisation
            put(fmu, INPUTS, u)
            get(fmu, OUTPUTS)
            put(fmu, list(tuned), tuned.values())
        fmu.enterContinuousTimeMode()
        put(fmu, STATES, x)
        put(fmu, INPUTS, u)
        assert get(fmu, SLOPES) == pytest.approx(A @ x + B @ u, rel=1e-12)
        assert get(fmu, OUTPUTS) == pytest.approx(C @ x + D @ u, rel=1e-12)


@pytest.mark.parametrize("version", VERSIONS)
def test_states_are_saved_serialised_and_restored(tmp_path: Path, version: int) -> None:
    u = pushes(40)
    with running(unit(tmp_path, version), "CoSimulation") as fmu:
        early = stepped(fmu, u[:20], 0.02)
        word = "FMUstate" if version == VERSIONS[0] else "FMUState"
        state = getattr(fmu, f"get{word}")()
        serial = fmu.serializeFMUstate if version == VERSIONS[0] else fmu.serializeFMUState
        back = fmu.deSerializeFMUstate if version == VERSIONS[0] else fmu.deserializeFMUState
        kept = back(serial(state))
        first = stepped(fmu, u[20:], 0.02)
        getattr(fmu, f"set{word}")(kept)
        assert np.array_equal(stepped(fmu, u[20:], 0.02), first)
        fmu.reset()
        if version == VERSIONS[0]:
            fmu.setupExperiment(startTime=0.0)
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()
        assert np.array_equal(stepped(fmu, u[:20], 0.02), early)


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("kind", ["ModelExchange", "CoSimulation"])
def test_directional_derivatives_give_the_matrices(tmp_path: Path, version: int, kind: str) -> None:
    A, B, C, D = plant().matrices()
    with running(unit(tmp_path, version), kind) as fmu:
        for matrix, of, by in (
            (A, SLOPES, STATES), (B, SLOPES, INPUTS), (C, OUTPUTS, STATES), (D, OUTPUTS, INPUTS),
        ):  # fmt: skip
            columns = [fmu.getDirectionalDerivative(of, [vr], [1.0]) for vr in by]
            assert pytest.approx(matrix, rel=1e-14, abs=1e-300) == np.array(columns).T
        both = fmu.getDirectionalDerivative(SLOPES + OUTPUTS, STATES[:2] + INPUTS[:1], [2.0, -1, 3])
        seed = np.zeros(2 * N), np.zeros(NU)
        seed[0][:2], seed[1][0] = (2.0, -1.0), 3.0
        exact = np.concatenate([A @ seed[0] + B @ seed[1], C @ seed[0] + D @ seed[1]])
        assert np.array(both) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("version", VERSIONS)
def test_model_exchange_by_an_integrator_of_our_own(tmp_path: Path, version: int) -> None:
    """Inputs move between the points, which is where importers hold them."""
    end, n = 0.6, 2 * N

    def push(t: float) -> np.ndarray:
        return np.array([np.sin(11.0 * t), np.cos(5.0 * t), t])

    A, B, C, D = plant().matrices()
    at = np.linspace(0.0, end, 31)
    fine = {"method": "Radau", "rtol": 1e-10, "atol": 1e-14, "t_eval": at}
    truth = solve_ivp(lambda t, x: A @ x + B @ push(t), (0, end), np.zeros(n), jac=A, **fine)
    exact = np.array([C @ x + D @ push(t) for t, x in zip(truth.t, truth.y.T, strict=True)])
    with running(unit(tmp_path, version), "ModelExchange") as fmu:
        fmu.enterContinuousTimeMode()

        def slope(t: float, x: np.ndarray) -> np.ndarray:
            there(t, x)
            return get(fmu, SLOPES)

        def there(t: float, x: np.ndarray) -> None:
            fmu.setTime(t)
            put(fmu, INPUTS, push(t))
            put(fmu, STATES, x)

        found = solve_ivp(slope, (0, end), np.zeros(n), jac=A, **fine)
        y = []
        for t, x in zip(found.t, found.y.T, strict=True):
            there(t, x)
            y.append(get(fmu, OUTPUTS))
    assert off(np.array(y), exact) < 1e-6


@pytest.mark.parametrize("version", VERSIONS)
def test_a_simulated_frequency_response_is_the_modal_one(tmp_path: Path, version: int) -> None:
    """A sine of the second input from its own steady state, fitted by sine and cosine."""
    f, lines = 4.3, 400
    made = plant()
    A, B, _, D = made.matrices()
    s, step = 2j * np.pi * f, 1.0 / (f * lines)
    # Held over a step, u_k = Re e^{s k h}: the steady state of the discrete system.
    n = len(A)
    E = expm(np.block([[A, B[:, 1:2]], [np.zeros((1, n + 1))]]) * step)
    z = np.exp(s * step)
    X = np.linalg.solve(z * np.eye(n) - E[:n, :n], E[:n, n])
    start = dict(zip(STATES, X.real.tolist(), strict=True))
    u = np.zeros((2 * lines, NU))
    turns = np.exp(s * step * np.arange(2 * lines))
    u[:, 1] = turns.real
    with running(unit(tmp_path, version), "CoSimulation", start) as fmu:
        y = stepped(fmu, u, step)
    # Output k stands at the end of the step: half a step of hold lies between.
    phase = turns * np.exp(0.5 * s * step)
    fit = np.linalg.lstsq(np.column_stack([phase.real, -phase.imag]), y, rcond=None)[0]
    hold = np.sinc(f * step)
    modal = made.responses(np.array([f]))[:, 1, 0] * hold
    instant = made.quantity == 2
    found = fit[0] + 1j * fit[1]
    assert found[~instant] == pytest.approx(modal[~instant], rel=2e-4)
    # An acceleration has the held force in it, which is half a step late at the end of its step.
    late = D[:, 1] * (np.exp(-0.5 * s * step) - hold)
    lag = modal[instant] + late[instant]
    assert found[instant] == pytest.approx(lag, rel=2e-3)


@pytest.fixture(scope="module")
def duct_directly() -> dict[float, np.ndarray]:
    """Receptances 10:+Z and 333:-X over 10:+Z of all degrees of freedom, m/N, by frequency."""
    model = build_model(trueup.read_deck(DUCT))
    rows = [int(np.flatnonzero((model.dofs.node == n) & (model.dofs.component == c))[0])
            for n, c in ((10, 3), (333, 1))]  # fmt: skip
    R, K, M = sp.diags([1.0, -1.0]) @ model.expansion[rows], model.K(), model.M()
    found = {}
    for f in (14.0, 83.0, 119.0):
        Z = sp.csr_matrix(K - (2.0 * np.pi * f) ** 2 * M)
        found[f] = 1e-3 * (R @ factorise(Z, False).solve(R[0].toarray().ravel()))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("version", VERSIONS)
def test_the_duct_simulated_is_the_deck_solved_directly(
    tmp_path: Path, version: int, duct_directly: dict[float, np.ndarray]
) -> None:
    """Sines through the unit, and all degrees of freedom of the deck, undamped, in the band."""
    asked = {"inputs": "10:+Z", "outputs": "10:+Z,333:-X", "fmax": 120.0, "damping": 0.0}
    told = trueup.write_fmu(DUCT, tmp_path / "duct.fmu", fmi=version, platforms=OWN, **asked)
    (note,) = [w for w in told.warnings if "what is left out" in w]
    stated = float(note.split("is about ")[1].split(" %")[0]) / 100.0
    with running(tmp_path / "duct.fmu", "CoSimulation") as fmu:
        names = {v.name: v.valueReference for v in fmu.told.modelVariables}
        n = sum(name.endswith(".q") for name in names)
        push, motions = [0], [1, 2]
        states, slopes = list(range(3, 3 + 2 * n)), list(range(3 + 2 * n, 3 + 4 * n))
        A = np.array([fmu.getDirectionalDerivative(slopes, [vr], [1.0]) for vr in states]).T
        B = np.array(fmu.getDirectionalDerivative(slopes, push, [1.0]))
        C = np.array([fmu.getDirectionalDerivative(motions, [vr], [1.0]) for vr in states]).T
        band = 2j * np.pi * np.linspace(2.0, 120.0, 60)
        usual = np.median([np.abs(C @ np.linalg.solve(s * np.eye(2 * n) - A, B)) for s in band], 0)
        for f, direct in duct_directly.items():
            lines, s = 400, 2j * np.pi * f
            step = 1.0 / (f * lines)
            E = expm(np.block([[A, B[:, None]], [np.zeros((1, 2 * n + 1))]]) * step)
            start = np.linalg.solve(np.exp(s * step) * np.eye(2 * n) - E[:-1, :-1], E[:-1, -1])
            put(fmu, states, start.real)
            turns = np.exp(s * step * np.arange(lines))
            y = []
            for k, now in enumerate(turns.real):
                put(fmu, push, [now])
                fmu.doStep(k * step, step)
                y.append(get(fmu, motions))
            phase = turns * np.exp(0.5 * s * step) * np.sinc(f * step)
            fit = np.linalg.lstsq(np.column_stack([phase.real, -phase.imag]), np.array(y))[0]
            assert (np.abs(fit[0] + 1j * fit[1] - direct) < stated * usual).all()
