"""The units in a C host of the project's own."""

from __future__ import annotations

import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import numpy as np
import pytest
from tests.adapters.fmu.plants import VERSIONS, held, plant, pushes, unit

COMPILER = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
STEP = 0.013


@pytest.fixture(scope="module")
def host(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if COMPILER is None:
        pytest.skip("no C compiler is at hand")
    program = tmp_path_factory.mktemp("host") / "host"
    source = Path(__file__).with_name("host.c")
    subprocess.run([COMPILER, "-O1", "-o", program, source, "-ldl"], check=True)
    return program


def opened(path: Path, folder: Path) -> tuple[Path, Path, str]:
    """Library, resources and token of a unit."""
    with zipfile.ZipFile(path) as archive:
        archive.extractall(folder)
    (library,) = [p for p in folder.glob("binaries/*/*") if "x86_64-linux" in str(p)
                  or "linux64" in str(p)] or [None]  # fmt: skip
    if library is None:
        pytest.skip("no binary of this platform")
    text = (folder / "modelDescription.xml").read_text(encoding="utf-8")
    found = re.search(r'(?:guid|instantiationToken)="([^"]*)"', text)
    assert found
    return library, folder / "resources", found[1]


def run(host: Path, *words: object) -> subprocess.CompletedProcess[str]:
    given = "\n".join(" ".join(map(repr, u)) for u in pushes(60).tolist())
    return subprocess.run(
        [str(w) for w in (host, *words)], input=given, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize("version", VERSIONS)
def test_a_host_in_c_gets_the_exact_answer(host: Path, tmp_path: Path, version: int) -> None:
    folder = tmp_path / "a folder ü"
    library, resources, token = opened(unit(tmp_path, version), folder)
    where = resources.as_uri() if version == VERSIONS[0] else resources
    done = run(host, library, where, token, version, STEP, 5)
    assert done.returncode == 0, done.stderr
    y = np.array([[float(x) for x in line.split()] for line in done.stdout.splitlines()])
    exact = held(plant(), pushes(60), STEP)
    assert np.abs(y - exact).max(axis=0) == pytest.approx(
        np.zeros(5), abs=1e-10 * np.abs(exact).max()
    )


@pytest.mark.parametrize("version", VERSIONS)
def test_what_cannot_be_instantiated_says_why(host: Path, tmp_path: Path, version: int) -> None:
    library, resources, token = opened(unit(tmp_path, version), tmp_path / "unit")
    other = run(host, library, resources, "{other}", version, STEP, 5)
    lost = run(host, library, tmp_path / "nowhere", token, version, STEP, 5)
    (resources / "plant.bin").write_bytes((resources / "plant.bin").read_bytes()[:200])
    cut = run(host, library, resources, token, version, STEP, 5)
    said = [done.stderr.replace("%s", "") for done in (other, lost, cut)]
    assert [done.returncode for done in (other, lost, cut)] == [5, 5, 5]
    if version == VERSIONS[1]:  # in 2.0 the sentence is an argument that this host does not print
        assert "the token is not that of this model" in said[0]
        assert "plant.bin cannot be opened" in said[1]
        assert "plant.bin in the resources is cut off" in said[2]
