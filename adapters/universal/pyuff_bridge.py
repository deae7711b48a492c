"""pyuff's dictionaries in place of universal files, both ways.

pyuff and trueup meet in a file that lives as long as the call: what each makes of it is what its
own reader and writer say, and nothing of it is said twice.
"""

import copy
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ...core.data.measurement import Measurement
from ...core.errors import InputError
from ...core.late_imports import optional
from .datasets.write_functions import spacing
from .write_universal import write_universal

SAID = "pyuff's sets"
"""How messages call them."""


def sets_of(test: Measurement) -> list[dict[str, Any]]:
    """Return a test as pyuff's dictionaries; see `ModalTest.to_pyuff`."""
    even = test.frfs is not None and spacing(test.frfs.frequencies_hz)[2]
    with _file() as path:
        write_universal(
            path,
            geometry=test.geometry,
            modes=test.modes,
            frfs=test.frfs,
            units=test.length_unit,
            binary=even,  # of uneven spacing pyuff reads garbage in binary
        )
        return _sets(optional("pyuff", "pyuff").UFF(str(path)))


def is_pyuff(source: object) -> bool:
    """Tell pyuff's dictionaries, or its ``UFF``, from paths."""
    if isinstance(source, Sequence) and not isinstance(source, str):
        return len(source) > 0 and all(isinstance(s, Mapping) for s in source)
    return isinstance(source, Mapping) or type(source).__module__.split(".")[0] == "pyuff"


@contextmanager
def file_of(source: Any) -> Iterator[Path]:
    """Give a universal file of pyuff's dictionaries, which stay as they are, or of its ``UFF``.

    Raises
    ------
    InputError
        pyuff is not installed or does not accept them. What is raised inside names `SAID` where
        it named the file.
    """
    UFF = optional("pyuff", "pyuff").UFF
    if isinstance(source, Mapping):
        source = [source]
    sets = copy.deepcopy(list(source) if isinstance(source, Sequence) else _sets(source))
    with _file() as path:
        for k, each in enumerate(sets, 1):
            _write(UFF(str(path)), each, k)
        try:
            yield path
        except InputError as error:
            raise InputError(str(error).replace(str(path), SAID)) from None


def _write(file: Any, each: dict[str, Any], number: int) -> None:
    with _theirs(f"{SAID}: set {number} (type {each.get('type')}) cannot be written by pyuff"):
        file.write_sets([each], "add")


def _sets(file: Any) -> list[dict[str, Any]]:
    with _theirs(f"{SAID} cannot be read by pyuff"):
        found = file.read_sets()
    return [found] if isinstance(found, dict) else list(found)


@contextmanager
def _theirs(fault: str) -> Iterator[None]:
    """Keep pyuff quiet, and say what went wrong: what it raises is of any kind."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except Exception as error:
        raise InputError(f"{fault}: {error}") from error


@contextmanager
def _file() -> Iterator[Path]:
    with TemporaryDirectory(prefix="trueup-") as folder:
        yield Path(folder) / "sets.unv"
