"""Whose report it is, and what it was made of."""

from __future__ import annotations

import hashlib
import shutil

import trueup

LOGO = '<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><rect width="9"/></svg>'
STUDY = """
deck = "duct.bdf"
test = ["duct_test.unv"]
deck_length_unit = "mm"
title = "Duct & test"
author = "A. Author"
company = "Works Ltd"
date = 2026-11-22
logo = "logo.svg"
"""


def test_the_report_carries_title_author_logo_and_the_hashes_of_its_inputs(duct, call, tmp_path):
    inputs = tmp_path / "inputs"
    shutil.copytree(duct, inputs)
    (inputs / "logo.svg").write_text(LOGO, encoding="utf-8")
    (inputs / "study.toml").write_text(STUDY, encoding="utf-8")
    run = tmp_path / "run"
    assert call("correlate", "--study", inputs / "study.toml", "--out", run, "-q").status == 0
    page = (run / "report.html").read_text(encoding="utf-8")
    for said in ("Duct &amp; test", "A. Author · Works Ltd · 2026-11-22", "data:image/svg+xml;",
                 f"trueup {trueup.__version__}", "correlate --study study.toml"):  # fmt: skip
        assert said in page, said
    found = trueup.open_run(run)
    by_name = {row.path.rsplit("/", 1)[-1]: row.sha256 for row in found.inputs}
    assert set(by_name) == {"duct.bdf", "mesh.bdf", "properties.bdf", "duct_test.unv"}
    for name, digest in by_name.items():
        assert hashlib.sha256((inputs / name).read_bytes()).hexdigest() == digest
        assert digest[:16] in page
    assert call("report", run).status == 0
    assert (run / "report.html").read_text(encoding="utf-8") == page


def test_a_logo_that_is_none_is_said_before_the_work(duct, call, tmp_path):
    study = tmp_path / "study.toml"
    files = f"deck = {str(duct / 'duct.bdf')!r}\ntest = [{str(duct / 'duct_test.unv')!r}]\n"
    for logo, said in (("logo.doc", "no picture that a page shows"), ("none.png", "cannot read")):
        study.write_text(f"{files}logo = {logo!r}\n", encoding="utf-8")
        answer = call("correlate", "--study", study, "--out", tmp_path / "run")
        assert answer.status == 1
        assert said in answer.sentence
    assert not (tmp_path / "run").exists()


def test_what_modes_are_called_by_hand_and_what_the_deck_weighs(duct, call, tmp_path):
    run = tmp_path / "run"
    files = [duct / "duct.bdf", duct / "duct_test.unv"]
    named = ["--mode-name", "1=oval, upright", "--mode-name", "7=third ring"]
    unit = ["--deck-length-unit", "mm"]
    answer = call("correlate", *files, *named, *unit, "--out", run)
    assert answer.status == 0
    page = (run / "report.html").read_text(encoding="utf-8")
    found = trueup.open_run(run)
    assert found.mode_names.to_dict() == [
        {"test": 1, "name": "oval, upright"}, {"test": 7, "name": "third ring"},
    ]  # fmt: skip
    (weight,) = found.weight
    assert weight.kilograms == 1000.0 * weight.mass
    solved = trueup.solve(files[0], 7)
    assert weight.mass == solved.mass
    for said in ("oval, upright", "third ring", f"{weight.kilograms:.5g} kg"):
        assert said in page, said
        assert said.split()[-1] in answer.out, "a long name is folded in the terminal"
    assert call("correlate", *files, "--mode-name", "first", *unit).status == 2
    said = call("correlate", *files, "--mode-name", "99=far", *unit)
    assert "mode_names names test mode 99; the test has 24" in said.sentence


def test_pages_of_one_side_carry_the_letterhead_and_can_be_made_again(duct, call, tmp_path):
    study = tmp_path / "study.toml"
    deck = str(duct / "duct.bdf")
    study.write_text(f"deck = {deck!r}\ntitle = 'Modes of the duct'\n", encoding="utf-8")
    run, again = tmp_path / "run", tmp_path / "again"
    assert call("solve", "--study", study, "-n", 8, "--out", run, "-q").status == 0
    assert call("solve", "--study", run / "study.toml", "-n", 8, "--out", again, "-q").status == 0
    for folder in (run, again):
        page = (folder / "report.html").read_text(encoding="utf-8")
        for said in ("Modes of the duct", f"trueup {trueup.__version__}", "solve --study"):
            assert said in page, said
    assert len(trueup.open_run(run).inputs) == 3
    assert call("solve", "-q").status == 2
