"""A terminal and a notebook give the same answer."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from io import StringIO
from pathlib import Path
from unittest.mock import patch

import pytest

import trueup
from trueup.cli.app import run
from trueup.core.results.plain import Tables

DUCT = Path(__file__).parents[2] / "fixtures" / "duct"
DATA = Path(__file__).parents[2].parent / "shared" / "data"
FILES = (DUCT / "duct.bdf", DUCT / "duct_test.unv")
TOWER = (DATA / "cases/tower_frame/tower.bdf", DATA / "cases/tower_frame/tower_test.unv")


def terminal(*words: object) -> Mapping[str, object]:
    out = StringIO()
    argv = ["trueup", *map(str, words), "--json", "-"]
    with patch.object(sys, "argv", argv), patch.object(sys, "stdout", out):
        assert run() == 0
    answer: dict[str, object] = json.loads(out.getvalue())
    return {k: v for k, v in answer.items() if k != "seconds"}


def notebook(found: Tables) -> object:
    return {k: v for k, v in found.to_dict().items() if k != "seconds"}


def test_correlate(tmp_path: Path) -> None:
    said = terminal("correlate", *FILES, "--rotate", "test", "--out", tmp_path / "run")
    assert said == notebook(trueup.correlate(*FILES, rotate="test"))


def test_update(tmp_path: Path) -> None:
    words = ("-p", "PBAR 11 I1", "--max-iterations", "2", "--out", tmp_path / "run")
    said = terminal("update", *FILES, *words)
    assert said == notebook(trueup.update(*FILES, "PBAR 11 I1", max_iterations=2))


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="../shared/data is absent")
def test_discover(tmp_path: Path) -> None:
    said = terminal("discover", *TOWER, "--deck-length-unit", "mm", "--out", tmp_path / "run")
    assert said == notebook(trueup.discover(*TOWER, deck_length_unit="mm"))


def test_solve() -> None:
    assert terminal("solve", FILES[0], "-n", 8) == notebook(trueup.solve(FILES[0], 8))


@pytest.mark.skipif(not DATA.is_dir(), reason="../shared/data is absent")
def test_identify(tmp_path: Path) -> None:
    frf = DATA / "uff" / "garteur_frf_1995.uff"
    said = terminal("identify", frf, "--fmax", 20, "--out", tmp_path / "run")
    assert said == notebook(trueup.identify(frf, fmax=20.0))


def test_inspect() -> None:
    assert terminal("inspect", *FILES) == notebook(trueup.inspect(list(FILES)))


def test_convert(tmp_path: Path) -> None:
    to = tmp_path / "a.h5", tmp_path / "b.h5"
    said = terminal("convert", FILES[1], to[0])
    told = notebook(trueup.convert(FILES[1], to[1]))
    assert {**said, "destination": str(to[1])} == told
