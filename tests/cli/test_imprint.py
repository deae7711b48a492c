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
