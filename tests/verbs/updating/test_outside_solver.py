"""The user's own solver verifies an update: `trueup solve` as that, one that is off, bad ones."""

from __future__ import annotations

import shlex
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest
from tests.verbs.updating.test_measured_beside import TRUTH

import trueup
from trueup.adapters.nastran import read_modes
from trueup.adapters.nastran.editing.changed_deck import ChangedDeck
from trueup.verbs.updating.outside_solver import outside_solver

SELF = f"{shlex.quote(sys.executable)} -m trueup solve {{deck}} -n 6 --out modes.h5"
HIGHER = """
import h5py, subprocess, sys
subprocess.run([sys.executable, "-m", "trueup", "solve", sys.argv[1], "-n", "6", "--out",
                "modes.h5"], check=True)
with h5py.File("modes.h5", "r+") as file:
    for modes in file["modes"].values():
        modes["frequencies_hz"][...] *= 1.03
"""
"""A solver whose frequencies are three percent higher."""


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))


def run(files: tuple[Path, Path], solver: str, **more: object) -> trueup.Updated:
    return trueup.update(
        *files, ["MAT1 1 E"], residuals="frequencies", deck_length_unit="mm",
        solver=solver, regularisation=0.0, **more,
    )  # fmt: skip


def script(tmp_path: Path, text: str) -> str:
    file = tmp_path / "solver.py"
    file.write_text(text)
    return f"{shlex.quote(sys.executable)} {shlex.quote(str(file))} {{deck}}"


def test_trueups_own_solver_agrees_with_itself(files: tuple[Path, Path], tmp_path: Path) -> None:
    done = run(files, SELF)
    assert done.parameters[0].factor == pytest.approx(TRUTH[0], rel=1e-4)
    assert done.solver is not None
    assert done.solver.runs == 2
    assert done.solver.off_before < 1e-4 > done.solver.off_after
    again = trueup.open_run(done.save(tmp_path / "run"))
    assert again.to_dict() == done.to_dict()
    assert again.study.solver == SELF


def test_a_solver_that_is_off_is_corrected_for(files: tuple[Path, Path], tmp_path: Path) -> None:
    done = run(files, script(tmp_path, HIGHER))
    assert done.parameters[0].factor == pytest.approx(TRUTH[0] / 1.03**2, rel=1e-3)
    assert done.solver is not None
    assert done.solver.off_before == pytest.approx(3.0, rel=1e-3)
    assert done.solver.left < 0.05
    worst = max(abs(p.deviation_percent) for p in done.after.pairs)
    assert worst < 0.05
    assert len(done.after.pairs) == len(done.before.pairs) == 6
    start = np.array([p.deviation_percent for p in done.before.pairs])
    np.testing.assert_allclose(start, 100.0 * (1.03 / TRUTH[0] ** 0.5 - 1.0), atol=0.01)


def test_every_configuration_is_verified(files: tuple[Path, Path], tmp_path: Path) -> None:
    """Two that are alike, solved by two processes."""
    deck, test = files
    states = [{"name": name, "deck": deck, "test": test} for name in ("empty", "Full")]
    done = trueup.update(
        parameters=["MAT1 1 E"], configurations=states, residuals="frequencies",
        deck_length_unit="mm", regularisation=0.0, solver=script(tmp_path, HIGHER),
        executor="processes:2",
    )  # fmt: skip
    assert done.parameters[0].factor == pytest.approx(TRUTH[0] / 1.03**2, rel=1e-3)
    for result in done.results.values():
        assert result.solver.off_before == pytest.approx(3.0, rel=1e-3)
        assert max(abs(p.deviation_percent) for p in result.after.pairs) < 0.05
    again = trueup.open_run(done.save(tmp_path / "run"))
    assert again.results["Full"].solver == done.results["Full"].solver


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("print('licence expired'); raise SystemExit(7)", r"status 7 \('licence expired'\)"),
        ("print('done')", r"left no modes \('done'\)"),
        (
            "open('out.f06', 'w').write('*** USER FATAL MESSAGE 9050 (SEKRRS)\\n')",
            r"left no modes \('\*\*\* USER FATAL MESSAGE 9050 \(SEKRRS\)'\)",
        ),
        ("open('out.op2', 'wb').write(bytes(range(256)) * 40)", "left no modes"),
        ("import time; time.sleep(60)", "did not end within 2 s"),
    ],
    ids=["dead", "silent", "fatal", "garbage", "hung"],
)
def test_a_bad_run_ends_in_a_sentence_and_keeps_the_deck(
    files: tuple[Path, Path], tmp_path: Path, text: str, said: str
) -> None:
    with pytest.raises(trueup.CheckError, match=said) as error:
        run(files, script(tmp_path, text), solver_limit=2.0)
    folder = Path(str(error.value).rsplit(" are in ", 1)[1])
    assert (folder / "bar.bdf").read_text() == files[0].read_text()
    assert (folder / "solver.log").is_file()


def test_a_command_that_cannot_be_is_refused(files: tuple[Path, Path]) -> None:
    with pytest.raises(trueup.InputError, match="say where the deck goes"):
        run(files, "nastran job.bdf")
    with pytest.raises(trueup.InputError, match="'no-such-nastran' cannot be run"):
        run(files, "no-such-nastran {deck}")
    with pytest.raises(trueup.InputError, match="solver_limit"):
        run(files, SELF, solver_limit=0.0)


@pytest.mark.parametrize("kept", ["modes.op2", "modes.h5", "modes.f06"])
def test_modes_are_taken_of_what_msc_nastran_leaves(kept: str, tmp_path: Path) -> None:
    """A solver that leaves one of the files of a recorded run of MSC Nastran."""
    recorded = Path(__file__).parents[4] / "shared" / "data" / "nastran" / "svanberg_beam"
    if not recorded.is_dir():
        pytest.skip("no shared data beside the repository")
    deck = trueup.read_deck(recorded / "modes.dat")
    changed = ChangedDeck.of(deck.text, deck.text)
    copy = f"import shutil; shutil.copy({str(recorded / kept)!r}, {kept!r})"
    with outside_solver(script(tmp_path, copy), 60.0) as solver:
        found = solver.modes(changed)
    np.testing.assert_allclose(
        found.frequencies_hz, read_modes(recorded / "modes.op2", deck).frequencies_hz, rtol=1e-5
    )
    assert not list(tmp_path.glob("trueup-solver-*"))
