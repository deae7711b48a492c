"""Where independent pieces of work run: here, in processes of this machine, on a Dask cluster."""

from __future__ import annotations

import os
import pickle
import re
import subprocess
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from typing import Any

from ...core.errors import CheckError, InputError
from ...core.independent import Each, R, T, in_turn

_TRIES = 3
"""Processes or workers that may end under a piece of work before it is given up."""
_GRACE = 5
"""Seconds that a process may take to end by itself."""
_ANSWERS = 30
"""Seconds that a Dask scheduler may take to answer."""
_FORM = re.compile(r"processes(:(?P<number>[1-9]\d*))?|dask:(?P<address>.+)")


def require_executor(asked: str) -> None:
    """Refuse what names no executor.

    Raises
    ------
    InputError
        It is neither ``processes``, ``processes:N`` nor ``dask:ADDRESS``.
    """
    if not _FORM.fullmatch(asked):
        raise InputError(f"executor is '{asked}'; give processes, processes:4 or dask:ADDRESS")


@contextmanager
def executor(asked: str) -> Iterator[Each]:
    """Give what does independent pieces of work, until the block ends.

    A piece whose process or worker ends under it is done again by another, so that the answer is
    the same.

    Raises
    ------
    InputError
        As `require_executor`; dask is not installed, or no scheduler answers.
    CheckError
        A piece of work ended its process `_TRIES` times.
    """
    require_executor(asked)
    found = _FORM.fullmatch(asked)
    assert found is not None
    if found["address"]:
        with _cluster(found["address"]) as each:
            yield each
        return
    yield partial(_in_processes, int(found["number"] or os.cpu_count() or 1))


def _in_processes(number: int, work: Callable[[T], R], items: Sequence[T], /) -> Iterator[R]:
    if min(number, len(items)) < 2:
        yield from in_turn(work, items)
        return
    threads = str(max(1, (os.cpu_count() or 1) // number))
    path = os.pathsep.join(p for p in sys.path if p)
    settings = {"OMP_NUM_THREADS": threads, **os.environ, "PYTHONPATH": path}
    sent, running, ended = pickle.dumps(work), set[subprocess.Popen[bytes]](), threading.Event()

    def one(item: T) -> R:
        for _ in range(_TRIES):
            if ended.is_set():
                break
            piece = sent + pickle.dumps(item)
            process = subprocess.Popen(
                [sys.executable, "-m", "trueup.verbs.studies.piece_of_work"],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=settings,
                start_new_session=True,
            )  # fmt: skip
            running.add(process)
            answer, _ = process.communicate(piece)
            running.discard(process)
            if process.returncode == 0:
                value: R = _answer(pickle.loads(answer))
                return value
        raise CheckError(f"a piece of the work ended its process {_TRIES} times; is memory short?")

    with ThreadPoolExecutor(number) as pool:
        try:
            yield from pool.map(one, items)
        finally:
            ended.set()
            for process in tuple(running):
                _end(process)


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process; it first ends what it started itself, the user's solver."""
    process.terminate()
    try:
        process.wait(_GRACE)
    except subprocess.TimeoutExpired:
        process.kill()


def answered(work: Callable[[Any], R], item: Any) -> tuple[R | None, Exception | None]:
    """Return what comes of a piece of work, or what it raises."""
    try:
        return work(item), None
    except Exception as error:  # noqa: BLE001 - raised again where it was asked for
        return None, error


def _answer(told: tuple[R | None, Exception | None]) -> R:
    value, error = told
    if error is not None:
        raise error
    return value  # type: ignore[return-value]


@contextmanager
def _cluster(address: str) -> Iterator[Each]:
    try:
        from distributed import Client
    except ImportError:
        raise InputError(
            f"executor 'dask:{address}' needs Dask; pip install 'trueup[dask]'"
        ) from None
    try:
        client = Client(address, timeout=_ANSWERS)
    except (OSError, TimeoutError, ValueError) as error:
        why = " ".join(str(error).split()) or type(error).__name__
        raise InputError(f"no Dask scheduler answers at '{address}': {why}") from None
    with client:
        yield partial(_on_cluster, client)


def _on_cluster(client: Any, work: Callable[[T], R], items: Sequence[T], /) -> Iterator[R]:
    """Send the work once, as a task of its own, which is done again if its worker ends."""
    from distributed import KilledWorker

    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Sending large graph", UserWarning)
            shared = client.submit(pickle.loads, pickle.dumps(work), pure=False)
            told = client.map(answered, [shared] * len(items), items, pure=False)
        for one in told:
            value: R = _answer(one.result())
            yield value
    except KilledWorker:
        raise CheckError("a piece of the work ended its Dask workers; is memory short?") from None
    except ModuleNotFoundError as error:
        raise InputError(f"the Dask workers lack '{error.name}'; install trueup there") from None
