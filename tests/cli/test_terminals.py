"""What is printed can be printed: on terminals and into files of any encoding."""

from __future__ import annotations

import os
import signal
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
             "-p", "MAT1 1 E", "-p", "MAT1 1 RHO", "--max-iterations", 1, "--out", tmp_path / "run",
             "-q")  # fmt: skip
    said = call(*asked)
    assert said.out == ""
    assert "stay as in the deck" in said.err


def test_a_test_mode_without_a_partner_cannot_be_moved_to(call, duct, tmp_path):
    asked = ("update", duct / "duct.bdf", duct / "duct_test.unv", "--test-mode", 7, "-p",
             "PBAR 11 I1", "--out", tmp_path / "run")  # fmt: skip
    said = call(*asked)
    assert said.status == 1
    assert "none of the test modes that take part pairs" in said.sentence
    assert not (tmp_path / "run").exists()


def test_a_folder_that_cannot_be_written_is_said_before_the_work(call, duct, tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    said = call("discover", duct / "duct.bdf", duct / "duct_test.unv", "--out",
                tmp_path / "file" / "run")  # fmt: skip
    assert said.status == 1
    assert "cannot be written" in said.sentence


@pytest.mark.skipif(os.name == "nt", reason="no SIGINT is sent there")
def test_an_interrupted_verb_says_what_it_was_at_and_leaves_nothing(duct, tmp_path):
    words = ("discover", duct / "duct.bdf", duct / "duct_test.unv", "--out", tmp_path / "run")
    told = ["-c", "import signal, runpy; signal.signal(signal.SIGINT, signal.default_int_handler);"
            "runpy.run_module('trueup', run_name='__main__')"]  # fmt: skip
    done = subprocess.Popen(
        [sys.executable, *told, *map(str, words), "-v"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert done.stderr is not None
    assert done.stderr.readline() == "reading and placing\n"
    done.send_signal(signal.SIGINT)
    _, err = done.communicate(timeout=120)
    assert done.returncode == 130
    assert "interrupted while reading and placing; nothing was written" in err
    assert not list(tmp_path.iterdir())
