"""A run folder: written whole or not at all."""

import json
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from ...core.errors import InputError, Place
from ...core.files import replacing
from ...core.results.plain import plain

_OWN = {
    "changes.diff",
    "deck",
    "modes.h5",
    "modes.unv",
    "modes_complex.unv",
    "report.html",
    "result.h5",
    "result.json",
    "stabilisation.html",
    "study.toml",
}


@contextmanager
def run_folder(path: Path, force: bool) -> Iterator[Path]:
    """Give a temporary folder beside `path` that takes its name when all went well.

    Raises
    ------
    InputError
        When `path` exists and `force` is not given, or cannot be written.
    """
    refuse_existing(path, force)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        work = Path(tempfile.mkdtemp(prefix=f".{path.name}.", dir=path.parent))
    except OSError as error:
        raise _unwritten(path, error) from error
    try:
        yield work
        work.chmod(0o755)
        if path.exists():
            old = Path(tempfile.mkdtemp(prefix=f".{path.name}.old.", dir=path.parent))
            os.replace(path, old / path.name)
            os.replace(work, path)
            _keep_foreign(old / path.name, path)
            shutil.rmtree(old)
        else:
            os.replace(work, path)
    except OSError as error:
        raise _unwritten(path, error) from error
    finally:
        shutil.rmtree(work, ignore_errors=True)


def _unwritten(path: Path, error: OSError) -> InputError:
    return Place(path).fault(f"cannot be written: {error.strerror or error}")


def _keep_foreign(old: Path, new: Path) -> None:
    """Move what trueup did not write from a replaced run folder to the new one."""
    for entry in old.iterdir():
        if entry.name not in _OWN and not (new / entry.name).exists():
            os.replace(entry, new / entry.name)


def refuse_existing(path: Path, force: bool) -> None:
    """Raise `InputError` when a run folder would be written over another, or cannot be."""
    if path.exists() and not force:
        raise Place(path).fault("exists; give force=True to replace it or another run folder")
    if path.exists() and not (path.is_dir() and (path / "result.json").exists()):
        raise Place(path).fault("exists and is not a run folder; give another run folder")
    there = next((p for p in path.absolute().parents if p.exists()), path.parent)
    try:
        Path(tempfile.mkdtemp(prefix=".trueup.", dir=there)).rmdir()
    except OSError as error:
        raise _unwritten(path, error) from error


def json_text(result: Mapping[str, object]) -> str:
    """Return strict JSON (a value that is not a number becomes null), keys in order."""
    return json.dumps(plain(result), indent=1, allow_nan=False) + "\n"


def write_json(path: Path, result: Mapping[str, object]) -> None:
    """Write a result atomically."""
    write_text(path, json_text(result))


def write_text(path: Path, text: str) -> None:
    """Write a text file atomically."""
    with replacing(path) as fresh:
        fresh.write_text(text, encoding="utf-8")
