"""What is printed can be printed: on terminals and into files of any encoding."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from trueup.core.ascii import in_ascii


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "utf-8"])
def test_tables_come_out_whatever_the_encoding(encoding, duct, tmp_path):
    words = ("correlate", duct / "duct.bdf", duct / "duct_test.unv", "--out", tmp_path / "run")
    done = subprocess.run(
        [sys.executable, "-m", "trueup", *map(str, words), "--deck-length-unit", "mm"],
        env={**os.environ, "PYTHONIOENCODING": encoding},
        capture_output=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    text = done.stdout.decode(encoding)
    assert ("−9.85" if encoding == "utf-8" else "-9.85") in text
    assert "?" not in text


def test_signs_are_spelled_and_the_rest_is_marked():
    assert in_ascii("x1.2 ± 0.1 → θ = 30°, é, 日") == "x1.2 +/- 0.1 -> theta = 30 deg, e, ?"


def test_quiet_keeps_the_warnings(call, duct, tmp_path):
    asked = ("update", duct / "duct.bdf", duct / "duct_test.unv", "--residuals", "frequencies",
             "-p", "MAT1 1 E", "-p", "MAT1 1 RHO", "--out", tmp_path / "run", "-q")  # fmt: skip
    said = call(*asked)
    assert said.out == ""
    assert "stays as in the deck" in said.err


def test_a_test_mode_without_a_partner_cannot_be_moved_to(call, duct, tmp_path):
    asked = ("update", duct / "duct.bdf", duct / "duct_test.unv", "--test-mode", 7, "-p",
             "PBAR 11 I1", "--out", tmp_path / "run")  # fmt: skip
    said = call(*asked)
    assert said.status == 1
    assert "none of the test modes that take part pairs" in said.sentence
    assert not (tmp_path / "run").exists()
