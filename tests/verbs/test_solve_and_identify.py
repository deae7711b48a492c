"""`trueup.solve` and `trueup.identify`: as in a terminal, with the nouns in hand."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trueup
from trueup.adapters.store import read_store
from trueup.adapters.universal import read_universal, write_universal
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry

DUCT = Path(__file__).parents[2] / "fixtures" / "duct"
HZ, DAMPING, NODES = np.array([20.0, 60.0]), np.array([0.01, 0.02]), np.array([1, 2, 3])
SHAPES = np.array([[1.0, 1.0], [0.5, -0.9], [-0.4, 0.6]])


@pytest.fixture(scope="module")
def survey() -> Frfs:
    """Accelerances of two modes of unit modal mass at three sensors, driven at the first."""
    f = np.linspace(5.0, 90.0, 600)
    s, w = 2j * np.pi * f, 2.0 * np.pi * HZ
    gain = s**2 / (s**2 + 2.0 * (DAMPING * w)[:, None] * s + (w**2)[:, None])
    values = np.einsum("ok,ik,kl->oil", SHAPES, SHAPES[:1], gain)
    noise = np.random.default_rng(5).standard_normal((2, *values.shape))
    dofs = Dofs(NODES, np.full(3, 3))
    return Frfs(f, dofs, dofs.take(np.array([0])), values + 1e-3 * (noise[0] + 1j * noise[1]))


@pytest.fixture(scope="module")
def file(survey: Frfs, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("survey") / "survey.unv"
    xyz = np.array([[0.0, 0, 0], [1, 0, 0], [1, 2, 0]])
    write_universal(path, geometry=Geometry(NODES, xyz, "m"), frfs=survey)
    return path


def test_modes_are_identified_in_files_and_in_functions(survey: Frfs, file: Path) -> None:
    for source in (survey, file, [str(file)], trueup.read_test(file)):
        found = trueup.identify(source, fmax=85.0)
        assert [m.frequency_hz for m in found.modes] == pytest.approx(HZ, rel=1e-3)
        assert found.range_hz[1] <= 85.0
        assert len(found.content.modes["test"]) == 2
    assert found.frf == ()
    assert trueup.identify(file).frf == (str(file),)


def test_what_an_identification_saved_is_opened_again(file: Path, tmp_path: Path) -> None:
    found = trueup.identify(file)
    folder = found.save(tmp_path / "run")
    again = trueup.open_run(folder)
    assert isinstance(again, trueup.Identified)
    assert again.to_dict() == found.to_dict() == json.loads((folder / "result.json").read_text())
    twice = again.save(tmp_path / "again")
    for path in folder.iterdir():
        if path.is_file() and path.suffix != ".h5":
            both = ((f / path.name).read_bytes() for f in (folder, twice))
            there, back = (re.sub(rb"\d\d-\w{3}-\d\d \d\d:\d\d:\d\d", b"", x) for x in both)
            assert there == back, path.name
    modes = read_universal([found.write(tmp_path / "modes.unv")]).modes
    assert modes is not None
    assert modes.frequencies_hz == pytest.approx(HZ, rel=1e-3)


def test_what_an_identification_cannot_use_is_named(file: Path) -> None:
    with pytest.raises(trueup.InputError, match="no frequency response"):
        trueup.identify(DUCT / "duct_test.unv")
    with pytest.raises(trueup.InputError, match="holds no frequency responses"):
        trueup.identify(trueup.read_test(DUCT / "duct_test.unv"))
    with pytest.raises(trueup.InputError, match="'fmin' has a value of the wrong type: '5'"):
        trueup.identify(file, fmin="5")  # type: ignore[arg-type]
    with pytest.raises(trueup.InputError, match="'max_order' has a value of the wrong type"):
        trueup.identify(file, max_order=2.5)  # type: ignore[arg-type]
    with pytest.raises(trueup.InputError, match="exponential window is '2 %%'"):
        trueup.identify(file, exponential_window="2 %%")
    with pytest.raises(trueup.InputError, match="a test is given as int"):
        trueup.identify(3)


def test_normal_modes_of_a_deck_and_of_a_model(tmp_path: Path) -> None:
    from trueup.adapters.nastran import build_model

    deck = trueup.read_deck(DUCT / "duct.bdf")
    found, path = trueup.solve(deck, 9), trueup.solve(str(DUCT / "duct.bdf"), fmax=40.0)
    assert (len(found.modes), found.rigid_body_modes) == (9, 6)
    assert found.mass == path.mass
    assert path.modes[-1].frequency_hz < 40.0
    assert path.modes[-1].frequency_hz == pytest.approx(found.modes[7].frequency_hz)
    assert found.checks.missed == 0
    model = trueup.solve(build_model(deck), 9)
    assert [m.frequency_hz for m in model.modes] == [m.frequency_hz for m in found.modes]
    assert model.mass is None
    assert len(read_store(found.write(tmp_path / "modes.h5")).modes["analysis"]) == 9
    with pytest.raises(trueup.InputError, match=r"\.txt: modes are written"):
        found.write(tmp_path / "modes.txt")


@pytest.mark.parametrize(
    ("request_", "modes", "told"),
    [
        ("EIGRL,1,,,2", 2, None),
        ("EIGRL,1,,100.", 2, None),
        ("EIGRL,1,,100.,1", 1, None),
        ("EIGR,1,LAN,0.,100.", 2, None),
        ("EIGR,1,GIV,0.,1.,,2", 2, None),
        ("EIGRL,1,5.,300.", 3, "asks for modes from 5 Hz: the 1 below"),
        ("EIGRL,1,,1.", 0, "no mode lies below 1 Hz"),
    ],
)
def test_what_the_deck_asks_for_is_found(
    tmp_path: Path, request_: str, modes: int, told: str | None
) -> None:
    """A clamped bar with a mass of 10 kg at its tip: 3.99, 5.65 and 231 Hz."""
    deck = tmp_path / "bar.bdf"
    deck.write_text(
        f"SOL 103\nCEND\nMETHOD=1\nSPC=1\nBEGIN BULK\n{request_}\nGRID,1,,0.,0.,0.\n"
        "GRID,2,,1.,0.,0.\nSPC1,1,123456,1\nCBAR,1,1,1,2,0.,1.,0.\n"
        "PBAR,1,1,1.E-4,1.E-8,2.E-8,3.E-8\nMAT1,1,2.1E11,,.3\nCONM2,5,2,,10.\nENDDATA\n"
    )
    found = trueup.solve(deck)
    stiffness = 2.1e11 * np.array([3e-8, 6e-8, 1e-4])
    expected = np.sqrt(stiffness / 10.0) / (2.0 * np.pi)
    assert [m.frequency_hz for m in found.modes] == pytest.approx(expected[:modes], rel=1e-6)
    assert [told in w for w in found.warnings] == [True] if told else not found.warnings
    assert len(trueup.solve(deck, 3).modes) == 3


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"number": 0}, "number is 0"),
        ({"number": 1.5}, "'number' has a value of the wrong type: 1.5"),
        ({"number": True}, "'number' has a value of the wrong type: True"),
        ({"fmax": -3.0}, "fmax is -3.0"),
        ({"fmax": "high"}, "'fmax' has a value of the wrong type: 'high'"),
        ({"fmax": float("inf")}, "'fmax' must be a finite number"),
    ],
)
def test_what_a_solution_cannot_use_is_named(given: dict[str, Any], said: str) -> None:
    with pytest.raises(trueup.InputError, match=said):
        trueup.solve(DUCT / "duct.bdf", **given)
