"""What is wrong with the input is said in one clear sentence, with status 1, nothing written."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import typer

from trueup.cli import app as application

Call = Callable[..., Any]
Change = Callable[[str], str]


def edit(path: Path, change: Change) -> None:
    text = path.read_text()
    changed = change(text)
    assert changed != text
    path.write_text(changed)


def refused(call: Call, inputs: Path, *words: object, verb: str = "correlate") -> str:
    """Return the sentence of a refused run; nothing may have been written."""
    out = inputs.parent / "run"
    before = sorted(inputs.rglob("*"))
    deck, test = inputs / "duct.bdf", inputs / "duct_test.unv"
    said = call(verb, deck, test, "--out", out, *words)
    assert said.status == 1, (said.out, said.err)
    assert not out.exists()
    assert sorted(inputs.parent.iterdir()) == [inputs]
    assert sorted(inputs.rglob("*")) == before
    sentence: str = said.sentence
    return sentence


def test_a_missing_include(call: Call, inputs: Path) -> None:
    (inputs / "mesh.bdf").unlink()
    sentence = refused(call, inputs)
    assert re.search(r"duct\.bdf line 14: the INCLUDE file 'mesh\.bdf' does not exist", sentence)


def test_a_missing_deck(call: Call, inputs: Path) -> None:
    (inputs / "duct.bdf").unlink()
    assert "duct.bdf: No such file" in refused(call, inputs)


def test_a_missing_test(call: Call, inputs: Path) -> None:
    (inputs / "duct_test.unv").unlink()
    assert "duct_test.unv does not exist" in refused(call, inputs)


def test_a_truncated_universal_file(call: Call, inputs: Path) -> None:
    edit(inputs / "duct_test.unv", lambda t: t[: len(t) * 5 // 9])
    sentence = refused(call, inputs)
    assert re.search(r"duct_test\.unv line \d+: the file ends inside dataset 55", sentence)
    assert "export or copy it again" in sentence


def test_nan_in_a_shape(call: Call, inputs: Path) -> None:
    """The value at one node of the first mode; NaN is never taken for 0."""
    edit(inputs / "duct_test.unv", lambda t: t.replace("  2.50239e-03", "          NaN", 1))
    sentence = refused(call, inputs)
    assert "duct_test.unv" in sentence
    assert re.search(r"line \d+: .* not a finite number at node 2;", sentence)


def test_a_test_with_no_geometry(call: Call, inputs: Path) -> None:
    edit(
        inputs / "duct_test.unv",
        lambda t: re.sub(r"    -1\n    15 *\n.*?\n    -1\n", "", t, count=1, flags=re.DOTALL),
    )
    sentence = refused(call, inputs)
    assert "a test with no geometry cannot be placed" in sentence
    assert "2411" in sentence


def test_a_test_a_thousand_times_too_small(call: Call, inputs: Path) -> None:
    """Dataset 164 says millimetres where the numbers are metres."""
    scale = "   1.0000000000000000D+00"
    edit(inputs / "duct_test.unv", lambda t: t.replace(scale, "   1.0000000000000000D+03", 1))
    sentence = refused(call, inputs, "--deck-length-unit", "mm")
    assert "1000" in sentence
    assert "unit" in sentence


def test_a_deck_unit_that_cannot_be_right(call: Call, inputs: Path) -> None:
    sentence = refused(call, inputs, "--deck-length-unit", "m")
    assert "1000" in sentence
    assert "unit" in sentence


@pytest.mark.parametrize(
    ("parameter", "sentence"),
    [
        ("PBAR 99 I1", "there is no PBAR 99 in the deck; the deck has PBAR 11"),
        ("PBAR 11 QQ", "PBAR has no value 'QQ': it has A, I1, I2"),
        ("flange", "parameter 'flange' lacks"),
        ("PBAR 11 I1 [2, 1]", "the bounds [2, 1] are factors on the deck's value"),
        ("PWHAT 11 I1", "PWHAT"),
    ],
)
def test_a_parameter_that_names_no_card(
    call: Call, inputs: Path, parameter: str, sentence: str
) -> None:
    assert sentence in refused(call, inputs, "-p", parameter, verb="update")


@pytest.mark.parametrize("option", ["--from", "--to"])
def test_a_format_that_is_none_is_named_by_its_option(
    call: Call, inputs: Path, option: str
) -> None:
    said = call("convert", inputs / "duct.bdf", inputs / "a.h5", option, "xyz")
    assert said.status == 1
    assert said.sentence.startswith(f"{option} 'xyz' is n")


def test_an_update_of_nothing(call: Call, inputs: Path) -> None:
    out = inputs.parent / "run"
    said = call("update", inputs / "duct.bdf", inputs / "duct_test.unv", "--out", out)
    assert said.status == 2
    assert "no parameter is named" in said.err
    assert not out.exists()


HINGED = """SOL 103
CEND
METHOD = 1
SPC = 1
BEGIN BULK
EIGRL,1,,,4
GRID,1,,0.,0.,0.
GRID,2,,.1,0.,0.
GRID,3,,.2,0.,0.
GRID,74,,.3,0.,0.
CBAR,1,1,1,2,0.,1.,0.
CBAR,2,1,2,3,0.,1.,0.
CBAR,3,1,3,74,0.,1.,0.
,5
PBAR,1,1,1.-4,1.-9,4.-9,1.-9
MAT1,1,2.1+11,,.3,7850.
SPC1,1,123456,1
ENDDATA
"""


@pytest.mark.parametrize("verb", ["correlate", "solve"])
def test_a_free_mechanism(call: Call, inputs: Path, verb: str) -> None:
    """The last bar of a cantilever hangs on a hinge (pin flag 5) and turns freely."""
    (inputs / "duct.bdf").write_text(HINGED)
    if verb == "solve":
        said = call("solve", inputs / "duct.bdf", "--out", inputs.parent / "modes.h5")
        assert said.status == 1, said.out
        sentence = said.sentence
        assert not (inputs.parent / "modes.h5").exists()
    else:
        sentence = refused(call, inputs)
    assert "mechanism" in sentence
    assert re.search(r"\b74:", sentence)


STUDY = 'deck = "duct.bdf"\ntest = ["duct_test.unv"]\n'


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (STUDY + "mac_mim = 0.7\n", "unknown key 'mac_mim'; did you mean 'mac_min'?"),
        (STUDY + "quux = 1\n", "unknown key 'quux'; known: deck, test"),
        (STUDY + 'mac_min = "high"\n', "'mac_min' has a value of the wrong type: 'high'"),
        (STUDY + "mac_min = true\n", "'mac_min' has a value of the wrong type: True"),
        (STUDY + "test_modes = [1.5]\n", "'test_modes' has a value of the wrong type: 1.5"),
        (STUDY + "stages = 3\n", "'stages' has a value of the wrong type: 3"),
        (STUDY + "[[stages]]\nresidual = 'shapes'\n", "did you mean 'residuals'?"),
        (STUDY + "mac_min = \n", "is not valid TOML"),
        (STUDY + "mac_min = 7.0\n", "mac_min is 7.0; give a value above 0 and up to 1"),
        (STUDY + "rotate = 'both'\n", "rotate is 'both'; give one of analysis, test, none"),
        (STUDY + "deck_length_unit = 'cm'\n", "deck_length_unit is 'cm'; give one of m, mm"),
        (STUDY + "residuals = 'all'\nparameters = ['PBAR 11 I1']\n", "residuals is 'all'"),
        (
            STUDY + "parameters = ['a = PBAR 11 I1']\n[[stages]]\nparameters = ['b']\n",
            "a stage names the parameter 'b'",
        ),
    ],
)
def test_a_study_file_with_a_mistake(call: Call, inputs: Path, text: str, sentence: str) -> None:
    study = inputs / "study.toml"
    study.write_text(text)
    verb = "update" if "parameters" in text else "correlate"
    said = call(verb, "--study", study, "--out", inputs.parent / "run")
    assert said.status == 1
    assert sentence in said.sentence
    assert sorted(inputs.parent.iterdir()) == [inputs]


def test_a_study_file_that_is_missing_or_no_text(call: Call, inputs: Path) -> None:
    assert "study file" in call("correlate", "--study", inputs / "no.toml").sentence
    (inputs / "latin.toml").write_bytes(b"deck = '\xe9.bdf'\n")
    assert "is not UTF-8 text" in call("correlate", "--study", inputs / "latin.toml").sentence


def test_a_report_of_what_is_no_run_folder(call: Call, inputs: Path) -> None:
    assert "is not a run folder" in call("report", inputs).sentence
    (inputs / "result.json").write_text("{'no json")
    assert "cannot be read" in call("report", inputs).sentence
    (inputs / "result.json").write_text('{"schema": "other/1"}')
    assert "is not a result of trueup" in call("report", inputs).sentence
    assert not (inputs / "report.html").exists()


@pytest.mark.parametrize(
    "words",
    [
        ("correlate",),
        ("correlate", "deck.bdf"),
        ("correlate", "--nonsense"),
        ("correlate", "deck.bdf", "test.unv", "--mac-min", "much"),
        ("nonsense",),
        ("solve",),
        ("solve", "deck.bdf", "-n", "many"),
        ("report",),
        ("update", "deck.bdf", "test.unv", "-p"),
        ("update", "deck.bdf", "test.unv", "--residuals", "everything"),
        ("update", "deck.bdf", "test.unv", "--max-iterations", "0"),
        ("correlate", "deck.bdf", "test.unv", "--rotate", "both"),
        ("correlate", "deck.bdf", "test.unv", "--mac-min", "1.2"),
        ("correlate", "deck.bdf", "test.unv", "--deck-length-unit", "km"),
        ("solve", "deck.bdf", "-n", "0"),
        ("solve", "deck.bdf", "--fmax", "-1"),
    ],
)
def test_wrong_usage_has_status_two(call: Call, words: tuple[str, ...]) -> None:
    said = call(*words)
    assert said.status == 2
    assert said.out == ""
    assert "Error: " in said.err
    assert "Traceback" not in said.err


def failing(error: BaseException) -> typer.Typer:
    app = typer.Typer(pretty_exceptions_enable=False)

    @app.command()
    def fail() -> None:
        raise error

    return app


@pytest.mark.parametrize(
    ("error", "status", "sentence"),
    [
        (ZeroDivisionError("division\nby zero"), 70, "(ZeroDivisionError: division by zero)"),
        (AssertionError(), 70, "(AssertionError:"),
        (MemoryError(), 1, "memory does not suffice"),
        (PermissionError(13, "Permission denied", "/x/y"), 1, "/x/y: Permission denied"),
    ],
)
def test_no_exception_ever_shows_a_traceback(
    call: Call, monkeypatch: pytest.MonkeyPatch, error: BaseException, status: int, sentence: str
) -> None:
    monkeypatch.delenv("TRUEUP_TRACEBACK", raising=False)
    monkeypatch.setattr(application, "app", failing(error))
    said = call()
    assert said.status == status
    assert sentence in said.sentence
    if status == 70:
        assert "set TRUEUP_TRACEBACK=1" in said.sentence


def test_the_traceback_can_be_had(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TRUEUP_TRACEBACK", "1")
    monkeypatch.setattr(application, "app", failing(KeyError("node")))
    said = call()
    assert said.status == 70
    assert said.err.startswith("Traceback")
    assert said.err.splitlines()[-1].startswith("trueup: a fault of trueup's own")


def test_a_check_that_fails_has_status_three(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    from trueup.core.errors import CheckError

    monkeypatch.setattr(application, "app", failing(CheckError("a mode was missed")))
    said = call()
    assert said.status == 3
    assert said.sentence == "a mode was missed"
