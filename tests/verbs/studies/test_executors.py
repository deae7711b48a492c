"""Independent pieces of work elsewhere: the same answer, whoever dies in the middle of them."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import trueup
from trueup.core.errors import CheckError, InputError
from trueup.core.independent import Each, in_turn
from trueup.core.updating.metropolis import adaptive_metropolis
from trueup.verbs.studies import executors
from trueup.verbs.studies.executors import executor
from trueup.verbs.updating import solved_decks
from trueup.verbs.updating.outside_solver import _run

NUMBERS = [3.0, 1.0, 4.0, 1.5, 9.0]


def root(of: float) -> float:
    return float(np.sqrt(of))


def root_of_a_survivor(mark: Path, of: float) -> float:
    """End the process the first time that it comes to 4."""
    if of == 4.0 and not mark.exists():
        mark.write_text("")
        os.kill(os.getpid(), signal.SIGKILL)
    return root(of)


def deadly(of: float) -> float:
    os.kill(os.getpid(), signal.SIGKILL)
    return of


def refusing(of: float) -> float:
    os.write(1, b"what a piece of work prints is no part of its answer")
    if of == 4.0:
        raise InputError("four is at fault")
    return of


@pytest.fixture(scope="module")
def scheduler() -> Iterator[str]:
    distributed = pytest.importorskip("distributed", reason="needs the extra dask")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster:
        yield f"dask:{cluster.scheduler_address}"


@pytest.fixture(params=["processes:2", "dask"])
def asked(request: pytest.FixtureRequest) -> str:
    if request.param == "dask":
        return str(request.getfixturevalue("scheduler"))
    return str(request.param)


@pytest.mark.filterwarnings("default")
def test_the_answer_is_the_same_where_one_is_killed_in_the_middle(asked: str, tmp_path: Path):
    mark = tmp_path / "mark"
    with executor(asked) as each:
        assert list(each(partial(root_of_a_survivor, mark), NUMBERS)) == list(
            in_turn(root, NUMBERS)
        )
    assert mark.exists()


def height_elsewhere(mark: Path, here: int, x: np.ndarray) -> float:
    """A Gaussian; whoever else asks for it first is killed."""
    if os.getpid() != here and not mark.exists():
        mark.write_text("")
        os.kill(os.getpid(), signal.SIGKILL)
    return -0.5 * float(x @ x)


@pytest.mark.filterwarnings("default")
def test_chains_go_on_alike_where_one_is_killed(asked: str, tmp_path: Path):
    def chains(each: Each, pid: int) -> np.ndarray:
        height = partial(height_elsewhere, tmp_path / "mark", pid)
        return adaptive_metropolis(height, np.zeros(2), np.eye(2), 400, 3, each).values

    here = chains(in_turn, os.getpid())
    with executor(asked) as each:
        np.testing.assert_array_equal(chains(each, os.getpid()), here)
    assert (tmp_path / "mark").exists()


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_what_a_piece_raises_is_raised_here(asked: str):
    with executor(asked) as each, pytest.raises(InputError, match="four is at fault"):
        list(each(refusing, NUMBERS))


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_a_piece_that_kills_whoever_does_it_is_given_up(asked: str):
    with executor(asked) as each, pytest.raises(CheckError, match="is memory short"):
        list(each(deadly, NUMBERS))


@pytest.mark.parametrize("asked", ["threads", "processes:0", "dask:", "processes:two"])
def test_what_is_no_executor_is_refused(asked: str):
    with pytest.raises(InputError, match=r"give processes, processes:4 or dask:ADDRESS"):
        trueup.update("deck.bdf", "test.unv", ["MAT1 1 E"], executor=asked)


@pytest.mark.filterwarnings("default")
def test_a_scheduler_that_does_not_answer_is_named(monkeypatch: pytest.MonkeyPatch):
    pytest.importorskip("distributed", reason="needs the extra dask")
    monkeypatch.setattr(executors, "_ANSWERS", 1)
    with (
        pytest.raises(InputError, match=r"no Dask scheduler answers at 'tcp://127.0.0.1:9'"),
        executor("dask:tcp://127.0.0.1:9"),
    ):
        pass


def started(folder: Path, of: float) -> int:
    """Start a command as the user's solver is started, which goes on for a minute."""
    words = [sys.executable, "-c", "import os, sys, time; open(sys.argv[1], 'w').write("
             "str(os.getpid())); time.sleep(60)", str(folder / f"{of:g}")]  # fmt: skip
    with (folder / f"{of:g}.log").open("wb") as log:
        return _run(words, folder, log, 60.0)


