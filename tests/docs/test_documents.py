"""The code in the documents runs as it stands."""

from __future__ import annotations

import contextlib
import io
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from trueup.cli.app import run
from trueup.verbs.studies.study import read_study, study_keys

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
DATA = ROOT.parent / "shared" / "data"
BLOCK = re.compile(r"^```(python|sh)([^\n]*)\n(.*?)^```", re.M | re.S)
NEEDED = {
    "tutorial-garteur.md": (
        "nastran/garteur/garteur_fem.bdf",
        "uff/garteur_frf_1995.uff",
        "uff/garteur_geometry.unv",
    )
}


def blocks(path: Path) -> Iterator[tuple[str, str, str]]:
    """Language, words after it, and text of each fenced block."""
    for match in BLOCK.finditer(path.read_text(encoding="utf-8")):
        yield match[1], match[2].strip(), match[3]


def run_blocks(path: Path, monkeypatch: pytest.MonkeyPatch, skipped: set[str]) -> None:
    space: dict[str, object] = {"__name__": path.stem}
    for language, words, text in blocks(path):
        if words in skipped:
            continue
        if language == "python":
            exec(compile(text, str(path), "exec"), space)
        for line in text.splitlines() if language == "sh" else ():
            if line.startswith("trueup "):
                monkeypatch.setattr("sys.argv", shlex.split(line))
                assert run() == 0, line


def test_every_key_of_a_study_is_documented():
    text = (DOCS / "how-to.md").read_text(encoding="utf-8")
    assert [k for k in study_keys() if f"`{k}`" not in text] == []


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    shutil.copytree(ROOT / "fixtures" / "duct", tmp_path / "duct")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def prepared(name: str, folder: Path) -> Path:
    for needed in NEEDED.get(name, ()):
        if not (DATA / needed).is_file():
            pytest.skip(f"{needed} is not beside the checkout: a public file that is not shipped")
        shutil.copy(DATA / needed, folder)
    return DOCS / name


@pytest.mark.parametrize("name", ["tutorial-duct.md", "tutorial-garteur.md"])
def test_a_tutorial_runs_as_it_stands(
    name: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with contextlib.redirect_stdout(io.StringIO()):
        run_blocks(prepared(name, folder), monkeypatch, {"slow"})


@pytest.mark.slow
def test_the_unit_in_a_loop_is_the_direct_solution(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("fmpy", reason="FMPy is not installed: pip install FMPy")
    with contextlib.redirect_stdout(io.StringIO()) as said:
        run_blocks(DOCS / "simulation.md", monkeypatch, set())
    assert "11598 degrees of freedom directly, and the unit beside" in said.getvalue()
    assert (folder / "plant.fmu").is_file()


@pytest.mark.slow
def test_the_duct_tutorial_runs_to_its_end(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with contextlib.redirect_stdout(io.StringIO()) as said:
        run_blocks(DOCS / "tutorial-duct.md", monkeypatch, set())
    assert (folder / "completed").is_dir()
    assert said.getvalue().count("mass") >= 3


@pytest.mark.parametrize("name", ["make_reference.py", "make_cards.py"])
def test_a_page_made_from_the_code_is_current(name: str) -> None:
    made = subprocess.run([sys.executable, DOCS / name, "--check"], check=False)
    assert made.returncode == 0, f"python docs/{name} writes the page anew"


def test_every_link_between_documents_leads_somewhere() -> None:
    for path in (ROOT / "README.md", *sorted(DOCS.glob("*.md"))):
        text = path.read_text(encoding="utf-8")
        for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", text):
            if "://" not in target:
                assert (path.parent / target).exists(), f"{path.name}: {target}"


def test_the_study_of_the_how_to_is_read(tmp_path: Path) -> None:
    text = re.search(r"^```toml\n(.*?)^```", (DOCS / "how-to.md").read_text(), re.M | re.S)
    assert text
    path = tmp_path / "study.toml"
    path.write_text(text[1], encoding="utf-8")
    study = read_study(path)
    assert study.deck == tmp_path / "duct.bdf"
    assert len(study.parameters) == 2
