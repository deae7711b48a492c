"""``trueup identify`` and FRFs in place of modes, as a user calls them."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from trueup.adapters.store import read_store
from trueup.adapters.universal import read_universal, write_universal
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from

HZ, DAMPING = np.array([20.0, 50.0, 80.0]), np.array([0.01, 0.005, 0.02])
NODES = np.array([1, 2, 3, 4])
SHAPES = np.array([[1.0, 1.0, 1.0], [0.5, -0.5, -1.0], [-0.4, -0.9, 0.6], [0.8, 0.3, -0.2]])

PLATE = """SOL 103
CEND
METHOD = 1
BEGIN BULK
EIGRL,1,,,3
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,1.,2.,0.
GRID,4,,0.,2.,0.
CQUAD4,1,1,1,2,3,4
PSHELL,1,1,.01,1,,1
MAT1,1,7.e10,,.3,2700.
ENDDATA
"""

Call = Callable[..., Any]


def survey() -> Frfs:
    """Accelerances of three modes of unit modal mass at four sensors, driven at the first two."""
    rng = np.random.default_rng(5)
    f = np.linspace(5.0, 100.0, 800)
    s = 2j * np.pi * f
    w = 2.0 * np.pi * HZ
    gain = s**2 / (s**2 + 2.0 * (DAMPING * w)[:, None] * s + (w**2)[:, None])
    values = np.einsum("ok,ik,kl->oil", SHAPES, SHAPES[:2], gain)
    noise = rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    values = values + 0.002 * np.sqrt(np.mean(np.abs(values) ** 2)) * noise
    dofs = Dofs(NODES, np.full(4, 3))
    return Frfs(f, dofs, dofs.take(np.array([0, 1])), values)


def geometry() -> Geometry:
    return Geometry(NODES, np.array([[0.0, 0, 0], [1, 0, 0], [1, 2, 0], [0, 2, 0]]), "m")


@pytest.fixture
def frf(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "survey.unv"
    write_universal(path, geometry=geometry(), frfs=survey())
    return path


def test_modes_of_known_functions(frf: Path, call: Call) -> None:
    before = frf.read_bytes()
    answer = call("identify", frf, "--json", "-")
    assert answer.status == 0
    result = json.loads(answer.out)
    assert result["schema"] == "trueup/identify/1"
    modes = result["modes"]
    assert [m["frequency_hz"] for m in modes] == pytest.approx(HZ, rel=1e-4)
    assert [m["damping_ratio"] for m in modes] == pytest.approx(DAMPING, rel=1e-2)
    for m, hz, zeta in zip(modes, HZ, DAMPING, strict=True):
        assert 0.0 < m["frequency_std"] < 1e-3 * hz
        assert abs(m["frequency_hz"] - hz) < 5.0 * m["frequency_std"]
        assert abs(m["damping_ratio"] - zeta) < 5.0 * m["damping_std"]
        assert m["mpc"] > 0.99
        assert m["mpd"] < 5.0
        assert m["quality"] > 0.99
        assert m["generalized_mass"] == pytest.approx(1.0, rel=0.05)
        assert m["close_pair_possible"] is False
    assert [r["node"] for r in result["references"]] == [1, 2]
    assert result["responses"] == [{"node": int(n), "direction": "Z"} for n in NODES]
    assert result["bands"][0]["low_hz"] == pytest.approx(5.0)
    assert result["bands"][-1]["high_hz"] == pytest.approx(100.0)
    assert frf.read_bytes() == before


def test_the_run_folder(frf: Path, call: Call, result_of: Callable[[Path], Any]) -> None:
    assert call("identify", frf, "--quiet").out == ""
    run = Path("survey_identify")
    assert {p.name for p in run.iterdir()} == {
        "modes.unv", "modes_complex.unv", "result.h5", "result.json", "stabilisation.html",
        "study.toml", "tables",
    }  # fmt: skip
    hz = [m["frequency_hz"] for m in result_of(run)["modes"]]
    content = read_universal([run / "modes.unv"])
    assert content.modes is not None
    assert content.modes.frequencies_hz == pytest.approx(hz, rel=1e-6)
    assert content.length_unit == "m"
    vertical = content.modes.dofs.component == 3
    mac = np.abs(np.sum(content.modes.shapes[vertical] * SHAPES, axis=0)) ** 2
    mac /= np.sum(content.modes.shapes[vertical] ** 2, axis=0) * np.sum(SHAPES**2, axis=0)
    assert mac.min() > 0.999
    told = read_universal([run / "modes_complex.unv"]).modes
    assert told is not None
    assert told.is_complex
    store = read_store(run / "result.h5")
    assert set(store.modes) == {"test", "test_complex"}
    assert store.matrices["shape_std"].shape == store.modes["test"].shapes.shape
    assert "3 modes between 5 and 100 Hz" in (run / "stabilisation.html").read_text()
    assert call("identify", frf, "--quiet").status == 0
    assert Path("survey_identify_2").is_dir()
    assert "stabilisation.html" in call("report", run).sentence


def test_all_of_it_can_stand_in_a_study(
    frf: Path, call: Call, result_of: Callable[[Path], Any]
) -> None:
    study = Path("study.toml")
    study.write_text('test = ["survey.unv"]\nfmin = 35.0\nrefuse = [80.0]\nout = "by_study"\n')
    assert "1 mode between 35" in call("identify", "--study", study).out
    again = call("identify", "--study", Path("by_study", "study.toml"), "--out", "again")
    assert again.status == 0
    assert result_of(Path("again"))["modes"] == result_of(Path("by_study"))["modes"]
    both = call("identify", frf, "--study", study, "--fmin", 6, "--out", "both")
    assert "2 modes between 6" in both.out
    assert "names it as its test" in call("identify").err
    study.write_text("tests = 1")
    assert "'tests'" in call("identify", "--study", study).sentence


@pytest.mark.parametrize("suffix", ["unv", "h5"])
def test_only_the_modes(frf: Path, call: Call, suffix: str) -> None:
    target = Path(f"modes.{suffix}")
    answer = call("identify", frf, "--fmin", 35, "--fmax", 95, "--out", target)
    assert answer.status == 0
    assert "2 modes between 35" in answer.out
    assert not Path("survey_identify").exists()
    modes = read_store(target).modes["test"] if suffix == "h5" else read_universal([target]).modes
    assert modes is not None
    assert modes.frequencies_hz == pytest.approx(HZ[1:], rel=1e-3)
    assert "--force" in call("identify", frf, "--out", target).sentence


def test_a_poor_mode_is_kept_and_marked(frf: Path, call: Call) -> None:
    answer = call("identify", frf, "--fmax", 80.5)
    assert answer.status == 0
    assert "1 marked as poor" in answer.out
    assert "at the edge of the measured range" in answer.err


def ring() -> tuple[Geometry, Frfs, Any]:
    """A ring's pair of ovalling modes, 0.3 % apart at 0.5 % damping, with 1 % noise.

    Radial sensors, every third one mounted inwards; two references.
    """
    node, angle = np.arange(1, 13), np.arange(12) * np.pi / 6.0
    out = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(12)])
    axis = np.where((node % 3 == 0)[:, None], -out, out)
    shapes = np.column_stack([np.cos(2.0 * angle), np.sin(2.0 * angle)])
    seen = shapes * np.sum(axis * out, axis=1)[:, None]
    poles = poles_from(np.array([50.0, 50.15]), np.array([0.005, 0.005]))
    driven = np.array([1, 5])
    f = np.linspace(42.0, 58.0, 640)
    values = modal_response(f, poles, seen + 0j, seen[driven] / (2j * poles.imag))
    rng = np.random.default_rng(2)
    e = rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    values += 0.01 * np.sqrt(np.mean(np.abs(values) ** 2, axis=2, keepdims=True)) * e / np.sqrt(2)
    values[7, 1] = np.nan
    dofs = Dofs(node, np.ones(12, int), axis)
    return Geometry(node, out, "m"), Frfs(f, dofs, dofs.take(driven), values), shapes


def test_a_pair_from_rovings_with_turned_sensors(frf: Path, call: Call) -> None:
    place, survey, truth = ring()
    files = []
    for k in range(3):
        rows = np.arange(k, 12, 3)
        part = replace(survey, responses=survey.responses.take(rows), values=survey.values[rows])
        here = np.union1d(part.responses.node, part.references.node)
        nodes = Geometry(here, place.xyz[here - 1], "m")
        files.append(Path(f"roving{k}.unv"))
        write_universal(files[-1], geometry=nodes, frfs=part)
    answer = call("identify", *files, "--out", "pair.unv", "--json", "-", "--quiet")
    assert answer.status == 0
    result = json.loads(answer.out)
    assert [m["frequency_hz"] for m in result["modes"]] == pytest.approx([50.0, 50.15], rel=2e-4)
    assert not any(m["close_pair_possible"] for m in result["modes"])
    assert (len(result["responses"]), len(result["references"])) == (12, 2)
    modes = read_universal([Path("pair.unv")]).modes
    assert modes is not None
    angle = (modes.dofs.node - 1) * np.pi / 6.0
    outward = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))])
    found = np.zeros((12, 2))
    np.add.at(
        found, modes.dofs.node - 1, modes.shapes * np.sum(modes.dofs.axis * outward, 1)[:, None]
    )
    a, b = np.linalg.qr(found)[0], np.linalg.qr(truth)[0]
    assert np.linalg.svd(a.T @ b)[1].min() ** 2 > 0.99


def test_one_reference_warns_of_pairs(frf: Path, call: Call) -> None:
    f = survey()
    one = replace(f, references=f.references.take(np.array([0])), values=f.values[:, :1])
    write_universal(frf, geometry=geometry(), frfs=one)
    answer = call("identify", frf)
    assert "a close pair may hide" in answer.out
    assert "one reference cannot tell" in " ".join(answer.err.split())


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--fmin", 60, "--fmax", 40], "empty"),
        (["--fmin", 200], "frequency line"),
        (["--max-order", 1], "order"),
        (["--refuse", 33], "no mode to refuse"),
        (["--take", 33], "no root can be taken at"),
        (
            ["--take", 70, "--fmax", 60],
            "no root can be taken at 70 Hz: only 5 to 59.93 Hz take part",
        ),
        (
            ["--refuse", 50, "--band", "5:30", "--band", "70:100"],
            "only 5 to 29.97 and 70.04 to 99.88 Hz take part",
        ),
        (["--modes", 0], "0 modes are asked for"),
        (["--modes", 99], "99 modes are asked for; the functions hold"),
        (["--band", "60:15"], "the band 60:15 Hz is reversed"),
        (["--band", "15:15"], "the band 15:15 Hz is empty"),
        (["--band", "-5:15"], "the band -5:15 Hz begins below 0 Hz"),
        (["--band", "15-60"], "'bands' holds '15-60', which is no band as 15:60 is"),
        (["--band", "15:60:80"], "which is no band as 15:60 is"),
        (["--band", "15:x"], "which is no band as 15:60 is"),
        (["--band", "5:nan"], "'bands' must be a finite number"),
        (["--band", "40:60", "--fmax", 30], "the band 40:60 Hz lies above fmax 30 Hz"),
        (["--band", "40:40.1"], "frequency line(s) between 40 and 40.1 Hz"),
        (["--out", "nowhere/modes.unv"], "does not exist"),
        (["--out", "survey.unv"], "input itself"),
    ],
)
def test_options_that_cannot_be(frf: Path, call: Call, options: list[Any], said: str) -> None:
    answer = call("identify", frf, *options)
    assert answer.status == 1
    assert said in answer.sentence
    assert not Path("survey_identify").exists()


def test_what_lies_outside_of_the_bands_takes_no_part(frf: Path, call: Call) -> None:
    """20 and 80 Hz are found; 50 Hz, in the gap, is not, and nothing is said of it."""
    options = ("--band", "70:95", "--band", "8:20", "--band", "19:35", "--json", "-", "--quiet")
    result = json.loads(call("identify", frf, *options).out)
    assert [m["frequency_hz"] for m in result["modes"]] == pytest.approx(HZ[[0, 2]], rel=1e-3)
    assert [m["damping_ratio"] for m in result["modes"]] == pytest.approx(DAMPING[[0, 2]], rel=0.05)
    assert all(not 35 < r["frequency_hz"] < 70 for r in result["rejected"])
    step = 95.0 / 799
    assert result["lines"] == pytest.approx((27.0 + 25.0) / step, abs=2)
    assert result["range_hz"] == pytest.approx([8.0, 95.0], abs=step)
    ends = [(b["low_hz"], b["high_hz"]) for b in result["bands"]]
    assert all(high < 36 or low > 69 for low, high in ends)
    assert len(call("identify", frf, *options).out) > 0


def test_as_many_modes_as_there_are(frf: Path, call: Call) -> None:
    """The shape that is known least goes first, and its mode says so."""
    scaled = survey()
    s = 2j * np.pi * scaled.frequencies_hz  # of two modes; the third, at 80 Hz, hardly moves
    w = 2.0 * np.pi * HZ
    gain = s**2 / (s**2 + 2.0 * (DAMPING * w)[:, None] * s + (w**2)[:, None])
    part = np.einsum("o,i,l->oil", SHAPES[:, 2], SHAPES[:2, 2], gain[2])
    values = scaled.values - 0.97 * part
    write_universal(frf, geometry=geometry(), frfs=replace(scaled, values=values))
    two = json.loads(call("identify", frf, "--modes", 2, "--json", "-", "--quiet").out)
    assert [m["frequency_hz"] for m in two["modes"]] == pytest.approx(HZ[:2], rel=1e-3)
    (third,) = [r for r in two["rejected"] if abs(r["frequency_hz"] - 80.0) < 0.5]
    assert third["reason"].startswith("not among the 2 best founded modes")
    three = json.loads(call("identify", frf, "--modes", 3, "--json", "-", "--quiet").out)
    whole = json.loads(call("identify", frf, "--json", "-", "--quiet").out)
    assert three == whole


def test_a_study_tells_how_modes_are_identified_on_the_way(
    frf: Path, call: Call, tmp_path: Path
) -> None:
    write_universal(tmp_path / "plate.unv", geometry=geometry(), frfs=survey())
    deck = tmp_path / "plate.bdf"
    deck.write_text(PLATE)
    study = tmp_path / "study.toml"
    study.write_text(
        'deck = "plate.bdf"\ntest = ["plate.unv"]\nmac_min = 0.01\nfrequency_tolerance = 1e3\n'
        'bands = ["8:30", [40.0, 95.0]]\nrefuse = 80\nidentify_modes = 2\n'
    )
    answer = call("correlate", "--study", study, "--json", "-", "--quiet", "--out", "run")
    assert answer.status == 0, answer.err
    assert json.loads(answer.out)["test_hz"] == pytest.approx(HZ[:2], rel=1e-3)
    again = call("correlate", "--study", "run/study.toml", "--json", "-", "--quiet")
    assert json.loads(again.out) == json.loads(answer.out)
    one = ("--refuse", 50, "--refuse", 80, "--band", "8:95", "--identify-modes", 1)
    fewer = call("correlate", "--study", study, *one, "--json", "-", "--quiet")
    assert json.loads(fewer.out)["test_hz"] == pytest.approx(HZ[:1], rel=1e-3)
    for line, said in (
        ("takes = [97.5]", "unknown key 'takes'; did you mean 'take'?"),
        ("identify_modes = 0", "identify_modes is 0; it must be 1 or more"),
        ("bands = ['60:15']", "the band 60:15 Hz is reversed"),
        ("bands = [15, 60]", "'bands' holds 15, which is no band as 15:60 is"),
        ("take = ['97.5']", "'take' has a value of the wrong type"),
        ("exponential_window = '0%'", "the exponential window is '0%'; give its time constant"),
        ("fmin = 50\nfmax = 40", "50 to 40 Hz, is empty"),
    ):
        study.write_text(f'deck = "plate.bdf"\ntest = ["plate.unv"]\n{line}\n')
        assert said in call("correlate", "--study", study).sentence
    modes = call("correlate", deck, "run.unv", "--take", 50)
    assert "does not exist" in modes.sentence
    assert call("identify", "plate.unv", "--out", "modes.unv", "--quiet").status == 0
    assert (
        "the test holds modes, so none are identified: take would say how"
        in call("correlate", deck, "modes.unv", "--take", 50).sentence
    )


def test_files_without_frequency_responses(frf: Path, call: Call) -> None:
    assert "does not exist" in call("identify", "absent.unv").sentence
    write_universal(frf, geometry=geometry())
    said = call("identify", frf).sentence
    assert "survey.unv" in said
    assert "no frequency response" in said


def test_dead_and_coherence_like_channels_are_named(frf: Path, call: Call) -> None:
    values = survey().values.copy()
    values[2] = 0.25
    values[3] = np.abs(np.sin(np.arange(values.shape[2])))
    write_universal(frf, geometry=geometry(), frfs=replace(survey(), values=values))
    answer = call("identify", frf)
    said = " ".join(answer.err.split())
    assert answer.status == 0
    assert "3:Z/1:Z, 3:Z/2:Z are the same at every line (a dead channel): left out" in said
    assert "4:Z/1:Z, 4:Z/2:Z are real and between 0 and 1 (a coherence" in said
    write_universal(frf, geometry=geometry(), frfs=replace(survey(), values=values * 0 + 1))
    assert "no frequency response that can be fitted" in call("identify", frf).sentence


def test_a_function_that_is_there_twice_is_told(frf: Path, call: Call) -> None:
    frf.write_bytes(2 * frf.read_bytes())
    answer = call("identify", frf, "--json", "-")
    assert answer.status == 0
    warnings = json.loads(answer.out)["warnings"]
    assert sum("were read before; the first is kept" in w for w in warnings) == 8


def test_time_records_beside_the_functions_are_looked_at(frf: Path, call: Call) -> None:
    """One of a response that was cut off at 1, of dataset 58, type 1."""
    t = np.arange(400) / 200.0
    wave = np.clip(3.0 * np.exp(-t) * np.sin(30.0 * t), -1.0, 1.0)
    head = "\n".join(["    -1", "    58", *["NONE"] * 5])
    codes = f"{1:5d}{0:10d}{1:5d}{0:10d} {'NONE':10s}{3:10d}{3:4d} {'NONE':10s}{0:10d}{0:4d}"
    axis = f"{2:10d}{len(t):10d}{1:10d}{0.0:13.5e}{t[1]:13.5e}{0.0:13.5e}"
    of = "\n".join(f"{k:10d}{0:5d}{0:5d}{0:5d} {'NONE':20s} {'NONE':20s}" for k in (17, 12, 0, 0))
    rows = "\n".join("".join(f"{v:13.5e}" for v in wave[k : k + 6]) for k in range(0, len(wave), 6))
    record = frf.with_name("record.unv")
    record.write_text("\n".join([head, codes, axis, of, rows, "    -1", ""]))
    said = " ".join(call("identify", frf, record).err.split())
    assert "time records of 3:Z: cut off at one value (an overload)" in said