@pytest.fixture
def ctrl_c() -> Iterator[None]:
    """Heard, though a shell that starts this in the background has it ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.slow
@pytest.mark.usefixtures("ctrl_c")
def test_what_pieces_have_started_ends_with_them(tmp_path: Path):
    """Ctrl-C while two solvers run elsewhere."""
    marks = [tmp_path / "1", tmp_path / "2"]

    def interrupt() -> None:
        while not all(m.exists() and m.read_text() for m in marks):
            time.sleep(0.05)
        signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

    threading.Thread(target=interrupt, daemon=True).start()
    with executor("processes:2") as each, pytest.raises(KeyboardInterrupt):
        list(each(partial(started, tmp_path), [1.0, 2.0]))
    for mark in marks:
        with pytest.raises(ProcessLookupError):
            os.kill(int(mark.read_text()), 0)


def updated(files: tuple[Path, Path], **more: object) -> trueup.Updated:
    return trueup.update(
        *files, ["MAT1 1 E"], residuals="frequencies", deck_length_unit="mm", starts=3,
        regularisation=0.0, **more,
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_starts_end_alike_wherever_they_run(files: tuple[Path, Path], asked: str):
    here = updated(files, executor="processes:1")
    there = updated(files, executor=asked)
    assert [s.factors for s in there.starts] == [s.factors for s in here.starts]
    assert [q.factor for q in there.parameters] == [q.factor for q in here.parameters]


@pytest.mark.filterwarnings("default")
def test_chains_are_the_same_wherever_they_run(files: tuple[Path, Path], asked: str):
    more = {"samples": 400, "prior_sigma": 0.3}
    here, there = (
        trueup.update(*files, ["MAT1 1 E"], residuals="frequencies, prior", deck_length_unit="mm",
                      executor=whose, **more)
        for whose in ("processes:1", asked)
    )  # fmt: skip
    np.testing.assert_array_equal(there.draws.values, here.draws.values)
    assert list(there.samples) == list(here.samples)


def test_an_update_goes_on_where_it_was_cut_off(files: tuple[Path, Path], tmp_path: Path):
    keep = tmp_path / "keep"
    whole = updated(files, keep=keep)
    pieces = sorted(p.name for p in keep.iterdir())
    assert pieces == ["0", "1", "2", "3", "made_of"]
    (keep / "3").unlink()
    before = {p: (keep / p).stat().st_mtime_ns for p in ("1", "2")}
    again = updated(files, keep=keep)
    assert {p: (keep / p).stat().st_mtime_ns for p in before} == before
    assert [s.factors for s in again.starts] == [s.factors for s in whole.starts]
    assert again.parameters[0].factor == pytest.approx(whole.parameters[0].factor, rel=1e-4)
    assert [h.factors for h in again.history][: len(whole.history)] == [
        h.factors for h in whole.history
    ]
    with pytest.raises(InputError, match="is not of this study, deck, test and version"):
        updated(files, keep=keep, seed=7)


@pytest.mark.filterwarnings("default")
def test_configurations_are_solved_alike_wherever_that_is(
    files: tuple[Path, Path], asked: str, monkeypatch: pytest.MonkeyPatch
):
    """Each deck is read and solved, and the updated one again, by the executor."""
    sent: list[str] = []

    @contextmanager
    def told(who: str) -> Iterator[Each]:
        with executor(who) as each:
            yield lambda work, items: (sent.append(work.__name__), each(work, items))[1]

    monkeypatch.setattr(solved_decks, "executor", told)
    states = [{"name": n, "deck": files[0], "test": files[1]} for n in ("one", "other")]

    def together(who: str) -> trueup.UpdatedTogether:
        done = trueup.update(parameters=["MAT1 1 E"], configurations=states, executor=who,
                             residuals="frequencies", deck_length_unit="mm")  # fmt: skip
        assert isinstance(done, trueup.UpdatedTogether)
        return done

    here = together("processes:1")
    assert not sent
    monkeypatch.setattr(solved_decks, "_WORTH_SENDING", 1)
    there = together(asked)
    assert sent == ["_analysis", "_solved_again"]
    assert [q.factor for q in there.parameters] == [q.factor for q in here.parameters]
    for name, own in here.results.items():
        assert there.results[name].pairs == own.pairs
        assert there.results[name].deck.diff == own.deck.diff
