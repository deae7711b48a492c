"""The command line called as a user calls it, in this process."""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest

from trueup.cli.app import run

DUCT = Path(__file__).parents[2] / "fixtures" / "duct"


@dataclass(frozen=True)
class Answer:
    """What a call gave back."""

    status: int
    out: str
    err: str

    @property
    def sentence(self) -> str:
        """The one line on standard error of a call that was refused."""
        lines = self.err.splitlines()
        assert len(lines) == 1, self.err
        assert lines[0].startswith("trueup: ")
        assert "Traceback" not in self.err
        assert self.out == ""
        return lines[0].removeprefix("trueup: ")


def call_trueup(*words: object) -> Answer:
    out, err = io.StringIO(), io.StringIO()
    with (
        patch.object(sys, "argv", ["trueup", *map(str, words)]),
        redirect_stdout(out),
        redirect_stderr(err),
    ):
        status = run()
    return Answer(status, out.getvalue(), err.getvalue())


@pytest.fixture(scope="session")
def call() -> Callable[..., Answer]:
    return call_trueup


@pytest.fixture(scope="session")
def duct() -> Path:
    return DUCT


@pytest.fixture
def inputs(tmp_path: Path) -> Path:
    """A copy of the duct's files that a test may spoil."""
    folder = tmp_path / "inputs"
    folder.mkdir()
    for path in DUCT.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    return folder


@pytest.fixture(scope="session")
def result_of() -> Callable[[Path], dict[str, Any]]:
    def read(run_folder: Path) -> dict[str, Any]:
        result: dict[str, Any] = json.loads((run_folder / "result.json").read_text())
        return result

    return read
